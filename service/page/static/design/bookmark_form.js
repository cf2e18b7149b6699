/** Decision for a design, bookmark with a note, search near it; and the history of decisions and notes. */

import { ago } from "../jobs/times.js";
import { go, link } from "../lib/address.js";
import { get, patch, post } from "../lib/api.js";
import { askFirst } from "../lib/dialog.js";
import { fill, h } from "../lib/dom.js";
import { attempt, sayProblem } from "../lib/notices.js";
import { inDisplayUnits, withUnit } from "../lib/numbers.js";
import { capitalised } from "../lib/words.js";

/** @typedef {Pick<Api.Bookmarks, "designs" | "history">} List */

/** @param {string} name @param {string} label @param {Dom.Attributes<HTMLInputElement>} attributes */
const field = (name, label, attributes) =>
  h("label", {}, label, h("input", { type: "text", autocomplete: "off", name, ...attributes }));

/** Ask a person, who may give a name for the history. @param {Parameters<typeof askFirst>[0]} question */
export function askPerson({ content, act, ...question }) {
  const author = field("author", "Your name, for the history", {
    value: localStorage.getItem("author") ?? "",
    maxlength: 100,
  });
  askFirst({
    ...question,
    content: [content, author],
    act: (values) => {
      localStorage.setItem("author", values.author);
      return act(values);
    },
  });
}

/** Return who changed something, and when. @param {Api.HistoryEntry | undefined} entry */
const byWhom = (entry) => entry && [entry.author && `${entry.author}, `, ago(entry.at)];

/** Return the chosen design, and its decision in the history. @param {List} list */
function decisionOf({ designs, history }) {
  const decided = designs.find((one) => one.decided);
  const entry = history.findLast(
    ({ bookmark, action }) => bookmark === decided?.number && action === "decided",
  );
  return { decided, entry };
}

/** Return reason, author and time of the decision. @param {List} list @param {boolean} reason whether with the reason */
export function decisionText(list, reason = true) {
  const { decided, entry } = decisionOf(list);
  return [reason && decided?.reason && ` (${decided.reason})`, entry && [", ", byWhom(entry)]];
}

/** Return the entries of a history as a list. @param {Api.HistoryEntry[]} entries @param {(entry: Api.HistoryEntry) => string} words */
export function historyList(entries, words) {
  return (
    entries.length > 0 &&
    h(
      "ul",
      { class: "history" },
      entries.map((entry) =>
        h("li", {}, words(entry), h("span", { class: "quiet" }, " · ", byWhom(entry))),
      ),
    )
  );
}

/** Return the notes on a bookmark. @param {List} list @param {number} number */
export function notesOn({ history }, number) {
  const notes = history.filter(
    ({ bookmark, action, text }) => bookmark === number && action === "note" && text,
  );
  return historyList(notes, ({ text }) => text);
}

/**
 * Return the link to a bookmarked design; null if it differs from its original in more than its numbers.
 * @param {string | number} job @param {Api.Kept} one
 */
export function hrefOf(job, { design, numbers }) {
  const query = Object.entries(numbers ?? {}).map(([key, value]) => [key, String(value)]);
  return design && numbers
    ? link(["jobs", job, "designs", design], Object.fromEntries(query))
    : null;
}

/**
 * Ask for name and reason of a decision, or for name and note. known: bookmark of the design. title: its name without a bookmark. faults:
 * requirements that it misses; deviations: those that it misses by no more than is allowed. send(body): sends the remarks to the service.
 * @param {{ deciding: boolean, list: List, known: Api.Kept | undefined, title: string, faults: string[], deviations: string[], send: (body: object) => unknown }} options
 */
export function askRemarks({ deciding, list, known, title, faults, deviations, send }) {
  const { decided } = decisionOf(list);
  const other = decided !== known ? decided : null;
  const name = known?.name ?? title;
  const [decideWords, keepWords] = [
    other ? "Replace the decision" : faults.length ? "Decide nonetheless" : "Decide",
    known ? "Save" : "Keep",
  ];
  askPerson({
    title: deciding ? `Decide on ${name}?` : known ? `Note on ${name}` : `Keep ${name}?`,
    content: [
      deciding &&
        other &&
        h(
          "p",
          { class: "warning" },
          "This replaces the decision for ",
          h("strong", {}, other.name),
          decisionText(list),
          ".",
        ),
      deciding &&
        faults.length > 0 &&
        h("p", { class: "bad" }, `${capitalised(faults.join("; "))}.`),
      deviations.map((words) => h("p", {}, `${inDisplayUnits(capitalised(words))}.`)),
      field("name", "Name of the design", { value: name, maxlength: 200 }),
      field(deciding ? "reason" : "note", deciding ? "Reason" : "Note", {
        value: (deciding && known?.reason) || "",
        maxlength: 4000,
      }),
    ],
    yes: deciding ? decideWords : keepWords,
    act: (values) => {
      const said = Object.entries(values).map(([key, text]) => [key, text.trim() || undefined]);
      return send({ ...Object.fromEntries(said), decided: deciding || undefined });
    },
  });
}

