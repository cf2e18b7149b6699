/** Requirement on a quantity and its bounds: exactly, at least, at most, or between two; each a value or a formula. */

import { h } from "../lib/dom.js";
import { completing } from "./completion.js";
import { entries } from "./controls.js";
import { field, replace } from "./field.js";
import { at, idOf, isTable } from "./path.js";
import { kindOf, spread } from "../lib/units.js";

const ANY = ["any", "any"];
const MODES = [
  ["equals", "exactly"],
  ["min", "at least"],
  ["max", "at most"],
  ["between", "between"],
];
/** @type {Record<string, string[]>} */
const KEYS = { any: [], equals: ["equals"], min: ["min"], max: ["max"], between: ["min", "max"] };
/** Kinds of bounds in words. @type {Record<string, string>} */
const SAID = { equals: "exactly", min: "at least", max: "at most" };

/**
 * Return the field of the requirement on a quantity {name, title, unit, sentence}.
 * @param {Form.Whole} form @param {Api.Quantity} quantity @param {{ label?: string, place?: Form.Path }} options
 */
export function requirement(
  form,
  quantity,
  { label = quantity.title, place = ["constraints"] } = {},
) {
  const path = [...place, quantity.name];
  const here = () => replace(form, node, () => requirement(form, quantity, { label, place }));
  const { controls, mode } = bounds(
    form,
    { path, id: path },
    { label, kind: kindOf(quantity.unit), any: true, again: () => form.redraw(), here },
  );
  const node = field(form, path, label, controls, {
    sentence: quantity.sentence,
    name: quantity.name,
  });
  node.classList.toggle("two", mode === "between");
  return node;
}

/**
 * Return the controls of the bounds at a path of the job: {mode, keys, inputs, controls}.
 * @param {Form.Whole} form @param {Form.Spot} spot @param {{ label: string, kind: string | null, any?: boolean, again: () => void, here?: () => void }} options any: whether nothing may be asked; again: draws them anew; here: without what is around them
 */
export function bounds(form, spot, { label, kind, any = false, again, here = again }) {
  const stated = form.at(spot.path);
  const ends = spread(at(stated, ["equals"]), kind);
  const statedBounds = ends ? { min: ends[0], max: ends[1] } : stated;
  const mode = modeOf(statedBounds);
  const select = h(
    "select",
    {
      id: idOf(spot.id, any ? "c" : "m"),
      class: "mode",
      "aria-label": any ? null : `${label}: what must hold`,
      onchange: () => {
        write(KEYS[select.value]);
        again();
      },
    },
    (any ? [ANY, ...MODES] : MODES).map(([value, text]) =>
      h("option", { value, selected: value === mode }, text),
    ),
  );
  const keys = KEYS[mode];
  const ranges = mode === "equals" || mode === "between";
  const { inputs, units, read } = entries(
    keys.map((key) => ({
      id: idOf(spot.id, key),
      jobValue: at(statedBounds, [key]),
      title: `${label}, ${SAID[key]}`,
    })),
    { label, kind, range: ranges, unitId: idOf(spot.id, "u") },
    () => write(),
  );
  const between = () => inputs.map((_, n) => read(n).ends).find(Boolean);
  /** @param {string[]} names */
  const write = (names = keys) => {
    /** @type {Record<string, unknown>} */
    const values = {};
    const both = between();
    (both && names.length ? KEYS.between : names).forEach((key, place) => {
      const n = Math.min(place, inputs.length - 1);
      const typed = both ? (kind ? both[place] : Number(both[place])) : n >= 0 && read(n).value;
      values[key] = typed === false ? "" : (typed ?? ""); // the service reports it as missing
    });
    form.put(spot.path, names.length ? values : undefined);
  };
  const drawn = () => {
    if (!select.isConnected) return; // redrawn in the meantime
    write();
    here();
  };
  inputs.forEach((input) => input.addEventListener("change", () => between() && setTimeout(drawn))); // after the next control has received the focus
  const [low, high] = inputs.map((input) => completing(input, form, { number: true }));
  const controls = [select, low, high && h("span", { class: "to" }, "and"), high, units].filter(
    (one) => one instanceof HTMLElement,
  );
  return { mode, keys, inputs, controls };
}

/** Return the kind of a requirement. @param {unknown} requirement */
function modeOf(requirement) {
  if (!isTable(requirement)) return "any";
  if (requirement.equals !== undefined) return "equals";
  if (requirement.min !== undefined && requirement.max !== undefined) return "between";
  return requirement.max !== undefined ? "max" : "min";
}
