/** Active constraints of the job; one click widens a limit and runs again. */

import { get, post } from "../lib/api.js";
import { go } from "../lib/address.js";
import { fill, h, markInvalid, numberField } from "../lib/dom.js";
import { attempt } from "../lib/notices.js";
import { counted, inDisplayUnit, unitOf, withUnit } from "../lib/numbers.js";
import { parseQuantity } from "../lib/quantity_text.js";
import { sentenceOf } from "../lib/refusals.js";
import { capitalised } from "../lib/words.js";

/** @import { Explorer } from "./explorer.js" */

const FEW = 4; // maximum number of visible limits
const WORDS = { lower: "at least", upper: "at most" };
const REST = 1e-6; // relative tolerance of an active limit

/** Return the panel of the limits of an explorer. @param {Explorer} explorer */
export function bindingPanel(explorer) {
  const { job, data } = explorer;
  const list = h("div", { class: "limits" });
  const wrong = h("p", { class: "bad", role: "alert", hidden: true });
  const place = h(
    "section",
    { class: "panel binding", "aria-labelledby": "binding-title", hidden: true },
    h("h2", { id: "binding-title" }, "Active constraints"),
    h(
      "p",
      { class: "quiet hint" },
      "Designs at a limit of the job might improve beyond it. Widening a limit starts a new run; this front is drawn behind the new one.",
    ),
    list,
    wrong,
  );

  attempt(
    async () => show((await get(`jobs/${job.id}/binding`, {}, explorer.signal)).limits),
    (problem) => refuse(sentenceOf(problem)),
  );

  /** @param {string} sentence */
  function refuse(sentence) {
    place.hidden = false;
    wrong.hidden = sentence === "";
    wrong.textContent = sentence && `${capitalised(sentence)}.`;
  }

  /** @param {Api.Limit[]} limits */
  function show(limits) {
    place.hidden = limits.length === 0;
    const [shown, rest] = [limits.slice(0, FEW), limits.slice(FEW)];
    fill(
      list,
      shown.map(line),
      rest.length > 0 &&
        h(
          "details",
          {},
          h("summary", {}, `${rest.length} more ${rest.length === 1 ? "limit" : "limits"}`),
          h("div", { class: "limits" }, rest.map(line)),
        ),
    );
  }

  /** @param {Api.Limit} limit */
  function line(limit) {
    const { title, side, value, unit, wider, column, designs } = limit;
    const id = `wider-${limit.of}-${side}`;
    const count = designs.length;
    const words = `${count} of ${counted(data.count, "design")} ${count === 1 ? "is" : "are"} at the limit ${title} ${WORDS[side]} ${withUnit(value, unit)}`;
    const those =
      data.knows(column) &&
      h(
        "button",
        {
          type: "button",
          class: "linked",
          "aria-label": `Show the designs at the limit ${title} ${WORDS[side]} ${withUnit(value, unit)}`,
          onclick: () => {
            const near = REST * Math.abs(value);
            explorer.limit(
              column,
              side === "upper"
                ? { low: value - near, high: null }
                : { low: null, high: value + near },
            );
          },
        },
        "show them",
      );
    const bar = h("span", {});
    bar.style.width = `${(100 * count) / data.count}%`;
    const share = h("span", { class: "rest-share", "aria-hidden": "true" }, bar);
    if (wider === null)
      return h(
        "div",
        { class: "limit" },
        share,
        h("p", {}, words, ". ", those),
        h("p", { class: "quiet" }, "Change it in the job."),
      );
    const input = numberField({
      id,
      value: String(Number(inDisplayUnit(wider, unit).toPrecision(6))),
      "aria-describedby": `${id}-unit`,
    });
    const button = h("button", {}, "Widen and run again");
    return h(
      "form",
      {
        class: "limit",
        novalidate: true,
        "data-limit": `${limit.of}.${side}`,
        onsubmit: (event) => {
          event.preventDefault();
          widen(limit, input, button);
        },
      },
      share,
      h("p", {}, words, ". ", those),
      h(
        "div",
        { class: "row" },
        h("label", { for: id }, h("span", { class: "hidden" }, `${title} `), WORDS[side]),
        input,
        h("span", { class: "quiet", id: `${id}-unit` }, unitOf(unit)),
        button,
      ),
    );
  }

  /** @param {Api.Limit} limit @param {HTMLInputElement} input @param {HTMLButtonElement} button */
  async function widen(limit, input, button) {
    const unit = unitOf(limit.unit);
    const { value, wrong } = parseQuantity(input.value, limit.unit);
    markInvalid(input, value === undefined);
    if (value === undefined) {
      refuse(
        `${limit.title} ${WORDS[limit.side]}: ${wrong?.replace(/\.$/, "") ?? `a number${unit && ` in ${unit}`} is needed`}`,
      );
      input.focus();
      return;
    }
    refuse("");
    const widened = { limits: [{ of: limit.of, side: limit.side, value }] };
    await attempt(
      async () => go(["jobs", (await post(`jobs/${job.id}/widened`, widened)).id]),
      (problem) => {
        refuse(sentenceOf(problem));
        input.focus();
      },
      button,
    );
  }

  return place;
}
