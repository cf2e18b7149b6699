/** Actions on a job: stop, resume, clone and, in a menu, delete. */

import { post, remove, statusOf } from "../lib/api.js";
import { link } from "../lib/address.js";
import { h } from "../lib/dom.js";
import { menu } from "../lib/menu.js";
import { say, sayProblem } from "../lib/notices.js";
import { ENDED } from "./states.js";

/**
 * Return the buttons of a job. A stopped search can continue later. changed(job) is called with the job as it is after an action,
 * changed(null) once it is gone, whoever deleted it.
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
          run(event.currentTarget, async () => {
            const now = await post(`jobs/${job.id}/${path}`);
            say(sentence);
            changed(now);
          }),
      },
      label,
    );
  /** @param {{ currentTarget: HTMLButtonElement }} event */
  const gone = async (event) => {
    const button = event.currentTarget;
    if (
      !(await confirmed(
        `Delete run ${job.id}?`,
        `“${job.name}” and all its results will be deleted permanently.`,
        "Delete",
      ))
    ) {
      button.closest("details")?.querySelector("summary")?.focus();
      return;
    }
    await run(button, async () => {
      await remove(`jobs/${job.id}`);
      say(`Run ${job.id} was deleted.`);
      changed(null);
    });
  };
  /** @param {HTMLButtonElement} button @param {() => Promise<void>} doing */
  const run = async (button, doing) => {
    button.disabled = true;
    try {
      await doing();
    } catch (problem) {
      if (statusOf(problem) === 404) {
        say(`Run ${job.id} no longer exists: somebody deleted it.`);
        changed(null);
      } else sayProblem(problem);
    } finally {
      button.disabled = false;
    }
  };
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

/**
 * Ask for confirmation; the promise gives the answer.
 * @param {string} question @param {string} consequence @param {string} yes @returns {Promise<boolean>}
 */
function confirmed(question, consequence, yes) {
  return new Promise((answer) => {
    const dialog = h(
      "dialog",
      {
        "aria-labelledby": "question",
        onclose: () => {
          dialog.remove();
          answer(dialog.returnValue === "yes");
        },
      },
      h("h2", { id: "question" }, question),
      h("p", {}, consequence),
      h(
        "form",
        { method: "dialog", class: "row" },
        h("button", { value: "no", autofocus: true }, "Keep it"),
        h("button", { value: "yes", class: "danger" }, yes),
      ),
    );
    document.body.append(dialog);
    dialog.showModal();
  });
}
