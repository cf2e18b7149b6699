import assert from "node:assert/strict";
import { test } from "node:test";

import {
  at,
  idOf,
  isTable,
  parsedPath,
  put,
  withRenamedKey,
  valueOf,
  pathText,
} from "../../../../../service/page/static/form/path.js";
import { draws } from "../draws.mjs";

const KEYS = ["load", "force", "mechanism", "crank_angle", "rod", "min"];

/** Return a drawn path: a key first, places of lists only behind keys. */
function path({ whole, one, number }) {
  const found = [one(KEYS)];
  while (found.length < whole(1, 5))
    found.push(typeof found.at(-1) === "string" && number(0, 1) < 0.4 ? 0 : one(KEYS));
  return found;
}

test("a path is written as the service writes it, places counted from 1", () => {
  const draw = draws(5);
  for (let n = 0; n < 1000; n += 1) {
    const one = path(draw).map((key) => (key === 0 ? draw.whole(0, 30) : key));
    const read = pathText(one)
      .split(".")
      .flatMap((part) => part.split(" #").map((key, place) => (place ? Number(key) - 1 : key)));
    assert.deepEqual(read, one);
  }
  assert.equal(pathText(["load", 0, "force"]), "load #1.force");
  for (const one of [["load", 2, "force"], ["constraints", 'rod "a" + 2'], ["name"]])
    assert.deepEqual(parsedPath(pathText(one)), one);
  assert.equal(pathText([]), "");
});

test("tables and lists are tables, and nothing else is", () => {
  for (const part of [{}, [], { a: 1 }]) assert.equal(isTable(part), true);
  for (const part of [null, undefined, "5 kg", 0, NaN, true]) assert.equal(isTable(part), false);
});

test("what is put is there, and nothing is left once it is taken away", () => {
  const draw = draws(6);
  for (let n = 0; n < 1000; n += 1) {
    const one = path(draw);
    const job = { name: "kept" };
    put(job, one, "5 mm");
    assert.equal(at(job, one), "5 mm");
    put(job, one, undefined);
    assert.equal(at(job, one), undefined);
    assert.equal(job.name, "kept");
    if (!one.includes(0)) assert.deepEqual(job, { name: "kept" });
  }
});

test("others stay as they are", () => {
  const job = {
    load: [{ force: "1 N" }, { force: "2 N" }],
    constraints: { stroke: { min: 1, max: 2 } },
  };
  put(job, ["load", 0], undefined);
  put(job, ["constraints", "stroke", "max"], undefined);
  assert.deepEqual(job, { load: [{ force: "2 N" }], constraints: { stroke: { min: 1 } } });
  put(job, ["tolerances", "rod"], undefined);
  assert.deepEqual(job, { load: [{ force: "2 N" }], constraints: { stroke: { min: 1 } } });
});

test("nothing stands behind a value that is no table", () => {
  for (const value of [null, 4, "text", undefined, NaN])
    assert.equal(at({ name: value }, ["name", "further"]), undefined);
});

test("ids of different paths of a form differ, and are names in a document", () => {
  const ids = [["load", 0, "force"], ["load", 1, "force"], ["load", 0], ["rod"]].flatMap((one) =>
    ["c", "u"].map((part) => idOf(one, part)),
  );
  assert.equal(new Set(ids).size, ids.length);
  assert.match(idOf(["choice of", "µ"], "c"), /^[\w-]+$/);
});

test("keys that are formulas are written in quotes, long ones as far as the service writes them", () => {
  assert.equal(
    pathText(["constraints", "2 * crank + rod", "max"]),
    'constraints."2 * crank + rod".max',
  );
  assert.equal(pathText(["quantity", "room", "formula"]), "quantity.room.formula");
  assert.equal(pathText(["constraints", "x+".repeat(40)]), `constraints."${"x+".repeat(30)}..."`);
});

test("a key that is called otherwise stays in its place", () => {
  assert.deepEqual(Object.keys(withRenamedKey({ a: 1, "b c": 2, d: 3 }, "b c", "b c + 1")), [
    "a",
    "b c + 1",
    "d",
  ]);
});

test("a name has the value that its length or requirement has, and none where that is a range", () => {
  const job = {
    constraints: { stroke: { equals: "90 mm" }, time_ratio: { equals: "1.2 +- 0.1" } },
    variables: { rod: "150 mm", crank: "40 mm ± 1 mm", offset: ["0 mm", "5 mm"] },
  };
  const form = { at: (path) => at(job, path) };
  assert.deepEqual(
    ["stroke", "rod", "time_ratio", "crank", "offset", "height"].map((name) => valueOf(form, name)),
    ["90 mm", "150 mm", null, null, null, null],
  );
});
