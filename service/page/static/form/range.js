/** Range of a dimension: from one length to another, fixed, or one of several. */

import { h } from "../lib/dom.js";
import { changeUnit, numberInput, unitSelect } from "./controls.js";
import { field } from "./field.js";
import { at, idOf } from "./path.js";
import { taken } from "./typed_field.js";
import { convert, join, split } from "./units.js";

const MODES = [["range", "from – to"], ["fixed", "fixed at"], ["choices", "one of"]];

/**
 * Return the field of the range of crank, rod or offset; why: {sentence, name}.
 * @param {Form.Whole} form @param {Form.Path} path @param {{ label: string, why: Form.Why }} looks
 */
export function range(form, path, { label, why }) {
  const given = form.at(path);
  const mode = Array.isArray(given) ? "range" : given !== null && typeof given === "object" ? "choices" : given === undefined ? "range" : "fixed";
  const ends = mode === "range" ? [at(given, [0]), at(given, [1])] : mode === "fixed" ? [given] : [at(given, ["choices"]) ?? []].flat();
  const parts = ends.map((end) => split(end, "length"));
  const unit = parts.find((one) => one.number !== "")?.unit || split(undefined, "length").unit;
  const numbers = parts.map((one) => convert(one.number, one.unit, unit, "length"));
  const select = h("select", { id: idOf(path, "c"), class: "mode" }, MODES.map(([value, text]) => h("option", { value, selected: value === mode }, text)));
  const units = unitSelect(label, "length", unit, false, idOf(path, "u"));
  const inputs =
    mode === "choices"
      ? [h("input", { type: "text", id: idOf(path, "of"), value: numbers.join(", "), "aria-label": `${label}, lengths to choose from, separated by commas` })]
      : numbers.map((value, place) => numberInput(idOf(path, place), value, mode === "fixed" ? `${label}, fixed at` : `${label}, ${place ? "to" : "from"}`));
  const typed = () => (mode === "choices" ? inputs[0].value.split(",") : inputs.map((one) => one.value));
  /** @param {string} to */
  const write = (to = mode) => {
    const values = mode === "choices" ? typed().map((text) => join(text, units.value)) : inputs.map((one) => taken(one, { kind: "length", select: units }));
    const first = values.find((one) => one !== undefined);
    if (to === "range") form.put(path, first === undefined ? undefined : [values[0] ?? "", values.at(-1) ?? ""]);
    else if (to === "fixed") form.put(path, first);
    else form.put(path, { choices: values.filter((one) => one !== undefined) });
  };
  inputs.forEach((input) => input.addEventListener("input", () => write()));
  units.addEventListener("change", () => {
    const from = units.dataset.from ?? units.value;
    if (mode === "choices") inputs[0].value = typed().map((text) => convert(text.trim(), from, units.value, "length")).join(", ");
    changeUnit(units, mode === "choices" ? [] : inputs, "length");
    write();
  });
  select.addEventListener("change", () => {
    write(select.value);
    form.redraw();
  });
  const between = mode === "range" ? [inputs[0], h("span", { class: "to" }, "to"), inputs[1]] : inputs;
  return field(form, path, label, [select, ...between, units], why);
}
