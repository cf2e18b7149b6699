/** Number fields: typed text is parsed, explained beside the field, and tidied when the field loses focus. */

import { parseNumber } from "../lib/number_text.js";
import { join, measureOf } from "../lib/units.js";

/** @typedef {{ kind?: string | null, percent?: boolean, select?: HTMLSelectElement | null, range?: boolean }} Measure range: whether a range may stand for a value */

const NAME = /[a-z]{3,}(?:_[a-z]+)*/g;

/** What the job had for an input, as it was drawn. @type {WeakMap<HTMLInputElement, { value: string, unit: string | undefined, jobValue: unknown }>} */
const drawn = new WeakMap();

/**
 * Remember what the job has for an input: as long as nothing else is typed it stays so, in its own unit.
 * @param {HTMLInputElement} input @param {unknown} jobValue @param {HTMLSelectElement | null} [select]
 */
export function drawnFrom(input, jobValue, select) {
  if (typeof jobValue === "string" || typeof jobValue === "number")
    drawn.set(input, { value: input.value, unit: select?.value, jobValue });
}

/**
 * Return what a job holds for what is typed in an input: a number in the unit that the field shows, or the text as it is where
 * only the service can say what it means; undefined for nothing. What cannot be read is said at the field.
 * @param {HTMLInputElement} input @param {Measure} measure @returns {string | number | undefined}
 */
export function taken(input, measure = {}) {
  return entered(input, measure).value;
}

/**
 * Return the same as {value}; or {ends}, in the unit that the field shows, of a range that is typed as its middle and half its width.
 * @param {HTMLInputElement} input @param {Measure} measure @returns {{ value?: string | number, ends?: string[] }}
 */
export function entered(
  input,
  { kind = null, percent = false, select = null, range = false } = {},
) {
  const parsed = parseNumber(valued(input), {
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
    for (const name of ["said", "number"]) delete input.dataset[name]; // else it was put in order
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
 * Return what was typed, after "=" with the values of the job in place of their names, as in "=stroke/2". The form answers the event
 * "value-of" with the value of a name; what has none stays, and is a formula for the service.
 * @param {HTMLInputElement} input
 */
function valued(input) {
  const typed = input.value.trim();
  if (!typed.startsWith("=")) return input.value;
  return typed.replace(NAME, (name) => {
    const query = { name, value: /** @type {string | number | null} */ (null) };
    input.dispatchEvent(new CustomEvent("value-of", { bubbles: true, detail: query }));
    return query.value === null ? name : `(${query.value})`;
  });
}

/** Put the number that was understood in place of what was typed. @param {HTMLInputElement} input */
export function ordered(input) {
  if (input.dataset.number !== undefined) input.value = input.dataset.number;
}

/** Say beside the field how its numbers were read. @param {HTMLInputElement} input */
export function say(input) {
  const place = input.closest(".field")?.querySelector(".understood");
  if (!(place instanceof HTMLElement)) return;
  const readings = [...(input.closest(".field")?.querySelectorAll("input") ?? [])].flatMap(
    ({ dataset }) => dataset.said ?? [],
  );
  place.textContent = readings.join(" · ");
  place.hidden = readings.length === 0;
}
