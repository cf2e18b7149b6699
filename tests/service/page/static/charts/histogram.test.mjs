import assert from "node:assert/strict";
import { test } from "node:test";

import { countsInBins } from "../../../../../service/page/static/charts/histogram.js";
import { draws } from "../draws.mjs";

test("every chosen design that has a value is counted once on each axis, where it is", () => {
  const { whole, number } = draws(80);
  for (let n = 0; n < 100; n += 1) {
    const [axes, count, top, bottom] = [whole(1, 5), whole(1, 60), 12, whole(200, 400)];
    const heights = Int16Array.from({ length: axes * count }, () =>
      number(0, 1) < 0.1 ? -1 : whole(top, bottom),
    );
    const mask = Uint8Array.from({ length: count }, () => whole(0, 1));
    const counts = countsInBins(heights, axes, mask, top, bottom);
    const bins = counts.length / axes;
    for (let axis = 0; axis < axes; axis += 1) {
      for (let bin = 0; bin < bins; bin += 1) {
        const [from, to] = [bin, bin + 1].map((edge) => top + (edge * (bottom - top)) / bins);
        const inside = (y) => y >= from && (y < to || (bin === bins - 1 && y <= bottom));
        const expected = [...mask.keys()].filter(
          (row) =>
            mask[row] && heights[row * axes + axis] >= 0 && inside(heights[row * axes + axis]),
        ).length;
        assert.equal(counts[axis * bins + bin], expected);
      }
    }
  }
});
