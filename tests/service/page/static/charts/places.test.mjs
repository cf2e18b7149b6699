/** Places in a cycle: a turn, two turns, and a swing forth and back. */

import assert from "node:assert/strict";
import { test } from "node:test";

import "../browser.mjs";
import { abscissaOf } from "../../../../../service/page/static/charts/abscissa.js";
import { crankAt, positionOfAngle } from "../../../../../service/page/static/charts/cycle.js";

const COUNT = 360;

/** Crank angles of a swing at even times, at a speed that is not constant. @param {number} from @param {number} to */
function swing(from, to) {
  const crank_angle_deg = Array.from(
    { length: COUNT },
    (_, n) => from + (to - from) * (0.5 - 0.5 * Math.cos((2 * Math.PI * n) / COUNT)),
  );
  return {
    turns: 0,
    centres: [0, 180],
    curves: { crank_angle_deg, slider_position_mm: crank_angle_deg.map((angle) => 200 - angle) },
  };
}

test("a place of a swing is where the crank stands, in the way that it is on", () => {
  for (const [from, to] of [
    [11.16, 101.16],
    [100, -30],
    [350, 420],
  ]) {
    const one = swing(from, to);
    for (let share = 0.05; share < 1; share += 0.1) {
      const angle = from + (to - from) * share;
      for (const now of [10, 200]) {
        const place = positionOfAngle(one, angle - 360, now);
        assert.ok(now < 180 ? place <= 180 : place >= 180);
        assert.ok(Math.abs(crankAt(one, place) - angle) < (0.3 * Math.abs(to - from)) / 90);
      }
    }
    assert.ok(
      Math.abs(crankAt(one, positionOfAngle(one, to + Math.sign(to - from) * 20, 10)) - to) < 1,
    );
  }
});

test("a place of turns is the crank angle over their number", () => {
  const curves = { slider_position_mm: [1, 2, 3, 4] };
  for (const angle of [0, 33.5, 180, 359]) {
    assert.equal(
      crankAt({ turns: 1, curves }, positionOfAngle({ turns: 1, curves }, angle, 50)),
      angle,
    );
    for (const now of [10, 190]) {
      const at = crankAt({ turns: 2, curves }, positionOfAngle({ turns: 2, curves }, angle, now));
      assert.equal(at % 360, angle);
      assert.equal(at >= 360, now >= 180);
    }
  }
});

test("curves of a swing are over both ways, time, crank angle or slider position", () => {
  const one = swing(10, 100);
  const both = abscissaOf("angle", 0, 0);
  assert.deepEqual(
    both.ticks?.map(({ text }) => text),
    ["start", "end", "start"],
  );
  assert.equal(both.path(one, COUNT).length, COUNT + 1);
  const crank = abscissaOf("crank", 0, 0);
  const { low, high } = crank.span([one]);
  assert.ok(low < 10 && high > 100 && high < 110);
  assert.equal(crank.angle, null);
  assert.ok(Math.abs(Number(crank.place(one, 180)) - 100) < 1e-9);
  const position = abscissaOf("position", 0, 0).span([one]);
  assert.ok(position.low < 100 && position.high > 190);
  assert.equal(abscissaOf("time", 3, 0).span([one]).high, 20);
});

test("a cycle of two turns has its crank angles to 720 deg below it", () => {
  assert.deepEqual(
    abscissaOf("angle", 60, 2).ticks?.map(({ text }) => text),
    ["0°", "180°", "360°", "540°", "720°"],
  );
  assert.deepEqual(
    abscissaOf("angle", 60).ticks?.map(({ text }) => text),
    ["0°", "90°", "180°", "270°", "360°"],
  );
});
