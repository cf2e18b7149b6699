import assert from "node:assert/strict";
import { test } from "node:test";

import { draws } from "../draws.mjs";

const { rankInFront } = await import("../../../../../service/page/static/design/rank.js");
const OBJECTIVE = {
  column: "time_ratio",
  title: "time ratio",
  unit: "",
  sense: "maximise",
  target: null,
};

test("what is changed is never the best on the front, least of all where it is worse than the only design of it", () => {
  const { number, whole } = draws(61);
  for (let n = 0; n < 100; n += 1) {
    const front = Array.from({ length: whole(1, 6) }, () => ({ time_ratio: number(1, 2) }));
    const value = number(0.9, 2.1);
    const better = front.filter((row) => row.time_ratio > value).length;
    const { words, share } = rankInFront(OBJECTIVE, front, value, { broken: false });
    assert.equal(words.startsWith("no design on the front"), better === 0);
    if (better > 0 && front.length > 1)
      assert.equal(words, `${better} of ${front.length} designs are better`);
    if (better === front.length) assert.equal(share, 0);
    if (better === 0) assert.equal(share, 1);
    assert.equal(
      rankInFront(OBJECTIVE, front, value, { broken: true }).words,
      "misses a requirement",
    );
  }
  assert.equal(
    rankInFront(OBJECTIVE, [{ time_ratio: 1.11 }], 1.028, { broken: false }).words,
    "the only design on the front is better",
  );
});

test("a design of a front is the best of it if none is better but for rounding", () => {
  const front = [{ time_ratio: 1.2 }, { time_ratio: 1.2 + 1e-13 }, { time_ratio: 1.1 }];
  assert.deepEqual(
    front.map(({ time_ratio: value }) => rankInFront(OBJECTIVE, front, value, null).words),
    ["best on the front", "best on the front", "2 of 3 designs are better"],
  );
  assert.equal(rankInFront(OBJECTIVE, front, null, null).words, "3 of 3 designs are better");
});
