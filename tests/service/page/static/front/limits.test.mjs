import assert from "node:assert/strict";
import { test } from "node:test";

import { FrontData } from "../../../../../service/page/static/front/data.js";
import { Limits } from "../../../../../service/page/static/front/limits.js";
import { draws } from "../draws.mjs";

const WORDS = ["inward", "outward", "equal"];

/** Return designs as the service gives them: two columns of numbers and one of words, with gaps; and their cells. */
function front({ number, whole, one }) {
  const count = whole(0, 60);
  const cells = {
    crank_mm: Array.from({ length: count }, () => number(20, 100)),
    peak_torque_Nm: Array.from({ length: count }, () =>
      number(0, 1) < 0.2 ? null : number(-5, 5),
    ),
    slow_stroke: Array.from({ length: count }, () => (number(0, 1) < 0.1 ? null : one(WORDS))),
  };
  const columns = Object.keys(cells).map((key) => ({ key, title: key, unit: "" }));
  const data = new FrontData(1, { count, columns, objectives: [] }, null);
  data.take(cells);
  return { data, cells, count };
}

test("the designs within all limits are those that a look at each one finds", () => {
  const draw = draws(7);
  for (let n = 0; n < 400; n += 1) {
    const { data, cells, count } = front(draw);
    const limits = new Limits(data);
    const end = (low, high) => (draw.number(0, 1) < 0.3 ? null : draw.number(low, high));
    const asked = {
      crank: { low: end(20, 60), high: end(60, 100) },
      torque: { low: end(-5, 0), high: end(0, 5) },
      words: WORDS.filter(() => draw.number(0, 1) < 0.5),
    };
    limits.set("crank_mm", asked.crank);
    limits.set("peak_torque_Nm", asked.torque);
    limits.set("slow_stroke", { words: asked.words });
    limits.apply();
    const within = (value, { low, high }) =>
      (low === null && high === null) ||
      (value !== null && value >= (low ?? -Infinity) && value <= (high ?? Infinity));
    const wanted = Array.from(
      { length: count },
      (_, row) =>
        within(cells.crank_mm[row], asked.crank) &&
        within(cells.peak_torque_Nm[row], asked.torque) &&
        (!asked.words.length || asked.words.includes(cells.slow_stroke[row])),
    );
    assert.deepEqual([...limits.mask].map(Boolean), wanted);
    assert.equal(limits.chosen, wanted.filter(Boolean).length);
  }
});

test("a design on a limit is within it, also where the limit went through a unit and back", () => {
  const { data } = front(draws(8));
  for (const value of data.numbers("crank_mm")) {
    const limits = new Limits(data);
    limits.set("crank_mm", { low: (value / 25.4) * 25.4, high: (value / 25.4) * 25.4 });
    limits.apply();
    assert.ok(limits.chosen >= 1);
  }
});

test("a design without a value is outside of every limit on it", () => {
  const { data } = front(draws(9));
  const limits = new Limits(data);
  limits.set("peak_torque_Nm", { low: -1e9, high: null });
  limits.apply();
  assert.equal(
    limits.chosen,
    [...data.numbers("peak_torque_Nm")].filter((value) => !Number.isNaN(value)).length,
  );
});

test("a line around designs keeps those inside a triangle, whichever way it is drawn", () => {
  const draw = draws(10);
  for (let n = 0; n < 300; n += 1) {
    const { data, cells, count } = front(draw);
    const line = Array.from({ length: 3 }, () => [draw.number(20, 100), draw.number(-5, 5)]);
    const limits = new Limits(data, new Map(), {
      x: "crank_mm",
      y: "peak_torque_Nm",
      line: n % 2 ? line : [...line].reverse(),
    });
    limits.apply();
    const turns = (x, y) =>
      line.map(([x1, y1], side) => {
        const [x2, y2] = line[(side + 1) % 3];
        return Math.sign((x2 - x1) * (y - y1) - (y2 - y1) * (x - x1));
      });
    const wanted = Array.from({ length: count }, (_, row) => {
      const up = cells.peak_torque_Nm[row];
      return up !== null && new Set(turns(cells.crank_mm[row], up)).size === 1;
    });
    assert.deepEqual([...limits.mask].map(Boolean), wanted);
  }
});

test("a limit without ends, or without words, is none", () => {
  const { data, count } = front(draws(11));
  const limits = new Limits(data);
  limits.set("crank_mm", { low: 30, high: null });
  assert.equal(limits.open, false);
  for (const [key, none] of [
    ["crank_mm", { low: null, high: null }],
    ["crank_mm", null],
    ["slow_stroke", { words: [] }],
  ]) {
    limits.set(key, none);
    assert.equal(limits.open, true);
  }
  limits.apply();
  assert.equal(limits.chosen, count);
});

test("the conditions for the API say the same as the limits", () => {
  const { data } = front(draws(12));
  const limits = new Limits(data);
  limits.set("crank_mm", { low: 30.5, high: 60 });
  limits.set("slow_stroke", { words: ["inward"] });
  assert.deepEqual(limits.conditions(), [
    "crank_mm >= 30.5",
    "crank_mm <= 60",
    "slow_stroke != equal",
    "slow_stroke != outward",
  ]);
  limits.clear();
  assert.deepEqual(limits.conditions(), []);
});

test("a front without designs has limits too", () => {
  const data = new FrontData(
    1,
    { count: 0, columns: [{ key: "crank_mm", title: "crank", unit: "mm" }], objectives: [] },
    null,
  );
  data.take({ crank_mm: [] });
  const limits = new Limits(data);
  limits.set("crank_mm", { low: 1, high: 2 });
  limits.apply();
  assert.equal(limits.chosen, 0);
});
