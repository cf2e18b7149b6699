/** Analyses of a design: some always visible, the others in tabs, each with text, tables and figure. */

import { whenNear } from "../lib/deferred.js";
import { fill, h } from "../lib/dom.js";
import { capitalised } from "../lib/words.js";
import { question } from "./question.js";

/** @type {Record<string, number>} */
const KEYS = { ArrowLeft: -1, ArrowRight: 1 };
/** Titles of the analyses that are always visible, by name. @type {Record<string, string>} */
const TITLES = {
  extremes: "Extreme values over the turn",
  sensitivity: "Sensitivity",
  tolerances: "Effect of tolerances on the slider position",
};
/** Titles for a lever. @type {Record<string, string>} */
const TITLES_OF_LEVER = { lever: "Moved by a cylinder that turns" };
/** Titles for a swinging crank. @type {Record<string, string>} */
const TITLES_OF_SWING = { swing: "The swing", ...TITLES_OF_LEVER };
const WITHOUT = "This job has no tolerances. Add some under “Tolerances”.";
const ELSEWHERE = ["inverse", "round", "wish"]; // questions with a separate view

/**
 * Put the analyses into two places. questions, fronts: the service's questions about a design, and about a front. swings: whether the
 * crank swings; isLever: whether a cylinder moves it; lacking: names of questions that the
 * machine does not meet; tolerances: whether the job has any. tab: the selected tab; chooseTab(tab): called
 * for another one, "" for the first. Returns show(lengths): lengths of a changed design, or null for the unchanged one.
 * @param {{ sections: HTMLElement, tabs: HTMLElement }} places
 * @param {{ job: string, number: number, questions: Api.Topic[], fronts: Api.Topic[], swings: boolean, isLever: boolean, lacking: string[], tolerances: boolean, tab: string, chooseTab: (tab: string) => void, signal: AbortSignal }} options
 */
export function analyses(
  places,
  { job, number, questions, fronts, swings, isLever, lacking, tolerances, tab, chooseTab, signal },
) {
  const titles = isLever ? TITLES_OF_LEVER : swings ? TITLES_OF_SWING : TITLES;
  /** @param {string} name @param {HTMLElement[]} buttons */
  const tabList = (name, buttons) =>
    h("div", { class: "tabs", role: "tablist", "aria-label": name, onkeydown }, buttons);
  const panel = h("div", {
    class: "panel analysis",
    role: "tabpanel",
    id: "analysis",
    tabindex: 0,
  });
  /** @param {Api.Topic} of @param {string} path */
  const withView = (of, path) => ({ ...of, view: question(of, { path, job, signal }) });
  /** @param {Api.Topic} of */
  const isListed = ({ name }) => !(name in titles || ELSEWHERE.includes(name));
  /** @param {Api.Topic} of */
  const ofDesign = (of) => withView(of, `jobs/${job}/designs/${number}/${of.path}`);
  const ofFront = fronts
    .filter(isListed)
    .map((of) => withView(of, of.path.replace("{number}", job).replace("{design}", `${number}`)));
  const [absent, fitting] = [true, false].map((lacks) =>
    questions.filter((one) => isListed(one) && lacking.includes(one.name) === lacks),
  );
  /** Whether an analysis is of a machine like this one in particular. @param {Api.Topic} of */
  const isSpecial = ({ premise, path }) => Boolean(premise) && path.startsWith("topics/");
  fitting.sort((one, other) => Number(isSpecial(other)) - Number(isSpecial(one)));
  const listed = [...fitting.map(ofDesign), ...ofFront, ...absent.map(ofDesign)];
  const fit = listed.length - absent.length; // number of those that suit the machine
  let chosen = Math.max(
    listed.findIndex(({ name }) => name === tab),
    0,
  );
  /** @type {Page.Numbers | null} */
  let lengths = null;
  /** @type {ReturnType<typeof question>[]} */
  const begun = []; // of the sections
  let near = false; // whether the tabs have ever been visible

  const buttons = listed.map((one, n) =>
    h(
      "button",
      {
        type: "button",
        role: "tab",
        id: `tab-${one.name}`,
        "aria-controls": "analysis",
        title: one.shows,
        onclick: () => choose(n),
      },
      one.title,
      n >= fit && h("span", { class: "quiet" }, ` needs ${one.premise}`),
    ),
  );

  const others = h(
    "details",
    { hidden: !absent.length },
    h("summary", {}, `${absent.length} for other machines`),
    tabList("Analyses for other machines", buttons.slice(fit)),
  );

  /** Mark the selected tab. The buttons are not redrawn, so they keep the focus. */
  function markChosen() {
    buttons.forEach((button, n) => {
      button.setAttribute("aria-selected", String(n === chosen));
      button.tabIndex = n === chosen ? 0 : -1;
    });
    panel.setAttribute("aria-labelledby", buttons[chosen].id);
    others.open ||= chosen >= fit;
  }

  async function draw() {
    const { shows, command, view } = listed[chosen];
    const isOfDesign = !ofFront.includes(listed[chosen]);
    near = true;
    markChosen();
    fill(
      panel,
      h(
        "p",
        { class: "quiet hint" },
        `${capitalised(shows)}${lengths && isOfDesign ? "; for the changed design" : ""}. The same as `,
        h("code", {}, `slidercrank ${command}`),
        ".",
      ),
      view.node,
    );
    if (isOfDesign) await view.ask(lengths); // the others are slow or need inputs
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
    buttons[chosen].focus();
  }

  fill(
    places.sections,
    Object.entries(titles).map(([name, title]) => {
      const [{ view }] = questions.filter((one) => one.name === name).map(ofDesign);
      const lacks = name === "tolerances" && !tolerances;
      const body = h(
        "div",
        { class: "panel" },
        lacks ? h("p", { class: "quiet" }, WITHOUT) : view.node,
      );
      const begin = () => {
        begun.push(view);
        return view.ask(lengths);
      };
      if (!lacks) whenNear(body, begin, signal);
      return h("section", { class: name }, h("h2", {}, title), body);
    }),
  );
  if (!swings) {
    fill(
      places.tabs,
      h("h2", {}, "Analyses"),
      tabList("Analyses", buttons.slice(0, fit)),
      others,
      panel,
    );
    markChosen();
    whenNear(panel, async () => near || (await draw()), signal);
  }
  return {
    /** @param {Page.Numbers | null} now */
    show(now) {
      const same = JSON.stringify(now) === JSON.stringify(lengths);
      lengths = now;
      if (same) return;
      for (const view of begun) view.ask(now);
      if (near) draw();
    },
  };
}
