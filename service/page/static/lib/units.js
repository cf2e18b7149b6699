/** The units that a field offers, and values with units as job files have them: "40 mm". */

import { system, unitTable } from "./numbers.js";
import { parseNumber } from "./number_text.js";

/** @type {Record<string, Record<string, number>>} */
let KINDS = {}; // by kind, what one of each unit is in the SI unit, which comes first: a plain number of a job is in it
/** @type {Record<string, Record<string, string>>} */
let SPOKEN = {}; // by kind, the unit that other words mean there: 1/min of a speed
/** @type {Record<string, Record<string, string>>} */
let USUAL = { si: {}, inch: {} };
const NUMBER = /^\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,3})?)\s*(.*)$/s;

/** Load the table of kinds, to offer and to parse units. */
export async function readyKinds() {
  const { kinds: known } = await unitTable();
  KINDS = Object.fromEntries(
    known.map(({ name, units }) => [
      name,
      Object.fromEntries(units.map(({ unit, factor }) => [unit, factor])),
    ]),
  );
  SPOKEN = Object.fromEntries(known.map(({ name, spoken }) => [name, spoken]));
  USUAL = {
    si: Object.fromEntries(known.map(({ name, si }) => [name, si])),
    inch: Object.fromEntries(known.map(({ name, inch }) => [name, inch])),
  };
}

/**
 * Return what is known of the units of a kind: {factors, what one of each is in its SI unit; spoken, other words for them}; nothing for a
 * number without a kind.
 * @param {string | null | undefined} kind
 */
export function measureOf(kind) {
  return { factors: KINDS[kind ?? ""] ?? {}, spoken: SPOKEN[kind ?? ""] ?? {} };
}

/** Return the names of all kinds. */
export function kinds() {
  return Object.keys(KINDS);
}

/** Return the kind of value that a unit measures, "length" for "mm"; null for none. @param {string} unit */
export function kindOf(unit) {
  return Object.keys(KINDS).find((kind) => unit in KINDS[kind]) ?? null;
}

/**
 * Return the units of a kind, smallest system first; percent: with the share of a dimension.
 * @param {string} kind @param {{ percent?: boolean }} options
 */
export function unitsOf(kind, { percent = false } = {}) {
  return [...Object.keys(KINDS[kind] ?? {}), ...(percent ? ["%"] : [])];
}

/** Return the unit that an empty field of a kind begins with, by what the reader prefers. @param {string} kind */
export function usual(kind) {
  return USUAL[system()][kind] ?? USUAL.si[kind] ?? Object.keys(KINDS[kind] ?? { "": 1 })[0];
}

/**
 * Return {number, unit} of a value of a job, both text: what is no value with a unit stays as it is, as the number.
 * @param {unknown} value @param {string | null | undefined} kind
 */
export function split(value, kind) {
  if (value === undefined || value === null) return { number: "", unit: kind ? usual(kind) : "" };
  if (typeof value === "number")
    return { number: String(value), unit: Object.keys(KINDS[kind ?? ""] ?? { "": 1 })[0] };
  const match = NUMBER.exec(String(value));
  const { factors, spoken } = measureOf(kind);
  const word = match?.[2].trim() ?? "";
  const unit = spoken[word] ?? word;
  if (match && (unit === "%" || unit in factors)) return { number: match[1], unit };
  return { number: String(value), unit: "" };
}

/**
 * Return the ends of a range that a job states as its middle and half its width, "180 mm +- 0.5 mm", each as a value of a job; null for
 * what states no such range.
 * @param {unknown} value @param {string | null | undefined} kind @returns {[string, string] | null}
 */
export function spread(value, kind) {
  const parsed =
    typeof value === "string"
      ? parseNumber(value, { unit: "", ...measureOf(kind), range: true })
      : {};
  if (!parsed.ends || (kind && !parsed.unit)) return null;
  const [low, high] = parsed.ends.map((end) => (parsed.unit ? `${end} ${parsed.unit}` : end));
  return [low, high];
}

/** Return the value of a job for a number and a unit as typed; undefined for an empty number. @param {string} number @param {string} unit */
export function join(number, unit) {
  const typed = number.trim().replaceAll("−", "-");
  if (typed === "") return undefined;
  if (/[a-z_]{3}|\(/i.test(typed)) return typed; // a formula, whose numbers have units of their own
  return unit ? `${typed} ${unit}` : typed;
}

/**
 * Return a number as typed in another unit of its kind, to ten digits; what is no number, or a share, stays.
 * @param {string} number @param {string} from @param {string} to @param {string | null | undefined} kind
 */
export function convert(number, from, to, kind) {
  const factors = KINDS[kind ?? ""] ?? {};
  if (
    from === to ||
    !(from in factors) ||
    !(to in factors) ||
    number.trim() === "" ||
    !Number.isFinite(Number(number))
  )
    return number;
  return String(Number(((Number(number) * factors[from]) / factors[to]).toPrecision(10)));
}
