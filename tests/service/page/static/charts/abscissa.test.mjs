import assert from "node:assert/strict";
import { test } from "node:test";

import "../browser.mjs";
import { abscissaOf, wayAt } from "../../../../../service/page/static/charts/abscissa.js";
import { draws } from "../draws.mjs";

/** Return a design whose slider goes as crank and rod make it go, at so many angles. */
function design({ number }, count = 360) {
  const [r, l, e] = [number(20, 40), number(90, 200), number(-30, 30)];
  const position = Array.from({ length: count }, (_, n) => {
    const angle = (2 * Math.PI * n) / count;
    return r * Math.cos(angle) + Math.sqrt(l * l - (e - r * Math.sin(angle)) ** 2);
  });
  const inner = (180 / Math.PI) * (Math.PI + Math.asin(e / (l - r)));
  const outer = (180 / Math.PI) * Math.asin(e / (l + r));
  return {
    curves: { slider_position_mm: position },
    centres: [(inner + 360) % 360, (outer + 360) % 360],
    sliderEnds: [Math.sqrt((l - r) ** 2 - e * e), Math.sqrt((l + r) ** 2 - e * e)],
  };
}

test("time goes with the crank, whichever way it turns", () => {
  const draw = draws(90);
  for (let n = 0; n < 200; n += 1) {
    const [rpm, angle] = [
      draw.number(5, 3000) * (draw.whole(0, 1) ? 1 : -1),
      draw.number(0, 359.9),
    ];
    const over = abscissaOf("time", rpm);
    const seconds = over.place({}, angle);
    const turned = (((6 * rpm * seconds) % 360) + 360) % 360; // 6 deg/s in one rpm
    assert.ok(Math.min(Math.abs(turned - angle), 360 - Math.abs(turned - angle)) < 1e-6);
    assert.ok(Math.abs(over.angle(seconds) - angle) < 1e-6 || angle < 1e-6);
    const path = over.path({}, 12);
    assert.deepEqual(
      path.map(({ n: at }) => at).sort((a, b) => a - b),
      [0, ...Array.from({ length: 12 }, (_, k) => k)],
    );
    assert.ok(path.every(({ x }, k) => k === 0 || x > path[k - 1].x));
    for (const { x, n: at } of path.slice(0, 12))
      assert.ok(Math.abs(over.place({}, 30 * at) - x) < 1e-9);
  }
});

test("over the way of the slider the curve goes from the inner dead centre to the stroke, and closes", () => {
  const draw = draws(91);
  for (let n = 0; n < 100; n += 1) {
    const one = design(draw);
    const stroke = one.sliderEnds[1] - one.sliderEnds[0];
    const over = abscissaOf("way", 60);
    const path = over.path(one, 360);
    assert.equal(path[0].x, path.at(-1).x);
    assert.ok(Math.abs(Math.min(...path.map(({ x }) => x))) < 1e-3 * stroke);
    assert.ok(Math.abs(Math.max(...path.map(({ x }) => x)) - stroke) < 1e-3 * stroke);
    assert.ok(Math.abs(wayAt(one, one.centres[1]) - stroke) < 1e-3 * stroke);
    assert.equal(abscissaOf("position", 60).place(one, 0), one.curves.slider_position_mm[0]);
  }
});

test("a crank without speed has no time", () => {
  assert.equal(abscissaOf("time", 0).title, "crank angle");
});
