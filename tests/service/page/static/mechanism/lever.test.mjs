import assert from "node:assert/strict";
import { test } from "node:test";

import { leverAt } from "../../../../../service/page/static/mechanism/lever.js";
import { draws } from "../draws.mjs";

const view = { x: (mm) => 3 + 0.5 * mm, y: (mm) => 400 - 0.5 * mm };
/** Return a point of the picture in mm, y upward. */
const back = ([x, y]) => [(x - 3) / 0.5, (400 - y) / 0.5];

test("pin, pivots and the cylinder's line lie as the law of cosines and the offset say", () => {
  const { number } = draws(72);
  for (let n = 0; n < 300; n += 1) {
    const linkage = {
      crank_mm: number(100, 500),
      rod_mm: number(600, 1200),
      offset_mm: number(-80, 80),
    };
    const lever = { frame_angle_deg: number(-180, 180), pin_angle_deg: number(-40, 40) };
    const degrees = number(-180, 180);
    const found = leverAt(linkage, lever, view, degrees);
    const [pivot, base, pin, foot] = [found.pivot, found.base, found.pin, found.foot].map(back);
    const { crank_mm: r, rod_mm: f, offset_mm: e } = linkage;
    const between = (degrees + lever.pin_angle_deg - lever.frame_angle_deg) * (Math.PI / 180);
    const length = Math.sqrt(r * r + f * f - 2 * r * f * Math.cos(between) - e * e);
    const distance = (one, other) => Math.hypot(one[0] - other[0], one[1] - other[1]);
    const near = (one, other) => assert.ok(Math.abs(one - other) < 1e-8 * f, `${one} ${other}`);
    near(distance(pivot, pin), r);
    near(distance(pivot, base), f);
    near(distance(foot, pin), length);
    // Left of the way from A to B: A + e n + L u is B, with n as u turned counter-clockwise.
    const u = [(pin[0] - foot[0]) / length, (pin[1] - foot[1]) / length];
    near(base[0] - e * u[1], foot[0]);
    near(base[1] + e * u[0], foot[1]);
  }
});
