import assert from "node:assert/strict";
import { test } from "node:test";

import {
  interpolatedValue,
  extremes,
  wrappedAngle,
} from "../../../../../service/page/static/charts/cycle.js";
import { draws } from "../draws.mjs";

/** Return a drawn curve, with gaps. */
function curve({ whole, number }, gaps = 0.2) {
  return Array.from({ length: whole(1, 40) }, () => (number(0, 1) < gaps ? null : number(-5, 5)));
}

test("an angle is turned into the first turn", () => {
  const { number, whole } = draws(20);
  for (let n = 0; n < 500; n += 1) {
    const [angle, turns] = [number(0, 360), whole(-20, 20)];
    assert.ok(Math.abs(wrappedAngle(angle + 360 * turns) - angle) < 1e-9);
  }
  assert.equal(wrappedAngle(360), 0);
  assert.equal(wrappedAngle(-0), 0);
});

test("a curve goes through its points and straight between them, also over the end of the turn", () => {
  const draw = draws(21);
  for (let n = 0; n < 500; n += 1) {
    const values = curve(draw);
    const step = 360 / values.length;
    const [place, share] = [draw.whole(0, values.length - 1), draw.number(0.01, 0.99)];
    const [from, to] = [values[place], values[(place + 1) % values.length]];
    const found = interpolatedValue(values, (place + share) * step + 360 * draw.whole(-2, 2));
    if (from === null || to === null) assert.equal(found, null);
    else assert.ok(Math.abs(found - (from * (1 - share) + to * share)) < 1e-9);
    if (360 % values.length === 0) assert.equal(interpolatedValue(values, place * step), from);
  }
});

test("the extremes are the least and greatest value, the first of equal ones, gaps left out", () => {
  const draw = draws(22);
  for (let n = 0; n < 500; n += 1) {
    const values = curve(draw, 0.4).map((value) => value && Math.round(value));
    const found = extremes(values);
    const known = values.filter((value) => value !== null);
    if (!known.length) {
      assert.equal(found, null);
      continue;
    }
    for (const [end, value] of [
      ["low", Math.min(...known)],
      ["high", Math.max(...known)],
    ]) {
      assert.deepEqual(found[end], { angle: (360 * values.indexOf(value)) / values.length, value });
    }
  }
  assert.equal(extremes([]), null);
});
