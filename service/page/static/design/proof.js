/** How far the front can be from the true one: asked for by a button, as `slidercrank certify` proves it. */

import { get, isAbort } from "../lib/api.js";
import { fill, h } from "../lib/dom.js";
import { inShownUnits } from "../lib/numbers.js";
import { sentenceOf } from "../lib/refusals.js";

const SHARE = 100; // percent
const LONGEST = 20; // s, what the service gives a proof

/** Return the node. @param {{ job: string, signal: AbortSignal }} given */
export function proof({ job, signal }) {
  const epsilon = h("input", {
    type: "number",
    min: "0.01",
    max: "50",
    step: "any",
    value: "1",
    required: true,
  });
  const seconds = h("input", {
    type: "number",
    min: "1",
    max: String(LONGEST),
    step: "any",
    value: "10",
    required: true,
  });
  const button = h("button", {}, "Prove it");
  const answer = h("div", { role: "status" });

  async function prove() {
    button.disabled = true;
    fill(answer, h("p", { class: "quiet busy" }, "Bounding the ranges of crank, rod and offset …"));
    try {
      const query = { epsilon: epsilon.valueAsNumber / SHARE, seconds: seconds.valueAsNumber };
      const found = await get(`jobs/${job}/certificate`, query, signal);
      const [first, ...others] = found.sentences;
      fill(
        answer,
        h("p", { class: found.proven ? "good" : "at-limit" }, inShownUnits(first)),
        others.map((sentence) => h("p", {}, inShownUnits(sentence))),
      );
    } catch (error) {
      if (isAbort(error)) return;
      fill(answer, h("p", { class: "quiet" }, `${sentenceOf(error)}.`));
    } finally {
      button.disabled = false;
    }
  }
  return [
    h(
      "p",
      { class: "quiet hint" },
      "Proves how far the front of this design can be from the true one: no possible design beats all of its designs by more than this share of each objective's range. As ",
      h("code", {}, "slidercrank certify"),
      " proves it.",
    ),
    h(
      "form",
      {
        class: "row",
        onsubmit: (event) => {
          event.preventDefault();
          prove();
        },
      },
      h("label", {}, "By at most, % ", epsilon),
      h("label", {}, "Time for it, s ", seconds),
      button,
    ),
    answer,
  ];
}
