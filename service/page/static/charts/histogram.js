/** Histograms of the remaining designs beside the axes of parallel coordinates. */

const BINS = 24;
const WIDE = 16; // pixels, of the fullest bin of an axis

/**
 * Return the number of masked rows in each bin, axis by axis, from the top.
 * @param {Int16Array} heights of every design on every axis, less than 0 where it has no value
 * @param {number} axes @param {ArrayLike<number>} mask @param {number} top of the axes @param {number} bottom
 */
export function countsInBins(heights, axes, mask, top, bottom) {
  const counts = new Uint32Array(axes * BINS);
  for (let row = 0; row < mask.length; row += 1) {
    if (!mask[row]) continue;
    for (let axis = 0; axis < axes; axis += 1) {
      const y = heights[row * axes + axis];
      if (y >= 0)
        counts[
          axis * BINS +
            Math.max(0, Math.min(BINS - 1, Math.floor(((y - top) / (bottom - top)) * BINS)))
        ] += 1;
    }
  }
  return counts;
}

/**
 * Draw the bins at the left of the axes.
 * @param {Page.Canvas} context @param {{ axes: readonly unknown[], across: number[], heights: Int16Array, height: number, ink: Page.Ink }} view
 * @param {ArrayLike<number>} mask @param {number} room above and below the axes
 */
export function drawHistograms(context, { axes, across, heights, height, ink }, mask, room) {
  const [top, bottom] = [room, height - room];
  const counts = countsInBins(heights, axes.length, mask, top, bottom);
  const tall = (bottom - top) / BINS;
  context.fillStyle = ink.quiet;
  context.globalAlpha = 0.35;
  axes.forEach((_, axis) => {
    const axisCounts = counts.subarray(axis * BINS, (axis + 1) * BINS);
    const most = Math.max(...axisCounts);
    axisCounts.forEach((count, bin) => {
      const wide = most ? (WIDE * count) / most : 0;
      context.fillRect(across[axis] - wide, top + bin * tall, wide, Math.max(1, tall - 1));
    });
  });
  context.globalAlpha = 1;
}
