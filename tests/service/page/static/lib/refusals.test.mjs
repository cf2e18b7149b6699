import assert from "node:assert/strict";
import { before, test } from "node:test";

const stored = new Map();
globalThis.localStorage = {
  getItem: (key) => stored.get(key) ?? null,
  setItem: (key, value) => stored.set(key, value),
};
globalThis.window = new EventTarget();
const UNITS = {
  titles: {},
  suffixes: { mm: "_mm", "m/s": "_m_s", "N m": "_Nm" },
  inch: {
    mm: { unit: "in", factor: 1 / 25.4 },
    "N m": { unit: "lbf in", factor: 8.8507457673787 },
  },
};
globalThis.fetch = async () => new Response(JSON.stringify(UNITS));
const { chooseSystem } = await import("../../../../../service/page/static/lib/numbers.js");
const { Problem } = await import("../../../../../service/page/static/lib/api.js");
const { sentenceOf } = await import("../../../../../service/page/static/lib/refusals.js");
const inWords = (detail) => sentenceOf(new Problem(422, detail));

before(() => chooseSystem("si"));

const LENGTHS =
  "body crank_mm: must be at least 0.0001; got -1; correct it\n  body rod_mm: must be at most 50800.0; got 1000000.0; correct it";

test("a refusal speaks of fields by their names, and of values with their units", () => {
  assert.equal(
    inWords(LENGTHS),
    "Crank must be at least 0.0001\u00a0mm; got −1\u00a0mm; correct it. Rod must be at most 50800\u00a0mm; got 1·10⁶\u00a0mm; correct it",
  );
  assert.equal(
    inWords('query slider_velocity_m_s: must be at most 1000000.0; got "2e6"; correct it'),
    "Slider velocity must be at most 1·10⁶\u00a0m/s; got 2·10⁶\u00a0m/s; correct it",
  );
  assert.equal(
    inWords("body name: is missing, but required; add it"),
    "Name is missing, but required; add it",
  );
  assert.equal(inWords("there is no job 7; list the jobs"), "There is no job 7; list the jobs");
});

test("in inches a refusal has inches, but for what somebody typed", async () => {
  await chooseSystem("inch");
  assert.equal(
    inWords(LENGTHS.split("\n")[1].trim()),
    "Rod must be at most 2000\u00a0in; got 39370.08\u00a0in; correct it",
  );
  assert.equal(
    inWords('a crank from 25.4 mm to 50.8 mm; got "60 mm"; 25.4 to 76.2 mm is possible with 2 N m'),
    'A crank from 1 in to 2 in; got "60 mm"; 1 to 3 in is possible with 17.701 lbf in',
  );
  assert.equal(inWords("bar 25.4 x 50.8 mm, (0, 25.4) mm"), "Bar 1 x 2 in, (0, 1) in");
  await chooseSystem("si");
});
