/** Units that fields offer, and values with units in the notation of job files: "40 mm". */

import { system, unitTable } from "./numbers.js";
import { parseNumber } from "./number_text.js";

/** @type {Record<string, Record<string, number>>} */
let KINDS = {}; // by kind: factor of each unit to SI; the SI unit comes first and applies to plain numbers in jobs
/** @type {Record<string, Record<string, string>>} */
let SPOKEN = {}; // by kind: units for other words, such as 1/min for a speed
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
 * Return the units of a kind: {factors, spoken}, with factors to SI and other words for them; empty without a kind.
 * @param {string | null | undefined} kind
 */
export function measureOf(kind) {
  return { factors: KINDS[kind ?? ""] ?? {}, spoken: SPOKEN[kind ?? ""] ?? {} };
}

/** Return the names of all kinds. */
export function kinds() {
  return Object.keys(KINDS);
}

/** Return the kind of a unit, such as "length" for "mm", or null. @param {string} unit */
export function kindOf(unit) {
  return Object.keys(KINDS).find((kind) => unit in KINDS[kind]) ?? null;
}

/**
 * Return the units of a kind, those of the smallest system first. percent: whether to include % of a dimension.
 * @param {string} kind @param {{ percent?: boolean }} options
 */
export function unitsOf(kind, { percent = false } = {}) {
  return [...Object.keys(KINDS[kind] ?? {}), ...(percent ? ["%"] : [])];
}

/** Return the default unit of an empty field in the chosen unit system. @param {string} kind */
export function usual(kind) {
  return USUAL[system()][kind] ?? USUAL.si[kind] ?? Object.keys(KINDS[kind] ?? { "": 1 })[0];
}

/**
 * Return {number, unit} of a job value as text; text that is not a value with a unit becomes the number.
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
 * Return the ends of a range stated as its middle and half its width, "180 mm +- 0.5 mm", as job values; null for other text.
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

/** Return the job value for a typed number and a unit; undefined for an empty number. @param {string} number @param {string} unit */
export function join(number, unit) {
  const typed = number.trim().replaceAll("−", "-");
  if (typed === "") return undefined;
  if (/[a-z_]{3}|\(/i.test(typed)) return typed; // a formula, whose numbers contain their units
  return unit ? `${typed} ${unit}` : typed;
}

/**
 * Return a typed number in another unit of its kind, with ten digits; other text and fractions stay unchanged.
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
