/** Live checks: what the service says of the job while it is typed, a moment after the last change; only the latest answer counts. */

import { post } from "../lib/api.js";

const WAIT = 200; // ms
const AGAIN = 3000; // ms until the next try while the service does not answer

/** Return a function that asks about a job; told({answer}) or told({problem}) with the latest; `signal` ends it. */
export function checker(told, signal) {
  let timer = null;
  let asked = null;
  const ask = async (job) => {
    asked?.abort();
    const mine = (asked = new AbortController());
    try {
      const answer = await post("preview", { job }, { signal: mine.signal });
      if (asked === mine && !signal.aborted) told({ answer });
    } catch (problem) {
      if (problem.name === "AbortError" || asked !== mine || signal.aborted) return;
      told({ problem });
      if (problem.status === 0) timer = setTimeout(() => ask(job), AGAIN);
    }
  };
  signal.addEventListener("abort", () => {
    clearTimeout(timer);
    asked?.abort();
  });
  return (job, { now = false } = {}) => {
    clearTimeout(timer);
    asked?.abort(); // what it says is of another job by now
    timer = setTimeout(() => ask(structuredClone(job)), now ? 0 : WAIT);
  };
}
