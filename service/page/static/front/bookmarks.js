/** Bookmarked designs of a run: names, notes, stars, the decision and its reason, shared by everyone with access. */

import { address, get, patch, post, remove } from "../lib/api.js";
import { fill, first, focused, h } from "../lib/dom.js";
import { attempt, sayProblem } from "../lib/notices.js";
import { apiSystem, inDisplayUnits, text, unitOf } from "../lib/numbers.js";
import {
  askPerson,
  askRemarks,
  decisionText,
  historyList,
  hrefOf,
  notesOn,
  searchButton,
  withdraw,
} from "../design/bookmark_form.js";
import { lengthsOf } from "../design/loading.js";
import { headed } from "./columns.js";
import { LENGTHS } from "./linkages.js";
import { headsOf, numberCell, table as tableOf } from "../lib/table.js";

/** @import { Explorer } from "./explorer.js" */

const EVERY = 5_000; // ms between polls for changes by others
/** Entries of the history in words. @type {Record<Api.HistoryEntry["action"], (entry: Api.HistoryEntry) => string>} */
const ACTIONS = {
  note: ({ name, text: note }) => `Note on ${name}: ${note}`,
  reason: ({ name, text: reason }) => `${name}: ${reason}`,
  decided: ({ name, text: reason }) => `Decided on ${name}${reason && `: ${reason}`}`,
  withdrawn: ({ name }) => `Decision for ${name} withdrawn`,
  deleted: ({ name }) => `${name} dropped`,
};

/** Return {place, file, draw(), marks(), ask()} for the bookmarks of an explorer, with the decision at its head. @param {Explorer} explorer */
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
  const past = h("details", {});
  const place = h(
    "section",
    { class: "panel kept", "aria-labelledby": "kept-title" },
    h("div", { class: "row spread" }, h("h2", { id: "kept-title" }, "Kept designs"), stars, add),
    none,
    table,
    past,
  );
  /** @type {Pick<Api.Bookmarks, "designs" | "history">} */
  let list = { designs: [], history: [] };
  let loaded = false;
  let turn = 0;

  /** Request the bookmarks. refuse(problem): called after a failure. */
  async function ask(refuse = sayProblem) {
    const request = (turn += 1);
    await attempt(async () => {
      const before = marks().length;
      const answer = await get(`jobs/${job.id}/kept`, {}, explorer.signal);
      if (request !== turn) return;
      if (loaded && JSON.stringify(answer) === JSON.stringify(list)) return;
      loaded = true;
      list = answer;
      drawTable();
      if (before || marks().length) explorer.update("all"); // otherwise text typed at the axes would stay
    }, refuse);
  }

  /** Change a bookmark. @param {number} number @param {object} changes */
  async function change(number, changes) {
    await patch(`jobs/${job.id}/kept/${number}`, changes);
    await ask();
  }

  async function keepTicked() {
    for (const number of chosen.selected)
      await post(`jobs/${job.id}/kept`, { design: number, name: `Design ${number}`, star: true });
    await ask();
  }

  /** Delete a bookmark; ask first if it has a star or a history. @param {Api.Kept} one */
  function drop({ number, name, decided, star }) {
    /** @param {{ author?: string }} values */
    const act = async ({ author = "" }) => {
      await remove(`jobs/${job.id}/kept/${number}?author=${encodeURIComponent(author)}`);
      await ask();
    };
    if (!star && !list.history.some(({ bookmark }) => bookmark === number))
      return attempt(() => act({}));
    askPerson({
      title: `Drop ${name}?`,
      content: [
        decided &&
          h(
            "p",
            { class: "warning" },
            "It is the chosen design; without it, the run has no decision.",
          ),
        h("p", {}, "Its notes and reasons stay in the history."),
      ],
      yes: "Drop",
      act,
      danger: true,
    });
  }

  /**
   * Ask for name and reason, or name and note, after loading changes by others.
   * @param {Api.Kept} one @param {boolean} deciding @param {HTMLElement} button
   */
  const remark = (one, deciding, button) =>
    attempt(
      async () => {
        await ask();
        const known = list.designs.find(({ number }) => number === one.number);
        const { name: title, number, ...judged } = known ?? one;
        askRemarks({
          ...judged,
          deciding,
          list,
          known,
          title,
          send: (body) => change(number, body),
        });
      },
      sayProblem,
      button,
    );

  /** Show the decision at the head of the run, with its report. @param {Api.Kept | undefined} one */
  function showDecision(one) {
    const href = one && hrefOf(job.id, one);
    fill(
      decision,
      one && h("strong", {}, href ? h("a", { href }, one.decision) : one.decision),
      one && h("span", { class: "quiet" }, decisionText(list, false)),
      one?.deviations.map((words) => `; ${inDisplayUnits(words)}`),
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
    const href = hrefOf(job.id, one);
    /** @param {string} title @param {string} label @param {string} act @param {(button: HTMLElement) => unknown} does */
    const button = (title, label, act, does) =>
      h(
        "button",
        {
          type: "button",
          "aria-label": `${label} ${name}`,
          "data-act": `${act}-${number}`,
          onclick: ({ currentTarget }) => does(currentTarget),
        },
        title,
      );
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
            onclick: () => attempt(() => change(number, { star: !one.star })),
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
        one.faults.map((fault) =>
          h("div", { class: one.broken.length ? "bad" : "at-limit" }, fault),
        ),
        one.deviations.map((words) => h("div", { class: "quiet" }, inDisplayUnits(words))),
      ),
      data.objectives.map((objective) => {
        const { column, unit } = objective;
        const cell = numberCell(column, cells[column], text(cells[column], unit, 5));
        cell.dataset.title = headed(objective);
        return cell;
      }),
      h(
        "td",
        { class: "words" },
        one.decided && h("strong", { class: "good" }, "✓ Decided "),
        one.reason,
        notesOn(list, number),
      ),
      h(
        "td",
        { class: "acting" },
        one.decided
          ? button("Withdraw", "Withdraw the decision for", "decide", () =>
              withdraw(job.id, one, ask),
            )
          : button("Decide", "Decide on", "decide", (node) => remark(one, true, node)),
        button("Note", "Note on", "note", (node) => remark(one, false, node)),
        searchButton(`${job.id}`, () => lengthsOf(cells), {
          title: "Search near",
          name: `Search near ${name}`,
          act: `near-${number}`,
        }),
        button("Drop", "Drop", "drop", () => drop(one)),
      ),
    );
  }

  function drawTable() {
    const { designs, history } = list;
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
      "decision and notes",
      unseen("Decide, note, search near, drop"),
    ];
    fill(
      table,
      tableOf(
        "Kept designs",
        headsOf(heads, (n) => n > 1 && n < heads.length - 2),
        listed.map(line),
      ),
    );
    past.hidden = history.length === 0;
    fill(
      past,
      h("summary", {}, `History (${history.length})`),
      historyList(history.toReversed(), (entry) => ACTIONS[entry.action](entry)),
    );
    if (focusedAct) first(place, `[data-act="${CSS.escape(focusedAct)}"]`)?.focus();
  }

  const look = () => document.hidden || ask(() => {}); // the next request may succeed
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

  /** Return the bookmarks outside the front, for the charts. */
  const marks = () =>
    list.designs
      .filter(({ changed, star }) => changed && (star || !only.checked))
      .map(({ cells, name }) => ({ cells, name }));
  drawTable();
  ask();
  return { place, file, draw, marks, ask };
}
