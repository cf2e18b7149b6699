/** Controls of the form, each bound to a path in the job. */

import { h, numberField } from "../lib/dom.js";
import { field } from "./field.js";
import { idOf } from "./path.js";
import { describe, words } from "./schema.js";
import { drawnFrom, typedValueOrRange, replaceTyped, typedJobValue } from "./typed_number.js";
import { convert, split, unitsOf, usual } from "../lib/units.js";

/** @type {Partial<Record<Form.Described["control"], (form: Form.Whole, path: Form.Path, looks: Form.Looks) => HTMLElement>>} */
const MAKE = { quantity, choice, whole: plain, ratio: plain, text: plain, list };

/**
 * Return the field for a path as the schema describes it; null for values that only the job file can state. options: {label, why,
 * required}.
 * @param {Form.Whole} form @param {Form.Path} path @param {Partial<Form.Looks>} options @returns {HTMLElement | null}
 */
export function byschema(form, path, options = {}) {
  const node = form.schema.property(path);
  if (!node) return null;
  const described = describe(node);
  const label = options.label ?? words(path[path.length - 1]);
  const why = options.why ?? described.description;
  if (described.control === "table") {
    const keys = (described.keys ?? []).filter(
      (key) => key !== "file" || form.at([...path, key]) !== undefined,
    ); // a service does not open files
    const inner = keys.map((key) => byschema(form, [...path, key]));
    return h(
      "fieldset",
      { class: "inner" },
      h("legend", {}, label),
      h("div", { class: "fields" }, inner),
    );
  }
  const make = MAKE[described.control];
  return make ? make(form, path, { ...described, ...options, label, why }) : null;
}

/** Return a field for a number with its unit. @param {Form.Whole} form @param {Form.Path} path @param {Form.Looks} looks */
export function quantity(form, path, { kind, percent = false, label, why, wide }) {
  const entry = entries(
    [{ id: idOf(path, "c"), jobValue: form.at(path) }],
    { label, kind: kind ?? null, percent, unitId: idOf(path, "u") },
    () => form.put(path, entry.read(0).value),
  );
  return field(form, path, label, entry.controls, why, { wide });
}

/**
 * Return inputs for numbers with a common unit: {inputs, units, controls, read(n)}. ones: value in the job and name of each. range:
 * whether a range is permitted. write: called after each change.
 * @param {{ id: string, jobValue: unknown, title?: string }[]} ones
 * @param {{ label: string, kind: string | null, percent?: boolean, range?: boolean, unitId: string }} looks @param {() => void} write
 */
export function entries(ones, { label, kind, percent = false, range = false, unitId }, write) {
  const parts = ones.map(({ jobValue }) => split(jobValue, kind));
  const unit = parts.find((one) => one.number !== "")?.unit ?? split(undefined, kind).unit;
  const units = kind && ones.length ? unitSelect(label, kind, unit, percent, unitId) : null;
  const inputs = ones.map(({ id, jobValue, title }, n) => {
    const input = numberInput(id, convert(parts[n].number, parts[n].unit, unit, kind), title);
    drawnFrom(input, jobValue, units);
    input.addEventListener("input", () => write());
    return input;
  });
  units?.addEventListener("change", () => {
    changeUnit(units, inputs, kind);
    write();
  });
  /** @param {number} n @returns {{ value?: string | number, ends?: string[] }} */
  const read = (n) => {
    const entry = typedValueOrRange(inputs[n], { kind, percent, select: units, range });
    return kind || entry.ends ? entry : { value: number(inputs[n]) };
  };
  return { inputs, units, controls: units ? [...inputs, units] : inputs, read };
}

/**
 * Return a field for one of several words; omitting it means the fallback.
 * @param {Form.Whole} form @param {Form.Path} path @param {Form.Looks} looks
 */
export function choice(
  form,
  path,
  { options = [], fallback, label, why, required = false, changed = () => {} },
) {
  const jobValue = form.at(path);
  const isListed = jobValue === undefined || options.some((one) => one === jobValue);
  const choices = [
    ...(required ? [] : [["", fallback === undefined ? "not given" : `${fallback} (usual)`]]),
    ...options.map((one) => [String(one), words(one)]),
  ];
  if (!isListed) choices.push([String(jobValue), String(jobValue)]);
  const select = h(
    "select",
    {
      id: idOf(path, "c"),
      onchange: () => {
        form.put(
          path,
          select.value === ""
            ? undefined
            : (options.find((one) => String(one) === select.value) ?? select.value),
        );
        changed(select.value);
      },
    },
    choices.map(([value, text]) =>
      h("option", { value, selected: value === String(jobValue ?? "") }, text),
    ),
  );
  return field(form, path, label, [select], why);
}

