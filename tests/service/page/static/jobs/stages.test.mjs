import assert from "node:assert/strict";
import { test } from "node:test";

import { stagesAfter } from "../../../../../service/page/static/jobs/stages.js";

/** Return the stages after events [stage, round, seconds, step, steps]. */
function after(events) {
  let [stages, seconds] = [[], 0];
  for (const [stage, round, now, step = 0, steps = 0] of events) {
    stages = stagesAfter(stages, { stage, round, seconds: now, step, steps }, seconds);
    seconds = now;
  }
  return stages;
}

test("stages follow each other, each with its rounds, its steps and its time", () => {
  const found = after([
    ["sampling", 1, 0.4],
    ["zooming", 2, 0.6],
    ["zooming", 3, 0.9],
    ["selecting designs", 3, 1.1, 20, 300],
    ["selecting designs", 3, 1.5, 300, 300],
  ]);
  assert.deepEqual(found, [
    { name: "sampling", rounds: [1, 1], step: 0, steps: 0, from: 0, to: 0.4 },
    { name: "zooming", rounds: [2, 3], step: 0, steps: 0, from: 0.4, to: 0.9 },
    { name: "selecting designs", rounds: [3, 3], step: 300, steps: 300, from: 0.9, to: 1.5 },
  ]);
});

test("a search that begins anew has its own stages", () => {
  const found = after([
    ["sampling", 1, 0.4],
    ["zooming", 2, 0.6],
    ["sampling", 1, 0.3],
    ["zooming", 2, 0.5],
  ]);
  assert.deepEqual(
    found.map(({ name, to }) => [name, to]),
    [
      ["sampling", 0.3],
      ["zooming", 0.5],
    ],
  );
});
