/** Analyses of a design, a tab each: every topic that the service has and the view does not draw itself, with text, tables and figure. */

import { address, get, isAbort, statusOf } from "../lib/api.js";
import { fill, focused, formOf, h, numberField } from "../lib/dom.js";
import { link } from "../lib/address.js";
import { measured } from "../lib/measured.js";
import { apiSystem, unitOf } from "../lib/numbers.js";
import { beforePrinting } from "../lib/printing.js";
import { capital, inWords } from "../lib/words.js";
import { proof } from "./proof.js";
import { sentenceOf } from "../lib/refusals.js";
import { headsOf, scrolledTable } from "../lib/table.js";

/** @type {Record<string, number>} */
const KEYS = { ArrowLeft: -1, ArrowRight: 1 };
const NEAR = "200px"; // before they are in sight
const CERTIFY = {
  name: "certify",
  title: "Certify",
  shows: "how far the front can be from the true one",
  inputs: [],
};

/**
 * Put the tabs into `place`. drawn: names of topics that the view draws itself. tab: that is chosen; told(tab): another one is, "" for the
 * first. Returns show(lengths): of a changed design, null for the design itself.
 * @param {HTMLElement} place
 * @param {{ job: string, number: number, drawn: readonly string[], tab: string, told: (tab: string) => void, signal: AbortSignal }} given
 */
export function analyses(place, { job, number, drawn, tab, told, signal }) {
  const tabs = h("div", {
    class: "tabs",
    role: "tablist",
    "aria-label": "Analyses",
    onkeydown: step,
  });
  const panel = h("div", {
    class: "panel analysis",
    role: "tabpanel",
    id: "analysis",
    tabindex: 0,
  });
  fill(place, h("h2", {}, "Analyses"), tabs, panel);
  /** @type {Api.Topic[]} */
  let topics = [];
  let chosen = tab;
  /** @type {Page.Numbers | null} */
  let lengths = null;
  let turn = 0;
  /** @type {Map<string, ReturnType<typeof asking>>} */
  let forms = new Map();

  /** @type {Promise<void> | null} */
  let begun = null;
  const watcher = new IntersectionObserver(
    (now) => {
      if (now.some((one) => one.isIntersecting)) begun ??= begin();
    },
    { rootMargin: NEAR },
  );
  watcher.observe(place);
  beforePrinting(() => (begun ??= begin()).then(pictured), signal);
  signal.addEventListener("abort", () => watcher.disconnect(), { once: true });

  /** Wait for the figure of the tab. */
  async function pictured() {
    const picture = panel.querySelector("img");
    if (picture && !picture.complete)
      await new Promise((done) =>
        ["load", "error"].forEach((name) => picture.addEventListener(name, done, { once: true })),
      );
  }

  async function begin() {
    watcher.disconnect();
    try {
      topics = [
        ...(await get("topics", {}, signal)).topics.filter(({ name }) => !drawn.includes(name)),
        CERTIFY,
      ];
      forms = new Map(topics.map(({ name, inputs }) => [name, asking(inputs, ask)]));
      await choose((topics.find(({ name }) => name === chosen) ?? topics[0]).name);
    } catch (error) {
      if (!isAbort(error)) fill(panel, h("p", { class: "error" }, sentenceOf(error)));
    }
  }

  /** @param {string} name */
  function choose(name) {
    chosen = name;
    if (begun) told(name === topics[0].name ? "" : name);
    fill(
      tabs,
      topics.map((one) =>
        h(
          "button",
          {
            type: "button",
            role: "tab",
            id: `tab-${one.name}`,
            "aria-controls": "analysis",
            "aria-selected": String(one.name === name),
            tabindex: one.name === name ? 0 : -1,
            title: one.shows,
            onclick: () => choose(one.name),
          },
          one.title,
        ),
      ),
    );
    panel.setAttribute("aria-labelledby", `tab-${name}`);
    return ask();
  }

  /** @param {KeyboardEvent} event */
  function step({ key }) {
    const by = KEYS[key];
    if (!by) return;
    const at = topics.findIndex(({ name }) => name === chosen);
    choose(topics[(at + by + topics.length) % topics.length].name);
    document.getElementById(`tab-${chosen}`)?.focus();
  }

  async function ask() {
    const own = (turn += 1);
    if (chosen === CERTIFY.name) {
      fill(panel, proof({ job, signal }));
      return;
    }
    const { title, shows, inputs } = /** @type {Api.Topic} */ (
      topics.find(({ name }) => name === chosen)
    );
    const asked = /** @type {ReturnType<typeof asking>} */ (forms.get(chosen));
    const path = /** @type {const} */ (`jobs/${job}/designs/${number}/topics/${chosen}`);
    const head = [
      h(
        "p",
        { class: "quiet hint" },
        `${capital(inWords(shows))}${lengths ? "; of the changed design" : ""}. As `,
        h("code", {}, `analyse --show ${chosen}`),
        " tells it.",
      ),
      inputs.length > 0 && asked.form,
    ];
    const held = focused(asked.form);
    const { values, wrong } = asked.given();
    const options = { ...lengths, units: apiSystem(), ...values };
    const waiting = h("p", { class: "quiet busy", role: "status" }, "Computing …");
    const answer = h("div", {}, wrong ? h("p", { class: "bad", role: "alert" }, wrong) : waiting);
    fill(panel, head, answer);
    held?.focus();
    if (wrong) return;
    try {
      const found = await get(path, options, signal);
      if (own !== turn || !found) return;
      const { told: blocks } = found;
      const file = address(`${path}.svg`, options);
      const picture = h("img", {
        src: file,
        alt: `Figure: ${title}`,
        onerror: ({ currentTarget }) => currentTarget.remove(),
      });
      fill(
        answer,
        h("div", { class: "analysis-columns" }, h("div", {}, blocks.map(block)), picture),
      );
    } catch (error) {
      if (own !== turn || isAbort(error)) return;
      const lacks = statusOf(error) === 422;
      fill(
        answer,
        h(
          "p",
          { class: lacks ? "quiet" : "error" },
          `${sentenceOf(error)}. `,
          lacks && h("a", { href: link(["new"], { from: job }) }, "Change the job"),
        ),
      );
    }
  }

  window.addEventListener("units", () => begun && chosen !== CERTIFY.name && ask(), { signal });
  return {
    /** @param {Page.Numbers | null} now */
    show(now) {
      if (JSON.stringify(now) === JSON.stringify(lengths)) return;
      lengths = now;
      if (topics.length && chosen !== CERTIFY.name) ask(); // a proof is of the front, whatever the design
    },
  };
}

