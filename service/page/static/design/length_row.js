/** Field and slider for a length of a linkage, or another number of a design. */

import { h, markInvalid, numberField, typeInto } from "../lib/dom.js";
import { inDisplayUnit, text, unitOf, withUnit } from "../lib/numbers.js";
import { parseQuantity } from "../lib/quantity_text.js";

/** @type {[keyof Page.Lengths, string][]} */
export const LENGTHS = [
  ["crank_mm", "Crank"],
  ["rod_mm", "Rod"],
  ["offset_mm", "Offset"],
];
const STEPS = 1000;
export const SAME = 1e-9; // relative

/**
 * Return the controls of a length. set(value): called with a new length, or null for invalid text. ends: range from the job, or only of
 * the slider if `isOfJob` is false. describedBy: id of the element that explains invalid text.
 * @template {string} Key @param {Key} key @param {string} title @param {readonly number[]} ends @param {(value: number | null) => void} set
 * @param {{ isOfJob?: boolean, describedBy?: string, unit?: string }} [options]
 */
export function lengthRow(
  key,
  title,
  [low, high],
  set,
  { isOfJob = true, describedBy = "", unit = "mm" } = {},
) {
  const fixed = low === high;
  const isPositive = key === "crank_mm" || key === "rod_mm";
  const id = `what-if-${key}`;
  const outside = h(
    "span",
    { class: "at-limit", role: "status", hidden: true },
    " · outside the job",
  );
  const understood = h("span", { class: "quiet ends", role: "status" }); // interpretation of a sum or a unit
  let wrong = ""; // why the typed text is not a length
  const number = numberField({
    id,
    disabled: fixed,
    oninput: () => {
      const { value, said = "", wrong: sentence = "" } = typed();
      wrong = sentence;
      markInvalid(number, wrong, describedBy);
      if (value !== undefined) slide(value);
      understood.textContent = said;
      set(value ?? null);
    },
    // Replace the typed text with the length that was understood, and keep the explanation visible.
    onchange: () => {
      const { value, said = "" } = typed();
      if (value === undefined) return;
      show(value);
      understood.textContent = said;
    },
  });
  const slider = h("input", {
    type: "range",
    min: 0,
    max: STEPS,
    step: 1,
    disabled: fixed,
    "aria-label": `${title}, slider`,
    oninput: () => {
      const position = slider.value;
      const value = low + (Number(position) / STEPS) * (high - low);
      show(value);
      slider.value = position;
      set(value);
    },
  });

  /** Return the length in the field, or why it is invalid. @returns {{ value?: number, said?: string | null, wrong?: string }} */
  function typed() {
    const parsed = parseQuantity(number.value, unit);
    if (parsed.value !== undefined && (parsed.value > 0 || !isPositive)) return parsed;
    return {
      wrong:
        parsed.wrong ??
        `${title} needs a ${unit === "mm" ? "length" : "number"}${isPositive ? " above 0" : ""}${parsed.empty ? "" : `; got ${number.value.trim()}`}.`,
    };
  }

  /** Show a length beside its field, and whether it is outside the ranges of the job. @param {number} value */
  function slide(value) {
    slider.value = String(high > low ? (STEPS * (value - low)) / (high - low) : 0);
    slider.setAttribute("aria-valuetext", withUnit(value, unit));
    outside.hidden =
      fixed ||
      !isOfJob ||
      (value >= low - SAME * Math.abs(low) && value <= high + SAME * Math.abs(high));
  }

  /** @param {number} value */
  function show(value) {
    wrong = understood.textContent = "";
    number.value = String(Number(inDisplayUnit(value, unit).toPrecision(6)));
    markInvalid(number, false, describedBy);
    slide(value);
  }

  return {
    key,
    node: h(
      "div",
      { class: "length" },
      h("label", { for: id }, title),
      slider,
      number,
      h("span", { class: "quiet" }, unitOf(unit)),
      h(
        "span",
        { class: "quiet ends", hidden: !isOfJob },
        fixed ? "fixed by the job" : `${text(low, unit, 4)} to ${withUnit(high, unit, 4)}`,
        outside,
      ),
      understood,
    ),
    show,
    wrong: () => wrong,
    text: () => number.value,
    /** @param {string | undefined} words */
    type: (words) => words && typeInto(number, words),
  };
}
