import assert from "node:assert/strict";
import { test } from "node:test";

import { growth } from "../../../../../service/page/static/jobs/growth.js";
import { draws } from "../draws.mjs";

test("the gain of the last ten rounds is that of the last over the eleventh last", () => {
  const drawn = draws(5);
  for (let n = 0; n < 200; n += 1) {
    const rounds = [drawn.number(0.1, 1)];
    for (let round = 1; round < drawn.whole(2, 40); round += 1)
      rounds.push(rounds.at(-1) * (1 + drawn.number(0.001, 0.2)));
    if (rounds.length < 2) continue;
    const found = growth(rounds);
    assert.equal(found.rounds, Math.min(10, rounds.length - 1));
    const percent = 100 * (rounds.at(-1) / rounds[Math.max(0, rounds.length - 11)] - 1);
    assert.ok(
      Math.abs(Number(found.text.slice(1, -2)) - percent) <=
        (percent >= 10 ? 0.5 : percent >= 1 ? 0.05 : 0.005) + 1e-9,
      `${found.text} is ${percent}`,
    );
  }
});

test("a gain is said in words where it is none or too small to count", () => {
  assert.deepEqual(growth([0.5, 0.5]), { rounds: 1, text: "nothing" });
  assert.deepEqual(growth([0.5, 0.50001]), { rounds: 1, text: "under 0.01 %" });
  assert.deepEqual(growth([0.5, 0.5001]), { rounds: 1, text: "+0.02 %" });
});

test("without two rounds that found something nothing is compared", () => {
  for (const rounds of [[], [0.3], [null, 0.3], [0, 0, 0.3]]) assert.equal(growth(rounds), null);
});
