import assert from "node:assert/strict";
import { test } from "node:test";

import {
  choicesFrom,
  leaveOutConstants,
  queryOf,
  toggled,
} from "../../../../../service/page/static/front/choices.js";
import { draws } from "../draws.mjs";

const OBJECTIVES = ["time_ratio", "peak_torque_Nm", "least_transmission_angle_deg"];
const SIZES = ["crank_mm", "rod_mm", "offset_mm", "rod_width_mm", "choice_rod"];
const KEYS = [...SIZES, ...OBJECTIVES, "slow_stroke"];
const FRONT = {
  columns: KEYS.map((key) => ({ key, group: SIZES.includes(key) ? "Dimensions" : "Motion" })),
  objectives: OBJECTIVES.map((column) => ({ column })),
  count: 50,
  strokes_differ: true,
};

const from = (text) => choicesFrom(new URLSearchParams(text), FRONT);
const textOf = (chosen, lasso = chosen.lasso) => {
  const query = Object.entries(queryOf(chosen, lasso)).filter(
    ([, value]) => value !== "" && value !== null,
  );
  return new URLSearchParams(query.map(([key, value]) => [key, String(value)])).toString();
};

test("an address without choices is the standard view, and the standard view needs no address", () => {
  const chosen = from("");
  assert.equal(textOf(chosen), "");
  assert.deepEqual([chosen.x, chosen.y, chosen.colour], OBJECTIVES);
  assert.deepEqual(
    chosen.axes.map(({ key }) => key),
    [...SIZES, ...OBJECTIVES],
  );
});

test("a dimension that all designs share is neither on the usual axes nor in the usual table", () => {
  const data = {
    count: 50,
    range: (key) => ({
      low: 0,
      high: ["choice_rod", "time_ratio"].includes(key) ? 0 : 1,
    }),
    better: (key) => (OBJECTIVES.includes(key) ? "more is better" : ""),
  };
  const [usual, asked] = ["", "axes=choice_rod&columns=slow_stroke"].map(from);
  for (const chosen of [usual, asked]) leaveOutConstants(chosen, data);
  assert.deepEqual(
    usual.axes.map(({ key }) => key),
    [...SIZES.slice(0, 4), ...OBJECTIVES],
  );
  assert.deepEqual(usual.columns, [...OBJECTIVES, ...SIZES.slice(0, 4), "slow_stroke"]);
  assert.equal(textOf(usual), "");
  assert.deepEqual([asked.axes[0].key, asked.columns], ["choice_rod", ["slow_stroke"]]);
});

test("what is chosen comes back from its address", () => {
  const { one, number, whole } = draws(30);
  const some = () => [...new Set(Array.from({ length: whole(1, 4) }, () => one(KEYS)))];
  for (let n = 0; n < 500; n += 1) {
    const chosen = from("");
    Object.assign(chosen, {
      axes: some().map((key) => ({ key, flipped: number(0, 1) < 0.5 })),
      x: one(KEYS),
      y: one(KEYS),
      colour: one([...KEYS, ""]),
      columns: some(),
      sort: one([...KEYS, ""]),
      page: whole(1, 9),
      selected: [...new Set([whole(1, 50), whole(1, 50)])],
      weights: one([null, [0, 10, 3]]),
      limits: new Map([
        ["crank_mm", { low: one([null, -3.5]), high: 80 }],
        ["slow_stroke", { words: ["inward", "equal"] }],
      ]),
      lasso: one([
        null,
        {
          x: "crank_mm",
          y: "rod_mm",
          line: [
            [1.5, 2],
            [3, -4e-7],
            [5, 1e6],
          ],
        },
      ]),
    });
    chosen.reverse = chosen.sort !== "" && number(0, 1) < 0.5;
    const back = from(textOf(chosen));
    assert.deepEqual({ ...back, standard: null }, { ...chosen, standard: null });
  }
});

test("what an address says of unknown columns, designs and numbers is left out", () => {
  const chosen = from(
    "axes=nothing,-crank_mm&x=nothing&sort=-nothing&page=0&selected=0,51,7,7.5,x&weights=1,2&min.crank_mm=abc&min.nothing=1&lasso=crank_mm,rod_mm,1,2,3",
  );
  assert.deepEqual(chosen.axes, [{ key: "crank_mm", flipped: true }]);
  assert.equal(chosen.x, "time_ratio");
  assert.deepEqual([chosen.sort, chosen.page, chosen.weights, chosen.lasso], ["", 1, null, null]);
  assert.deepEqual(chosen.selected, [7]);
  assert.equal(chosen.limits.size, 0);
});

test("a fourth selected design takes the place of the first", () => {
  assert.deepEqual([4, 5, 6, 7].reduce(toggled, []), [5, 6, 7]);
  assert.deepEqual(toggled([5, 6], 5), [6]);
});
