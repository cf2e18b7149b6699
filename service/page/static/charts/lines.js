/** Lines of designs over parallel axes: drawing single lines, and finding the line under the pointer. */

import { nearest } from "./pointer_access.js";

const NEAR = 8; // vertical pixels within which the pointer is on a line

/**
 * Draw the line of a design. across, heights: pixels of the axes, and of all designs on them; negative for a missing value.
 * @param {Page.Canvas} context @param {number} row @param {number} axes @param {number[]} across @param {Int16Array} heights
 */
export function drawLine(context, row, axes, across, heights) {
  context.beginPath();
  let down = false;
  for (let axis = 0; axis < axes; axis += 1) {
    const y = heights[row * axes + axis];
    if (y < 0) down = false;
    else if (down) context.lineTo(across[axis], y);
    else context.moveTo(across[axis], y);
    down = y >= 0;
  }
  context.stroke();
}

/**
 * Return the design of `mask` whose line passes nearest above or below a point; null if none is near.
 * @param {{ across: number[], heights: Int16Array }} view @param {Uint8Array} mask @param {number} x @param {number} y
 */
export function nearestLine({ across, heights }, mask, x, y) {
  const count = across.length;
  const after = across.findIndex((at) => at >= x);
  const right = after < 0 ? count - 1 : after; // beyond the ends, use the end
  const left = after <= 0 ? right : right - 1;
  const share = right === left ? 0 : (x - across[left]) / (across[right] - across[left]);
  /** @param {number} row */
  const distance = (row) => {
    const [from, to] = [heights[row * count + left], heights[row * count + right]];
    const isDrawn = mask[row] && from >= 0 && to >= 0;
    return isDrawn ? Math.abs(from + share * (to - from) - y) : Infinity;
  };
  return nearest(mask.length, distance, NEAR);
}
