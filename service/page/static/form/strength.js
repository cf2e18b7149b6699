/** Material, pins and bar sizes of crank and rod, for stress and safety; which are fixed and which vary. */

import { h } from "../lib/dom.js";
import { convert, join, split } from "../lib/units.js";
import { byschema, choice } from "./controls.js";
import { at, isTable } from "./path.js";
import { range } from "./range.js";
import { rangeAround, titleOf } from "./extra_variables.js";

const PATH = ["sections"];
const RANGES = ["width", "depth"];
/** Bars whose eyes hold each pin. @type {Record<string, string[]>} */
const BARS = { crank_pivot: ["crank"], crank_pin: ["crank", "rod"], slider_pin: ["rod"] };

/** Return the fields of material and pins. @param {Form.Whole} form */
export function strength(form) {
  const table = form.schema.property(PATH);
  const on = form.at(PATH) !== undefined;
  const select = choice(
    {
      ...form,
      at: () => (on ? "yes" : undefined),
      put: (_, value) =>
        putSections(
          form,
          value
            ? { material: form.schema.property([...PATH, "material"])?.examples?.[0], pins: {} }
            : undefined,
        ),
      register: () => {},
    },
    ["sections", "on"],
    {
      options: ["yes"],
      label: "with material and pins",
      fallback: "no",
      why: "Material and pins of crank and rod, for objectives and requirements on stresses, safety factors and pin pressures.",
      changed: () => form.redraw(),
    },
  );
  if (!on) return [select];
  const missing = ["crank", "rod"].filter(
    (link) =>
      !isTable(form.at(["mechanism", link])) ||
      at(form.job, ["mechanism", link, "width"]) === undefined,
  );
  const rest = Object.keys(table?.properties ?? {}).filter(
    (key) => !["material", "pins", ...RANGES].includes(key),
  );
  return [
    select,
    missing.length
      ? h(
          "p",
          { class: "quiet wide" },
          `For stresses and safety, give the ${missing.join(" and the ")} a rectangular section (width and depth) in the fields above.`,
        )
      : null,
    h(
      "p",
      { class: "quiet wide" },
      "The values are those of a common steel; enter those of your material, and a diameter for each pin.",
    ),
    missing.length
      ? null
      : h(
          "p",
          { class: "row wide" },
          h(
            "button",
            { type: "button", onclick: () => propose(form) },
            "Make pins half as thick as their bars are wide",
          ),
          h(
            "span",
            { class: "quiet" },
            "a common starting point; where two bars meet, the narrower one counts",
          ),
        ),
    byschema(form, [...PATH, "material"]),
    h(
      "fieldset",
      { class: "inner" },
      h("legend", {}, "pins"),
      h(
        "div",
        { class: "fields" },
        keysOf(form, [...PATH, "pins"]).map((key) =>
          fixedOrVarying(form, [...PATH, "pins", key], `diameter of the ${titleOf(key)}`),
        ),
      ),
    ),
    h(
      "details",
      { class: "more" },
      h("summary", {}, "Safety factors and available sizes"),
      h(
        "div",
        { class: "fields" },
        rest.map((key) => byschema(form, [...PATH, key])),
        RANGES.map((key) =>
          range(form, [...PATH, key], {
            label: `available ${key}`,
            why: form.schema.property([...PATH, key])?.description ?? "",
          }),
        ),
      ),
    ),
  ];
}

/** Add material and pins, or remove them with their variables. @param {Form.Whole} form @param {unknown} table */
function putSections(form, table) {
  if (table === undefined) form.put(["variables", ...PATH], undefined);
  form.put(PATH, table);
}

/** Set each pin to half the width of its bar. @param {Form.Whole} form */
function propose(form) {
  for (const [pin, links] of Object.entries(BARS)) {
    const widths = links.map((link) => split(form.at(["mechanism", link, "width"]), "length"));
    const [narrowest] = widths.sort((one, other) => inMetres(one) - inMetres(other));
    const half = 0.5 * Number(narrowest.number);
    if (half > 0)
      form.put([...PATH, "pins", pin], join(String(Number(half.toPrecision(6))), narrowest.unit));
  }
  form.redraw();
}

/** @param {{ number: string, unit: string }} length */
function inMetres({ number, unit }) {
  return Number(convert(number, unit, "m", "length"));
}

/** Return the material and pins in one line. @param {Form.Whole} form */
export function strengthGiven(form) {
  const pins = Object.values(form.at([...PATH, "pins"]) ?? {}).map(String);
  const yields = form.at([...PATH, "material", "yield_strength"]);
  return form.at(PATH) === undefined
    ? ""
    : [yields && `yield strength ${yields}`, pins.length && `pins ${pins.join(", ")}`]
        .filter(Boolean)
        .join("; ");
}

/** @param {Form.Whole} form @param {Form.Path} path */
function keysOf(form, path) {
  return Object.keys(form.schema.property(path)?.properties ?? {});
}

/**
 * Return the field of a fixed number with a button that makes it vary; if it varies, the field of its permitted values.
 * @param {Form.Whole} form @param {Form.Path} path @param {string} label
 */
export function fixedOrVarying(form, path, label) {
  const varies = ["variables", ...path];
  const valueNow = () => /** @type {string | number | undefined} */ (form.at(path));
  /** @param {unknown} values */
  const vary = (values) => {
    form.put(varies, values);
    form.redraw();
  };
  if (form.at(varies) !== undefined && valueNow() !== undefined)
    return range(form, varies, {
      label,
      drop: "Hold",
      why: `The search chooses a value in this range; analyses of single designs use ${valueNow()}.`,
      fixed: false,
      removed: () => vary(undefined),
    });
  const fixedField = byschema(form, path, { label, required: true });
  const button = h(
    "button",
    {
      type: "button",
      "aria-label": `Let ${label} vary`,
      onclick: () => vary(rangeAround(valueNow() ?? "")),
    },
    "Let it vary",
  );
  fixedField?.querySelector(".field-controls")?.append(button);
  return fixedField;
}
