/** A requirement on a quantity: any value, exactly one, at least, at most, or between two. */

import { h } from "../lib/dom.js";
import { changeUnit, number, numberInput, unitSelect } from "./controls.js";
import { field } from "./field.js";
import { at, idOf, isTable } from "./path.js";
import { taken } from "./typed_field.js";
import { convert, kindOf, split } from "./units.js";

const MODES = [["any", "any"], ["equals", "exactly"], ["min", "at least"], ["max", "at most"], ["between", "between"]];
/** @type {Record<string, string[]>} */
const KEYS = { any: [], equals: ["equals"], min: ["min"], max: ["max"], between: ["min", "max"] };
/** @type {Record<string, string>} */
const SAID = { equals: "exactly", min: "at least", max: "at most" };

/**
 * Return the field of the requirement on a quantity {name, title, unit, sentence}.
 * @param {Form.Whole} form @param {Api.Quantity} quantity @param {{ label?: string, place?: Form.Path }} given
 */
export function requirement(form, quantity, { label = quantity.title, place = ["constraints"] } = {}) {
  const path = [...place, quantity.name];
  const given = form.at(path);
  const mode = modeOf(given);
  const kind = kindOf(quantity.unit);
  const select = h("select", { id: idOf(path, "c"), class: "mode" }, MODES.map(([value, text]) => h("option", { value, selected: value === mode }, text)));
  const keys = KEYS[mode];
  const parts = keys.map((key) => split(at(given, [key]), kind));
  const unit = parts.find((one) => one.number !== "")?.unit ?? (kind ? split(undefined, kind).unit : "");
  const units = keys.length && kind ? unitSelect(label, kind, unit, false, idOf(path, "u")) : null;
  const inputs = keys.map((key, place) => {
    return numberInput(idOf(path, key), convert(parts[place].number, parts[place].unit, unit, kind), `${label}, ${SAID[key]}`);
  });
  /** @param {string[]} names */
  const write = (names = keys) => {
    /** @type {Record<string, unknown>} */
    const bounds = {};
    names.forEach((key, place) => {
      const input = inputs[Math.min(place, inputs.length - 1)];
      const typed = input && (kind ? taken(input, { kind, select: units }) : number(input));
      bounds[key] = typed ?? ""; // the service says that it is missing
    });
    form.put(path, names.length ? bounds : undefined);
  };
  inputs.forEach((input) => input.addEventListener("input", () => write()));
  units?.addEventListener("change", () => {
    changeUnit(units, inputs, kind);
    write();
  });
  select.addEventListener("change", () => {
    write(KEYS[select.value]);
    form.redraw();
  });
  const [low, high] = inputs;
  const controls = [select, low, high && h("span", { class: "to" }, "and"), high, units].filter((one) => one instanceof HTMLElement);
  const made = field(form, path, label, controls, { sentence: quantity.sentence, name: quantity.name });
  made.classList.toggle("two", mode === "between");
  return made;
}

/** Return which kind of requirement is given. @param {unknown} given */
function modeOf(given) {
  if (!isTable(given)) return "any";
  if (given.equals !== undefined) return "equals";
  if (given.min !== undefined && given.max !== undefined) return "between";
  return given.max !== undefined ? "max" : "min";
}
