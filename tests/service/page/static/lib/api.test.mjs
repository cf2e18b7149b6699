import assert from "node:assert/strict";
import { test } from "node:test";

import { get, isAbort, post, statusOf } from "../../../../../service/page/static/lib/api.js";

/** Return an answer of a service that is too busy for now. */
const busy = () =>
  new Response(JSON.stringify({ detail: "all were busy; try again" }), {
    status: 503,
    headers: { "Retry-After": "5" },
  });

/** Let the service answer in turn, the last answer ever after; return what happens: requests, and waits in ms, which pass if `passes`. */
function answer(answers, passes = true) {
  const seen = [];
  let asked = 0;
  globalThis.fetch = async (_, { method }) => {
    seen.push(method);
    asked += 1;
    return (answers[asked - 1] ?? answers.at(-1))();
  };
  globalThis.setTimeout = (call, ms) => {
    seen.push(ms);
    if (passes) queueMicrotask(call);
  };
  return seen;
}

test("a busy service is asked again at the time that it names, three times at most, for a GET alone", async (context) => {
  const { fetch, setTimeout } = globalThis;
  context.after(() => Object.assign(globalThis, { fetch, setTimeout }));

  let seen = answer([busy, busy, () => new Response("[1]")]);
  assert.deepEqual(await get("jobs"), [1]);
  assert.deepEqual(seen, ["GET", 5000, "GET", 5000, "GET"]);

  seen = answer([busy]);
  const refused = await get("jobs").catch((problem) => problem);
  assert.deepEqual([statusOf(refused), refused.message], [503, "all were busy; try again"]);
  assert.equal(seen.filter((one) => one === "GET").length, 4);

  seen = answer([busy]);
  await assert.rejects(post("jobs", {}), /all were busy/);
  assert.deepEqual(seen, ["POST"]);

  seen = answer([busy], false);
  const view = new AbortController();
  const left = get("jobs", {}, view.signal).catch((problem) => problem);
  for (let n = 0; n < 20; n += 1) await Promise.resolve();
  assert.deepEqual(seen, ["GET", 5000]);
  view.abort();
  assert.ok(isAbort(await left));
});
