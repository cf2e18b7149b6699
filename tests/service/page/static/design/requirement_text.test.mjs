import assert from "node:assert/strict";
import { test } from "node:test";

import { missText } from "../../../../../service/page/static/design/requirement_text.js";
import { readySystem } from "../../../../../service/page/static/lib/numbers.js";
import { choose } from "../browser.mjs";
import { draws } from "../draws.mjs";

await readySystem();

/** Return the numbers of a sentence. @param {string} sentence */
const numbers = (sentence) =>
  [...sentence.replaceAll("·10⁻", "e-").matchAll(/\d[\d.]*(?:e-[⁰¹²³⁴⁵⁶⁷⁸⁹]+)?/g)].map(([one]) =>
    Number(one.replace(/[⁰¹²³⁴⁵⁶⁷⁸⁹]/g, (sign) => `${"⁰¹²³⁴⁵⁶⁷⁸⁹".indexOf(sign)}`)),
  );

test("a miss of less than the shown digits is written with as many as tell it", () => {
  choose("si");
  const asked = { title: "stroke", unit: "mm", lower: 104.3, upper: 104.3 };
  assert.equal(
    missText(104.30016, asked).replaceAll("\u00a0", " "),
    "Misses a requirement: stroke 104.30016 mm; must be exactly 104.3 mm, 0.00016 mm less.",
  );
});

test("the numbers of a miss differ by the miss that is said, at either end and in either system", () => {
  const { number, size, whole } = draws(67);
  for (const units of ["si", "inch"]) {
    choose(units);
    for (let n = 0; n < 500; n += 1) {
      const bound = number(1, 500);
      const miss = Math.abs(size(-6, 1));
      const low = whole(0, 1) === 1 && miss < bound;
      const asked = {
        title: "rod",
        unit: "mm",
        lower: low ? bound : null,
        upper: low ? null : bound,
      };
      const sentence = missText(low ? bound - miss : bound + miss, asked);
      const [value, limit, by] = numbers(sentence);
      assert.ok(Math.abs(Math.abs(value - limit) - by) <= 0.12 * by, sentence);
      assert.ok(sentence.endsWith(low ? "more." : "less."), sentence);
    }
  }
  choose("si");
});

test("a requirement on a value that a design has not is said to have none", () => {
  const asked = { title: "stroke", unit: "mm", lower: 10, upper: null };
  assert.match(missText(null, asked), /stroke has no value; must be at least 10\u00a0mm\.$/);
});
