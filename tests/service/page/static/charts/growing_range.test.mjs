import assert from "node:assert/strict";
import { test } from "node:test";

import { growingRange } from "../../../../../service/page/static/charts/growing_range.js";
import { draws } from "../draws.mjs";

test("an axis holds all it has shown, never shrinks, and moves seldom", () => {
  const drawn = draws(3);
  const extent = growingRange();
  let [before, moved, least, most] = [null, 0, Infinity, -Infinity];
  for (let n = 0; n < 400; n += 1) {
    const values = Array.from({ length: 5 }, () => drawn.number(-1, 1) * (1 + n / 100));
    [least, most] = [Math.min(least, ...values), Math.max(most, ...values)];
    const now = extent("torque N m", values);
    assert.ok(now.low <= least && now.high >= most);
    if (before) assert.ok(now.low <= before.low && now.high >= before.high);
    moved += before !== null && (now.low !== before.low || now.high !== before.high) ? 1 : 0;
    before = now;
  }
  assert.ok(moved > 2 && moved < 30, `moved ${moved} times`);
});

test("each axis has its own range", () => {
  const extent = growingRange();
  extent("a", [0, 1]);
  assert.deepEqual(extent("b", [10, 20]), { low: 8, high: 22 });
  assert.deepEqual(extent("b", [12, 13]), { low: 8, high: 22 });
});
