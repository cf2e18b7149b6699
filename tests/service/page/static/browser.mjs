/** The little of a browser that modules without a document need: what the reader chose, and the answer of the service. */

/** The units of the inch system, by definition of the inch and the pound. */
export const INCH = {
  mm: { unit: "in", factor: 1 / 25.4 },
  kg: { unit: "lb", factor: 1 / 0.45359237 },
  N: { unit: "lbf", factor: 1 / (0.45359237 * 9.80665) },
};

let chosen = "si";
Object.defineProperty(globalThis, "localStorage", { value: { getItem: (name) => (name === "units" ? chosen : null) } });
globalThis.fetch = async (url) => {
  if (url !== "api/v1/units") throw new Error(`nobody answers ${url}`);
  return new Response(JSON.stringify({ inch: INCH }));
};

/** Choose the system of units: "si" or "inch". */
export function choose(system) {
  chosen = system;
}
