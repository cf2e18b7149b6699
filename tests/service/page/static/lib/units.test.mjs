import assert from "node:assert/strict";
import { test } from "node:test";

import { choose } from "../browser.mjs";
import { draws } from "../draws.mjs";

const { convert, join, kindOf, readyKinds, split, spread, unitsOf, usual } =
  await import("../../../../../service/page/static/lib/units.js");
await readyKinds();

// One of the first unit in the second, from handbooks and not by way of SI: what the page computes must agree.
const KNOWN = [
  ["in", "mm", 25.4, "length"],
  ["foot", "in", 12, "length"],
  ["deg", "rad", 0.017453292519943, "angle"],
  ["rev/s", "rpm", 60, "angular speed"],
  ["lb", "kg", 0.45359237, "mass"],
  ["lbf", "N", 4.4482216152605, "force"],
  ["lbf ft", "lbf in", 12, "torque"],
  ["lbf in", "N m", 0.1129848290276, "torque"],
  ["psi", "Pa", 6894.757293168, "pressure"],
  ["hp", "W", 745.6998715823, "power"],
  ["lb/in^3", "g/cm^3", 27.6799047102, "density"],
  ["lbf/in", "N/mm", 0.17512683524645, "stiffness"],
];

test("values change their unit as handbooks have it, there and back", () => {
  const { size } = draws(60);
  for (const [from, to, factor, kind] of KNOWN) {
    for (let n = 0; n < 50; n += 1) {
      const value = Number(size(-6, 6).toPrecision(6));
      const found = convert(String(value), from, to, kind);
      assert.ok(
        Math.abs(Number(found) / (value * factor) - 1) < 1e-9,
        `${value} ${from} is ${found} ${to}`,
      );
      assert.ok(Math.abs(Number(convert(found, to, from, kind)) / value - 1) < 1e-9);
    }
  }
});

test("what is no number, no unit of the kind, or not finite stays as it was typed", () => {
  for (const typed of ["", "  ", "abc", "1,5", "Infinity", "NaN", "1 2"])
    assert.equal(convert(typed, "mm", "in", "length"), typed);
  assert.equal(convert("5", "%", "mm", "length"), "5");
  assert.equal(convert("5", "kg", "mm", "length"), "5");
  assert.equal(convert("5", "mm", "in", null), "5");
});

test("a value of a job is taken apart and put together again", () => {
  const { one, size } = draws(61);
  for (let n = 0; n < 500; n += 1) {
    const kind = one(["length", "force", "torque", "angle", "stiffness"]);
    const [number, unit] = [String(Number(size(-5, 7).toPrecision(5))), one(unitsOf(kind))];
    const parts = split(`${number} ${unit}`, kind);
    assert.deepEqual(parts, { number, unit });
    assert.equal(join(parts.number, parts.unit), `${number} ${unit}`);
  }
  assert.deepEqual(split("0.2%", "length"), { number: "0.2", unit: "%" });
  assert.deepEqual(split("3.2", null), { number: "3.2", unit: "" });
});

test("a plain number of a job is in the SI unit, and nothing has the usual one", () => {
  for (const [kind, unit] of [
    ["length", "m"],
    ["angle", "rad"],
    ["force", "N"],
    ["torque", "N m"],
    ["mass", "kg"],
  ])
    assert.deepEqual(split(0.04, kind), { number: "0.04", unit });
  for (const nothing of [undefined, null])
    assert.deepEqual(split(nothing, "length"), { number: "", unit: usual("length") });
});

test("what is no value with a unit stays whole, for the service to say what is wrong", () => {
  for (const given of ["forty mm", "40 parsecs", "mm", "", "40 mm wide"])
    assert.deepEqual(split(given, "length"), { number: given, unit: "" });
});

test("a range that a job states as its middle and half its width has two ends, in its own unit", () => {
  assert.deepEqual(spread("40 mm +- 10 mm", "length"), ["30 mm", "50 mm"]);
  assert.deepEqual(spread("180±0.5 in", "length"), ["179.5 in", "180.5 in"]);
  assert.deepEqual(spread("300 1/min +- 5 1/min", "angular speed"), ["295 rpm", "305 rpm"]);
  assert.deepEqual(spread("1.2 +- 0.1", null), ["1.1", "1.3"]);
  for (const given of [
    "40 mm",
    "40 +- 10",
    "rod +- 10 mm",
    "+- 3 mm",
    "40 mm +- 2 deg",
    40,
    undefined,
    ["40 mm +- 10 mm"],
    { equals: "40 mm +- 1 mm" },
  ])
    assert.equal(spread(given, "length"), null);
});

test("a speed in a word of plates is one in the unit that it means", () => {
  for (const [given, parts] of [
    ["300 1/min", ["300", "rpm"]],
    ["60 spm", ["60", "rpm"]],
    ["2.5 Hz", ["2.5", "rev/s"]],
  ])
    assert.deepEqual(Object.values(split(given, "angular speed")), parts);
  assert.deepEqual(split("5 Hz", "length"), { number: "5 Hz", unit: "" });
});

test("a number that is left empty is no value; a minus of any kind is one", () => {
  assert.equal(join("  ", "mm"), undefined);
  assert.equal(join("−5", "mm"), "-5 mm");
  assert.equal(join("3.2 * offset", "mm"), "3.2 * offset");
  assert.equal(join("−5e−3", ""), "-5e-3");
});

test("each unit belongs to one kind, and the usual ones are among those that a field offers", () => {
  for (const kind of ["length", "force", "torque", "mass", "pressure", "angle"]) {
    for (const system of ["si", "inch"]) {
      choose(system);
      assert.ok(unitsOf(kind).includes(usual(kind)), `${kind} in ${system}`);
    }
    for (const unit of unitsOf(kind)) assert.equal(kindOf(unit), kind);
    assert.deepEqual(unitsOf(kind, { percent: true }), [...unitsOf(kind), "%"]);
  }
  choose("si");
  assert.equal(kindOf("parsec"), null);
});
