/** A run in the list. */

import { named } from "../front/columns.js";
import { link } from "../lib/address.js";
import { h } from "../lib/dom.js";
import { counted, grouped } from "../lib/numbers.js";
import { inWords } from "../lib/words.js";
import { actions } from "./actions.js";
import { badge } from "./states.js";
import { moment } from "./times.js";

/**
 * Return a run as a list item. picture: picture of its front. compare(number, yes): called when its check box changes. changed(): called
 * after an action.
 * @param {Api.JobRow} job
 * @param {{ picture: Element, chosen: boolean, compare: (number: number, yes: boolean) => void, changed: (job: Api.JobRow | null) => unknown }} options
 */
export function runRow(job, { picture, chosen, compare, changed }) {
  return h(
    "li",
    { class: "panel run" },
    h(
      "label",
      { class: "tick" },
      h("input", {
        type: "checkbox",
        "data-act": "tick",
        checked: chosen,
        disabled: !job.summary?.designs && !chosen,
        onchange: (event) => compare(job.id, event.currentTarget.checked),
      }),
      h("span", { class: "hidden" }, `Compare run ${job.id}, ${job.name}`),
    ),
    h(
      "div",
      { class: "what" },
      h("a", { class: "name", href: link(["jobs", job.id]), "data-act": "open" }, job.name),
      h("div", { class: "quiet" }, badge(job), ` · run ${job.id} · `, moment(job)),
    ),
    picture,
    h("div", { class: "found" }, progressOrResult(job)),
    h("div", { class: "row acts" }, actions(job, changed)),
  );
}

/** Return the progress or the result of a job. @param {Api.JobRow} job */
function progressOrResult(job) {
  if (job.state === "running" && job.progress) {
    const { stage, steps, feasible } = job.progress;
    const [part, done, of] = steps
      ? ["", job.progress.step, steps]
      : ["round ", job.progress.round, job.progress.rounds];
    return [
      h("progress", {
        max: of,
        value: done,
        "aria-label": `run ${job.id}: ${part}${done} of ${of}`,
      }),
      h(
        "div",
        { class: "quiet" },
        `${stage}, ${part}${grouped(done)} of ${grouped(of)} · ${counted(feasible, "feasible design")}`,
      ),
    ];
  }
  const { decision } = job;
  if (job.summary?.designs) {
    const { designs, best } = job.summary;
    return [
      h(
        "div",
        {},
        counted(designs, "design"),
        decision && [" · ", h("strong", {}, `decided for ${decision}`)],
      ),
      h(
        "div",
        { class: "quiet best" },
        "best: ",
        Object.entries(best)
          .map(([key, value]) => named(key, value))
          .join(" · "),
      ),
    ];
  }
  return h(
    "div",
    { class: "quiet" },
    inWords(job.reason) || (job.state === "queued" ? "waiting for a worker" : ""),
  );
}
