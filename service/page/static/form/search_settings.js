/** Settings of the search: number of designs, seed, method; and its limits. */

import { h } from "../lib/dom.js";
import { byschema, number, numberInput } from "./controls.js";
import { field } from "./field.js";
import { idOf } from "./path.js";

/** Return the fields of the search. Priority and limits belong to the submission, not to the job. @param {Form.Whole} form */
export function solving(form) {
  /** @param {string} key @param {string} label @param {string} why @param {number} factor */
  const limitField = (key, label, why, factor = 1) => {
    const path = ["submission", key];
    const limit = form.submission[key];
    const input = numberInput(
      idOf(path, "c"),
      limit === undefined ? "" : String(typeof limit === "number" ? limit / factor : limit),
    );
    input.addEventListener("input", () => {
      const typed = number(input);
      form.submit(key, typeof typed === "number" ? typed * factor : typed);
    });
    return field(form, path, label, [input], why);
  };
  return [
    h(
      "div",
      { class: "fields" },
      ["designs", "seed", "method"].map((key) => byschema(form, ["optimiser", key])),
    ),
    h(
      "details",
      { class: "more" },
      h("summary", {}, "Samples, budget, priority and limits"),
      h(
        "div",
        { class: "fields" },
        byschema(form, ["optimiser", "samples"]),
        byschema(form, ["optimiser", "evaluations"]),
        limitField(
          "priority",
          "priority",
          "Jobs with higher priority are solved first; 0 is usual.",
        ),
        limitField(
          "seconds",
          "time limit (s)",
          "Time after which the search ends with the designs found so far; if left empty, the limit of the service applies.",
        ),
        limitField(
          "evaluations",
          "limit of designs",
          "Number of evaluated designs after which the search ends.",
        ),
        limitField(
          "memory_bytes",
          "memory limit (MB)",
          "Memory that the worker of this job may use.",
          1e6,
        ),
      ),
    ),
  ];
}
