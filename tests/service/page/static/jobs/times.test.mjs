import assert from "node:assert/strict";
import { test } from "node:test";

import { agoText } from "../../../../../service/page/static/jobs/times.js";

test("a time is said as one would say it", () => {
  const now = new Date(2026, 10, 25, 14, 30, 20);
  const known = [
    [[2026, 10, 25, 14, 30, 0], "just now"],
    [[2026, 10, 25, 14, 29, 10], "1 minute ago"],
    [[2026, 10, 25, 13, 45, 20], "45 minutes ago"],
    [[2026, 10, 25, 9, 5, 0], "today 09:05"],
    [[2026, 10, 24, 23, 59, 0], "yesterday 23:59"],
    [[2026, 2, 3, 8, 0, 0], "3 Mar 08:00"],
    [[2025, 11, 31, 8, 0, 0], "31 Dec 2025"],
  ];
  for (const [parts, text] of known) assert.equal(agoText(new Date(...parts), now), text);
});

test("what was in the evening is said by the clock only as long as it is the same day", () => {
  assert.equal(
    agoText(new Date(2026, 0, 1, 23, 50), new Date(2026, 0, 2, 0, 10)),
    "20 minutes ago",
  );
  assert.equal(
    agoText(new Date(2025, 11, 31, 23, 0), new Date(2026, 0, 1, 0, 30)),
    "yesterday 23:00",
  );
});
