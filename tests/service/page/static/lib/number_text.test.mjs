import assert from "node:assert/strict";
import { test } from "node:test";

import { isRange, parseNumber } from "../../../../../service/page/static/lib/number_text.js";
import { draws } from "../draws.mjs";

const LENGTH = {
  unit: "mm",
  factors: { m: 1, mm: 1e-3, cm: 1e-2, µm: 1e-6, in: 0.0254, foot: 0.3048 },
  percent: true,
};
const TORQUE = { unit: "N m", factors: { "N m": 1, "kN m": 1000, "lbf in": 0.1129848290276167 } };
const SPEED = { unit: "m/s", factors: { "m/s": 1, "mm/s": 1e-3 } };
const RATIO = { unit: "", factors: {} };
const TURNING = {
  unit: "rpm",
  factors: { "rad/s": 1, rpm: Math.PI / 30, "rev/s": 2 * Math.PI },
  spoken: { "1/min": "rpm", "min^-1": "rpm", Hz: "rev/s" },
};

/** Expect a text to be read as a number in a unit, and said unless it is plain. */
function reads(text, number, field = LENGTH, unit = field.unit) {
  const found = parseNumber(text, field);
  assert.ok(
    Math.abs(Number(found.number) - number) <= 1e-11 * Math.abs(number),
    `${text} is ${JSON.stringify(found)}`,
  );
  assert.equal(found.unit, unit, text);
  return found;
}

test("what CAD takes is taken", () => {
  const known = [
    ["150", 150],
    [" 150 mm ", 150],
    ["150mm", 150],
    ["150,5", 150.5],
    ["2*75", 150],
    ["1/2 in", 12.7],
    ['1/2"', 12.7],
    ["1 1/2 in", 38.1],
    ["6 in", 152.4],
    ["3 in + 5 mm", 81.2],
    ["5 ft - 1 in", 1498.6],
    ["100 + 5 mm", 105],
    ["(5 ft + 3 in) / 2", 800.1],
    ["2 * (3 + 4) cm", 140],
    ["10 mm * 3", 30],
    ["-2*3", -6],
    ["−7,5", -7.5],
    ["2 × 75", 150],
    ["=2*75", 150],
    ["100 + -0.5", 99.5],
    ["1e2", 100],
    ["1,5e2", 150],
    ["0.15 m", 150],
    [".5", 0.5],
    [",5", 0.5],
    ["1/4 + 1/8 in", 9.525],
    ["2--3", 5],
  ];
  for (const [text, number] of known) reads(text, number);
  reads("150 N m", 150, TORQUE);
  reads("2*10 Nm", 20, TORQUE);
  reads("1 kN·m", 1000, TORQUE);
  reads("600/2 mm/s", 0.3, SPEED);
  reads("3,2", 3.2, RATIO);
  reads("2*1,6", 3.2, RATIO);
  reads("0,2 %", 0.2, LENGTH, "%");
});

test("points and commas: the last of both is the decimal one; a comma alone before three digits is for thousands, and that is said", () => {
  for (const [text, number] of [
    ["1.500,5", 1500.5],
    ["1,500.5", 1500.5],
    ["1.500.000", 1.5e6],
    ["1,500,000", 1.5e6],
    ["1 500", 1500],
    ["1 500,25", 1500.25],
    ["0,500", 0.5],
    ["1.500", 1.5],
    ["1,50", 1.5],
    ["1500,125", 1500.125],
  ])
    reads(text, number);
  const { said } = reads("1,500", 1500);
  assert.match(said, /is read as 1500 mm; write 1\.500 if you mean that/);
  assert.equal(reads("150", 150).said, null);
  assert.equal(reads("150 mm", 150).said, null);
  assert.equal(reads("2*75", 150).said, '"2*75" = 150 mm');
});

test("what cannot be read is said in a sentence", () => {
  const known = [
    ["2*", /number is missing at the end/],
    ["*2", /number is missing before "\*2"/],
    ["2*(3", /not closed/],
    ["2)", /never opened/],
    ["1/0", /divides by zero/],
    ["1 0/0 mm", /zero/],
    ["1,2,3", /more than one place/],
    ["1.2.3", /more than one place/],
    ["2 mm * 3 mm", /unit/],
    ["6/2 mm / 2 in", /unit/],
    ["5 ft + 3", /no unit/],
    ["5 7", /missing before "7"/],
    ["5 % + 1 mm", /percentage/],
    ["9*9e999", /no finite value/],
    ["()", /missing/],
    ["mm", null],
  ];
  for (const [text, sentence] of known) {
    const { wrong } = parseNumber(text, LENGTH);
    if (sentence) assert.match(wrong ?? "", sentence, text);
    else assert.equal(wrong, undefined);
  }
});

