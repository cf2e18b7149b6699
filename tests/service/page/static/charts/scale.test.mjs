import assert from "node:assert/strict";
import { test } from "node:test";

import { logScale, range, scale } from "../../../../../service/page/static/charts/scale.js";
import { draws } from "../draws.mjs";

/** Return drawn scales with what they were made of: ranges of all sizes, some far from zero. */
function drawn(count = 2000) {
  const { size, number, whole } = draws(1);
  return Array.from({ length: count }, () => {
    const wide = Math.abs(size(-7, 8));
    const low = number(-1, 1) * wide * 10 ** whole(0, 4);
    const [start, end, ticks] = [number(0, 50), number(100, 900), whole(3, 8)];
    return {
      low,
      high: low + wide,
      start,
      end,
      ticks,
      made: scale(low, low + wide, start, end, ticks),
    };
  });
}

/** Return the number that a tick says, such as 2·10⁶. */
function read(text) {
  const [factor, power = "⁰"] = text.replaceAll("−", "-").split("·10");
  const digits = power.replace("⁻", "-").replace(/[^-]/g, (sign) => "⁰¹²³⁴⁵⁶⁷⁸⁹".indexOf(sign));
  return Number(`${factor}e${digits}`);
}

test("the ends of a range lie on the ends of the pixels, and pixels lead back to values", () => {
  for (const { low, high, start, end, made } of drawn()) {
    assert.equal(made.at(low), start);
    assert.ok(Math.abs(made.at(high) - end) < 1e-6);
    for (const share of [0, 0.25, 0.7, 1]) {
      const value = low + share * (high - low);
      assert.ok(
        Math.abs(made.value(made.at(value)) - value) <= 1e-9 * (Math.abs(low) + Math.abs(high)),
      );
    }
  }
});

test("ticks are all multiples of 1, 2 or 5 times a power of ten within the range, the finest that are few enough", () => {
  for (const { low, high, ticks: count, made } of drawn()) {
    const steps = Array.from({ length: 60 }, (_, n) => n - 30).flatMap((power) =>
      [1, 2, 5].map((factor) => Number(`${factor}e${power}`)),
    );
    const step = steps.find((one) => one * (1 + 1e-9) >= (high - low) / count);
    const room = 1e-9 * step;
    const wanted = [];
    for (let n = Math.floor(low / step) - 1; n <= Math.ceil(high / step) + 1; n += 1) {
      if (n * step >= low - room && n * step <= high + room) wanted.push(n * step);
    }
    assert.equal(made.ticks.length, wanted.length, `${low} to ${high}`);
    made.ticks.forEach((tick, n) => assert.ok(Math.abs(tick - wanted[n]) <= room));
  }
});

test("the text of a tick is the tick, and no other tick has it", () => {
  for (const { low, high, made } of drawn()) {
    const texts = made.ticks.map(made.text);
    assert.equal(new Set(texts).size, texts.length, `${low} to ${high}: ${texts}`);
    texts.forEach((text, n) => {
      assert.doesNotMatch(text, /^-/);
      assert.ok(
        Math.abs(read(text) - made.ticks[n]) <= 1e-6 * (high - low),
        `${text} for ${made.ticks[n]}`,
      );
    });
  }
});

test("zero has no sign", () => {
  assert.ok(
    scale(-0.3, 0.3, 0, 100).ticks.some((tick) => scale(-0.3, 0.3, 0, 100).text(tick) === "0.0"),
  );
});

test("one value alone lies in the middle", () => {
  for (const value of [0, 7, -3e-9, 1e12, 4 + 1e-12]) {
    const made = scale(value, value, 0, 100);
    assert.ok(Math.abs(made.at(value) - 50) < 1e-3);
    assert.ok(made.ticks.length > 0);
  }
});

test("ends that are no numbers have no ticks, and the loop for them ends", () => {
  for (const [low, high] of [
    [NaN, NaN],
    [0, NaN],
    [-Infinity, Infinity],
    [0, Infinity],
  ])
    assert.deepEqual(scale(low, high, 0, 100).ticks, []);
});

test("the range of values is their least and greatest finite one with room on both sides", () => {
  const { number, whole, one } = draws(2);
  for (let n = 0; n < 500; n += 1) {
    const values = Array.from({ length: whole(1, 40) }, () =>
      number(0, 1) < 0.2 ? one([NaN, Infinity, -Infinity, null]) : number(-9, 9),
    );
    const finite = values.filter((value) => Number.isFinite(value)).sort((a, b) => a - b);
    const { low, high } = range(values, 0.1);
    if (!finite.length) assert.deepEqual({ low, high }, { low: 0, high: 1 });
    else {
      const wide = finite.at(-1) - finite[0];
      assert.ok(
        Math.abs(low - (finite[0] - 0.1 * wide)) < 1e-12 &&
          Math.abs(high - (finite.at(-1) + 0.1 * wide)) < 1e-12,
      );
    }
  }
  assert.deepEqual(range([]), { low: 0, high: 1 });
});

test("on a logarithmic scale equal ratios are equally long, pixels lead back, and ticks are round and within", () => {
  const { number, size, whole } = draws(2);
  for (let turn = 0; turn < 500; turn += 1) {
    const low = Math.abs(size(-5, 5));
    const high = low * 10 ** number(0.2, 6);
    const [start, end] = [number(0, 50), number(100, 900)];
    const made = logScale(low, high, start, end, whole(3, 8));
    assert.ok(Math.abs(made.at(low) - start) < 1e-6 && Math.abs(made.at(high) - end) < 1e-6);
    const middle = Math.sqrt(low * high);
    assert.ok(Math.abs(made.at(middle) - (start + end) / 2) < 1e-6);
    assert.ok(Math.abs(made.value(made.at(middle)) - middle) < 1e-9 * middle);
    assert.ok(Number.isNaN(made.at(0)) && Number.isNaN(made.at(-1)));
    assert.ok(made.ticks.length > 0 && made.ticks.length <= 20);
    for (const tick of made.ticks) {
      assert.ok(tick >= low * (1 - 1e-6) && tick <= high * (1 + 1e-6));
      assert.ok(Math.abs(read(made.text(tick)) - tick) <= 1e-6 * tick, made.text(tick));
    }
  }
});
