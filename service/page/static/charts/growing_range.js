/** Axis ranges that stay stable while their data grows. */

import { range } from "./scale.js";

const AHEAD = 0.2; // fraction of the range that is added as margin where it grows

/**
 * Return a function that gives an axis range for values: it includes all earlier ranges and grows in steps.
 * @returns {(key: string, values: Iterable<Api.Row[string]>) => Page.Range}
 */
export function growingRange() {
  /** @type {Map<string, Page.Range>} */
  const ranges = new Map();
  return (key, values) => {
    const { low, high } = range(values, 0);
    const before = ranges.get(key);
    if (before && before.low <= low && high <= before.high) return before;
    const [least, most] = [Math.min(low, before?.low ?? low), Math.max(high, before?.high ?? high)];
    const ahead = AHEAD * (most - least);
    const now = {
      low: !before || low < before.low ? least - ahead : least,
      high: !before || high > before.high ? most + ahead : most,
    };
    ranges.set(key, now);
    return now;
  };
}
