/** The little of a browser that modules without a document need: what the reader chose, and the answer of the service. */

/** The units of the inch system, by definition of the inch and the pound. */
export const INCH = {
  mm: { unit: "in", factor: 1 / 25.4 },
  kg: { unit: "lb", factor: 1 / 0.45359237 },
  N: { unit: "lbf", factor: 1 / (0.45359237 * 9.80665) },
};

// What one of a unit is in the first one of its line, the SI unit, by definition.
const UNITS = {
  length: { m: 1, mm: 1e-3, cm: 1e-2, µm: 1e-6, in: 0.0254, foot: 0.3048 },
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
  torque: {
    "N m": 1,
    "kN m": 1000,
    "N mm": 1e-3,
    "lbf in": 4.4482216152605 * 0.0254,
    "lbf ft": 4.4482216152605 * 0.3048,
  },
  power: { W: 1, kW: 1000, hp: 550 * 0.3048 * 4.4482216152605 },
  stiffness: { "N/m": 1, "N/mm": 1000, "lbf/in": 4.4482216152605 / 0.0254 },
  damping: { "N s/m": 1, "N s/mm": 1000, "lbf s/in": 4.4482216152605 / 0.0254 },
  pressure: { Pa: 1, MPa: 1e6, GPa: 1e9, psi: 4.4482216152605 / 0.0254 ** 2 },
  time: { s: 1, min: 60 },
};
const SPOKEN = { "angular speed": { "1/min": "rpm", "min^-1": "rpm", spm: "rpm", Hz: "rev/s" } };
const USUAL = {
  si: { length: "mm", angle: "deg", "angular speed": "rpm", stiffness: "N/mm", pressure: "MPa" },
  inch: {
    length: "in",
    area: "in^2",
    angle: "deg",
    "angular speed": "rpm",
    mass: "lb",
    inertia: "lb in^2",
    density: "lb/in^3",
    speed: "in/s",
    acceleration: "in/s^2",
    force: "lbf",
    torque: "lbf in",
    stiffness: "lbf/in",
    damping: "lbf s/in",
    power: "hp",
    pressure: "psi",
  },
};
const KINDS = Object.entries(UNITS).map(([name, units]) => ({
  name,
  units: Object.entries(units).map(([unit, factor]) => ({ unit, factor })),
  spoken: SPOKEN[name] ?? {},
  si: USUAL.si[name] ?? Object.keys(units)[0],
  inch: USUAL.inch[name] ?? Object.keys(units)[0],
}));

const SUFFIXES = { mm: "_mm", deg: "_deg", N: "_N", "N m": "_Nm", "m/s": "_m_s", "m/s^2": "_m_s2" };

let chosen = "si";
Object.defineProperty(globalThis, "localStorage", {
  value: { getItem: (name) => (name === "units" ? chosen : null) },
});
globalThis.fetch = async (url) => {
  if (url !== "api/v1/units") throw new Error(`nobody answers ${url}`);
  return new Response(JSON.stringify({ inch: INCH, kinds: KINDS, suffixes: SUFFIXES }));
};

/** Choose the system of units: "si" or "inch". */
export function choose(system) {
  chosen = system;
}
