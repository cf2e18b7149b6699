/** Live checks of the job by the service shortly after each change; only the latest response counts. */

import { isAbort, post, statusOf } from "../lib/api.js";

/** @typedef {Pick<Form.Whole, "job" | "submission">} Asked */

const WAIT = 200; // ms
const AGAIN = 3000; // ms until the next try while the service does not answer

/**
 * Return a function that has a job and its submission checked; told({answer}) or told({problem}): called with the latest response.
 * `signal` ends it.
 * @param {(said: { answer: Api.Preview, problem?: undefined } | { answer?: undefined, problem: unknown }) => void} report @param {AbortSignal} signal
 */
export function checker(report, signal) {
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let timer;
  /** @type {AbortController | null} */
  let running = null;
  /** @param {Asked} request */
  const ask = async (request) => {
    running?.abort();
    const mine = (running = new AbortController());
    try {
      const answer = await post("preview", request, { signal: mine.signal });
      if (running === mine && !signal.aborted) report({ answer });
    } catch (problem) {
      if (isAbort(problem) || running !== mine || signal.aborted) return;
      report({ problem });
      if (statusOf(problem) === 0) timer = setTimeout(() => ask(request), AGAIN);
    }
  };
  signal.addEventListener("abort", () => {
    clearTimeout(timer);
    running?.abort();
  });
  return (/** @type {Asked} */ { job, submission }, { now = false } = {}) => {
    clearTimeout(timer);
    running?.abort(); // its response is outdated
    timer = setTimeout(() => ask(structuredClone({ job, submission })), now ? 0 : WAIT);
  };
}
