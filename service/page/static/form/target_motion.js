/** Desired slider motion: points over the crank angle, pasted or drawn, and permitted shifts. */

import { interpolatedValue } from "../charts/cycle.js";
import { h } from "../lib/dom.js";
import { byschema } from "./controls.js";
import { points } from "./points.js";

const PATH = ["target_motion"];
const EVERY = 45; // deg between the initial points

/** Return the desired motion in one line, or "". @param {Form.Whole} form */
export function targetMotionText(form) {
  const angles = form.at([...PATH, "crank_angles"]);
  return Array.isArray(angles)
    ? `${angles.length} points`
    : form.at(PATH) === undefined
      ? ""
      : String(form.at([...PATH, "file"]) ?? "");
}

/** Return the fields of the desired motion, or the button that adds it. @param {Form.Whole} form */
export function targetMotion(form) {
  if (form.at(PATH) === undefined) {
    return h(
      "p",
      { class: "row wide" },
      h(
        "button",
        {
          type: "button",
          id: "add-target-motion",
          onclick: () => {
            form.put(PATH, first(form));
            form.redraw();
          },
        },
        "Add points of a motion",
      ),
      h(
        "span",
        { class: "quiet" },
        "Then add the motion deviation below, as an objective or a requirement.",
      ),
    );
  }
  const drop = h(
    "p",
    { class: "wide" },
    h(
      "button",
      {
        type: "button",
        onclick: () => {
          form.put(PATH, undefined);
          form.redraw("add-target-motion");
        },
      },
      "Remove the desired motion",
    ),
  );
  const free = ["phase", "shift"].map((key) => byschema(form, [...PATH, key]));
  if (form.at([...PATH, "crank_angles"]) === undefined)
    return [byschema(form, [...PATH, "file"]), free, drop];
  return [
    points(
      form,
      PATH,
      [
        { key: "crank_angles", label: "crank angle", kind: "angle" },
        { key: "positions", label: "slider position", kind: "length" },
      ],
      "Where the slider should be at crank angles that increase and span less than a turn",
    ),
    free,
    drop,
  ];
}

/** Return the initial motion: that of the sketched linkage, rounded, or else that of the description. @param {Form.Whole} form */
function first(form) {
  const motion = form.said?.example?.motion;
  const angles = motion ? Array.from({ length: 360 / EVERY }, (_, n) => n * EVERY) : [0, 90, 180];
  const positions = motion
    ? angles.map((angle) => Math.round(interpolatedValue(motion.slider_position_mm, angle) ?? 0))
    : [240, 200, 160];
  return {
    crank_angles: angles.map((angle) => `${angle} deg`),
    positions: positions.map((position) => `${position} mm`),
  };
}