test("a middle and half a width are the two ends of a range, in the unit of the field", () => {
  const known = [
    ["100 mm +- 0.5 mm", 99.5, 100.5],
    ["100 mm ± 0.5 mm", 99.5, 100.5],
    ["100±0.5", 99.5, 100.5],
    ["100 +/- 0,5", 99.5, 100.5],
    ["100 mm +− 0.5", 99.5, 100.5],
    ["1 in +- 2.54 mm", 22.86, 27.94],
    ["10 ± 1 cm", 90, 110],
    ["-5 mm +- 1 mm", -6, -4],
    ["2*75 +- 1/2", 149.5, 150.5],
    ["5 +- -1", 4, 6],
  ];
  for (const [text, low, high] of known) {
    const { ends, unit, said, number } = parseNumber(text, { ...LENGTH, range: true });
    assert.deepEqual([ends, unit, number], [[String(low), String(high)], "mm", undefined], text);
    assert.equal(said, `"${text}" = ${low} to ${high} mm`);
  }
  assert.deepEqual(parseNumber("300 1/min +- 0.5 Hz", { ...TURNING, range: true }).ends, [
    "270",
    "330",
  ]);
  assert.match(
    parseNumber("1,500 +- 5", { ...LENGTH, range: true }).said,
    /is read as 1495 to 1505 mm; write 1\.500 if/,
  );
  const { number } = draws(92);
  for (let n = 0; n < 300; n += 1) {
    const [middle, half] = [number(-500, 500), number(0, 5)].map((one) => Number(one.toFixed(4)));
    const { ends } = parseNumber(`${middle} +- ${half} cm`, { ...LENGTH, range: true });
    assert.ok(
      Math.abs(Number(ends[0]) - 10 * (middle - half)) < 1e-8 &&
        Math.abs(Number(ends[1]) - 10 * (middle + half)) < 1e-8,
    );
  }
});

test("where one value is asked for, a range is refused, and never taken for a difference", () => {
  for (const text of ["100 mm +- 0.5 mm", "100 ± 0.5", "100+-0.5", "100 +/- 0.5 mm"])
    assert.deepEqual(parseNumber(text, LENGTH), {
      wrong: `"${text}" is a range; write a single value here.`,
    });
  assert.match(parseNumber("120 rpm +- 5 rpm", TURNING).wrong, /is a range/);
  const known = [
    ["+-5", /missing before/],
    ["± 5", /missing before/],
    ["5 +-", /missing at the end/],
    ["2*(3 +- 1)", /not be in brackets/],
    ["1 +- 2 +- 3", /missing before/],
    ["3 +- 2 in + 1", /no unit/],
  ];
  for (const [text, sentence] of known)
    for (const range of [true, false])
      assert.match(
        parseNumber(text, { ...LENGTH, range }).wrong ?? "",
        text === "1 +- 2 +- 3" && !range ? /is a range/ : sentence,
        text,
      );
  assert.deepEqual(parseNumber("rod +- 2 mm", { ...LENGTH, range: true }), {});
  for (const [text, says] of [
    ["2 mm +- 1", true],
    ["2±1", true],
    ["2 +− 1", true],
    ["2 + -1", false],
    ["2--1", false],
  ])
    assert.equal(isRange(text), says, text);
});

test("other words for units mean what the service says, and only there", () => {
  for (const [text, number] of [
    ["300 1/min", 300],
    ["300 min^-1", 300],
    ["5 Hz", 300],
    ["2*60 1/min", 120],
  ])
    reads(text, number, TURNING);
  assert.deepEqual(parseNumber("300 min^-1", { ...TURNING, spoken: {} }), {});
  assert.equal(parseNumber("300 1/min", { ...TURNING, spoken: {} }).number, undefined);
  assert.deepEqual(parseNumber("5 Hz", LENGTH), {});
});

test("formulas and units that only the service knows are left to it, nothing is nothing", () => {
  for (const text of [
    "3.2 * offset",
    "=stroke/2",
    "5 mil",
    "forty mm",
    "sqrt(2)",
    "rod",
    "2 kg",
    "1e",
    "5 mmm",
  ])
    assert.deepEqual(parseNumber(text, LENGTH), {});
  for (const text of ["", "  ", "="]) assert.deepEqual(parseNumber(text, LENGTH), { empty: true });
});

test("sums and products of drawn numbers are what arithmetic makes of them", () => {
  const { number, one, whole } = draws(90);
  /** Return an expression, and its value. */
  const drawn = (depth) => {
    if (depth === 0 || number(0, 1) < 0.3) {
      const value = Number(number(0.1, 50).toFixed(whole(0, 2)));
      return [String(value), value];
    }
    const [sign, [left, a], [right, b]] = [one("+-*/"), drawn(depth - 1), drawn(depth - 1)];
    if (sign === "/" && b === 0) return [left, a];
    const value = { "+": a + b, "-": a - b, "*": a * b, "/": a / b }[sign];
    return [`(${left}${one(["", " "])}${sign} ${right})`, value];
  };
  for (let n = 0; n < 500; n += 1) {
    const [text, value] = drawn(4);
    const found = Number(parseNumber(text, RATIO).number);
    assert.ok(
      Math.abs(found - value) <= 1e-9 * Math.max(1, Math.abs(value)),
      `${text} is ${found}, not ${value}`,
    );
    const [unit, factor] = one([
      ["in", 25.4],
      ["cm", 10],
      ["mm", 1],
    ]);
    assert.ok(
      Math.abs(Number(parseNumber(`${text} ${unit}`, LENGTH).number) - value * factor) <=
        1e-9 * Math.max(1, Math.abs(value * factor)),
    );
  }
});

test("no text, however broken, throws", () => {
  const { one, whole } = draws(91);
  for (let n = 0; n < 5000; n += 1)
    parseNumber(
      Array.from({ length: whole(0, 9) }, () =>
        one([
          "1",
          "5",
          ",",
          ".",
          " ",
          "+",
          "-",
          "*",
          "/",
          "(",
          ")",
          "mm",
          "in",
          "%",
          "e",
          "x",
          "'",
          "^",
          "±",
        ]),
      ).join(""),
      LENGTH,
    );
});
