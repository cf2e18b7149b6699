/** Kept designs of a run: names, notes, stars, the decision and its reason, shared by everyone with access. */

import { link } from "../lib/address.js";
import { address, get, patch, post, remove } from "../lib/api.js";
import { fill, first, focused, h } from "../lib/dom.js";
import { attempt, sayProblem } from "../lib/notices.js";
import { apiSystem, text, unitOf } from "../lib/numbers.js";
import { searchButton } from "../design/bookmark_form.js";
import { lengthsOf } from "../design/loading.js";
import { headed } from "./columns.js";
import { LENGTHS } from "./linkages.js";
import { headsOf, numberCell, table as tableOf } from "../lib/table.js";

/** @import { Explorer } from "./explorer.js" */

const EVERY = 5_000; // ms between polls for others' changes

/** Return {place, file, draw(), marks(), ask()} for the kept designs of an explorer, at whose head the decision is. @param {Explorer} explorer */
export function bookmarksPanel(explorer) {
  const { data, job, chosen, decision } = explorer;
  const table = h("div", {
    class: "scroll",
    tabindex: 0,
    role: "region",
    "aria-label": "Table of kept designs",
  });
  const none = h(
    "p",
    { class: "quiet hint" },
    "None yet. Keep a design from its own view or from a wish, or tick designs in the table.",
  );
  const add = h("button", {
    type: "button",
    onclick: ({ currentTarget }) => attempt(keepTicked, sayProblem, currentTarget),
  });
  const only = h("input", {
    type: "checkbox",
    onchange: () => [drawTable(), explorer.update("marks")],
  });
  const stars = h("label", {}, only, " only with a star");
  const csv = h("a", { download: "" }, "Kept designs as CSV");
  const file = h("li", {}, csv);
  const place = h(
    "section",
    { class: "panel kept", "aria-labelledby": "kept-title" },
    h("div", { class: "row spread" }, h("h2", { id: "kept-title" }, "Kept designs"), stars, add),
    none,
    table,
  );
  /** @type {Api.Kept[]} */
  let designs = [];
  let loaded = false; // whether the service has answered
  let turn = 0; // of the latest question
  let typing = false; // a note or a reason, which is not sent yet
  let late = false; // drawing waits until that is

  /** Ask for the kept designs. refuse(problem): of a failure. */
  async function ask(refuse = sayProblem) {
    const request = (turn += 1);
    await attempt(async () => {
      const before = marks().length;
      const answer = await get(`jobs/${job.id}/kept`, {}, explorer.signal);
      if (request !== turn) return;
      if (loaded && JSON.stringify(answer.designs) === JSON.stringify(designs)) return;
      loaded = true;
      designs = answer.designs;
      drawTable();
      if (before || marks().length) explorer.update("all"); // otherwise text typed at the axes stays
    }, refuse);
  }

  /** @param {number} number @param {Partial<Api.Kept>} changes */
  async function change(number, changes) {
    await attempt(
      () => patch(`jobs/${job.id}/kept/${number}`, changes),
      (problem) => {
        sayProblem(problem);
        if (changes.decided) drawTable(); // the mark is where it was; what was typed stays, to be sent again
      },
    );
    await ask();
  }

  /** Send what was typed; nothing if it is unchanged. @param {number} [number] @param {Partial<Api.Kept>} [changes] */
  function sent(number, changes) {
    typing = false;
    if (number !== undefined && changes) change(number, changes);
    else if (late) drawTable();
  }

  async function keepTicked() {
    for (const number of chosen.selected)
      await post(`jobs/${job.id}/kept`, { design: number, name: `Design ${number}`, star: true });
    await ask();
  }

  /** @param {Api.Kept} one */
  async function drop({ number }) {
    await attempt(() => remove(`jobs/${job.id}/kept/${number}`));
    await ask();
  }

  /** Return the view of a kept design; null where more than its numbers is other than in the design that it began as. @param {Api.Kept} one */
  function hrefOf({ design, numbers }) {
    const value = Array.isArray(numbers?.value) ? numbers.value.join(",") : null;
    const query = /** @type {Record<string, number>} */ ({ ...numbers });
    return design && numbers
      ? link(["jobs", job.id, "designs", design], { ...query, value })
      : null;
  }

  /** Show the decision at the head of the run, with its report. @param {Api.Kept | undefined} one */
  function showDecision(one) {
    const href = one && hrefOf(one);
    fill(
      decision,
      one && h("strong", {}, href ? h("a", { href }, one.decision) : one.decision),
      one &&
        href && [
          " ",
          h(
            "a",
            {
              class: "button",
              download: "",
              href: address(`jobs/${job.id}/designs/${one.design}/report.html`, {
                ...one.numbers,
                units: apiSystem(),
              }),
            },
            "Report of the decision",
          ),
        ],
    );
    decision.hidden = !one;
  }

  /** @param {Api.Kept} one */
  function line(one) {
    const { number, name, cells } = one;
    const href = hrefOf(one);
    /** @param {"note" | "reason"} key @param {string} label @param {string} placeholder */
    const words = (key, label, placeholder) =>
      h("textarea", {
        rows: 1,
        maxlength: 4000,
        value: one[key],
        placeholder,
        "aria-label": `${label} ${name}`,
        "data-act": `${key}-${number}`,
        oninput: () => (typing = true),
        onchange: ({ currentTarget }) => sent(number, { [key]: currentTarget.value }),
        onblur: () => sent(),
      });
    return h(
      "tr",
      { class: one.decided ? "decided" : null },
      h(
        "td",
        {},
        h(
          "button",
          {
            type: "button",
            class: "star",
            "aria-pressed": String(one.star),
            "aria-label": `Star of ${name}`,
            "data-act": `star-${number}`,
            onclick: () => change(number, { star: !one.star }),
          },
          one.star ? "★" : "☆",
        ),
      ),
      h(
        "th",
        { scope: "row" },
        href ? h("a", { href }, name) : name,
        h(
          "div",
          { class: "quiet" },
          LENGTHS.map((key, n) => [
            n ? " · " : "",
            h(
              "span",
              { "data-key": key, "data-value": String(cells[key]) },
              text(cells[key], "mm", 4),
            ),
          ]),
          ` ${unitOf("mm")}`,
        ),
        one.outside.length > 0 && h("div", { class: "at-limit" }, "outside the job"),
        one.broken.length > 0 && h("div", { class: "bad" }, "misses a requirement"),
      ),
      data.objectives.map((objective) => {
        const { column, unit } = objective;
        const cell = numberCell(column, cells[column], text(cells[column], unit, 5));
        cell.dataset.title = headed(objective);
        return cell;
      }),
      h(
        "td",
        { "data-title": "decided" },
        h("input", {
          type: "radio",
          name: "decided",
          checked: one.decided,
          "aria-label": `Choose ${name}`,
          "data-act": `decided-${number}`,
          onchange: () => change(number, { decided: true }),
        }),
      ),
      h(
        "td",
        { class: "words" },
        words("reason", "Why, or why not,", "why, or why not"),
        words("note", "Note on", "note"),
      ),
      h(
        "td",
        {},
        searchButton(`${job.id}`, () => lengthsOf(cells), {
          title: "Search near",
          name: `Search near ${name}`,
          act: `near-${number}`,
        }),
        h(
          "button",
          { type: "button", "aria-label": `Drop ${name}`, onclick: () => drop(one) },
          "Drop",
        ),
      ),
    );
  }

  function drawTable() {
    late = typing;
    if (late) return; // the field would be another one, without what stands in it
    const focusedAct = focused(place)?.dataset.act;
    const listed = only.checked ? designs.filter(({ star }) => star) : designs;
    none.hidden = !loaded || designs.length > 0;
    table.hidden = listed.length === 0;
    for (const node of [stars, file]) node.hidden = designs.length === 0;
    csv.href = address(`jobs/${job.id}/kept.csv`, { units: apiSystem() });
    showDecision(designs.find(({ decided }) => decided));
    /** @param {string} title */
    const unseen = (title) => h("span", { class: "hidden" }, title);
    const heads = [
      unseen("Star"),
      "design",
      ...data.objectives.map(headed),
      "decided",
      "reason and note",
      unseen("Search near, drop"),
    ];
    fill(
      table,
      tableOf(
        "Kept designs",
        headsOf(heads, (n) => n > 1 && n < heads.length - 3),
        listed.map(line),
      ),
    );
    if (focusedAct) first(place, `[data-act="${CSS.escape(focusedAct)}"]`)?.focus();
  }

  const look = () => document.hidden || ask(() => {}); // the next one may be answered
  const watcher = setInterval(look, EVERY);
  explorer.signal.addEventListener("abort", () => clearInterval(watcher));
  for (const [from, name] of /** @type {const} */ ([
    [document, "visibilitychange"],
    [window, "focus"],
  ]))
    from.addEventListener(name, look, { signal: explorer.signal });

  /** Draw the button for the ticked designs. */
  function draw() {
    const ticked = chosen.selected.join(", ");
    add.textContent = ticked ? `Keep design ${ticked}` : "Keep ticked designs";
    add.disabled = !ticked;
  }

  /** Return the kept designs outside the front, for the charts. */
  const marks = () =>
    designs
      .filter(({ changed, star }) => changed && (star || !only.checked))
      .map(({ cells, name }) => ({ cells, name }));
  drawTable();
  ask();
  return { place, file, draw, marks, ask };
}
