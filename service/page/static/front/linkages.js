/** Designs of a front as linkages, and the frame that gives all of them one scale. */

import { get } from "../lib/api.js";
import { deadCentresOf } from "../mechanism/motion.js";
import { frameAround, frameOfExtent, frameWithin } from "../mechanism/frame.js";

/**
 * @import { FrontData } from "./data.js"
 * @import { Frame } from "../mechanism/frame.js"
 */

export const LENGTHS = ["crank_mm", "rod_mm", "offset_mm"];
const TIMES = 72; // of a swing back and forth

/**
 * Return {of(row), frame(), cycle(row), isRequested(row)} of a front whose lengths are loaded. cycle: the service's answer for a
 * swinging design, requested only once, null if the service has none.
 * @param {FrontData} data @param {AbortSignal} signal
 */
export function linkages(data, signal) {
  const { front } = data;
  /** @type {Frame | null} */
  let frame = front.extent_mm ? frameOfExtent(front.extent_mm) : null;
  /** @type {Map<number, Promise<Api.Cycle | null>>} */
  const cycles = new Map();
  /** @param {number} row */
  function cycle(row) {
    const path = /** @type {const} */ (`jobs/${front.job}/designs/${row + 1}/curves`);
    const asked = cycles.get(row) ?? get(path, { angles: TIMES }, signal).catch(() => null);
    cycles.set(row, asked);
    return asked;
  }
  const [crank, rod, offset] = LENGTHS.map((key) => data.numbers(key));
  /** @param {number} row @returns {Page.Lengths} */
  const lengthsAt = (row) => ({ crank_mm: crank[row], rod_mm: rod[row], offset_mm: offset[row] });

  /** Return the frame that holds every design. */
  function all() {
    if (frame) return frame;
    /** @type {Frame[]} */
    const frames = [];
    for (let row = 0; row < data.count; row += 1) {
      const { inner, outer } = deadCentresOf(lengthsAt(row));
      const { crank_mm: r } = lengthsAt(row);
      frames.push(
        frameWithin(
          lengthsAt(row),
          Number.isFinite(inner) ? inner : 0,
          Number.isFinite(outer) ? outer : r,
        ),
      ); // of a linkage that need not rotate fully
    }
    frame = frameAround(frames);
    return frame;
  }
  return {
    of: lengthsAt,
    frame: all,
    cycle,
    isRequested: (/** @type {number} */ row) => cycles.has(row),
  };
}
