/** What takes a moment: sensitivity and tolerances of a design, computed when the reader comes to it. */

import { get } from "../lib/api.js";
import { fill, h } from "../lib/dom.js";
import { sensitivity } from "./sensitivity.js";
import { tolerances } from "./tolerances.js";

const TOPICS = [
  { name: "sensitivity", title: "What it is sensitive to", show: sensitivity },
  { name: "tolerances", title: "What tolerances do to the slider's position", show: tolerances },
];
const NEAR = "300px"; // before it is in sight

/** Put the topics into `place`; each shows once it comes near, and says so where the design has none. */
export function topics(place, { job, number, objectives, requirements, signal }) {
  const sections = TOPICS.map(({ name, title, show }) => {
    const body = h("div", { class: "panel" }, h("p", { class: "quiet busy", role: "status" }, "Computing …"));
    const section = h("section", { class: name }, h("h2", {}, title), body);
    if (name === "tolerances" && !requirements.tolerances) {
      fill(body, h("p", { class: "quiet" }, "The job gives no tolerances, so that nothing comes of them; add some to it, such as crank = 0.05 mm."));
      return section;
    }
    const watcher = new IntersectionObserver(async (seen) => {
      if (!seen.some((one) => one.isIntersecting)) return;
      watcher.disconnect();
      try {
        const { analysis } = await get(`jobs/${job}/designs/${number}/analysis`, { show: name }, signal);
        show(body, analysis[name], { objectives, signal });
      } catch (error) {
        if (error.name !== "AbortError") fill(body, h("p", { class: error.status === 422 ? "quiet" : "error" }, sentence(error.message)));
      }
    }, { rootMargin: NEAR });
    watcher.observe(section);
    signal.addEventListener("abort", () => watcher.disconnect(), { once: true });
    return section;
  });
  fill(place, sections);
}

function sentence(text) {
  return `${text.charAt(0).toUpperCase()}${text.slice(1)}.`;
}
