/** Permitted values of a number: a range, a fixed value, steps, preferred numbers, or a list. */

import { h } from "../lib/dom.js";
import { changeUnit, numberInput, unitSelect } from "./controls.js";
import { field, replace } from "./field.js";
import { at, idOf, isTable } from "./path.js";
import { drawnFrom, typedValueOrRange } from "./typed_number.js";
import { convert, join, split, spread } from "../lib/units.js";

/** @typedef {"range" | "fixed" | "step" | "series" | "values" | "choices"} Mode */

/** @type {[Mode, string][]} */
const MODES = [
  ["range", "from – to"],
  ["fixed", "fixed at"],
  ["step", "in steps"],
  ["series", "in a series"],
  ["values", "only these"],
  ["choices", "one of"],
];
const LISTS = ["values", "choices"];
const STEPS = 20; // minimum number of initial steps

/**
 * Return the field for the permitted values of a number. why: {sentence, name}. fixed: whether a single value is permitted.
 * @param {Form.Whole} form @param {Form.Path} path @param {{ label: string, why: Form.Why, kind?: string | null, fixed?: boolean, drop?: string, removed?: () => void }} looks drop: what the button says that calls removed
 */
export function range(
  form,
  path,
  { label, why, kind = "length", fixed = true, drop: text = "Remove", removed },
) {
  const jobValue = spread(form.at(path), kind) ?? form.at(path);
  const mode = modeOf(jobValue);
  const begun = endsOf(jobValue, mode);
  const parts = begun.map((end) => split(end, kind));
  const unit = parts.find((one) => one.number !== "")?.unit || split(undefined, kind).unit;
  const numbers = parts.map((one) => convert(one.number, one.unit, unit, kind));
  const select = h(
    "select",
    {
      id: idOf(path, "c"),
      class: "mode",
      onchange: () => {
        write(/** @type {Mode} */ (select.value));
        form.redraw();
      },
    },
    MODES.filter(([value]) => fixed || value !== "fixed").map(([value, text]) =>
      h("option", { value, selected: value === mode }, text),
    ),
  );
  const units = kind ? unitSelect(label, kind, unit, false, idOf(path, "u")) : null;
  const list = LISTS.includes(mode);
  const titles = mode === "fixed" ? ["fixed at"] : ["from", "to", "step"];
  const inputs = list
    ? [
        h("input", {
          type: "text",
          id: idOf(path, "of"),
          value: numbers.join(", "),
          "aria-label": `${label}, values, separated by commas`,
        }),
      ]
    : numbers.map((value, place) =>
        numberInput(idOf(path, place), value, `${label}, ${titles[place]}`),
      );
  const series =
    mode === "series"
      ? seriesSelect(form, label, idOf(path, "series"), at(jobValue, ["series"]))
      : null;
  if (!list) inputs.forEach((input, place) => drawnFrom(input, begun[place], units));
  const typed = () => (list ? inputs[0].value.split(/[,;\n]/) : inputs.map((one) => one.value));
  /** Return the typed value of an input; only an end of the range can become a range. @param {HTMLInputElement} one @param {number} place */
  const read = (one, place) => typedValueOrRange(one, { kind, select: units, range: place < 2 });
  const ends = () =>
    list ? undefined : inputs.map((one, place) => read(one, place).ends).find(Boolean);
  /** @returns {unknown[]} */
  const values = () =>
    list
      ? typed().map((text) => (units ? join(text, units.value) : plain(text.trim() || undefined)))
      : inputs.map((one, place) =>
          units ? read(one, place).value : plain(read(one, place).value),
        );
  /** @param {Mode} to */
  const write = (to = mode) => {
    const enteredValues = values();
    const both = ends();
    if (both) enteredValues.splice(0, 2, ...(units ? both : both.map(plain)));
    const some = enteredValues.filter((one) => one !== undefined);
    const between = {
      min: enteredValues[0] ?? "",
      max: (list ? enteredValues.at(-1) : (enteredValues[1] ?? enteredValues[0])) ?? "",
    };
    if (to === "range" || (to === "fixed" && both))
      form.put(path, some.length ? [between.min, between.max] : undefined);
    else if (to === "fixed") form.put(path, some[0]);
    else if (to === "step")
      form.put(path, {
        ...between,
        step: mode === "step" ? (enteredValues[2] ?? "") : firstStep(inputs, units?.value ?? ""),
      });
    else if (to === "series")
      form.put(path, { ...between, series: series?.value ?? seriesOf(form)[0] });
    else form.put(path, { [to]: mode === "step" ? some.slice(0, 2) : some });
  };
  inputs.forEach((input) => input.addEventListener("input", () => write()));
  const again = () => {
    if (!node.isConnected) return; // redrawn in the meantime
    write();
    replace(form, node, () => range(form, path, { label, why, kind, fixed, drop: text, removed }));
  };
  inputs.forEach((input) => input.addEventListener("change", () => ends() && setTimeout(again))); // after the next control has received the focus
  series?.addEventListener("change", () => write());
  units?.addEventListener("change", () => {
    const from = units.dataset.from ?? units.value;
    if (list)
      inputs[0].value = typed()
        .map((text) => convert(text.trim(), from, units.value, kind))
        .join(", ");
    changeUnit(units, list ? [] : inputs, kind);
    write();
  });
  const [first, second, third] = inputs;
  /** @param {string} text */
  const word = (text) => h("span", { class: "to" }, text);
  const controls = [
    select,
    first,
    ...(second ? [word("to"), second] : []),
    ...(third ? [word("by"), third] : []),
    series,
    units,
  ].filter((one) => one instanceof HTMLElement);
  const drop =
    removed &&
    h("button", { type: "button", "aria-label": `${text} ${label}`, onclick: removed }, text);
  const node = field(form, path, label, drop ? [...controls, drop] : controls, why);
  node.classList.add("range");
  node.classList.toggle("two", mode === "step" || mode === "series" || drop !== undefined);
  return node;
}

