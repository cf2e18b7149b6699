import assert from "node:assert/strict";
import { test } from "node:test";

import { draws } from "../draws.mjs";

const stored = new Map();
globalThis.sessionStorage = {
  getItem: (key) => stored.get(key) ?? null,
  setItem: (key, value) => stored.set(key, value),
  removeItem: (key) => stored.delete(key),
};
const { neighbours, storeOrder, linesOf } =
  await import("../../../../../service/page/static/front/listed_order.js");

test("a list is walked through from end to end and back", () => {
  const { whole } = draws(95);
  for (let n = 0; n < 50; n += 1) {
    const all = whole(1, 40);
    const numbers = Array.from({ length: all }, (_, at) => at + 1)
      .filter(() => whole(0, 1))
      .sort(() => whole(-1, 1));
    storeOrder(7, numbers);
    if (!numbers.length) continue;
    const walked = [numbers[0]];
    for (
      let next = neighbours(7, walked[0], all).after;
      next !== null;
      next = neighbours(7, next, all).after
    )
      walked.push(next);
    assert.deepEqual(walked, numbers);
    assert.deepEqual(
      [...walked].reverse().map((one) => neighbours(7, one, all).before),
      [...numbers].reverse().map((_, at) => [...numbers].reverse()[at + 1] ?? null),
    );
  }
});

test("without a list, outside of it, or with a broken one, all designs are walked through by number", () => {
  for (const make of [
    () => storeOrder(7, null),
    () => storeOrder(7, [2, 4]),
    () => stored.set("listed 7", "{"),
    () => stored.set("listed 7", "{}"),
  ]) {
    make();
    assert.deepEqual(neighbours(7, 3, 3), {
      place: 3,
      count: 3,
      before: 2,
      after: null,
      listed: false,
    });
    assert.equal(neighbours(7, 1, 3).before, null);
  }
});

test("the lines of some designs are those of the table, in the wanted order; what is no such table is refused", () => {
  const table = "number,crank_mm\r\n1,10\r\n2,20\r\n3,30\r\n";
  assert.equal(linesOf(table, [3, 1]), "number,crank_mm\n3,30\n1,10\n");
  for (const [wrong, numbers] of [
    [table, [4]],
    ["crank_mm\n1,10\n", [1]],
    ["number,a\n1,x\n1,y\n", [1]],
  ])
    assert.throws(() => linesOf(wrong, numbers), /download the whole table/);
});
