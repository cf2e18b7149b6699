import assert from "node:assert/strict";
import { test } from "node:test";

import {
  ends,
  fromDisplayUnit,
  grouped,
  inDisplayUnit,
  inDisplayUnits,
  limitText,
  readySystem,
  text,
  unitOf,
  valueOf,
  withUnit,
} from "../../../../../service/page/static/lib/numbers.js";
import { choose, INCH } from "../browser.mjs";
import { draws } from "../draws.mjs";

await readySystem();
const RAISED = "⁰¹²³⁴⁵⁶⁷⁸⁹";
const read = (written) =>
  Number(
    written
      .replaceAll("−", "-")
      .replace("·10", "e")
      .replace("⁻", "-")
      .replace(/[⁰¹²³⁴⁵⁶⁷⁸⁹]/g, (sign) => RAISED.indexOf(sign)),
  );

/** Return numbers of all sizes and signs. */
function drawn(count = 3000, [low, high] = [-9, 12]) {
  const { size } = draws(3);
  return Array.from({ length: count }, () => size(low, high));
}

test("a number is written with as many digits as asked, and whole ones in full", () => {
  choose("si");
  for (const value of drawn()) {
    for (const digits of [3, 5]) {
      const whole = Math.abs(value) >= 10 ** digits && Math.abs(value) < 1e6;
      assert.equal(
        read(text(value, "", digits)),
        whole ? Math.sign(value) * Math.round(Math.abs(value)) : Number(value.toPrecision(digits)),
        `${value}`,
      );
    }
  }
});

test("a computed number ends in zeros where its digits do, a short one does not", () => {
  choose("si");
  assert.equal(text(114.2003), "114.20");
  assert.equal(text(1.22951, "", 4), "1.230");
  assert.equal(text(60 + 1e-10), "60");
  assert.equal(text(0.25), "0.25");
});

test("sentences have the signs of units, but not within quotation marks", () => {
  assert.equal(
    inDisplayUnits('1 deg more costs 0.02 m^2 and 3 kg m^2; write it like "45 deg"'),
    '1° more costs 0.02 m² and 3 kg m²; write it like "45 deg"',
  );
});

test("every minus is the sign of that name, in the exponent too", () => {
  choose("si");
  for (const value of drawn()) assert.doesNotMatch(text(value), /[-e+]/);
  assert.equal(text(-2.48e-9, "", 3), "−2.48·10⁻⁹");
});

test("what is not defined is a dash, text stays text, zero is zero", () => {
  for (const value of [null, undefined, NaN]) {
    assert.equal(text(value, "mm"), "–");
    assert.equal(withUnit(value, "mm"), "–");
  }
  assert.equal(text("inward"), "inward");
  assert.equal(text(-0), "0");
  assert.equal(withUnit("inward", "mm"), "inward");
});

test("a value that is shown in inches is the same length, and comes back", () => {
  choose("inch");
  for (const value of drawn(500)) {
    for (const [unit, { unit: name, factor }] of Object.entries(INCH)) {
      assert.equal(unitOf(unit), name);
      assert.ok(Math.abs(inDisplayUnit(value, unit) / (value * factor) - 1) < 1e-15);
      assert.ok(Math.abs(fromDisplayUnit(inDisplayUnit(value, unit), unit) / value - 1) < 1e-15);
    }
    assert.equal(inDisplayUnit(value, "deg"), value);
  }
  assert.equal(withUnit(25.4, "mm"), "1\u00a0in");
  choose("si");
  assert.equal(withUnit(25.4, "mm"), "25.4\u00a0mm");
  assert.equal(withUnit(38, "deg"), "38°");
  assert.equal(unitOf("kg m^2"), "kg m²");
});

test("a limit is rounded to the side where all values are possible, by less than its last digit", () => {
  for (const system of ["si", "inch"]) {
    choose(system);
    for (const value of drawn(2000, [-5, 6])) {
      const shown = inDisplayUnit(value, "mm");
      const step = Math.max(10 ** (Math.floor(Math.log10(Math.abs(shown))) - 4), 1e-12);
      const [up, down] = ["up", "down"].map((side) => read(limitText(value, "mm", side)));
      const room = 1.01e-10 * Math.abs(shown);
      assert.ok(
        up >= shown - room && up < shown + 1.001 * Math.min(step, 1),
        `${up} above ${shown}`,
      );
      assert.ok(
        down <= shown + room && down > shown - 1.001 * Math.min(step, 1),
        `${down} below ${shown}`,
      );
    }
  }
  choose("si");
  assert.equal(limitText(0, "mm", "up"), "0");
  assert.equal(limitText(40, "mm", "up"), "40"); // and not 40.001
  assert.equal(limitText(0.1 + 0.2, "mm", "up"), "0.3");
});

test("a millionth of an axis is zero at its end", () => {
  assert.deepEqual(ends({ low: -1e-9, high: 2 }, "mm"), ["0", "2"]);
  assert.deepEqual(ends({ low: 1, high: 1 }, "mm"), ["1", "1"]);
});

test("counts have their thousands apart", () => {
  const { whole } = draws(4);
  for (let n = 0; n < 300; n += 1) {
    const count = Math.floor(10 ** (whole(0, 900) / 100));
    assert.equal(grouped(count), count.toLocaleString("en-US"));
  }
});

test("a value is found by its name, whatever unit its key ends with", () => {
  const record = {
    least_m_s: 1.5,
    least_m_s2: 2.5,
    greatest_mm: null,
    ratio: 3,
    note: "none",
    other_deg: "text",
  };
  assert.deepEqual(valueOf(record, "least"), { value: 2.5, unit: "m/s^2" });
  assert.deepEqual(valueOf({ least_m_s: 1.5 }, "least"), { value: 1.5, unit: "m/s" });
  assert.deepEqual(valueOf(record, "greatest"), { value: null, unit: "mm" });
  assert.deepEqual(valueOf(record, "ratio"), { value: 3, unit: "" });
  for (const name of ["note", "other", "absent", ""])
    assert.deepEqual(valueOf(record, name), { value: null, unit: "" });
});
