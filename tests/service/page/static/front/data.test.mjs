import assert from "node:assert/strict";
import { test } from "node:test";

import { FrontData } from "../../../../../service/page/static/front/data.js";
import { draws } from "../draws.mjs";

/** Return the data of a front of one column "some". */
function of(cells) {
  const data = new FrontData(1, {
    count: cells.length,
    columns: [{ key: "some", title: "some", unit: "" }],
    objectives: [{ column: "best", sense: "maximise" }],
  });
  data.take({ some: cells });
  return data;
}

test("cells come back as they were given, numbers, words and gaps", () => {
  const { number, one, whole } = draws(40);
  for (let n = 0; n < 300; n += 1) {
    const kind = one([() => number(-5, 5), () => one(["b", "a", "c"])]);
    const cells = Array.from({ length: whole(0, 30) }, () => (number(0, 1) < 0.2 ? null : kind()));
    const data = of(cells);
    assert.deepEqual(
      cells.map((_, row) => data.cell("some", row)),
      cells,
    );
    const words = cells.filter((cell) => typeof cell === "string");
    assert.deepEqual(data.words("some"), words.length ? [...new Set(words)].sort() : null);
  }
});

test("the order is that of the values, ties as they come, gaps last", () => {
  const { number, whole } = draws(41);
  for (let n = 0; n < 300; n += 1) {
    const cells = Array.from({ length: whole(0, 40) }, () =>
      number(0, 1) < 0.2 ? null : whole(-4, 4),
    );
    const rows = cells.map((cell, row) => ({ cell, row }));
    rows.sort((a, b) => (a.cell ?? Infinity) - (b.cell ?? Infinity) || a.row - b.row);
    const order = [...of(cells).order("some")];
    assert.deepEqual(
      order.map((row) => cells[row]),
      rows.map(({ cell }) => cell),
    );
    assert.deepEqual(
      order.filter((row) => cells[row] !== null),
      rows.filter(({ cell }) => cell !== null).map(({ row }) => row),
    );
  }
});

test("a range that is constant but for rounding has equal ends, one without values is zero", () => {
  assert.deepEqual(of([1, 1 + 1e-12, null]).range("some"), { low: 1, high: 1 });
  assert.deepEqual(of([3, -1, null]).range("some"), { low: -1, high: 3 });
  assert.deepEqual(of([null, null]).range("some"), { low: 0, high: 0 });
  assert.deepEqual(of([]).range("some"), { low: 0, high: 0 });
});

test("less is better unless an objective says otherwise", () => {
  assert.equal(of([]).sense("some"), "minimise");
  assert.equal(of([]).sense("best"), "maximise");
});

test("a column that is not of the front is not asked for", async () => {
  const data = of([1, 2]);
  await data.need(["some", "other"]); // nobody answers here
  assert.equal(data.has("other"), false);
  assert.equal(data.knows("other"), false);
});
