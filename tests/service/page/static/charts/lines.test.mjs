import assert from "node:assert/strict";
import { test } from "node:test";

import { nearestLine } from "../../../../../service/page/static/charts/lines.js";
import { draws } from "../draws.mjs";

/** Return the vertical distance of a line of a design from a place, walked along pixel by pixel; Infinity where none is drawn. */
function distance(across, heights, row, x, y) {
  const at = Math.min(Math.max(x, across[0]), across[across.length - 1]);
  for (let axis = 1; axis < across.length; axis += 1) {
    const [from, to] = [
      heights[row * across.length + axis - 1],
      heights[row * across.length + axis],
    ];
    if (at < across[axis - 1] || at > across[axis] || from < 0 || to < 0) continue;
    return Math.abs(
      from + ((at - across[axis - 1]) / (across[axis] - across[axis - 1])) * (to - from) - y,
    );
  }
  return Infinity;
}

test("the nearest line under the pointer is the one that a search of all finds, if any is near", () => {
  const { number, whole } = draws(80);
  let found = 0;
  for (let n = 0; n < 500; n += 1) {
    const [axes, rows] = [whole(2, 5), whole(0, 12)];
    const across = Array.from({ length: axes }, (_, axis) => 30 + 100 * axis);
    const heights = Int16Array.from({ length: axes * rows }, () =>
      number(0, 1) < 0.1 ? -1 : whole(0, 200),
    );
    const mask = Uint8Array.from({ length: rows }, () => whole(0, 3) && 1);
    const [x, y] = [number(30.5, 30 + 100 * (axes - 1)), number(0, 200)];
    const distances = [...mask].map((one, row) =>
      one ? distance(across, heights, row, x, y) : Infinity,
    );
    const least = Math.min(Infinity, ...distances);
    const nearest = nearestLine({ across, heights }, mask, x, y);
    if (least >= 8) assert.equal(nearest, null);
    else {
      found += 1;
      assert.ok(Math.abs(distances[nearest] - least) < 1e-9);
    }
  }
  assert.ok(found > 50);
});

test("beyond the axes the end of a line counts, and of a single axis its place", () => {
  const heights = Int16Array.from([10, 50, 100, 20]);
  const both = Uint8Array.from([1, 1]);
  assert.equal(nearestLine({ across: [30, 130], heights }, both, 0, 98), 1);
  assert.equal(nearestLine({ across: [30, 130], heights }, both, 200, 48), 0);
  assert.equal(nearestLine({ across: [30], heights: heights.subarray(0, 2) }, both, 90, 49), 1);
  assert.equal(nearestLine({ across: [], heights: new Int16Array(0) }, both, 90, 49), null);
});
