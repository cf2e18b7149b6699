/** Live checks: what the service says of the job while it is typed, a moment after the last change; only the latest answer counts. */

import { isAbort, post, statusOf } from "../lib/api.js";

/** @typedef {Pick<Form.Whole, "job" | "submission">} Asked */

const WAIT = 200; // ms
const AGAIN = 3000; // ms until the next try while the service does not answer

/**
 * Return a function that asks about a job and how it is submitted; told({answer}) or told({problem}) with the latest; `signal` ends it.
 * @param {(said: { answer: Api.Preview, problem?: undefined } | { answer?: undefined, problem: unknown }) => void} told @param {AbortSignal} signal
 */
export function checker(told, signal) {
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let timer;
  /** @type {AbortController | null} */
  let asked = null;
  /** @param {Asked} given */
  const ask = async (given) => {
    asked?.abort();
    const mine = (asked = new AbortController());
    try {
      const answer = await post("preview", given, { signal: mine.signal });
      if (asked === mine && !signal.aborted) told({ answer });
    } catch (problem) {
      if (isAbort(problem) || asked !== mine || signal.aborted) return;
      told({ problem });
      if (statusOf(problem) === 0) timer = setTimeout(() => ask(given), AGAIN);
    }
  };
  signal.addEventListener("abort", () => {
    clearTimeout(timer);
    asked?.abort();
  });
  return (/** @type {Asked} */ { job, submission }, { now = false } = {}) => {
    clearTimeout(timer);
    asked?.abort(); // what it says is of another job by now
    timer = setTimeout(() => ask(structuredClone({ job, submission })), now ? 0 : WAIT);
  };
}