/**
 * Return a form for what a topic is asked with, and given(): {values} that were typed, by key in the units of the API, null for what is usual, and what is
 * {wrong} with them.
 * @param {Api.Topic["inputs"]} inputs @param {() => void} ask
 */
function asking(inputs, ask) {
  const fields = inputs.map(({ key, title, unit, usual }) => {
    const field = numberField({
      class: "short number",
      name: key,
      placeholder: usual,
    });
    return { key, title, unit, field };
  });
  const form = formOf(
    ask,
    fields.map(({ title, unit, field }) =>
      h("label", {}, `${title} `, field, unit && ` ${unitOf(unit)}`),
    ),
    h("button", {}, "Compute"),
  );
  form.classList.add("row");
  const given = () => {
    const typed = fields.map(({ key, unit, field }) => ({ key, ...measured(field.value, unit) }));
    const values = Object.fromEntries(typed.map(({ key, value }) => [key, value ?? null]));
    return { values, wrong: typed.map(({ wrong }) => wrong).find(Boolean) };
  };
  return { form, given };
}

/** @param {Api.Told} block */
function block({ sentence, heading, heads, right, rows }) {
  if (!rows.length) return h(heading ? "h3" : "p", {}, sentence);
  const lines = rows.map((cells) =>
    h(
      "tr",
      {},
      cells.map((cell, n) =>
        h(n ? "td" : "th", { scope: n ? null : "row", class: right[n] ? "number" : null }, cell),
      ),
    ),
  );
  return scrolledTable(
    "Numbers of the analysis",
    heads.some(Boolean) && headsOf(heads, (n) => right[n]),
    lines,
  );
}
