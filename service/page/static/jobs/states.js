/** States of a job in words, with a symbol and a colour. */

import { h } from "../lib/dom.js";

/** @type {Record<string, string>} */
const SIGNS = {
  queued: "…",
  running: "▶",
  stopping: "◼",
  done: "✓",
  infeasible: "∅",
  cancelled: "◼",
  failed: "✕",
};
/** @type {Record<string, string>} */
const WORDS = { infeasible: "no solution", cancelled: "stopped" }; // paused, finished early, or never started
/** @type {Api.Job["state"][]} */
export const STATES = ["queued", "running", "done", "infeasible", "cancelled", "failed"];
/** @type {string[]} */
export const ENDED = ["done", "infeasible", "cancelled", "failed"];

/** Return the word for a state. @param {string} state */
export function stateWord(state) {
  return WORDS[state] ?? state;
}

/** Return a badge with the state of a job. @param {Api.JobRow} job */
export function badge(job) {
  const state = job.state === "running" && job.cancel_asked ? "stopping" : job.state;
  return h(
    "span",
    { class: `state ${state}` },
    h("span", { "aria-hidden": "true" }, SIGNS[state] ?? ""),
    ` ${stateWord(state)}`,
  );
}
