/** What is wanted of a quantity: a check box, and whether to minimise, to maximise, or to come near a value. */

import { h } from "../lib/dom.js";
import { number, numberInput, unitSelect } from "./controls.js";
import { explanation, field } from "./field.js";
import { idOf } from "./path.js";
import { convert, join, kindOf, split } from "./units.js";

const SENSES = [["minimise", "minimise"], ["maximise", "maximise"], ["target", "bring to"]];

/** Return the field of the objective of a quantity {name, title, unit, sentence}. */
export function objective(form, quantity) {
  const path = ["objectives", quantity.name];
  const given = form.at(path);
  const kind = kindOf(quantity.unit);
  const box = h("input", { type: "checkbox", id: idOf(path, "c"), checked: given !== undefined });
  box.addEventListener("change", () => {
    form.put(path, box.checked ? (quantity.better === "high" ? "maximise" : "minimise") : undefined);
    form.redraw();
  });
  const ask = explanation(idOf(path, "why"), quantity.title, { sentence: quantity.sentence, name: quantity.name });
  const controls = given === undefined ? [] : wanted(form, path, quantity, kind, given);
  const made = field(form, path, quantity.title, [box, ...controls], "", { labelled: false });
  made.classList.add("wanted");
  made.querySelector(".field-label").replaceWith(h("div", { class: "wish" }, box, h("label", { for: box.id }, quantity.title), ask.button));
  made.querySelector(".field-controls").after(ask.text);
  return made;
}

function wanted(form, path, quantity, kind, given) {
  const sense = typeof given === "object" && given !== null ? "target" : String(given).replace("imize", "imise");
  const select = h("select", { id: idOf(path, "s"), "aria-label": `${quantity.title}: what is wanted` }, SENSES.map(([value, text]) => h("option", { value, selected: value === sense }, text)));
  if (sense !== "target") {
    select.addEventListener("change", () => {
      form.put(path, select.value === "target" ? { target: "" } : select.value);
      form.redraw();
    });
    return [select];
  }
  const { number: value, unit } = split(given.target === "" ? undefined : given.target, kind);
  const input = numberInput(idOf(path, "t"), value, `${quantity.title}: value to come near to`);
  const units = unitSelect(quantity.title, kind, unit, false, idOf(path, "u"));
  const write = () => form.put(path, { target: (kind ? join(input.value, units.value) : number(input.value)) ?? "" });
  input.addEventListener("input", write);
  units?.addEventListener("change", () => {
    input.value = convert(input.value, units.dataset.from, units.value, kind);
    units.dataset.from = units.value;
    write();
  });
  select.addEventListener("change", () => {
    form.put(path, select.value);
    form.redraw();
  });
  return [select, input, units].filter(Boolean);
}
