/** The speed of the crank and the way in which it turns: one value of the job, whose sign is the direction. */

import { h } from "../lib/dom.js";
import { byschema, changeUnit, numberInput, unitSelect } from "./controls.js";
import { field } from "./field.js";
import { idOf } from "./path.js";
import { points } from "./points.js";
import { taken } from "./typed_field.js";
import { split } from "../lib/units.js";

const PATH = ["mechanism", "speed"];

/** Return the fields of a speed that goes up and down over the turn: harmonics, or points. @param {Form.Whole} form */
export function speedProfile(form) {
  const path = ["mechanism", "speed_profile"];
  const table = points(form, path, [{ key: "crank_angles", label: "crank angle", kind: "angle" }, { key: "speeds", label: "crank speed", kind: "angular speed" }],
    "Measured speeds, with the sign of the speed, at crank angles that increase and span less than a turn; a smooth curve joins them. The speed of the job is their mean", { optional: true, title: "speeds over the turn, one a line" });
  const file = form.at([...path, "file"]) === undefined ? null : byschema(form, [...path, "file"]); // a service opens no files
  return h("fieldset", { class: "inner" }, h("legend", {}, "speed profile"), h("div", { class: "fields" }, byschema(form, [...path, "cosines"]), byschema(form, [...path, "sines"]), table, file));
}

/** Return the fields of speed and direction. @param {Form.Whole} form */
export function speed(form) {
  const { number, unit } = split(form.at(PATH), "angular speed");
  const backwards = number.startsWith("-");
  const input = numberInput(idOf(PATH, "c"), number.replace(/^[+-]/, ""));
  const units = unitSelect("crank speed", "angular speed", unit, false, idOf(PATH, "u"));
  const way = h(
    "select",
    { id: idOf(PATH, "way") },
    [["", "counter-clockwise"], ["-", "clockwise"]].map(([sign, text]) => h("option", { value: sign, selected: (sign === "-") === backwards }, text)),
  );
  const write = () => {
    const typed = input.value.trim();
    if (/^[-−]/.test(typed)) {
      way.value = "-"; // as typed, so that nothing is turned round twice
      input.value = typed.slice(1);
    }
    const found = taken(input, { kind: "angular speed", select: units });
    form.put(PATH, found && way.value + found);
  };
  input.addEventListener("input", write);
  way.addEventListener("change", write);
  units.addEventListener("change", () => {
    changeUnit(units, [input], "angular speed");
    write();
  });
  return [
    field(form, PATH, "crank speed", [input, units], "The speed at which the crank turns; it is taken as steady."),
    field(form, [...PATH, "direction"], "direction", [way], "With the sign of the offset, the direction says which stroke is the slow one: counter-clockwise and a positive offset make it the inward one.", { register: false }),
  ];
}
