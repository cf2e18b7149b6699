import assert from "node:assert/strict";
import { test } from "node:test";

import { deadCentresOf, motionOf } from "../../../../../service/page/static/mechanism/motion.js";
import { draws } from "../draws.mjs";

/** Return a linkage that turns fully, of either sign of the offset. */
function drawn({ number }) {
  const [crank_mm, offset_mm] = [number(5, 50), number(-40, 40)];
  return { crank_mm, offset_mm, rod_mm: crank_mm + Math.abs(offset_mm) + number(0.5, 200) };
}

test("crank pin and slider are a rod apart, the slider on the outer side, at every angle", () => {
  const source = draws(70);
  for (let n = 0; n < 100; n += 1) {
    const linkage = drawn(source);
    const { slider_position_mm, transmission_angle_deg } = motionOf(linkage);
    slider_position_mm.forEach((position, at) => {
      const angle = (at * Math.PI) / 180;
      const along = [
        position - linkage.crank_mm * Math.cos(angle),
        linkage.offset_mm - linkage.crank_mm * Math.sin(angle),
      ];
      assert.ok(along[0] > 0);
      assert.ok(Math.abs(Math.hypot(...along) - linkage.rod_mm) < 1e-9 * linkage.rod_mm);
      const fromNormal = (Math.abs(Math.atan2(along[0], Math.abs(along[1]))) * 180) / Math.PI;
      assert.ok(Math.abs(fromNormal - transmission_angle_deg[at]) < 1e-6);
    });
  }
});

test("the dead centres are the ends of the slider's way", () => {
  const source = draws(71);
  for (let n = 0; n < 100; n += 1) {
    const linkage = drawn(source);
    const { inner, outer } = deadCentresOf(linkage);
    const { slider_position_mm: way } = motionOf(linkage);
    const near = 1e-3 * (outer - inner); // the ends may be between two degrees
    assert.ok(Math.min(...way) >= inner - 1e-9 && Math.min(...way) < inner + near);
    assert.ok(Math.max(...way) <= outer + 1e-9 && Math.max(...way) > outer - near);
  }
});