/**
 * Return a field for a text, a ratio or a whole number; invalid numbers are kept as typed, for the service to explain.
 * @param {Form.Whole} form @param {Form.Path} path @param {Form.Looks} looks
 */
export function plain(form, path, { control, label, why, wide = false, long = false, fallback }) {
  const jobValue = form.at(path);
  const text =
    jobValue === undefined
      ? ""
      : typeof jobValue === "string"
        ? jobValue
        : JSON.stringify(jobValue);
  const input = long
    ? h("textarea", { rows: 2, id: idOf(path, "c"), value: text })
    : h("input", { type: "text", id: idOf(path, "c"), value: text, autocomplete: "off" });
  if (fallback !== undefined && fallback !== null) input.placeholder = String(fallback);
  if (control !== "text") {
    input.inputMode = "decimal";
    input.classList.add("short");
  }
  const write = () =>
    form.put(
      path,
      input instanceof HTMLTextAreaElement || control === "text"
        ? input.value || undefined
        : number(input),
    );
  input.addEventListener("input", write);
  if (input instanceof HTMLInputElement && control !== "text")
    input.addEventListener("change", () => replaceTyped(input));
  return field(form, path, label, [input], why, { wide });
}

/** Return a field for a list with commas between the entries. @param {Form.Whole} form @param {Form.Path} path @param {Form.Looks} looks */
function list(form, path, { label, why, example }) {
  const jobValue = form.at(path);
  const text = Array.isArray(jobValue)
    ? jobValue.join(", ")
    : jobValue === undefined
      ? ""
      : JSON.stringify(jobValue);
  const input = h("input", {
    type: "text",
    id: idOf(path, "c"),
    value: text,
    autocomplete: "off",
    placeholder: Array.isArray(example) ? example.join(", ") : null,
    oninput: () => {
      const entries = input.value
        .split(",")
        .map((one) => one.trim())
        .filter(Boolean);
      form.put(
        path,
        entries.length
          ? entries.map((one) => (Number.isFinite(Number(one)) ? Number(one) : one))
          : undefined,
      );
    },
  });
  return field(form, path, label, [input], `${why}; separated by commas`, { wide: true });
}

/**
 * Return an input for a number as text, so that mistakes can be explained.
 * @param {string} id @param {string} value @param {string | null} label
 */
export function numberInput(id, value, label = null) {
  return numberField({
    class: "short number",
    id,
    value,
    "aria-label": label,
    onchange: (event) => replaceTyped(event.currentTarget),
  });
}

/**
 * Return a select of the units of a kind; an unlisted unit is added.
 * @param {string} label @param {string} kind @param {string} unit @param {boolean} percent @param {string | null} id
 */
export function unitSelect(label, kind, unit, percent = false, id = null) {
  const units = unitsOf(kind, { percent });
  const chosen = unit || usual(kind);
  const select = h(
    "select",
    { class: "unit", id, "aria-label": `Unit of ${label}`, "data-from": chosen },
    units.map((one) =>
      h(
        "option",
        { value: one, selected: one === chosen },
        one.replace("^2", "²").replace("^3", "³"),
      ),
    ),
  );
  return select;
}

/**
 * Show the values of inputs in the chosen unit.
 * @param {HTMLSelectElement} select @param {HTMLInputElement[]} inputs @param {string | null | undefined} kind
 */
export function changeUnit(select, inputs, kind) {
  const from = select.dataset.from ?? select.value;
  for (const input of inputs) input.value = convert(input.value, from, select.value, kind);
  select.dataset.from = select.value;
}

/**
 * Return the value in a job for a number without a unit: a number if that preserves all digits, otherwise the text.
 * @param {HTMLInputElement} input
 */
export function number(input) {
  const typed = typedJobValue(input);
  if (typed === undefined || !Number.isFinite(Number(typed))) return typed;
  if (!/^\d+$/.test(String(typed)) || Number.isSafeInteger(Number(typed))) return Number(typed);
  input.dataset.wrong = `A whole number must be at most ${Number.MAX_SAFE_INTEGER}; got ${typed}; write a smaller one.`;
  return typed;
}
