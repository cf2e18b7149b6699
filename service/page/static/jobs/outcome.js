/** Outcome of a run without a complete front, with the remedy. */

import { link } from "../lib/address.js";
import { h } from "../lib/dom.js";
import { capitalised, inWords } from "../lib/words.js";

/** Return the message for a job that ended without success; null for one that is done. @param {Api.Job} job */
export function outcome(job) {
  const again = h(
    "a",
    { class: "button", href: link(["new"], { from: job.id }) },
    "Change the job",
  );
  const designs = job.summary?.designs ?? 0;
  if (job.state === "infeasible") {
    return outcomeMessage("No design meets all requirements", job.reason, [
      "Relax one of them, or widen a range, and search again. ",
      again,
    ]);
  }
  if (job.state === "failed") {
    return outcomeMessage("The run stopped with an error", job.reason, [
      "Resume it above to continue from its last round. If it stops there again, download its file error.txt and tell whoever runs the service, or change the job. ",
      again,
    ]);
  }
  if (job.state === "cancelled" && designs) {
    return outcomeMessage(
      "Stopped early",
      `The designs found so far are below; a longer search finds better designs. ${capitalised(inWords(job.reason))}.`,
      ["Resume it above to continue."],
    );
  }
  if (job.state === "cancelled") {
    return outcomeMessage(
      job.progress?.feasible
        ? "Stopped before its designs were collected"
        : "Stopped before it found a design",
      job.reason,
      ["Resume it above to continue."],
    );
  }
  return null;
}

/** @param {string} heading @param {string} reason @param {Dom.Child[]} remedy */
function outcomeMessage(heading, reason, remedy) {
  return h(
    "section",
    { class: "panel outcome", "aria-labelledby": "outcome-title" },
    h("h2", { id: "outcome-title" }, heading),
    reason && h("p", {}, capitalised(inWords(reason)).replace(/[^.!?]$/, "$&.")),
    h("p", {}, remedy),
  );
}
