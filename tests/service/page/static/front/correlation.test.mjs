import assert from "node:assert/strict";
import { test } from "node:test";

import "../browser.mjs";
import {
  inWords,
  rankCorrelation,
  ranks,
} from "../../../../../service/page/static/front/correlation.js";
import { draws } from "../draws.mjs";

/** Return the ranks as their definition has them: how many are less, and half of those that are alike. */
function defined(numbers) {
  return numbers.map(
    (one) =>
      numbers.filter((other) => other < one).length +
      (numbers.filter((other) => other === one).length + 1) / 2,
  );
}

test("ranks count what is less, alike numbers share theirs", () => {
  const { whole } = draws(70);
  for (let n = 0; n < 200; n += 1) {
    const numbers = Array.from({ length: whole(1, 30) }, () => whole(-5, 5));
    assert.deepEqual([...ranks(numbers)], defined(numbers));
  }
});

test("the rank correlation is Pearson's of the ranks, of the rows that count", () => {
  const { whole, number } = draws(71);
  for (let n = 0; n < 200; n += 1) {
    const count = whole(4, 30);
    const [a, b] = [0, 1].map(() =>
      Float64Array.from({ length: count }, () => (number(0, 1) < 0.1 ? NaN : whole(0, 9))),
    );
    const mask = Uint8Array.from({ length: count }, () => whole(0, 1));
    const rows = [...a.keys()].filter(
      (row) => mask[row] && !Number.isNaN(a[row]) && !Number.isNaN(b[row]),
    );
    const [x, y] = [a, b].map((column) => defined(rows.map((row) => column[row])));
    const mean = (list) => list.reduce((sum, one) => sum + one, 0) / list.length;
    const moment = (one, other) =>
      mean(one.map((each, m) => (each - mean(one)) * (other[m] - mean(other))));
    const found = rankCorrelation(a, b, mask);
    if (rows.length === 0 || moment(x, x) === 0 || moment(y, y) === 0) assert.equal(found, null);
    else assert.ok(Math.abs(found - moment(x, y) / Math.sqrt(moment(x, x) * moment(y, y))) < 1e-12);
  }
});

test("words follow the number", () => {
  assert.match(
    inWords("torque", "angle", 0.97, 50),
    /^Designs with a higher torque almost always have a higher angle/,
  );
  assert.match(
    inWords("torque", "angle", -0.8, 50),
    /mostly have a lower angle \(rank correlation −0.80, 50 designs\)/,
  );
  assert.match(inWords("torque", "angle", 0.1, 50), /^Torque and angle are hardly related/);
  assert.match(inWords("torque", "angle", null, 50), /cannot be compared/);
});
