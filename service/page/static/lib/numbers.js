/** Numbers for people. The API speaks mm, deg, N, N m, rpm; what a reader prefers is converted here, for show only. */

import { get } from "./api.js";

/** @type {{ si: Api.Units, inch: Api.Units | null }} */
const SYSTEMS = { si: {}, inch: null }; // the one of inches comes from the service, when it is first needed
/** @type {[string, string][]} */
let suffixes = []; // units of the API, and how keys of values in them end, the longest first
/** @type {Record<string, string>} */
let titles = {}; // of columns whose keys say others
/** @type {Record<string, string>} */
const PRETTY = { deg: "°" };
/** Signs of a power of ten, raised. @type {Record<string, string>} */
const POWERS = {
  "-": "⁻",
  ...Object.fromEntries([..."⁰¹²³⁴⁵⁶⁷⁸⁹"].map((sign, digit) => [digit, sign])),
};

/** The system of units that the reader chose: "si" or "inch". @returns {"si" | "inch"} */
export function system() {
  return localStorage.getItem("units") === "inch" ? "inch" : "si";
}

/** The system as the API calls it; null for that of its own. */
export function apiSystem() {
  return system() === "inch" ? "inch" : null;
}

/** @type {Promise<Api.Answer<"get", "units">> | null} */
let table = null;

/** Return the table of units of the service, asked for once. */
export function unitTable() {
  table ??= get("units").catch((problem) => {
    table = null; // another time it may answer
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

/** Return the title of a column of a quantity where its key says another one. Needs `readySystem`. @param {string} key */
export function titleOf(key) {
  return titles[key];
}

/**
 * Return the value of a record of the API whose key begins with a name and ends with a unit, and that unit: `least_mm` for
 * "least"; a ratio has no unit. Needs `readySystem`.
 * @param {Record<string, unknown>} record @param {string} name @returns {{ value: number | null, unit: string }}
 */
export function valueOf(record, name) {
  for (const [unit, suffix] of [...suffixes, ["", ""]]) {
    const value = record[name + suffix];
    if (typeof value === "number" || value === null) return { value, unit };
  }
  return { value: null, unit: "" };
}

/** Return {name, unit} of a key of the API: "crank" and "mm" of crank_mm. Needs `readySystem`. @param {string} key */
export function keyOf(key) {
  const [unit, suffix] = suffixes.find(
    ([, end]) => end && key.endsWith(end) && key.length > end.length,
  ) ?? ["", ""];
  return { name: key.slice(0, key.length - suffix.length), unit };
}

/**
 * Return a sentence of the service with its values in the units that are shown, five digits of them; what is quoted was typed by
 * somebody, and stays.
 * @param {string} sentence
 */
export function inDisplayUnits(sentence) {
  const units = Object.keys(SYSTEMS[system()] ?? {}).sort(
    (one, other) => other.length - one.length,
  );
  if (!units.length) return sentence;
  const number = "[-−]?\\d[\\d.]*(?:e[-+]?\\d+)?";
  const values = new RegExp(
    `(?<!["“\\w.^])((?:${number}(?:, | to | and | or | x ))*${number}\\)?) (${units.map((unit) => unit.replace("^", "\\^")).join("|")})(?![\\w^/])`,
    "g",
  );
  return sentence.replace(
    values,
    (_, quantity, unit) =>
      `${quantity.replace(new RegExp(number, "g"), (/** @type {string} */ one) => text(Number(one.replace("−", "-")), unit))} ${unitOf(unit)}`,
  );
}

/** Choose a system; the view is to be shown again. @param {string} name */
export async function chooseSystem(name) {
  await readySystem();
  localStorage.setItem("units", name);
}

/** Return the unit that is shown for one of the API, as job files write it: "in" for "mm". @param {string} unit @returns {string} */
export function plainUnitOf(unit) {
  return SYSTEMS[system()]?.[unit]?.unit ?? unit;
}

/** Return the unit that is shown for one of the API, such as "in" for "mm". @param {string} unit @returns {string} */
export function unitOf(unit) {
  const name = plainUnitOf(unit);
  return PRETTY[name] ?? name?.replace("^2", "²").replace("^3", "³");
}

/** Return a value of the API in the unit that is shown for it. @param {number} value @param {string} unit */
export function inDisplayUnit(value, unit) {
  return value * (SYSTEMS[system()]?.[unit]?.factor ?? 1);
}

/** Return a shown value in the unit of the API. @param {number} value @param {string} unit */
export function fromDisplayUnit(value, unit) {
  return value / (SYSTEMS[system()]?.[unit]?.factor ?? 1);
}

/**
 * Return a number as text: `digits` significant ones; text stays text; what is not defined is a dash.
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
  const places = Math.max(0, digits - 1 - Math.floor(Math.log10(size)));
  return String(Number(shown.toFixed(Math.min(places, 12)))).replace("-", "−");
}

/** Return a very large or small number in scientific notation: "2.48·10⁶". @param {number} value @param {number} digits */
export function withPower(value, digits) {
  const [factor, power] = value.toExponential(digits - 1).split("e");
  const raised = power.replace(/./g, (sign) => POWERS[sign] ?? "");
  return `${Number(factor)}·10${raised}`.replace("-", "−");
}

/**
 * Return a limit as text, rounded to the `side` where all values are possible, "up" or "down", so that what is read can be
 * asked for: what optimise/feasibility/safe_side_rounding.py does for sentences, in the unit that is shown.
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
 * Return the ends of an axis as text: a millionth of the axis is zero to every reader.
 * @param {Page.Range} options @param {string} unit @param {number} digits
 */
export function ends({ low, high }, unit, digits = 4) {
  return [low, high].map((value) =>
    text(Math.abs(value) < 1e-6 * Math.abs(high - low) ? 0 : value, unit, digits),
  );
}

/** Return how many of something there are: "1 design", "2,000 designs". @param {number} count @param {string} one */
export function counted(count, one) {
  return `${grouped(count)} ${one}${count === 1 ? "" : "s"}`;
}

/** Return a count with its thousands apart: "10,000". Not by the browser's locales: making those ready takes it 50 ms. @param {number} count */
export function grouped(count) {
  return String(count).replace(/\B(?=(\d{3})+$)/g, ",");
}
