/** Analyses of a design: some one below the other, the others a tab each; all that the service has, with text, tables and figure. */

import { get } from "../lib/api.js";
import { fill, h } from "../lib/dom.js";
import { whenNear } from "../lib/deferred.js";
import { sentenceOf } from "../lib/refusals.js";
import { capital } from "../lib/words.js";
import { question } from "./question.js";

/** @type {Record<string, number>} */
const KEYS = { ArrowLeft: -1, ArrowRight: 1 };
/** Titles of those that are always in sight, by name. @type {Record<string, string>} */
const TITLES = {
  extremes: "Extreme values over the turn",
  sensitivity: "What it is sensitive to",
  tolerances: "What tolerances do to the slider's position",
};
/** The only one of a design that swings. @type {Record<string, string>} */
const TITLES_OF_SWING = { swing: "The swing" };
const WITHOUT = "This job has no tolerances. Give it some under “Tolerances”.";
const ELSEWHERE = ["inverse"]; // questions with a view of their own
const CERTIFY = {
  name: "certify",
  path: "",
  command: "certify",
  title: "Certify",
  shows: "how far the front can be from the true one, whatever the design",
  figure: false,
  inputs: [
    ["epsilon", "By at most, as a share of each objective's range", "", "0.01"],
    ["seconds", "Time for it", "s", "10"],
  ].map(([key, title, unit, usual]) => ({
    ...{ key, title, unit, usual },
    ...{ help: "", words: [], required: false, example: "" },
  })),
};

/**
 * Put the analyses into two places. swings: whether the crank does. tolerances: whether the job has any. tab: that is chosen; told(tab): another one is, "" for the first.
 * Returns show(lengths): of a changed design, null for the design itself.
 * @param {{ sections: HTMLElement, tabs: HTMLElement }} places
 * @param {{ job: string, number: number, swings: boolean, tolerances: boolean, tab: string, told: (tab: string) => void, signal: AbortSignal }} given
 */
export function analyses(places, { job, number, swings, tolerances, tab, told, signal }) {
  const titles = swings ? TITLES_OF_SWING : TITLES;
  const tabs = h("div", { class: "tabs", role: "tablist", "aria-label": "Analyses", onkeydown });
  const panel = h("div", {
    class: "panel analysis",
    role: "tabpanel",
    id: "analysis",
    tabindex: 0,
  });
  /** @type {(Api.Topic & { view: ReturnType<typeof question> })[]} */
  let listed = [];
  let chosen = 0;
  /** @type {Page.Numbers | null} */
  let lengths = null;
  const all = get("topics", {}, signal).then(({ topics, questions }) => [...topics, ...questions]);
  all.catch(() => {}); // whoever needs them says so

  /** @param {Api.Topic} of */
  const withView = (of) => ({
    ...of,
    view: question(of, { path: `jobs/${job}/designs/${number}/${of.path}`, job, signal }),
  });

  /** Begin a part once it comes near; what goes wrong is said there. @param {Element} body @param {() => Promise<unknown>} begin */
  const later = (body, begin) =>
    whenNear(
      body,
      () => begin().catch((error) => fill(body, h("p", { class: "error" }, sentenceOf(error)))),
      signal,
    );

  function draw() {
    const { name, shows, command, view } = listed[chosen];
    fill(
      tabs,
      listed.map((one, n) =>
        h(
          "button",
          {
            type: "button",
            role: "tab",
            id: `tab-${one.name}`,
            "aria-controls": "analysis",
            "aria-selected": String(n === chosen),
            tabindex: n === chosen ? 0 : -1,
            title: one.shows,
            onclick: () => choose(n),
          },
          one.title,
        ),
      ),
    );
    panel.setAttribute("aria-labelledby", `tab-${name}`);
    fill(
      panel,
      h(
        "p",
        { class: "quiet hint" },
        `${capital(shows)}${lengths && name !== CERTIFY.name ? "; of the changed design" : ""}. As `,
        h("code", {}, `slidercrank ${command}`),
        " tells it.",
      ),
      view.node,
    );
    return name === CERTIFY.name ? null : view.ask(lengths); // a proof takes a while
  }

  /** @param {number} n */
  function choose(n) {
    chosen = n;
    told(n ? listed[n].name : "");
    return draw();
  }

  /** @param {KeyboardEvent} event */
  function onkeydown({ key }) {
    if (!KEYS[key]) return;
    choose((chosen + KEYS[key] + listed.length) % listed.length);
    document.getElementById(`tab-${listed[chosen].name}`)?.focus();
  }

  fill(
    places.sections,
    Object.entries(titles).map(([name, title]) => {
      const body = h("div", { class: "panel" });
      if (name === "tolerances" && !tolerances) fill(body, h("p", { class: "quiet" }, WITHOUT));
      else
        later(body, async () => {
          const [{ view }] = (await all).filter((one) => one.name === name).map(withView);
          fill(body, view.node);
          await view.ask();
        });
      return h("section", { class: name }, h("h2", {}, title), body);
    }),
  );
  if (!swings) {
    fill(places.tabs, h("h2", {}, "Analyses"), tabs, panel);
    later(panel, async () => {
      const proof = question(CERTIFY, {
        path: `jobs/${job}/certificate`,
        job,
        button: "Prove it",
        signal,
      });
      const others = (await all).filter(
        ({ name }) => !(name in titles || ELSEWHERE.includes(name)),
      );
      listed = [...others.map(withView), { ...CERTIFY, view: proof }];
      await choose(
        Math.max(
          listed.findIndex(({ name }) => name === tab),
          0,
        ),
      );
    });
  }
  return {
    /** @param {Page.Numbers | null} now */
    show(now) {
      const same = JSON.stringify(now) === JSON.stringify(lengths);
      lengths = now;
      if (listed.length && !same) draw();
    },
  };
}
