/** The units that a field offers, and values with units as job files have them: "40 mm". */

import { system } from "../lib/numbers.js";

// What one of the unit is in the first unit of its line, which is the SI unit: a plain number of a job is in it.
const KINDS = {
  length: { m: 1, mm: 1e-3, cm: 1e-2, "µm": 1e-6, in: 0.0254, foot: 0.3048 },
  area: { "m^2": 1, "cm^2": 1e-4, "mm^2": 1e-6, "in^2": 0.0254 ** 2 },
  angle: { rad: 1, deg: Math.PI / 180 },
  "angular speed": { "rad/s": 1, rpm: Math.PI / 30, "rev/s": 2 * Math.PI },
  "angular acceleration": { "rad/s^2": 1, "deg/s^2": Math.PI / 180 },
  mass: { kg: 1, g: 1e-3, t: 1000, lb: 0.45359237 },
  inertia: { "kg m^2": 1, "kg mm^2": 1e-6, "lb in^2": 0.45359237 * 0.0254 ** 2 },
  density: { "kg/m^3": 1, "g/cm^3": 1000, "lb/in^3": 0.45359237 / 0.0254 ** 3 },
  speed: { "m/s": 1, "mm/s": 1e-3, "in/s": 0.0254 },
  acceleration: { "m/s^2": 1, "mm/s^2": 1e-3, "in/s^2": 0.0254 },
  force: { N: 1, kN: 1000, lbf: 4.4482216152605 },
  torque: { "N m": 1, "kN m": 1000, "N mm": 1e-3, "lbf in": 4.4482216152605 * 0.0254, "lbf ft": 4.4482216152605 * 0.3048 },
  power: { W: 1, kW: 1000, hp: 550 * 0.3048 * 4.4482216152605 },
  stiffness: { "N/m": 1, "N/mm": 1000, "lbf/in": 4.4482216152605 / 0.0254 },
  damping: { "N s/m": 1, "N s/mm": 1000, "lbf s/in": 4.4482216152605 / 0.0254 },
  pressure: { Pa: 1, MPa: 1e6, GPa: 1e9, psi: 4.4482216152605 / 0.0254 ** 2 },
  time: { s: 1, min: 60 },
};
const USUAL = {
  si: { length: "mm", angle: "deg", "angular speed": "rpm", stiffness: "N/mm", pressure: "MPa" },
  inch: {
    length: "in", area: "in^2", angle: "deg", "angular speed": "rpm", mass: "lb", inertia: "lb in^2", density: "lb/in^3", speed: "in/s",
    acceleration: "in/s^2", force: "lbf", torque: "lbf in", stiffness: "lbf/in", damping: "lbf s/in", power: "hp", pressure: "psi",
  },
};
const NUMBER = /^\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,3})?)\s*(.*)$/s;

/** Return the names of all kinds. */
export function kinds() {
  return Object.keys(KINDS);
}

/** Return the kind of value that a unit measures, "length" for "mm"; null for none. */
export function kindOf(unit) {
  return Object.keys(KINDS).find((kind) => unit in KINDS[kind]) ?? null;
}

/** Return the units of a kind, smallest system first; percent: with the share of a dimension. */
export function unitsOf(kind, { percent = false } = {}) {
  return [...Object.keys(KINDS[kind] ?? {}), ...(percent ? ["%"] : [])];
}

/** Return the unit that an empty field of a kind begins with, by what the reader prefers. */
export function usual(kind) {
  return USUAL[system()][kind] ?? USUAL.si[kind] ?? Object.keys(KINDS[kind] ?? { "": 1 })[0];
}

/** Return {number, unit} of a value of a job, both text: what is no value with a unit stays as it is, as the number. */
export function split(value, kind) {
  if (value === undefined || value === null) return { number: "", unit: kind ? usual(kind) : "" };
  if (typeof value === "number") return { number: String(value), unit: Object.keys(KINDS[kind] ?? { "": 1 })[0] };
  const match = NUMBER.exec(String(value));
  const known = match && (match[2] === "%" || (kind && match[2].trim() in KINDS[kind]));
  if (known) return { number: match[1], unit: match[2].trim() };
  return { number: String(value), unit: "" };
}

/** Return the value of a job for a number and a unit as typed; undefined for an empty number. */
export function join(number, unit) {
  const typed = number.trim().replace("−", "-");
  if (typed === "") return undefined;
  return unit ? `${typed} ${unit}` : typed;
}

/** Return a number as typed in another unit of its kind, to ten digits; what is no number, or a share, stays. */
export function convert(number, from, to, kind) {
  const factors = KINDS[kind] ?? {};
  if (!(from in factors) || !(to in factors) || number.trim() === "" || !Number.isFinite(Number(number))) return number;
  return String(Number(((Number(number) * factors[from]) / factors[to]).toPrecision(10)));
}
