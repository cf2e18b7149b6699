/** Crank speed and direction: a speed, whose sign is the direction, or a time and a direction. */

import { h } from "../lib/dom.js";
import { byschema, choice, entries } from "./controls.js";
import { field } from "./field.js";
import { idOf } from "./path.js";
import { points } from "./points.js";

const TABLE = ["mechanism"];
const DIRECTION = [...TABLE, "direction"];
/** Keys that state the speed, by label. @type {Record<string, string>} */
const SPEED_KEYS = {
  "crank speed": "speed",
  "cycle time": "cycle_time",
  "strokes per minute": "strokes_per_minute",
};
/** @type {Record<string, string | null>} */
const KINDS = { speed: "angular speed", cycle_time: "time", strokes_per_minute: null };
/** @type {Record<string, string>} */
const WHY = {
  speed: "The speed of the crank; with a speed profile, its mean over the crank angle.",
  cycle_time:
    "The time of one turn, or of two turns if a load has a cycle of 720 deg. A speed profile is scaled to it.",
  strokes_per_minute: "The number of crank turns per minute. A speed profile is scaled to it.",
};

/** Return the fields of a speed profile: harmonics or points. @param {Form.Whole} form */
export function speedProfile(form) {
  const path = ["mechanism", "speed_profile"];
  const table = points(
    form,
    path,
    [
      { key: "crank_angles", label: "crank angle", kind: "angle" },
      { key: "speeds", label: "crank speed", kind: "angular speed" },
    ],
    "Measured speeds, negative if clockwise, at increasing crank angles that span less than a turn; a smooth curve joins them. Their mean must be the crank speed; if a cycle time is given, the speeds are scaled to it",
    { optional: true, title: "speeds over the turn, one per line" },
  );
  const file = form.at([...path, "file"]) === undefined ? null : byschema(form, [...path, "file"]); // a service does not open files
  return h(
    "fieldset",
    { class: "inner" },
    h("legend", {}, "speed profile"),
    h(
      "div",
      { class: "fields" },
      byschema(form, [...path, "cosines"]),
      byschema(form, [...path, "sines"]),
      table,
      file,
    ),
  );
}

/** Return the fields for speed and direction; a cycle time or strokes per minute may replace the speed. @param {Form.Whole} form */
export function speed(form) {
  const key =
    Object.values(SPEED_KEYS).find((one) => form.at([...TABLE, one]) !== undefined) ?? "speed";
  const [usual, ...others] = Object.keys(SPEED_KEYS);
  const label = Object.keys(SPEED_KEYS).find((one) => SPEED_KEYS[one] === key) ?? usual;
  const path = [...TABLE, key];
  const kind = KINDS[key];
  const signed = key === "speed"; // its sign is the direction
  const jobValue = form.at(path);
  const backwards = signed ? /^\s*-/.test(String(jobValue)) : form.at(DIRECTION) === "clockwise";
  const speedEntry = entries(
    [{ id: idOf(path, "c"), jobValue: signed ? unsigned(jobValue) : jobValue }],
    { label, kind, unitId: idOf(path, "u") },
    write,
  );
  const [input] = speedEntry.inputs;
  const way = h(
    "select",
    { id: idOf([...TABLE, "speed"], "way"), onchange: write },
    [
      ["", "counter-clockwise"],
      ["-", "clockwise"],
    ].map(([sign, text]) =>
      h("option", { value: sign, selected: (sign === "-") === backwards }, text),
    ),
  );
  function write() {
    const typed = input.value.trim();
    if (/^[-−]/.test(typed)) {
      way.value = "-"; // as typed, so that the sign is not reversed twice
      input.value = typed.slice(1);
    }
    const value = speedEntry.read(0).value;
    form.put(DIRECTION, !signed && way.value ? "clockwise" : undefined);
    if (signed) form.put(path, value && way.value + value);
    else form.put(path, value ?? ""); // to have it reported as missing
  }
  const stated = choice(
    {
      ...form,
      at: () => (key === "speed" ? undefined : label),
      put: (_, chosen) => stateSpeedAs(form, SPEED_KEYS[String(chosen ?? usual)], way.value),
    },
    [...TABLE, "stated"],
    {
      options: others,
      fallback: usual,
      label: "speed given by",
      why: "The mean speed of the crank over the crank angle, the cycle time, or the number of crank turns per minute. A speed profile is scaled to either of the last two.",
      changed: (chosen) => form.redraw(idOf([...TABLE, SPEED_KEYS[chosen || usual]], "c")),
    },
  );
  return [
    stated,
    field(form, path, label, speedEntry.controls, WHY[key]),
    field(
      form,
      [...TABLE, "speed", "direction"],
      "direction",
      [way],
      "At constant speed, the direction of rotation and the sign of the offset determine which stroke is slow: with counter-clockwise rotation and a positive offset, it is the inward stroke.",
      { register: false },
    ),
  ];
}

/** Return a speed of a job without its sign; a plain number is in rad/s. @param {unknown} speed */
function unsigned(speed) {
  if (typeof speed === "number") return `${Math.abs(speed)} rad/s`;
  return typeof speed === "string" ? speed.replace(/^\s*[+-]/, "") : speed;
}

/** State the speed by another key, in the same direction. @param {Form.Whole} form @param {string} key @param {string} sign */
function stateSpeedAs(form, key, sign) {
  for (const other of Object.values(SPEED_KEYS)) form.put([...TABLE, other], undefined);
  form.put([...TABLE, key], key === "speed" ? sign : "");
  form.put(DIRECTION, key !== "speed" && sign ? "clockwise" : undefined);
}
