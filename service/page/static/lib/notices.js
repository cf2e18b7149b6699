/** Short sentences at the edge of the page; screen readers read them out. */

import { h } from "./dom.js";

const SHOWN = 6000; // ms

/** Say something. kind: "info" goes away by itself, "error" stays until it is closed. */
export function say(sentence, kind = "info") {
  const notice = h("div", { class: `notice ${kind}` }, h("p", {}, sentence));
  notice.append(h("button", { type: "button", "aria-label": "Close", onclick: () => notice.remove() }, "×"));
  document.getElementById("notices").append(notice);
  if (kind === "info") setTimeout(() => notice.remove(), SHOWN);
}

/** Say what went wrong; nothing for what was only given up. */
export function sayProblem(error) {
  if (error.name !== "AbortError") say(error.message, "error");
}
