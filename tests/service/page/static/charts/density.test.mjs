import assert from "node:assert/strict";
import { test } from "node:test";

import { draws } from "../draws.mjs";

globalThis.ImageData ??= class {
  constructor(width, height) {
    this.data = new Uint8ClampedArray(4 * width * height);
  }
};
const { Density } = await import("../../../../../service/page/static/charts/density.js");

const [WIDTH, HEIGHT, ACROSS] = [60, 40, [5, 25, 50]];

/** Return lines of drawn heights, some without a place on an axis. */
function lines({ whole, number }, count = 30) {
  return Int16Array.from({ length: count * ACROSS.length }, () =>
    number(0, 1) < 0.1 ? -1 : whole(0, HEIGHT - 1),
  );
}

test("a line crosses every pixel column between two axes, no farther from it than a pixel", () => {
  const heights = lines(draws(50));
  for (let line = 0; line < heights.length / ACROSS.length; line += 1) {
    const density = new Density(WIDTH, HEIGHT, ACROSS, heights);
    density.add(line, 1);
    for (let axis = 0; axis + 1 < ACROSS.length; axis += 1) {
      const [from, to] = [
        heights[line * ACROSS.length + axis],
        heights[line * ACROSS.length + axis + 1],
      ];
      for (let x = ACROSS[axis]; x < ACROSS[axis + 1]; x += 1) {
        const lit = Array.from({ length: HEIGHT }, (_, y) => y).filter(
          (y) => density.counts[y * WIDTH + x],
        );
        if (from < 0 || to < 0) assert.deepEqual(lit, []);
        else {
          const slope = (to - from) / (ACROSS[axis + 1] - ACROSS[axis]);
          const at = from + slope * (x - ACROSS[axis]);
          assert.ok(lit.length > 0 || Math.abs(slope) > 1);
          for (const y of lit)
            assert.ok(Math.abs(y - at) <= Math.max(1, Math.abs(slope)) + 1e-9, `${y} for ${at}`);
        }
      }
    }
  }
});

test("lines that are added and taken away again leave nothing, in any order", () => {
  const draw = draws(51);
  const heights = lines(draw);
  const density = new Density(WIDTH, HEIGHT, ACROSS, heights);
  const all = Array.from({ length: heights.length / ACROSS.length }, (_, line) => line);
  for (const line of all) density.add(line, 1);
  assert.ok(density.counts.some((count) => count > 0));
  const shuffled = all
    .map((line) => [draw.number(0, 1), line])
    .sort(([a], [b]) => a - b)
    .map(([, line]) => line);
  for (const line of shuffled) density.add(line, -1);
  assert.ok(density.counts.every((count) => count === 0));
});
