import assert from "node:assert/strict";
import { test } from "node:test";

import "../browser.mjs";

const { describe, reader, words } =
  await import("../../../../../service/page/static/form/schema.js");

const { readyKinds } = await import("../../../../../service/page/static/lib/units.js");
await readyKinds();

const QUANTITY = { anyOf: [{ type: "string" }, { type: "number" }], examples: ["40 mm"] };
const SCHEMA = {
  properties: {
    name: { type: "string" },
    crank: { $ref: "#/$defs/Link", description: "the crank" },
    load: {
      type: "array",
      items: { oneOf: [{ $ref: "#/$defs/Force" }, { $ref: "#/$defs/Spring" }] },
    },
  },
  $defs: {
    Link: { description: "a link", properties: { mass: QUANTITY }, required: ["mass"] },
    Force: { properties: { force: QUANTITY } },
    Spring: { properties: { stiffness: { ...QUANTITY, examples: ["2 N/mm"] } } },
  },
};
const { property } = reader(SCHEMA);

test("a path leads through references, lists and the choice between tables", () => {
  assert.deepEqual(property(["name"]), { type: "string" });
  assert.equal(property(["crank"])?.description, "the crank"); // that of the place, not of what it refers to
  assert.deepEqual(property(["crank", "mass"]), QUANTITY);
  assert.equal(property(["load", 3, "stiffness"])?.examples?.[0], "2 N/mm");
  for (const path of [
    ["nothing"],
    ["name", "further"],
    ["crank", "mass", "unit"],
    ["load", "force"],
    ["load", 0, "nothing"],
  ])
    assert.equal(property(path), null, path.join());
});

test("each kind of value has its control", () => {
  assert.equal(describe(QUANTITY).control, "quantity");
  assert.equal(describe(QUANTITY).kind, "length");
  assert.equal(
    describe({ ...QUANTITY, anyOf: [{ type: "string", pattern: "%$" }, { type: "number" }] })
      .percent,
    true,
  );
  assert.deepEqual(describe({ enum: ["open", "crossed"], default: "open", description: "which" }), {
    control: "choice",
    options: ["open", "crossed"],
    fallback: "open",
    description: "which",
    example: undefined,
  });
  const controls = [
    [{ type: "integer" }, "whole"],
    [{ type: "number" }, "ratio"],
    [{ type: "string" }, "text"],
    [{ type: "array" }, "list"],
    [{ properties: { a: {} } }, "table"],
  ];
  for (const [node, control] of controls) assert.equal(describe(node).control, control);
});

test("what only the job file can say has no control of its own", () => {
  for (const node of [
    {},
    { anyOf: [] },
    { anyOf: [{ type: "string" }, { type: "array" }] },
    { anyOf: [{ type: "number" }, { type: "null" }] },
  ])
    assert.equal(describe(node).control, "other");
});

test("a key is read as words", () => assert.equal(words("crank_angle_at"), "crank angle at"));
