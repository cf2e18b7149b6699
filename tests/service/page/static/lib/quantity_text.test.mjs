import assert from "node:assert/strict";
import { test } from "node:test";

import { choose } from "../browser.mjs";
import { draws } from "../draws.mjs";

const { readyKinds } = await import("../../../../../service/page/static/lib/units.js");
const { readySystem } = await import("../../../../../service/page/static/lib/numbers.js");
const { parseQuantity } = await import("../../../../../service/page/static/lib/quantity_text.js");
await Promise.all([readySystem(), readyKinds()]);

/** Expect a text to be read as a value in a unit of the API. */
function reads(text, unit, value) {
  const found = parseQuantity(text, unit);
  assert.ok(
    Math.abs(found.value - value) <= 1e-11 * Math.abs(value),
    `${text} in ${unit} is ${JSON.stringify(found)}`,
  );
}

test("commas, products and units are read into the unit of the API, in either system", () => {
  choose("si");
  for (const [text, value] of [
    ["37,5", 37.5],
    ["2*19", 38],
    ["1.5 in", 38.1],
    ["1 1/2 in", 38.1],
    ["=76/2", 38],
    ["3.8 cm", 38],
  ])
    reads(text, "mm", value);
});

test("a number without a unit is in the one that is shown", () => {
  const { size } = draws(62);
  for (let n = 0; n < 200; n += 1) {
    const value = Number(size(-3, 4).toPrecision(6));
    choose("si");
    reads(String(value), "mm", value);
    choose("inch");
    reads(String(value), "mm", 25.4 * value);
    reads(`${value} mm`, "mm", value);
  }
  choose("si");
});

test("what is no value of the kind has a sentence, and nothing is nothing", () => {
  choose("si");
  for (const [text, unit] of [
    ["abc", "mm"],
    ["5 kg", "mm"],
    ["=rod/2", "mm"],
    ["1e400", "mm"],
    ["NaN", "N"],
    ["1/0", "mm"],
    ["5 mm", "N"],
  ]) {
    const found = parseQuantity(text, unit);
    assert.equal(found.value, undefined, text);
    assert.match(found.wrong, /\.$/, text);
  }
  assert.match(
    parseQuantity("abc", "mm").wrong,
    /“abc” is not a valid length; write a number, in mm or with its unit/,
  );
  for (const text of ["", "  ", "="]) assert.deepEqual(parseQuantity(text, "mm"), { empty: true });
});
