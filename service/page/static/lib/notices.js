/** Short sentences at the edge of the page; screen readers read them out. */

import { isAbort } from "./api.js";
import { byId, h } from "./dom.js";
import { sentenceOf } from "./refusals.js";

const DURATION = 6000; // ms

/** Show a message. kind: "info" disappears by itself, "error" stays until closed. @param {string} sentence @param {"info" | "error"} kind */
export function say(sentence, kind = "info") {
  const notice = h("div", { class: `notice ${kind}` }, h("p", {}, sentence));
  notice.append(
    h("button", { type: "button", "aria-label": "Close", onclick: () => notice.remove() }, "×"),
  );
  byId("notices").append(notice);
  if (kind === "info") setTimeout(() => notice.remove(), DURATION);
}

/**
 * Run an action; failures other than aborts go to `refuse`. busy: button marked in the meantime; it is not disabled, which would remove
 * the focus.
 * @template Result
 * @param {() => Promise<Result>} action @param {(problem: unknown) => unknown} refuse @param {HTMLElement} [busy]
 * @returns {Promise<Result | undefined>}
 */
export async function attempt(action, refuse = sayProblem, busy = undefined) {
  if (busy?.hasAttribute("aria-busy")) return undefined;
  busy?.setAttribute("aria-busy", "true");
  try {
    return await action();
  } catch (problem) {
    if (!isAbort(problem)) refuse(problem);
  } finally {
    busy?.removeAttribute("aria-busy");
  }
}

/** Show an error, unless it is an abort. @param {unknown} error */
export function sayProblem(error) {
  if (!isAbort(error)) say(sentenceOf(error), "error");
}
