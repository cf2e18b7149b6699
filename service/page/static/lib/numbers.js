/** Display of numbers. The API uses mm, deg, N, N m, rpm; numbers are converted to display units here. */

import { get } from "./api.js";

/** @type {{ si: Api.Units, inch: Api.Units | null }} */
const SYSTEMS = { si: {}, inch: null }; // the inch units come from the service when first needed
/** @type {[string, string][]} */
let suffixes = []; // units of the API, and endings of their keys, longest first
/** @type {Record<string, string>} */
let titles = {}; // of columns whose titles differ from their keys
/** @type {Record<string, string>} */
const PRETTY = { deg: "°" };
/** Superscript characters for powers of ten. @type {Record<string, string>} */
const POWERS = {
  "-": "⁻",
  ...Object.fromEntries([..."⁰¹²³⁴⁵⁶⁷⁸⁹"].map((sign, digit) => [digit, sign])),
};

/** Chosen unit system: "si" or "inch". @returns {"si" | "inch"} */
export function system() {
  return localStorage.getItem("units") === "inch" ? "inch" : "si";
}

/** Name of the system in the API; null for its default. */
export function apiSystem() {
  return system() === "inch" ? "inch" : null;
}

/** @type {Promise<Api.Answer<"get", "units">> | null} */
let table = null;

/** Return the table of units of the service, requested once. */
export function unitTable() {
  table ??= get("units").catch((problem) => {
    table = null; // a later request may succeed
    throw problem;
  });
  return table;
}

/** Load the units of both systems. Without an answer from the service, numbers are metric. */
export async function readySystem() {
  if (SYSTEMS.inch) return;
  const units = await unitTable();
  suffixes = Object.entries(units.suffixes).sort(([, one], [, other]) => other.length - one.length);
  titles = units.titles;
  SYSTEMS.inch = units.inch;
}

/** Return the title of a quantity's column if it differs from the key. Needs `readySystem`. @param {string} key */
export function titleOf(key) {
  return titles[key];
}

/**
 * Return the value in an API record whose key consists of a name and a unit, and the unit: `least_mm` for "least"; ratios have no unit.
 * Needs `readySystem`.
 * @param {Record<string, unknown>} record @param {string} name @returns {{ value: number | null, unit: string }}
 */
export function valueOf(record, name) {
  for (const [unit, suffix] of [...suffixes, ["", ""]]) {
    const value = record[name + suffix];
    if (typeof value === "number" || value === null) return { value, unit };
  }
  return { value: null, unit: "" };
}

/** Return {name, unit} of an API key: "crank" and "mm" for crank_mm. Needs `readySystem`. @param {string} key */
export function keyOf(key) {
  const [unit, suffix] = suffixes.find(
    ([, end]) => end && key.endsWith(end) && key.length > end.length,
  ) ?? ["", ""];
  return { name: key.slice(0, key.length - suffix.length), unit };
}

