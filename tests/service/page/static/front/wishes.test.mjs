import assert from "node:assert/strict";
import { test } from "node:test";

import {
  nearest,
  locationOfRefusal,
  wishesFrom,
  wishesOfPreference,
  wishQuery,
  wishRequest,
  mistakesIn,
} from "../../../../../service/page/static/front/wishes.js";
import { draws } from "../draws.mjs";

const OBJECTIVES = [
  { quantity: "time_ratio", unit: "", column: "a" },
  { quantity: "peak_torque", unit: "N m", column: "b" },
  { quantity: "robust worst peak_torque", unit: "N m", column: "c" },
];
const wishes = (of, design = null) => ({ of: new Map(Object.entries(of)), design });

test("wishes come back from their address", () => {
  const { one, number, whole } = draws(11);
  for (let n = 0; n < 300; n += 1) {
    const made = wishes({}, one([null, whole(1, 40)]));
    for (const { quantity } of OBJECTIVES) {
      const kind = one(["free", "value", "limit", "improve", "keep"]);
      if (kind !== "free")
        made.of.set(
          quantity,
          kind === "value" || kind === "limit" ? { kind, value: number(-1e5, 1e5) } : { kind },
        );
    }
    const back = wishesFrom(new URLSearchParams(wishQuery(made)), OBJECTIVES);
    assert.deepEqual(back, made.of.size ? made : null);
  }
});

test("a preferred design improves at most as far again as the other one is away", () => {
  const objectives = [
    { quantity: "time_ratio", column: "a", sense: "maximise" },
    { quantity: "peak_torque", column: "b", sense: "minimise" },
    { quantity: "stroke", column: "c", sense: "minimise", target: 80 },
  ];
  const [one, other] = [
    { number: 3, row: { a: 1.4, b: 120, c: 80 } },
    { number: 7, row: { a: 1.3, b: 100, c: 80 } },
  ];
  assert.deepEqual(
    wishesOfPreference(objectives, one, other),
    wishes({ time_ratio: { kind: "improve" }, peak_torque: { kind: "limit", value: 140 } }, 3),
  );
  assert.deepEqual(
    wishesOfPreference(objectives, other, one),
    wishes({ time_ratio: { kind: "limit", value: 1.2 }, peak_torque: { kind: "improve" } }, 7),
  );
});

test("what an address cannot mean is left out", () => {
  assert.equal(
    wishesFrom(
      new URLSearchParams("wish.time_ratio=fast&wish.other=1&wish.peak_torque=NaN&wish.design=2"),
      OBJECTIVES,
    ),
    null,
  );
  assert.equal(
    wishesFrom(new URLSearchParams("wish.time_ratio=1&wish.design=-2.5"), OBJECTIVES).design,
    null,
  );
});

test("the service is asked in its words, with a design only where one is spoken of", () => {
  assert.deepEqual(
    wishRequest(
      wishes(
        { time_ratio: { kind: "value", value: 1.25 }, peak_torque: { kind: "limit", value: 110 } },
        3,
      ),
      OBJECTIVES,
    ),
    { at: { time_ratio: "1.25", peak_torque: "may worsen to 110 N m" }, design: null },
  );
  assert.deepEqual(wishRequest(wishes({ time_ratio: { kind: "improve" } }, 3), OBJECTIVES), {
    at: { time_ratio: "improve" },
    design: 3,
  });
});

test("what is wrong is said at its field", () => {
  const places = (of, design) => mistakesIn(wishes(of, design), OBJECTIVES, 9).map(({ id }) => id);
  assert.deepEqual(places({}), [""]);
  assert.deepEqual(places({ time_ratio: { kind: "value", value: NaN } }), ["time_ratio"]);
  for (const design of [null, 0, 10, 1.5, NaN])
    assert.deepEqual(places({ time_ratio: { kind: "improve" } }, design), ["design"]);
  assert.deepEqual(places({ time_ratio: { kind: "improve" } }, 9), []);
  assert.deepEqual(
    places(Object.fromEntries(OBJECTIVES.map(({ quantity }) => [quantity, { kind: "keep" }])), 1),
    [""],
  );
  assert.equal(locationOfRefusal("time_ratio may worsen", OBJECTIVES).id, "time_ratio");
  assert.equal(locationOfRefusal("the service is busy", OBJECTIVES).id, "");
});

test("the nearest design is so by shares of the ranges", () => {
  const columns = { a: [0, 1, 2], b: [0, 1000, 2000] };
  const data = {
    count: 3,
    numbers: (key) => Float64Array.from(columns[key]),
    range: (key) => ({ low: columns[key][0], high: columns[key][2] }),
  };
  assert.equal(nearest({ a: 1.1, b: 1400 }, [{ column: "a" }, { column: "b" }], data), 2);
  assert.equal(nearest({ a: 9, b: 0 }, [{ column: "a" }, { column: "b" }], data), 3);
});
