/** Number fields: typed text is parsed, explained beside the field, and tidied when the field loses focus. */

import { parseNumber } from "../lib/number_text.js";
import { join, measureOf } from "../lib/units.js";

/** @typedef {{ kind?: string | null, percent?: boolean, select?: HTMLSelectElement | null, range?: boolean }} Measure range: whether a range may stand for a value */

const NAME = /[a-z]{3,}(?:_[a-z]+)*/g;

/** Values of inputs in the job, as drawn. @type {WeakMap<HTMLInputElement, { value: string, unit: string | undefined, jobValue: unknown }>} */
const drawn = new WeakMap();

/**
 * Remember the job's value for an input: unless the user types another, it stays unchanged, in its own unit.
 * @param {HTMLInputElement} input @param {unknown} jobValue @param {HTMLSelectElement | null} [select]
 */
export function drawnFrom(input, jobValue, select) {
  if (typeof jobValue === "string" || typeof jobValue === "number")
    drawn.set(input, { value: input.value, unit: select?.value, jobValue });
}

/**
 * Return the job value for the text in an input: a number in the unit of the field, or the unchanged text if only the service can
 * interpret it; undefined for empty text. Unreadable text is reported at the field.
 * @param {HTMLInputElement} input @param {Measure} measure @returns {string | number | undefined}
 */
export function typedJobValue(input, measure = {}) {
  return typedValueOrRange(input, measure).value;
}

/**
 * Return the same as {value}; or {ends}, in the unit of the field, for a range typed as its middle and half its width.
 * @param {HTMLInputElement} input @param {Measure} measure @returns {{ value?: string | number, ends?: string[] }}
 */
export function typedValueOrRange(
  input,
  { kind = null, percent = false, select = null, range = false } = {},
) {
  const parsed = parseNumber(withJobValues(input), {
    unit: select?.value ?? "",
    ...measureOf(kind),
    percent,
    range,
  });
  delete input.dataset.wrong;
  const before = drawn.get(input);
  if (before && before.value === input.value && before.unit === select?.value) {
    for (const name of ["said", "number"]) delete input.dataset[name];
    say(input);
    return { value: /** @type {string | number} */ (before.jobValue) };
  }
  if (input.value !== input.dataset.number)
    for (const name of ["said", "number"]) delete input.dataset[name];
  if (parsed.wrong !== undefined) input.dataset.wrong = parsed.wrong;
  if (parsed.ends) {
    input.dataset.said = parsed.said;
    say(input);
    return { ends: parsed.ends.map((end) => join(end, parsed.unit) ?? "") };
  }
  if (parsed.number === undefined) {
    say(input);
    return { value: parsed.empty ? undefined : input.value.trim().replace(/^=\s*/, "") };
  }
  if (select && parsed.unit !== select.value) select.value = select.dataset.from = parsed.unit; // to a share, or from one
  if (parsed.said) [input.dataset.said, input.dataset.number] = [parsed.said, parsed.number];
  say(input);
  return { value: join(parsed.number, parsed.unit) };
}

/**
 * Return the typed text; after "=", names are replaced by values of the job, as in "=stroke/2". The form answers the event "value-of"
 * with the value of a name; other names stay, as a formula for the service.
 * @param {HTMLInputElement} input
 */
function withJobValues(input) {
  const typed = input.value.trim();
  if (!typed.startsWith("=")) return input.value;
  return typed.replace(NAME, (name) => {
    const query = { name, value: /** @type {string | number | null} */ (null) };
    input.dispatchEvent(new CustomEvent("value-of", { bubbles: true, detail: query }));
    return query.value === null ? name : `(${query.value})`;
  });
}

/** Replace the typed text with the parsed number. @param {HTMLInputElement} input */
export function replaceTyped(input) {
  if (input.dataset.number !== undefined) input.value = input.dataset.number;
}

/** Show beside the field how its numbers were interpreted. @param {HTMLInputElement} input */
export function say(input) {
  const place = input.closest(".field")?.querySelector(".understood");
  if (!(place instanceof HTMLElement)) return;
  const readings = [...(input.closest(".field")?.querySelectorAll("input") ?? [])].flatMap(
    ({ dataset }) => dataset.said ?? [],
  );
  place.textContent = readings.join(" · ");
  place.hidden = readings.length === 0;
}