/** Return a sentence with ° and ² instead of deg and ^2 after numbers. @param {string} sentence */
export function withUnitSigns(sentence) {
  return sentence
    .replace(/(?<=\d\)?)[ \u00a0]deg\b(?!")/g, "°")
    .replace(/(?<=\d\)?[ \u00a0][a-zA-Z/ \u00a0]{0,6})\^([23])(?!")/g, (_, power) => POWERS[power]);
}

/**
 * Return a sentence of the service with its values in display units, with five digits; quoted text is user input and stays unchanged.
 * @param {string} sentence
 */
export function inDisplayUnits(sentence) {
  const units = Object.keys(SYSTEMS[system()] ?? {}).sort(
    (one, other) => other.length - one.length,
  );
  if (!units.length) return withUnitSigns(sentence);
  const number = "[-−]?\\d[\\d.]*(?:e[-+]?\\d+)?";
  const values = new RegExp(
    `(?<!["“\\w.^])((?:${number}(?:, | to | and | or | x ))*${number}\\)?) (${units.map((unit) => unit.replace("^", "\\^")).join("|")})(?![\\w^/])`,
    "g",
  );
  const converted = sentence.replace(
    values,
    (_, quantity, unit) =>
      `${quantity.replace(new RegExp(number, "g"), (/** @type {string} */ one) => text(Number(one.replace("−", "-")), unit))} ${unitOf(unit)}`,
  );
  return withUnitSigns(converted);
}

/** Choose a system; the caller redraws the view. @param {string} name */
export async function chooseSystem(name) {
  await readySystem();
  localStorage.setItem("units", name);
}

/** Return the display unit for an API unit in the notation of job files: "in" for "mm". @param {string} unit @returns {string} */
export function plainUnitOf(unit) {
  return SYSTEMS[system()]?.[unit]?.unit ?? unit;
}

/** Return the display unit for an API unit, such as "in" for "mm". @param {string} unit @returns {string} */
export function unitOf(unit) {
  const name = plainUnitOf(unit);
  return PRETTY[name] ?? name?.replace("^2", "²").replace("^3", "³");
}

/** Return an API value in its display unit. @param {number} value @param {string} unit */
export function inDisplayUnit(value, unit) {
  return value * (SYSTEMS[system()]?.[unit]?.factor ?? 1);
}

/** Return a displayed value in the unit of the API. @param {number} value @param {string} unit */
export function fromDisplayUnit(value, unit) {
  return value / (SYSTEMS[system()]?.[unit]?.factor ?? 1);
}

/**
 * Return a number as text with `digits` significant digits; text stays unchanged, undefined values become a dash.
 * @param {Api.Row[string] | undefined} value @param {string} unit @param {number} digits
 */
export function text(value, unit = "", digits = 5) {
  if (value === null || value === undefined || Number.isNaN(value)) return "–";
  if (typeof value !== "number") return String(value);
  const shown = inDisplayUnit(value, unit);
  if (shown === 0) return "0";
  const size = Math.abs(shown);
  if (size === Infinity) return shown > 0 ? "∞" : "−∞";
  if (size >= 1e6 || size < 1e-4) return withPower(shown, digits);
  const places = Math.min(Math.max(0, digits - 1 - Math.floor(Math.log10(size))), 12);
  const all = shown.toFixed(places); // with zeros at the end, unless the number is that short, as closely as a search meets requirements
  const isShort = Math.abs(Number(all) - shown) <= 1e-7 * size;
  return (isShort ? String(Number(all)) : all).replace("-", "−");
}

/** Return a very large or small number in scientific notation: "2.48·10⁶". @param {number} value @param {number} digits */
export function withPower(value, digits) {
  const [factor, power] = value.toExponential(digits - 1).split("e");
  const raised = power.replace(/./g, (sign) => POWERS[sign] ?? "");
  return `${Number(factor)}·10${raised}`.replace("-", "−");
}

/**
 * Return a limit as text, rounded "up" or "down" to the `side` where all values are possible, so that the number shown can be
 * entered as a requirement. optimise/feasibility/relaxation.py does the same for messages; here the displayed unit counts.
 * @param {number} value @param {string} unit @param {"up" | "down"} side @param {number} digits
 */
export function limitText(value, unit, side, digits = 5) {
  const shown = inDisplayUnit(value, unit);
  if (shown === 0) return "0";
  const places = Math.min(Math.max(0, digits - 1 - Math.floor(Math.log10(Math.abs(shown)))), 12);
  const rounding = 1e-10 * Math.abs(shown); // a number nearer to a shorter one than this is that one
  const scaled = (shown + (side === "up" ? -rounding : rounding)) * 10 ** places;
  return String(
    Number(
      ((side === "up" ? Math.ceil(scaled) : Math.floor(scaled)) / 10 ** places).toFixed(places),
    ),
  ).replaceAll("-", "−");
}

/** Return a number with its unit: "41.2 mm", "38°". @param {Api.Row[string] | undefined} value @param {string} unit @param {number} digits */
export function withUnit(value, unit = "", digits = 5) {
  if (typeof value !== "number" || Number.isNaN(value)) return text(value);
  const shown = unitOf(unit);
  return `${text(value, unit, digits)}${shown && shown !== "°" ? "\u00a0" : ""}${shown}`;
}

/**
 * Return the ends of an axis as text; a millionth of the axis counts as zero.
 * @param {Page.Range} options @param {string} unit @param {number} digits
 */
export function ends({ low, high }, unit, digits = 4) {
  return [low, high].map((value) =>
    text(Math.abs(value) < 1e-6 * Math.abs(high - low) ? 0 : value, unit, digits),
  );
}

/** Return a count with its noun: "1 design", "2,000 designs". @param {number} count @param {string} one */
export function counted(count, one) {
  return `${grouped(count)} ${one}${count === 1 ? "" : "s"}`;
}

/** Return a count with thousands separators: "10,000". The browser's locales take 50 ms to prepare. @param {number} count */
export function grouped(count) {
  return String(count).replace(/\B(?=(\d{3})+$)/g, ",");
}
