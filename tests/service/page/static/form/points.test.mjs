import assert from "node:assert/strict";
import { test } from "node:test";

import { pointsOf } from "../../../../../service/page/static/form/points.js";
import { draws } from "../draws.mjs";

const KNOWN = [
  ["rad", "deg"],
  ["N", "kN"],
];

test("rows are the same whatever stands between their cells, with decimal points or commas", () => {
  const { number } = draws(8);
  for (let n = 0; n < 300; n += 1) {
    const rows = Array.from({ length: 1 + (n % 7) }, () => [
      number(0, 360).toFixed(2),
      number(-900, 900).toFixed(3),
    ]);
    for (const between of ["\t", ";", "; ", " ", ", "])
      assert.deepEqual(
        pointsOf(rows.map((row) => row.join(between)).join("\n"), KNOWN).rows,
        rows,
        between,
      );
    for (const between of ["\t", ";", "  "])
      assert.deepEqual(
        pointsOf(rows.map((row) => row.join(between).replaceAll(".", ",")).join("\r\n"), KNOWN)
          .rows,
        rows,
        between,
      );
  }
});

test("a first line names the units, those that there are", () => {
  assert.deepEqual(pointsOf("angle (deg)\tforce [kN]\n0\t1,5\n", KNOWN), {
    rows: [["0", "1.5"]],
    units: ["deg", "kN"],
    wrong: null,
  });
  assert.deepEqual(pointsOf("angle;force (tonnes)\n0;1", KNOWN).units, ["", ""]);
});

test("a line that has not two cells is said with its place in the text; nothing is no mistake", () => {
  assert.match(String(pointsOf("a (deg)\tb (N)\n0\t1\n90", KNOWN).wrong), /^Line 3 .*got “90”/);
  assert.match(String(pointsOf("0 1 2", KNOWN).wrong), /^Line 1/);
  assert.deepEqual(pointsOf("  \n", KNOWN), { rows: [], units: [], wrong: null });
});
