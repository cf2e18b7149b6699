/** Analyses of a design: some one below the other, the others a tab each; all that the service has, with text, tables and figure. */

import { whenNear } from "../lib/deferred.js";
import { fill, h } from "../lib/dom.js";
import { capital } from "../lib/words.js";
import { question } from "./question.js";

/** @type {Record<string, number>} */
const KEYS = { ArrowLeft: -1, ArrowRight: 1 };
/** Titles of those that are always in sight, by name. @type {Record<string, string>} */
const TITLES = {
  extremes: "Extreme values over the turn",
  sensitivity: "Sensitivity",
  tolerances: "Effect of tolerances on the slider position",
};
/** The only one of a design that swings. @type {Record<string, string>} */
const TITLES_OF_SWING = { swing: "The swing" };
const WITHOUT = "This job has no tolerances. Add some under “Tolerances”.";
const ELSEWHERE = ["inverse"]; // questions with a view of their own
const CERTIFY = {
  name: "certify",
  path: "",
  command: "certify",
  title: "Certify",
  shows: "how far the front can be from the true one, whatever the design",
  figure: false,
  inputs: [
    ["epsilon", "Largest gap, as a fraction of each objective's range", "", "0.01"],
    ["seconds", "Time limit", "s", "10"],
  ].map(([key, title, unit, usual]) => ({
    ...{ key, title, unit, usual },
    ...{ help: "", words: [], required: false, example: "" },
  })),
};

/**
 * Put the analyses into two places. questions: all of the service; swings: whether the crank does; tolerances: whether the job has any;
 * tab: the chosen one; chooseTab(tab): another one is, "" for the first.
 * Returns show(lengths): of a changed design, null for the design itself.
 * @param {{ sections: HTMLElement, tabs: HTMLElement }} places
 * @param {{ job: string, number: number, questions: Api.Topic[], swings: boolean, tolerances: boolean, tab: string, chooseTab: (tab: string) => void, signal: AbortSignal }} options
 */
export function analyses(
  places,
  { job, number, questions, swings, tolerances, tab, chooseTab, signal },
) {
  const titles = swings ? TITLES_OF_SWING : TITLES;
  const tabs = h("div", { class: "tabs", role: "tablist", "aria-label": "Analyses", onkeydown });
  const panel = h("div", {
    class: "panel analysis",
    role: "tabpanel",
    id: "analysis",
    tabindex: 0,
  });
  /** @param {Api.Topic} of */
  const withView = (of) => ({
    ...of,
    view: question(of, { path: `jobs/${job}/designs/${number}/${of.path}`, job, signal }),
  });
  const proof = question(CERTIFY, {
    path: `jobs/${job}/certificate`,
    job,
    button: "Prove it",
    signal,
  });
  const listed = [
    ...questions.filter(({ name }) => !(name in titles || ELSEWHERE.includes(name))).map(withView),
    { ...CERTIFY, view: proof },
  ];
  let chosen = Math.max(
    listed.findIndex(({ name }) => name === tab),
    0,
  );
  /** @type {Page.Numbers | null} */
  let lengths = null;
  let near = false; // whether the tabs are, or have been, in sight

  async function draw() {
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
        `${capital(shows)}${lengths && name !== CERTIFY.name ? "; of the changed design" : ""}. The same as `,
        h("code", {}, `slidercrank ${command}`),
        ".",
      ),
      view.node,
    );
    if (name !== CERTIFY.name) await view.ask(lengths); // a proof takes a while
  }

  /** @param {number} n */
  function choose(n) {
    chosen = n;
    chooseTab(n ? listed[n].name : "");
    draw();
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
      const [{ view }] = questions.filter((one) => one.name === name).map(withView);
      const lacks = name === "tolerances" && !tolerances;
      const body = h(
        "div",
        { class: "panel" },
        lacks ? h("p", { class: "quiet" }, WITHOUT) : view.node,
      );
      if (!lacks) whenNear(body, () => view.ask(), signal);
      return h("section", { class: name }, h("h2", {}, title), body);
    }),
  );
  if (!swings) {
    fill(places.tabs, h("h2", {}, "Analyses"), tabs, panel);
    whenNear(
      panel,
      () => {
        near = true;
        return draw();
      },
      signal,
    );
  }
  return {
    /** @param {Page.Numbers | null} now */
    show(now) {
      const same = JSON.stringify(now) === JSON.stringify(lengths);
      lengths = now;
      if (near && !same) draw();
    },
  };
}
