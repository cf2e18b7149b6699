/** Objective on a quantity: a check box, and whether to minimise, to maximise, or to approach a value. */

import { h } from "../lib/dom.js";
import { entries } from "./controls.js";
import { explanation, field } from "./field.js";
import { at, idOf } from "./path.js";
import { kindOf } from "../lib/units.js";

const SENSES = [
  ["minimise", "minimise"],
  ["maximise", "maximise"],
  ["target", "bring to"],
];

/** Return the field of the objective of a quantity {name, title, unit, sentence}. @param {Form.Whole} form @param {Api.Quantity} quantity */
export function objective(form, quantity) {
  const path = ["objectives", quantity.name];
  const jobValue = form.at(path);
  const kind = kindOf(quantity.unit);
  const box = h("input", {
    type: "checkbox",
    id: idOf(path, "c"),
    checked: jobValue !== undefined,
    onchange: () => {
      form.put(
        path,
        box.checked ? (quantity.better === "high" ? "maximise" : "minimise") : undefined,
      );
      form.redraw();
    },
  });
  const ask = explanation(idOf(path, "why"), quantity.title, {
    sentence: quantity.sentence,
    name: quantity.name,
  });
  const controls =
    jobValue === undefined
      ? []
      : objectiveField(
          form,
          { path, id: path },
          { title: quantity.title, kind, again: () => form.redraw() },
        );
  const node = field(form, path, quantity.title, [box, ...controls], "", { labelled: false });
  node.classList.add("wanted");
  node
    .querySelector(".field-label")
    ?.replaceWith(
      h("div", { class: "wish" }, box, h("label", { for: box.id }, quantity.title), ask?.button),
    );
  if (ask) node.querySelector(".field-controls")?.after(ask.text);
  return node;
}

/**
 * Return the controls of an objective's sense: a direction or a target. again: redraws them.
 * @param {Form.Whole} form @param {Form.Spot} spot @param {{ title: string, kind: string | null, again: () => void }} of
 */
export function objectiveField(form, spot, { title, kind, again }) {
  const jobValue = form.at(spot.path);
  const sense =
    typeof jobValue === "object" && jobValue !== null
      ? "target"
      : String(jobValue).replace("imize", "imise");
  const select = h(
    "select",
    {
      id: idOf(spot.id, "s"),
      "aria-label": `${title}: minimise, maximise or target`,
      onchange: () => {
        form.put(spot.path, select.value === "target" ? { target: "" } : select.value);
        again();
      },
    },
    SENSES.map(([value, text]) => h("option", { value, selected: value === sense }, text)),
  );
  if (sense !== "target") return [select];
  const target = at(jobValue, ["target"]);
  const targetEntry = entries(
    [
      {
        id: idOf(spot.id, "t"),
        jobValue: target === "" ? undefined : target,
        title: `${title}: target value`,
      },
    ],
    { label: title, kind, unitId: idOf(spot.id, "u") },
    () => form.put(spot.path, { target: targetEntry.read(0).value ?? "" }),
  );
  return [select, ...targetEntry.controls];
}
