/** Motion of the crank: full rotation, or a swing between two angles, with the fields of each. */

import { h } from "../lib/dom.js";
import { say } from "../lib/notices.js";
import { byschema, choice } from "./controls.js";
import { isTable } from "./path.js";
import { points } from "./points.js";
import { speed } from "./speed.js";

/** @import { Column } from "./points.js" */

const PATH = ["motion"];
const INVERSION = ["mechanism", "inversion"];
const LEVER = "lever moved by a pivoting cylinder";
const TURNED = "rotates fully and turns a pivoting cylinder or an arm";
const SPEED = ["speed", "cycle_time", "strokes_per_minute", "direction"];
/** Keys that only a lever, or such a crank, has. */
const OF_LEVER = ["mechanism.frame_angle", "mechanism.pin_angle", "cylinder", "arm", "spring"];
/** Keys that neither has. */
const NOT_OF_LEVER = ["acceleration", "speed_profile", "rod", "slider", "cylinders", "branch"]
  .map((key) => `mechanism.${key}`)
  .concat("load", "drive", "friction", "clearance", "costs", "target_motion", "sections", "robust")
  .concat("tolerances.crank_angle", "tolerances.clearances");
/** Ways to state the ends of a swing: keys, and initial values. @type {Record<string, Record<string, string>>} */
const ENDS = {
  "two crank angles": { from: "30 deg", to: "90 deg" },
  "crank angle and swing": { from: "30 deg", swing: "60 deg" },
  "two slider positions": { slider_from: "300 mm", slider_to: "200 mm" },
  "slider position and travel": { slider_from: "300 mm", slider_travel: "-100 mm" },
};
const LABELS = {
  from: "from crank angle",
  to: "to crank angle",
  swing: "swing",
  slider_from: "from slider position",
  slider_to: "to slider position",
  slider_travel: "travel of the slider",
};
/** @type {[Column, Column]} */
const LAW = [
  { key: "law_times", label: "fraction of the time", kind: null },
  { key: "law_shares", label: "fraction of the travel", kind: null },
];
const FIRST = { kind: "swing", from: "30 deg", to: "90 deg", driver: "slider" };

/** Return whether the crank of a job swings. @param {Form.Whole} form */
export function swings(form) {
  return form.at([...PATH, "kind"]) === "swing";
}

/** Return whether a job is for a lever moved by a cylinder, or a crank that turns a cylinder or an arm. @param {Form.Whole} form */
export function isLever(form) {
  return form.at(INVERSION) !== undefined;
}

/** Return whether a quantity, or a kind of load, applies to the motion of a job. @param {Form.Whole} form @param {{ motion: string }} of */
export function appliesToMotion(form, { motion }) {
  return motion === "" || motion.split(", ").includes(motionOf(form));
}

/** Return the motion of a job in the words of the service. @param {Form.Whole} form */
function motionOf(form) {
  const [swing, turn] = isLever(form) ? ["lever", "arm"] : ["swing", "turn"];
  return swings(form) ? swing : turn;
}

/** Return the name of the keys that state the ends of a job's swing. @param {Form.Whole} form */
function stated(form) {
  const states = /** @param {string} key */ (key) => form.at([...PATH, key]) !== undefined;
  if (states("slider_travel")) return "slider position and travel";
  if (states("slider_from") || states("slider_to")) return "two slider positions";
  return states("swing") ? "crank angle and swing" : "two crank angles";
}

/** State the ends of the swing by other keys; a start of the same kind is kept. @param {Form.Whole} form @param {string} how */
function state(form, how) {
  const before = { .../** @type {Record<string, unknown>} */ (form.at(PATH)) };
  const remaining = Object.fromEntries(
    Object.entries(before).filter(
      ([key]) => !(key in LABELS) && (key !== "crank_side" || how.includes("slider")),
    ),
  );
  const wanted = ENDS[how] ?? {};
  form.put(PATH, {
    ...remaining,
    ...Object.fromEntries(
      Object.entries(wanted).map(([key, first]) => [key, before[key] ?? first]),
    ),
  });
  form.redraw();
}

