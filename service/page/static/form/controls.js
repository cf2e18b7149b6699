/** Controls of the form, each tied to a place in the job. */

import { h } from "../lib/dom.js";
import { field } from "./field.js";
import { idOf } from "./path.js";
import { describe, words } from "./schema.js";
import { convert, join, split, unitsOf, usual } from "./units.js";

/** Return the field of a path as the schema describes it; options: {label, why, required}. Null for what only the job file can say. */
export function byschema(form, path, options = {}) {
  const node = form.schema.property(path);
  if (!node) return null;
  const found = describe(node);
  const label = options.label ?? words(path.at(-1));
  const why = options.why ?? found.description;
  const make = { quantity, choice, whole: plain, ratio: plain, text: plain, list };
  if (found.control === "table") {
    const inner = found.keys.map((key) => byschema(form, [...path, key])).filter(Boolean);
    return h("fieldset", { class: "inner" }, h("legend", {}, label), h("div", { class: "fields" }, inner));
  }
  return make[found.control]?.(form, path, { ...found, ...options, label, why }) ?? null;
}

/** Return a field of a number with its unit. */
export function quantity(form, path, { kind, percent = false, label, why, wide }) {
  const { number, unit } = split(form.at(path), kind);
  const input = numberInput(idOf(path, "c"), number);
  const select = unitSelect(label, kind, unit, percent, idOf(path, "u"));
  const write = () => form.put(path, join(input.value, select?.value ?? ""));
  input.addEventListener("input", write);
  select?.addEventListener("change", () => {
    input.value = convert(input.value, select.dataset.from, select.value, kind);
    select.dataset.from = select.value;
    write();
  });
  return field(form, path, label, [input, select].filter(Boolean), why, { wide });
}

/** Return a field of one of several words. Left out means the fallback. */
export function choice(form, path, { options, fallback, label, why, required = false, changed = () => {} }) {
  const given = form.at(path);
  const known = given === undefined || options.includes(given);
  const shown = [...(required ? [] : [["", fallback === undefined ? "not given" : `${fallback} (usual)`]]), ...options.map((one) => [String(one), words(one)])];
  if (!known) shown.push([String(given), String(given)]);
  const select = h("select", { id: idOf(path, "c") }, shown.map(([value, text]) => h("option", { value, selected: value === String(given ?? "") }, text)));
  select.addEventListener("change", () => {
    form.put(path, select.value === "" ? undefined : options.find((one) => String(one) === select.value) ?? select.value);
    changed(select.value);
  });
  return field(form, path, label, [select], why);
}

/** Return a field of a text, a ratio or a whole number; what is no number is kept as it was typed, for the service to say so. */
export function plain(form, path, { control, label, why, wide = false, long = false, fallback }) {
  const given = form.at(path);
  const text = given === undefined ? "" : typeof given === "string" ? given : JSON.stringify(given);
  const input = long ? h("textarea", { rows: 2, id: idOf(path, "c"), value: text }) : h("input", { type: "text", id: idOf(path, "c"), value: text, autocomplete: "off" });
  if (control !== "text") {
    input.inputMode = "decimal";
    input.classList.add("short");
    if (fallback !== undefined && fallback !== null) input.placeholder = String(fallback);
  }
  input.addEventListener("input", () => form.put(path, control === "text" ? input.value || undefined : number(input.value)));
  return field(form, path, label, [input], why, { wide });
}

/** Return a field of a list, its entries separated by commas. */
export function list(form, path, { label, why, example }) {
  const given = form.at(path);
  const text = Array.isArray(given) ? given.join(", ") : given === undefined ? "" : JSON.stringify(given);
  const input = h("input", { type: "text", id: idOf(path, "c"), value: text, autocomplete: "off", placeholder: Array.isArray(example) ? example.join(", ") : null });
  input.addEventListener("input", () => {
    const entries = input.value.split(",").map((one) => one.trim()).filter(Boolean);
    form.put(path, entries.length ? entries.map((one) => (Number.isFinite(Number(one)) ? Number(one) : one)) : undefined);
  });
  return field(form, path, label, [input], `${why}; separated by commas`, { wide: true });
}

/** Return an input for a number as text, so that what is mistyped can be said. */
export function numberInput(id, value, label = null) {
  return h("input", { type: "text", inputmode: "decimal", autocomplete: "off", class: "short number", id, value, "aria-label": label });
}

/** Return a select of the units of a kind; null for a ratio. A unit that is not in the list is added to it. */
export function unitSelect(label, kind, unit, percent = false, id = null) {
  if (!kind) return null;
  const units = unitsOf(kind, { percent });
  const chosen = unit || usual(kind);
  const select = h("select", { class: "unit", id, "aria-label": `Unit of ${label}`, "data-from": chosen }, units.map((one) => h("option", { value: one, selected: one === chosen }, one.replace("^2", "²").replace("^3", "³"))));
  return select;
}

/** Return what a job holds for a typed number: a number if it is one. */
export function number(text) {
  const typed = text.trim().replaceAll("−", "-");
  if (typed === "") return undefined;
  return Number.isFinite(Number(typed)) ? Number(typed) : typed;
}
