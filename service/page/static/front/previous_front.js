/** Front of the run that this one was copied from, drawn behind the new one. */

import { get, isAbort } from "../lib/api.js";
import { FrontData } from "./data.js";

const MOST = 1500; // maximum number of drawn designs, evenly spread

/**
 * Return {run, points(x, y)}: the previous run's designs in two columns that were requested with need(keys); null if that run has no
 * front or was deleted.
 * @param {number} run @param {AbortSignal} signal
 */
export async function previousFront(run, signal) {
  /** @type {FrontData} */
  let data;
  try {
    data = new FrontData(run, await get(`jobs/${run}/front`, {}, signal), signal);
  } catch (problem) {
    if (isAbort(problem)) throw problem;
    return null;
  }
  if (!data.count) return null;
  const step = Math.max(1, Math.ceil(data.count / MOST));
  return {
    run,
    name: data.front.name,
    count: data.count,
    /** @param {string[]} keys */
    need: (keys) => data.need(keys),
    /** Return the designs as rows of two columns; none if the run lacks one. @param {string} x @param {string} y @returns {Api.Row[]} */
    rows(x, y) {
      if (![x, y].every((key) => data.has(key))) return [];
      return Array.from({ length: Math.floor((data.count - 1) / step) + 1 }, (_, n) => ({
        [x]: data.cell(x, n * step),
        [y]: data.cell(y, n * step),
      }));
    },
  };
}
