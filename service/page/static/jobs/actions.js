/** Actions on a job: stop, resume, clone and, in a menu, delete. */

import { post, remove, statusOf } from "../lib/api.js";
import { link } from "../lib/address.js";
import { askFirst } from "../lib/dialog.js";
import { h } from "../lib/dom.js";
import { menu } from "../lib/menu.js";
import { attempt, say, sayProblem } from "../lib/notices.js";
import { ENDED } from "./states.js";

/**
 * Return the buttons of a job. A stopped search can continue later. changed(job): called with the job after an action, or with null once
 * it has been deleted by anyone.
 * @param {Api.JobRow} job @param {(job: Api.Job | null) => unknown} changed @param {{ primary?: boolean }} looks primary: of the view of this job
 */
export function actions(job, changed, { primary = false } = {}) {
  const runName = `run ${job.id}, ${job.name}`;
  /** @param {string} label @param {"cancel" | "resume"} path @param {string} sentence */
  const act = (label, path, sentence) =>
    h(
      "button",
      {
        type: "button",
        class: primary && path === "resume" ? "primary" : null,
        "data-act": path,
        "aria-label": `${label} ${runName}`,
        onclick: (event) =>
          run(async () => {
            const now = await post(`jobs/${job.id}/${path}`);
            say(sentence);
            changed(now);
          }, event.currentTarget),
      },
      label,
    );
  const gone = () =>
    askFirst({
      title: `Delete run ${job.id}?`,
      content: h("p", {}, `“${job.name}” and all its results will be deleted permanently.`),
      yes: "Delete",
      danger: true,
      act: () =>
        run(async () => {
          await remove(`jobs/${job.id}`);
          say(`Run ${job.id} was deleted.`);
          changed(null);
        }),
    });
  /** @param {() => Promise<void>} doing @param {HTMLElement} [button] */
  const run = (doing, button) =>
    attempt(
      doing,
      (problem) => {
        if (statusOf(problem) !== 404) return sayProblem(problem);
        say(`Run ${job.id} no longer exists: somebody deleted it.`);
        changed(null);
      },
      button,
    );
  const ended = ENDED.includes(job.state);
  return [
    !ended &&
      !job.cancel_asked &&
      (job.state === "running"
        ? act(
            "Stop",
            "cancel",
            `Run ${job.id} stops with the designs found so far; Resume continues the search.`,
          )
        : act("Cancel", "cancel", `Run ${job.id} will not start.`)),
    ["cancelled", "failed"].includes(job.state) &&
      act("Resume", "resume", `Run ${job.id} continues.`),
    h(
      "a",
      { class: "button", href: link(["new"], { from: job.id }), "aria-label": `Clone ${runName}` },
      "Clone",
    ),
    ended &&
      menu(
        "…",
        h(
          "div",
          { class: "chooser-list panel narrow" },
          h(
            "button",
            {
              type: "button",
              class: "danger",
              "data-act": "delete",
              "aria-label": `Delete ${runName}`,
              onclick: gone,
            },
            "Delete this run",
          ),
        ),
        { name: `More for ${runName}`, act: "more" },
      ),
  ].filter(Boolean);
}
