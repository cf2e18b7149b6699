/** Objective on a quantity: a check box, and whether to minimise, to maximise, or to come near a value. */

import { h } from "../lib/dom.js";
import { changeUnit, number, numberInput, unitSelect } from "./controls.js";
import { explanation, field } from "./field.js";
import { at, idOf } from "./path.js";
import { drawnFrom, taken } from "./typed_field.js";
import { kindOf, split } from "../lib/units.js";

const SENSES = [
  ["minimise", "minimise"],
  ["maximise", "maximise"],
  ["target", "bring to"],
];

/** Return the field of the objective of a quantity {name, title, unit, sentence}. @param {Form.Whole} form @param {Api.Quantity} quantity */
export function objective(form, quantity) {
  const path = ["objectives", quantity.name];
  const given = form.at(path);
  const kind = kindOf(quantity.unit);
  const box = h("input", { type: "checkbox", id: idOf(path, "c"), checked: given !== undefined });
  box.addEventListener("change", () => {
    form.put(
      path,
      box.checked ? (quantity.better === "high" ? "maximise" : "minimise") : undefined,
    );
    form.redraw();
  });
  const ask = explanation(idOf(path, "why"), quantity.title, {
    sentence: quantity.sentence,
    name: quantity.name,
  });
  const controls =
    given === undefined
      ? []
      : wanted(
          form,
          { path, id: path },
          { title: quantity.title, kind, again: () => form.redraw() },
        );
  const made = field(form, path, quantity.title, [box, ...controls], "", { labelled: false });
  made.classList.add("wanted");
  made
    .querySelector(".field-label")
    ?.replaceWith(
      h("div", { class: "wish" }, box, h("label", { for: box.id }, quantity.title), ask?.button),
    );
  if (ask) made.querySelector(".field-controls")?.after(ask.text);
  return made;
}

/**
 * Return the controls of what is wanted of an objective: its direction, or a value to come near to. again: draws them anew.
 * @param {Form.Whole} form @param {Form.Spot} spot @param {{ title: string, kind: string | null, again: () => void }} of
 */
export function wanted(form, spot, { title, kind, again }) {
  const given = form.at(spot.path);
  const sense =
    typeof given === "object" && given !== null
      ? "target"
      : String(given).replace("imize", "imise");
  const select = h(
    "select",
    { id: idOf(spot.id, "s"), "aria-label": `${title}: what is wanted` },
    SENSES.map(([value, text]) => h("option", { value, selected: value === sense }, text)),
  );
  if (sense !== "target") {
    select.addEventListener("change", () => {
      form.put(spot.path, select.value === "target" ? { target: "" } : select.value);
      again();
    });
    return [select];
  }
  const target = at(given, ["target"]);
  const { number: value, unit } = split(target === "" ? undefined : target, kind);
  const input = numberInput(idOf(spot.id, "t"), value, `${title}: value to come near to`);
  const units = kind ? unitSelect(title, kind, unit, false, idOf(spot.id, "u")) : null;
  drawnFrom(input, target === "" ? undefined : target, units);
  const write = () =>
    form.put(spot.path, {
      target: (units ? taken(input, { kind, select: units }) : number(input)) ?? "",
    });
  input.addEventListener("input", write);
  units?.addEventListener("change", () => {
    changeUnit(units, [input], kind);
    write();
  });
  select.addEventListener("change", () => {
    form.put(spot.path, select.value);
    again();
  });
  return units ? [select, input, units] : [select, input];
}