/** @param {unknown} jobValue @returns {Mode} */
function modeOf(jobValue) {
  if (jobValue === undefined || Array.isArray(jobValue)) return "range";
  if (!isTable(jobValue)) return "fixed";
  return MODES.map(([mode]) => mode).find((mode) => mode in jobValue) ?? "choices";
}

/** Return the displayed values of a number in the order of the fields. @param {unknown} jobValue @param {Mode} mode @returns {unknown[]} */
function endsOf(jobValue, mode) {
  if (mode === "range") return [at(jobValue, [0]), at(jobValue, [1])];
  if (mode === "fixed") return [jobValue];
  if (mode === "step" || mode === "series")
    return ["min", "max", ...(mode === "step" ? ["step"] : [])].map((key) => at(jobValue, [key]));
  return [at(jobValue, [mode]) ?? []].flat();
}

/** Return the names of the series of preferred numbers, as the schema of the dimensions has them. @param {Form.Whole} form */
function seriesOf(form) {
  return (form.schema.property(["variables", "crank", "series"])?.enum ?? []).map(String);
}

/** @param {Form.Whole} form @param {string} label @param {string} id @param {unknown} chosen */
function seriesSelect(form, label, id, chosen) {
  const allSeries = seriesOf(form);
  const names =
    chosen === undefined || allSeries.includes(String(chosen))
      ? allSeries
      : [...allSeries, String(chosen)];
  return h(
    "select",
    { id, "aria-label": `${label}, series of preferred numbers` },
    names.map((one) => h("option", { value: one, selected: one === chosen }, one)),
  );
}

/** Return an initial step, a power of ten that divides the range well. @param {HTMLInputElement[]} inputs @param {string} unit */
function firstStep(inputs, unit) {
  const span = Math.abs(Number(inputs[1]?.value) - Number(inputs[0].value));
  const step =
    span > 0 && Number.isFinite(span)
      ? Number((10 ** Math.floor(Math.log10(span / STEPS))).toPrecision(1))
      : 1;
  return unit ? `${step} ${unit}` : step;
}

/** Return a number of a job that has no unit. @param {string | number | undefined} typed */
function plain(typed) {
  return typed !== undefined && Number.isFinite(Number(typed)) ? Number(typed) : typed;
}
