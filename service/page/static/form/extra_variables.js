/** Extra variables: which numbers of the job vary, and their permitted values. */

import { h } from "../lib/dom.js";
import { at, idOf, isTable } from "./path.js";
import { range } from "./range.js";
import { describe, words } from "./schema.js";

/** Numbers with their permitted values beside them. */
const SECTION_SIZE = /^(sections\.pins\.\w+|mechanism\.(crank|rod)\.(width|depth))$/;
const VALUES = ["choices", "min", "max", "step", "series", "values"]; // keys of a table of values

/** Return the fields of the extra variables and a select to add one. @param {Form.Whole} form */
export function varying(form) {
  const taken = new Set(extraVariables(form).map(({ name }) => name));
  const all = extraVariables(form).filter(({ name }) => !hasSizeField(form, name));
  const left = numbers(form).filter(({ name }) => !taken.has(name) && !hasSizeField(form, name));
  const select = h(
    "select",
    {
      id: "add-varying",
      onchange: () => {
        const chosen = left.find(({ name }) => name === select.value);
        if (!chosen) return;
        const path = ["variables", ...chosen.name.split(".")];
        form.put(path, rangeAround(chosen.value));
        form.redraw(idOf(path, 0));
      },
    },
    h("option", { value: "" }, "choose a number …"),
    left.map(({ name }) => h("option", { value: name }, titleOf(name))),
  );
  return [
    all.length
      ? h(
          "div",
          { class: "fields ranges" },
          all.map(({ path, name }) =>
            range(form, path, {
              ...looksOf(form, name),
              fixed: false,
              removed: () => {
                form.put(path, undefined);
                form.redraw("add-varying");
              },
            }),
          ),
        )
      : null,
    left.length
      ? h("p", { class: "row wide" }, h("label", { for: "add-varying" }, "Add a variable"), select)
      : null,
  ];
}

/** Whether the form shows the permitted values of a number beside it, in another section. @param {Form.Whole} form @param {string} name */
function hasSizeField(form, name) {
  return (
    SECTION_SIZE.test(name) &&
    at(form.job, name.split(".")) !== undefined &&
    form.at(["variables", name]) === undefined
  );
}

/** Return the names of the extra variables in words. @param {Form.Whole} form */
export function varyingNames(form) {
  return extraVariables(form).map(({ name }) => titleOf(name));
}

/** Return the tables whose numbers may vary. @param {Form.Whole} form */
function tablesWithVariables(form) {
  return Object.entries(form.schema.property(["variables"])?.properties ?? {})
    .filter(([, node]) => form.schema.resolve(node).type === "object")
    .map(([key]) => key);
}

/** Return the extra variables: path in the job and name. @param {Form.Whole} form */
function extraVariables(form) {
  const tables = tablesWithVariables(form);
  /** @type {{ path: Form.Path, name: string }[]} */
  const places = [];
  /** @param {unknown} part @param {Form.Path} path */
  const walk = (part, path) => {
    const table =
      isTable(part) &&
      !Array.isArray(part) &&
      !Object.keys(part).some((key) => VALUES.includes(key));
    if (table && Object.keys(part).length)
      for (const [key, inner] of Object.entries(part)) walk(inner, [...path, key]);
    else places.push({ path, name: path.slice(1).join(".") });
  };
  const variables = form.at(["variables"]);
  for (const [key, part] of Object.entries(isTable(variables) ? variables : {}))
    if (tables.includes(key.split(".")[0])) walk(part, ["variables", key]);
  return places;
}

/** Return the numbers of the job that may vary: {name, value}. @param {Form.Whole} form */
function numbers(form) {
  /** @type {{ name: string, value: string | number }[]} */
  const candidates = [];
  /** @param {unknown} part @param {Form.Path} path */
  const walk = (part, path) => {
    if (isTable(part)) {
      for (const [key, inner] of Object.entries(part))
        walk(inner, [...path, Array.isArray(part) ? Number(key) : key]);
    } else if (typeof part === "number" || typeof part === "string") {
      const node = form.schema.property(path);
      const control = node && describe(node).control;
      const isSingle = typeof path[path.length - 1] === "string"; // except tables of points
      if (
        isSingle &&
        (control === "quantity" || control === "ratio") &&
        !/%\s*$/.test(String(part))
      )
        candidates.push({ name: nameOf(path), value: part });
    }
  };
  for (const root of tablesWithVariables(form)) walk(form.at([root]), [root]);
  return candidates;
}

/** Return the name of a number in the notation of variables: list entries count from 1. @param {Form.Path} path */
function nameOf(path) {
  return path.map((key) => (typeof key === "number" ? key + 1 : key)).join(".");
}

/** Return a name in words: "mechanism.slider.mass" is "slider mass", "sections.pins.crank_pin" is "crank pin diameter". @param {string} name */
export function titleOf(name) {
  return words(
    name
      .replace(/^mechanism\./, "")
      .replace(/^sections\.pins\.(.+)/, "$1 diameter")
      .replaceAll(".", " "),
  );
}

/** @param {Form.Whole} form @param {string} name */
function looksOf(form, name) {
  const path = name.split(".").map((key) => (/^\d+$/.test(key) ? Number(key) - 1 : key));
  const node = form.schema.property(path);
  const described = node && describe(node);
  const jobValue = at(form.job, path);
  return {
    label: titleOf(name),
    kind: described?.kind ?? null,
    why: `${described?.description ?? ""}; ${jobValue === undefined ? "it also needs a value in its own field" : `${jobValue} where single designs are analysed`}`.replace(
      /^; /,
      "",
    ),
  };
}

/** Return a range around a value. @param {string | number} value */
export function rangeAround(value) {
  const [, number, unit] = /^\s*([+-]?[\d.]+(?:e[+-]?\d+)?)\s*(.*)$/is.exec(String(value)) ?? [];
  if (number === undefined || Number(number) === 0) return ["", ""];
  const ends = [0.5, 2]
    .map((factor) => Number((factor * Number(number)).toPrecision(3)))
    .sort((a, b) => a - b);
  return unit ? ends.map((end) => `${end} ${unit}`) : ends;
}