/**
 * Ask whether to withdraw a decision. done(): called after withdrawal.
 * @param {string | number} job @param {Api.Kept} one @param {() => unknown} done
 */
export function withdraw(job, { name, number }, done) {
  askPerson({
    title: `Withdraw the decision for ${name}?`,
    content: h("p", {}, "The design stays kept, and its reason stays in the history."),
    yes: "Withdraw",
    act: async ({ author }) => {
      await patch(`jobs/${job}/kept/${number}`, { decided: false, author });
      await done();
    },
  });
}

/**
 * Return {node, show(shown)}: buttons and status of a design. design: its original on the front. list: the bookmarks, requested if omitted.
 * dimensions(): its dimensions, or null if unchanged. allow(): deviations allowed for it. lengths(): the centre of a search nearby. kept(bookmark): called for a new bookmark.
 * shown: number of its bookmark or null, its name without a bookmark, and its missed requirements.
 * @param {{ job: string, design: number, list?: List, dimensions: () => Record<string, Api.Row[string]> | null, allow?: () => Api.WhatIf["allowed"] | undefined, kept: (bookmark: Api.Kept) => unknown, lengths: () => Page.Lengths }} options
 */
export function bookmarkForm({ job, design, list, dimensions, allow, kept, lengths }) {
  const standing = h("div", { class: "standing", role: "status" });
  let shown = {
    number: /** @type {number | null} */ (null),
    title: "",
    faults: /** @type {string[]} */ ([]),
    deviations: /** @type {string[]} */ ([]),
  };
  const known = () => list?.designs.find(({ number }) => number === shown.number);
  const load = async () => {
    const now = (list = await get(`jobs/${job}/kept`));
    draw();
    return now;
  };
  /** @param {object} body */
  const send = async (body) => {
    const bookmark = await post(`jobs/${job}/kept`, {
      design,
      dimensions: dimensions() ?? {},
      allow: allow?.() ?? {},
      ...body,
    });
    shown.number = bookmark.number;
    kept(bookmark);
    await load();
  };
  const [deciding, noting] = [true, false].map((isDecision) => {
    const open = async () => {
      askRemarks({ deciding: isDecision, list: await load(), known: known(), ...shown, send });
    };
    return h("button", {
      type: "button",
      onclick: ({ currentTarget }) => attempt(open, sayProblem, currentTarget),
    });
  });
  function draw() {
    const one = known();
    if (!list) return;
    const { decided } = decisionOf(list);
    const href = decided && hrefOf(job, decided);
    deciding.textContent = one?.decided ? "Change the reason" : "Decide on this design";
    deciding.classList.toggle("primary", !one?.decided);
    noting.textContent = one ? "Add a note" : "Keep";
    const beside = h("a", { href: link(["jobs", job]) }, "beside the front");
    fill(
      standing,
      one?.decided && [
        h("strong", { class: "good" }, "✓ Decided"),
        decisionText(list),
        "; see it ",
        beside,
        ". ",
        h("button", { type: "button", onclick: () => withdraw(job, one, load) }, "Withdraw"),
      ],
      one && !one.decided && [`“${one.name}” is kept; see it `, beside, ". "],
      decided &&
        decided !== one && [
          "The decision is for ",
          href ? h("a", { href }, decided.name) : decided.name,
          decisionText(list),
          ".",
        ],
      one && notesOn(list, one.number),
    );
  }
  if (list) draw();
  else attempt(load);
  return {
    node: h(
      "div",
      { class: "keep-or-search" },
      h(
        "div",
        { class: "row" },
        deciding,
        noting,
        searchButton(job, lengths, { title: "Search near it" }),
      ),
      standing,
    ),
    /** @param {typeof shown} now */
    show(now) {
      shown = now;
      draw();
    },
  };
}

/**
 * Return the button that searches near lengths. name: label if the title is not sufficient. act: key of the button in a list that is
 * redrawn.
 * @param {string} job @param {() => Page.Lengths} lengths @param {{ title: string, name?: string, act?: string }} looks
 */
export function searchButton(job, lengths, { title, name, act }) {
  const search = () =>
    askFirst({
      title: "Search near this design?",
      content: h(
        "p",
        {},
        `A new run of the same job varies ${Object.entries(lengths())
          .map(([key, value]) => `${key.replace("_mm", "")} ${withUnit(value, "mm", 4)}`)
          .join(", ")} by 10 %, the offset by at least 10 % of the crank. Fixed lengths stay.`,
      ),
      yes: "Start the search",
      act: async () => go(["jobs", (await post(`jobs/${job}/nearby`, lengths())).id]),
    });
  return h(
    "button",
    {
      type: "button",
      "aria-label": name,
      "data-act": act,
      onclick: search,
    },
    title,
  );
}
