/** The states of a job in words, with a sign and a colour. */

import { h } from "../lib/dom.js";

const SIGNS = { queued: "…", running: "▶", stopping: "◼", done: "✓", infeasible: "∅", cancelled: "◼", failed: "✕" };
const WORDS = { infeasible: "no solution" };
export const STATES = ["queued", "running", "done", "infeasible", "cancelled", "failed"];
export const ENDED = ["done", "infeasible", "cancelled", "failed"];

/** Return what a state is called. */
export function stateWord(state) {
  return WORDS[state] ?? state;
}

/** Return a badge that says in which state a job is. */
export function badge(job) {
  const state = job.state === "running" && job.cancel_asked ? "stopping" : job.state;
  return h("span", { class: `state ${state}` }, h("span", { "aria-hidden": "true" }, SIGNS[state] ?? ""), ` ${stateWord(state)}`);
}
