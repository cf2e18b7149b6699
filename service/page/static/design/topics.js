/** Slow topics: extremes, sensitivity and tolerances of a design, computed when the reader comes to it. */

import { isAbort, statusOf } from "../lib/api.js";
import { fill, h } from "../lib/dom.js";
import { beforePrinting } from "../lib/printing.js";
import { readySystem } from "../lib/numbers.js";
import { extremes } from "./extremes.js";
import { sensitivity } from "./sensitivity.js";
import { tolerances } from "./tolerances.js";
import { sentenceOf } from "../lib/refusals.js";

/**
 * The topics; show draws what /analysis gives for the name of one.
 * @type {{ name: string, title: string, show: (place: HTMLElement, found: unknown, given: { objectives: Api.Objective[], signal: AbortSignal }) => void }[]}
 */
const TOPICS = [
  {
    name: "extremes",
    title: "Extremes over the turn",
    show: (place, found, given) => extremes(place, /** @type {Api.Extremes} */ (found), given),
  },
  {
    name: "sensitivity",
    title: "What it is sensitive to",
    show: (place, found, given) =>
      sensitivity(place, /** @type {Api.Sensitivity} */ (found), given),
  },
  {
    name: "tolerances",
    title: "What tolerances do to the slider's position",
    show: (place, found, given) => tolerances(place, /** @type {Api.Tolerances} */ (found), given),
  },
];
const NEAR = "300px"; // before it is in sight
/** Names of the topics that are drawn here. */
export const DRAWN = TOPICS.map(({ name }) => name);

/**
 * Put the topics into `place`; each shows once it comes near, and says so where the design has none.
 * @param {HTMLElement} place
 * @param {{ analysis: (name: string) => Promise<Record<string, unknown>>, objectives: Api.Objective[], requirements: Api.Requirements, signal: AbortSignal }} given
 * analysis(name): what the API gives for a topic.
 */
export function topics(place, { analysis, objectives, requirements, signal }) {
  const sections = TOPICS.map(({ name, title, show }) => {
    const body = h(
      "div",
      { class: "panel" },
      h("p", { class: "quiet busy", role: "status" }, "Computing …"),
    );
    const section = h("section", { class: name }, h("h2", {}, title), body);
    if (name === "tolerances" && !requirements.tolerances) {
      fill(
        body,
        h(
          "p",
          { class: "quiet" },
          "The job gives no tolerances, so that nothing comes of them; give it some.",
        ),
      );
      return section;
    }
    /** @type {Promise<void> | null} */
    let asked = null;
    const ask = async () => {
      watcher.disconnect();
      try {
        const [found] = await Promise.all([analysis(name), readySystem()]);
        show(body, found[name], { objectives, signal });
      } catch (error) {
        if (isAbort(error)) return;
        fill(
          body,
          h("p", { class: statusOf(error) === 422 ? "quiet" : "error" }, `${sentenceOf(error)}.`),
        );
      }
    };
    const watcher = new IntersectionObserver(
      (seen) => {
        if (seen.some((one) => one.isIntersecting)) asked ??= ask();
      },
      { rootMargin: NEAR },
    );
    watcher.observe(section);
    beforePrinting(() => (asked ??= ask()), signal);
    signal.addEventListener("abort", () => watcher.disconnect(), { once: true });
    return section;
  });
  fill(place, sections);
}