/** Return the fields of the motion. turning: fields that only a fully rotating crank has. @param {Form.Whole} form @param {Dom.Child} turning */
export function motion(form, turning) {
  const lever = isLever(form);
  const kind = choice(
    {
      ...form,
      at: (path) => (!lever ? form.at(path) : swings(form) ? LEVER : TURNED),
      put: (_, value) => change(form, value),
    },
    [...PATH, "kind"],
    {
      options: ["swing", LEVER, TURNED],
      fallback: "rotates fully",
      label: "the crank",
      why: "The crank rotates fully at a given speed, swings back and forth between two angles, or is a lever moved by a cylinder on a second fixed pivot. It may also turn that cylinder, or an arm, as in shapers. With a second pivot, the rod is the frame between the pivots.",
      changed: () => form.redraw(),
    },
  );
  const angles =
    lever && ["frame_angle", "pin_angle"].map((key) => byschema(form, ["mechanism", key]));
  if (!swings(form)) return [kind, speed(form), angles, turning];
  /** @param {string} key @param {string} label */
  const motionField = (key, label) => byschema(form, [...PATH, key], { label });
  const slow = (form.at([...PATH, "law"]) ?? "slow") === "slow";
  /** @param {string} key @param {string} label @param {(chosen: string) => string[]} gone what a choice leaves without a meaning */
  const choosing = (key, label, gone) => {
    const fieldNode = motionField(key, label);
    fieldNode?.querySelector("select")?.addEventListener("change", ({ currentTarget }) => {
      for (const other of gone(/** @type {HTMLSelectElement} */ (currentTarget).value))
        form.put([...PATH, other], undefined);
      form.redraw();
    });
    return fieldNode;
  };
  const how = stated(form);
  const [usual, ...others] = Object.keys(ENDS).slice(0, lever ? 2 : undefined);
  const ways = choice(
    {
      ...form,
      at: () => (how === usual ? undefined : how),
      put: (_, value) => state(form, String(value ?? usual)),
    },
    [...PATH, "ends"],
    {
      options: others,
      fallback: usual,
      label: "stated by",
      why: "Give two crank angles, one angle and the swing from it (the start may then vary), or two slider positions (the angles then follow from the lengths).",
    },
  );
  return [
    kind,
    ways,
    ...Object.keys(ENDS[how] ?? {}).map((key) =>
      motionField(key, LABELS[/** @type {keyof typeof LABELS} */ (key)]),
    ),
    how.includes("slider") ? motionField("crank_side", "side of the crank pin") : null,
    angles ||
      choosing("driver", "driven end", (driver) =>
        driver === "slider" ? [] : ["actuator_tolerance"],
      ),
    motionField("margin", "margin from dead points"),
    choosing("law", "motion over time", (law) => [
      ...(law === "" || law === "slow" ? ["duration"] : []),
      ...(law === "table" ? [] : ["law_times", "law_shares"]),
    ]),
    slow ? null : motionField("duration", "duration of one stroke"),
    form.at([...PATH, "law"]) === "table"
      ? points(
          form,
          PATH,
          LAW,
          "Fraction of the travel at fractions of the time, both from 0 to 1",
          {
            optional: true,
            title: "points of the motion, one per line",
            files: false,
          },
        )
      : null,
    form.at([...PATH, "driver"]) === "slider"
      ? motionField("actuator_tolerance", "tolerance of the actuator")
      : null,
    turning,
    !lever &&
      h(
        "details",
        { class: "more" },
        h("summary", {}, "Crank speed (ignored for a swing)"),
        h("div", { class: "fields" }, speed(form)),
      ),
  ];
}

/** Switch between swing, full rotation and lever; remove values that do not apply, and report that. @param {Form.Whole} form @param {unknown} kind */
function change(form, kind) {
  const lever = kind === LEVER || kind === TURNED;
  const swinging = kind !== undefined && kind !== TURNED;
  form.put(PATH, swinging ? structuredClone(FIRST) : undefined);
  for (const place of lever ? NOT_OF_LEVER : OF_LEVER) form.put(place.split("."), undefined);
  if (kind === LEVER) for (const key of SPEED) form.put(["mechanism", key], undefined);
  if (kind === TURNED) form.put(["tolerances"], undefined);
  form.put(INVERSION, lever ? "turning cylinder" : undefined);
  if (lever) {
    if (swinging) form.put([...PATH, "driver"], undefined);
    form.put(["mechanism", "frame_angle"], form.at(["mechanism", "frame_angle"]) ?? "-60 deg");
  }
  /** @type {string[]} */
  const gone = [];
  for (const table of ["constraints", "objectives"]) {
    for (const name of Object.keys(form.at([table]) ?? {})) {
      const quantity = form.quantities.get(name);
      if (
        !(quantity ? appliesToMotion(form, quantity) : name !== "slow_stroke" || kind === undefined)
      ) {
        form.put([table, name], undefined);
        gone.push(quantity?.title ?? "slow stroke");
      }
    }
  }
  if (!isTable(form.at(["objectives"]))) {
    const first = form
      .judging()
      .find(({ motion: own, kind: of }) => own === motionOf(form) && (!swinging || of === "force"));
    if (first)
      form.put(["objectives", first.name], first.better === "high" ? "maximise" : "minimise");
  }
  if (gone.length)
    say(`Removed, as they apply to another motion: ${[...new Set(gone)].join(", ")}.`);
}
