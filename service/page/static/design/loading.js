/** Requests of the view to the API. */

import { get } from "../lib/api.js";
import { withResultants } from "./panels.js";

/**
 * Return a design in the form of the view: {number, name, series, row, columns, curves, curveColumns, centres}. series: 1, 2, 3.
 * @param {string} job @param {number} number @param {number} series @param {AbortSignal} signal
 * @returns {Promise<Page.Machine & { number: number, columns: Api.Column[] }>}
 */
export async function loadDesign(job, number, series, signal) {
  const path = /** @type {const} */ (`jobs/${job}/designs/${number}`);
  const [{ design, columns, violations }, cycle] = await Promise.all([
    get(path, {}, signal),
    get(`${path}/curves`, {}, signal),
  ]);
  return {
    number,
    name: `Design ${number}`,
    series,
    row: design,
    columns,
    violations,
    ...cycleOf(cycle),
  };
}

/** Return the lengths of a design. @type {(row: Api.Row) => Page.Lengths} */
export function lengthsOf(row) {
  return {
    crank_mm: Number(row.crank_mm),
    rod_mm: Number(row.rod_mm),
    offset_mm: Number(row.offset_mm),
  };
}

/**
 * Return the curves in an API response: {curves, curveColumns, centres, sliderEnds, turns, seconds, outlines}. centres: positions of the
 * dead centres in the cycle, or of both ends of a swing. sliderEnds: slider positions there, mm.
 * @param {Api.Cycle} cycle @returns {Pick<Page.Machine, "curves" | "curveColumns" | "centres" | "sliderEnds" | "turns" | "seconds" | "outlines">}
 */
export function cycleOf(cycle) {
  const {
    turns,
    seconds,
    outlines,
    slider_ends_mm: sliderEnds,
    inner_dead_centre_deg: inner,
    outer_dead_centre_deg: outer,
  } = cycle;
  const centres = /** @type {Page.Point} */ (
    inner === null || outer === null ? [0, 180] : [inner / turns, outer / turns]
  );
  const { curves, columns } = withResultants(cycle);
  return { curves, curveColumns: columns, centres, sliderEnds, turns, seconds, outlines };
}

/**
 * Return the numbers of the compared designs in the address: at most two, without duplicates.
 * @param {URLSearchParams} query @param {number} number
 */
export function comparedDesigns(query, number) {
  const numbers = (query.get("beside") ?? "").split(",").map(Number);
  return [...new Set(numbers)]
    .filter((one) => Number.isInteger(one) && one > 0 && one !== number)
    .slice(0, 2);
}

/**
 * Return the objectives of all designs of a front, as rows by column.
 * @param {string} job @param {Api.Front} front @param {AbortSignal} signal @returns {Promise<Api.Row[]>}
 */
export async function loadFront(job, front, signal) {
  const keys = front.objectives.map(({ column }) => column);
  const { values, count } = await get(`jobs/${job}/columns`, { columns: keys.join(",") }, signal);
  return Array.from({ length: count }, (_, n) =>
    Object.fromEntries(keys.map((key) => [key, values[key][n]])),
  );
}
