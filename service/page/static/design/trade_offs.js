/** Cost of one objective in the others at a design, in words. */

import { get, isAbort } from "../lib/api.js";
import { fill, h } from "../lib/dom.js";
import { apiSystem } from "../lib/numbers.js";
import { sentenceOf } from "../lib/refusals.js";

/**
 * Put the trade-off rates into `place`, in the units that the reader prefers.
 * @param {HTMLElement} place @param {{ job: string, number: number, signal: AbortSignal }} given
 */
export async function tradeOffs(place, { job, number, signal }) {
  const body = h("div", {}, h("p", { class: "quiet busy", role: "status" }, "Computing …"));
  fill(place, h("h2", {}, "What it would cost"), body);
  const draw = async () => {
    try {
      const { trade_offs: sentences, note } = await get(
        `jobs/${job}/designs/${number}/trade-offs`,
        { units: apiSystem() },
        signal,
      );
      fill(
        body,
        sentences.length
          ? [
              h(
                "p",
                { class: "quiet" },
                "Next to this design, along the front, with the requirements that are at their limit held:",
              ),
              h(
                "ul",
                {},
                sentences.map((one) => h("li", {}, `${one.replaceAll("^2", "²")}.`)),
              ),
            ]
          : h(
              "p",
              {},
              note ||
                "At this design nothing can be gained in one objective for a loss in the others.",
            ),
      );
    } catch (error) {
      if (!isAbort(error)) fill(body, h("p", { class: "error" }, sentenceOf(error)));
    }
  };
  window.addEventListener("units", draw, { signal });
  await draw();
}
