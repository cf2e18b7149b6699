import assert from "node:assert/strict";
import { test } from "node:test";

import { nextDesign } from "../../../../../service/page/static/charts/keyboard_access.js";
import { draws } from "../draws.mjs";

test("keys go through all designs that are let through, once each, in the order of the number, and back", () => {
  const { number, whole } = draws(4);
  for (let turn = 0; turn < 50; turn += 1) {
    const count = whole(1, 30);
    const values = Array.from({ length: count }, () => Math.round(number(0, 8))); // with ties
    const mask = values.map(() => (number(0, 1) < 0.7 ? 1 : 0));
    const order = values
      .map((_, row) => row)
      .filter((row) => mask[row])
      .sort((a, b) => values[a] - values[b] || a - b);
    if (!order.length) continue;
    for (const [list, by] of [
      [order, 1],
      [order.toReversed(), -1],
    ]) {
      let here = list[0];
      for (const expected of [...list.slice(1), list.at(-1)]) {
        here = nextDesign(here, mask, { of: (row) => values[row], by });
        assert.equal(here, expected);
      }
    }
  }
});
