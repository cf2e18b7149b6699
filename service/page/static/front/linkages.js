/** The designs of a front as linkages, and the frame in which all of them have one scale. */

import { deadCentresOf } from "../mechanism/motion.js";
import { around, frameWithin } from "../mechanism/frame.js";

/**
 * @import { FrontData } from "./data.js"
 * @import { Frame } from "../mechanism/frame.js"
 */

export const LENGTHS = ["crank_mm", "rod_mm", "offset_mm"];

/** Return {of(row), frame()} of a front whose lengths are here. @param {FrontData} data */
export function linkages(data) {
  /** @type {Frame | null} */
  let frame = null;
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
      ); // of one that need not turn
    }
    frame = around(frames);
    return frame;
  }
  return { of: lengthsAt, frame: all };
}
