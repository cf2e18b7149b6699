/** Head of the view: location, links to the previous and the next design, and the designs beside it. */

import { neighbours } from "../front/listed_order.js";
import { wishesOfPreference, wishQuery } from "../front/wishes.js";
import { lastAddress, link, read } from "../lib/address.js";
import { first, h } from "../lib/dom.js";

let stepped = ""; // label of the last step

/** Return the focus to the link used last, so that one key press takes the next step. @param {HTMLElement} place */
export function focusLastStep(place) {
  const words = stepped;
  stepped = "";
  if (words) first(place, `.design-head [aria-label="${words}"]`)?.focus({ preventScroll: true });
}

/** @typedef {{ number: number, name: string, series: number | string, row: Api.Row }} Shown A design of the view. */
/** @typedef {{ job: string, number: number, named: HTMLElement, undo: HTMLElement, front: Api.Front, main: Shown, others: Shown[], objectives: Api.Objective[] }} Place */

/** Return the part of the view on the screen, for any design. */
function currentView() {
  const { query } = read();
  return { over: query.get("over"), tab: query.get("tab") };
}

/** Return the head. named: name of the design. undo: button that reverts a change. @param {Place} shown */
export function designHead(shown) {
  const { job, number, named, undo, front, others } = shown;
  const beside = others.map((one) => one.number).join(",");
  const { place, count, before, after, listed } = neighbours(job, number, front.count);
  /** @param {number | null} to @param {string} words @param {string} sign */
  const step = (to, words, sign) =>
    to !== null
      ? h(
          "a",
          {
            class: "button",
            href: link(["jobs", job, "designs", to], { beside }),
            "aria-label": words,
            title: words,
            onclick: ({ currentTarget }) => {
              stepped = words;
              currentTarget.href = link(["jobs", job, "designs", to], { beside, ...currentView() });
            },
          },
          sign,
        )
      : h("span", { class: "button off", "aria-hidden": "true" }, sign);
  return h(
    "header",
    { class: "design-head" },
    h("p", { class: "back" }, h("a", { href: lastAddress(["jobs", job]) }, `← ${front.name}`)),
    h(
      "div",
      { class: "row" },
      h(
        "h1",
        {},
        named,
        h(
          "span",
          { class: "quiet" },
          ` of ${front.count}${listed ? `, ${place} of ${count} listed` : ""}`,
        ),
      ),
      undo,
      step(before, "Previous design", "‹"),
      step(after, "Next design", "›"),
      compare(shown),
    ),
  );
}

/** @param {Omit<Place, "named" | "undo">} place */
function compare({ job, number, front, main, others, objectives }) {
  const numbers = others.map((one) => one.number);
  /** @param {number[]} list */
  const to = (list) => link(["jobs", job, "designs", number], { beside: list.join(",") || null });
  const field = h("input", {
    type: "number",
    min: 1,
    max: front.count,
    required: true,
    id: "beside",
    class: "beside-number",
  });
  /** @param {Event} event */
  const add = (event) => {
    event.preventDefault();
    const other = Number(field.value);
    if (other !== number && !numbers.includes(other)) location.hash = to([...numbers, other]);
  };
  return h(
    "div",
    { class: "row beside" },
    others.map((one) =>
      h(
        "span",
        { class: "chip", "data-series": one.series },
        h("a", { href: link(["jobs", job, "designs", one.number]) }, one.name),
        h(
          "a",
          {
            href: to(numbers.filter((other) => other !== one.number)),
            "aria-label": `Remove design ${one.number}`,
            class: "chip-close",
          },
          "×",
        ),
      ),
    ),
    numbers.length < 2 && front.count > 1
      ? h(
          "form",
          { class: "row", onsubmit: add },
          h("label", { for: "beside" }, "Beside design"),
          field,
          h("button", {}, "Compare"),
        )
      : null,
    others.length === 1 &&
      h(
        "span",
        {
          class: "row prefer",
          title:
            "Improves further what the preferred design does better; the rest may worsen by at most the same amount again",
        },
        "Which do you prefer?",
        [main, ...others].map((one, n) =>
          h(
            "a",
            {
              class: "button",
              "aria-label": `Prefer ${one.name}`,
              href: link(["jobs", job], {
                ...wishQuery(wishesOfPreference(objectives, one, [...others, main][n])),
                show: "wishing",
              }),
            },
            one.name,
          ),
        ),
      ),
  );
}
