/** View of a design: its motion, curves, numbers and what-if sliders, with up to two others beside it. */

import { analyses } from "../design/analyses.js";
import { endsOf } from "../design/extremes.js";
import { comparedDesigns, cycleOf, loadDesign, loadFront } from "../design/loading.js";
import { showNumbers } from "../design/numbers.js";
import { showObjectives } from "../design/objectives.js";
import { overCycle } from "../design/over_cycle.js";
import { question } from "../design/question.js";
import { rounding } from "../design/rounding.js";
import { mechanismsPanel } from "../design/mechanisms.js";
import { exportMenu } from "../design/export_menu.js";
import { designHead, focusLastStep } from "../design/head.js";
import { playback } from "../mechanism/playback.js";
import { inverseForm } from "../design/inverse.js";
import { whatIf } from "../design/what_if.js";
import { contents } from "../design/contents.js";
import { bookmarkForm } from "../design/bookmark_form.js";
import { positionOfAngle } from "../charts/cycle.js";
import { keepChoices } from "../lib/address.js";
import { get, Problem } from "../lib/api.js";
import { fill, h } from "../lib/dom.js";
import { inDisplayUnits } from "../lib/numbers.js";
import { capitalised } from "../lib/words.js";

export const title = "Design";

const SOON = 150; // ms
const CYCLES = ["back and forth", "one turn", "two turns"];
/** Parts of the view for its table of contents, with titles. @type {[string, string][]} */
const CONTENTS = [
  ["stage", "Drawing"],
  ["what-if", "What if?"],
  ["rounding", "Round it"],
  ["curves", "Curves"],
  ["numbers", "All numbers"],
  ["topics", "Extremes, tolerances"],
  ["analyses", "Analyses"],
];
const LENGTHS = ["crank_mm", "rod_mm", "offset_mm"];

/** Show the design that the address names. @param {HTMLElement} place @param {Page.Visit} options */
export async function show(place, { parts, query, signal }) {
  const [, job, , designText] = parts;
  const number = Number(designText);
  if (!Number.isInteger(number) || number < 1)
    throw new Problem(404, `A design must be given by its number, from 1; got ${designText}.`);
  const path = /** @type {const} */ (`jobs/${job}/designs/${number}`);
  const [front, main, requirements, asked, kept] = await Promise.all([
    get(`jobs/${job}/front`, {}, signal),
    loadDesign(job, number, 1, signal),
    get(`${path}/requirements`, {}, signal),
    get("topics", {}, signal),
    get(`jobs/${job}/kept`, {}, signal),
  ]);
  const questions = [...asked.topics, ...asked.questions];
  const { names } = requirements;
  const [rows, ...others] = await Promise.all([
    loadFront(job, front, signal),
    ...comparedDesigns(query, number).map((other, n) => loadDesign(job, other, n + 2, signal)),
  ]);
  if (signal.aborted) return;
  for (const shown of [main, ...others])
    shown.name =
      kept.designs.find(({ design, changed }) => design === shown.number && !changed)?.name ??
      shown.name;

  const objectives = front.objectives;
  const named = h("span", {});
  const undo = h(
    "button",
    { type: "button", class: "undo", hidden: true, onclick: () => sliders.apply(main.row) },
    `Back to design ${number}`,
  );
  const shared = {
    named,
    undo,
    job,
    number,
    front,
    objectives,
    rows,
    main,
    others,
    requirements,
    names,
    signal,
  };
  const { turns, seconds } = main;
  const isLever = Boolean(main.outlines?.lever);
  const rpm = seconds ? (Math.sign(requirements.speed_rpm) || 1) * (60 / seconds) : 0; // cycles a minute
  const angle = playback(rpm, signal, CYCLES[turns]);
  /** @param {number} at @param {boolean} taken */
  const hold = (at, taken) => {
    if (taken && angle.playing) angle.pause();
    if (!angle.playing) angle.set(at);
  };
  const places = Object.fromEntries(
    [
      "objectives",
      "beyond",
      "stage",
      "what-if",
      "rounding",
      "curves",
      "inverse",
      "numbers",
      "trade-offs",
      "topics",
      "analyses",
    ].map((name) => [name, h("section", { class: name })]),
  );
  const files = exportMenu(job, number);
  let called = query.get("as") ?? ""; // how the changed design was made
  /** Show the name of the displayed design, and the decision on it. */
  const rename = () => {
    const { name, bookmark } = changed ?? requirements;
    const title = capitalised(
      changed && called && !bookmark ? `${called}, near design ${number}` : name,
    );
    named.textContent = title.includes(`esign ${number}`) ? title : `${title} · ${number}`;
    undo.hidden = changed === null;
    remarks.show({
      number: bookmark,
      title,
      faults: changed?.faults ?? [],
      deviations: changed?.deviations ?? [],
    });
  };
  const [ofPlace, ofWay] = Array.from({ length: 2 }, () =>
    h(
      "p",
      { class: "quiet unchanged", hidden: true },
      `For design ${number} itself, without the change:`,
    ),
  );
  const remarks = bookmarkForm({
    job,
    design: number,
    list: kept,
    dimensions: () => sliders.dimensions(),
    allow: () => changed?.allowed,
    lengths: () => sliders.lengths(),
    kept: ({ name, number: bookmark }) => {
      Object.assign(changed ?? requirements, { name, bookmark });
      rename();
    },
  });
  const strip = h("div", { class: "panel row strip", role: "group", "aria-label": "Motion" });
  fill(
    place,
    designHead(shared),
    h("div", { class: "row taking" }, remarks.node, files.node),
    h(
      "div",
      { class: "design-columns" },
      places.objectives,
      places.beyond,
      h("div", {}, places.stage, ofPlace, places["trade-offs"], places.rounding),
      places["what-if"],
    ),
    strip,
    places.curves,
    ofWay,
    places.inverse,
    places.numbers,
    places.topics,
    places.analyses,
  );
  for (const name of ["stage", "what-if", "trade-offs", "rounding"])
    places[name].classList.add("panel");
  const machines = mechanismsPanel(places.stage, strip, angle, turns);
  strip.append(
    contents(
      CONTENTS.map(([name, words]) => [words, places[name]]),
      signal,
    ),
  );
  let over = query.get("over") ?? "";
  let tab = query.get("tab") ?? ""; // of the analyses
  const charts = overCycle(places.curves, {
    path,
    rpm,
    turns,
    lever: isLever,
    over,
    turned: hold,
    told: (now) => {
      over = now;
      keepAll();
    },
  });
  angle.listen(charts.turn);
  signal.addEventListener("abort", () => [machines, charts].forEach((part) => part.close()), {
    once: true,
  });
  signal.addEventListener("abort", () => clearTimeout(later), { once: true });

  /** @type {Api.WhatIf | null} */
  let changed = null; // the answer to "what if"
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let later = 0;
  const linked = startOf(query);
  /** @type {Page.Numbers | null} */
  let changedNumbers = linked.lengths ?? null; // of the changed design
  const keepAll = () =>
    keepChoices({
      beside: others.map((one) => one.number).join(","),
      over,
      tab,
      ...changedNumbers,
      as: changedNumbers && called,
      value: changedNumbers?.value?.join(","),
      allow: changedNumbers?.allow?.join(","),
    });
  const further = analyses(
    { sections: places.topics, tabs: places.analyses },
    {
      job,
      number,
      questions,
      fronts: asked.fronts,
      swings: !turns,
      isLever,
      lacking: requirements.lacking,
      tolerances: requirements.tolerances,
      tab,
      chooseTab: (now) => {
        tab = now;
        keepAll();
      },
      signal,
    },
  );
  /** @type {Page.Machine[]} */
  let series = []; // of the curves
  let refused = false; // whether the last change is impossible, so that everything shows the unchanged design
  /** Show the objectives of the first of some designs, and which allowable values all of them violate. @param {Page.Machine[]} designs */
  const glance = (designs) => {
    const [shown] = designs;
    const whose = refused ? `Design ${number} itself: the change is not possible` : "";
    showObjectives(places.objectives, {
      objectives,
      front: rows,
      row: shown.row,
      others,
      before: shown === main ? null : main.row,
      changed: shown === main ? null : { broken: Boolean(changed?.broken.length) },
      whose,
      names,
    });
    fill(
      places.beyond,
      designs.flatMap(({ name, violations }) =>
        violations.map((sentence) =>
          h(
            "p",
            { class: "error" },
            `${name}, beyond the allowable value: ${inDisplayUnits(sentence)}.`,
          ),
        ),
      ),
    );
    for (const note of [ofPlace, ofWay]) note.hidden = shown === main;
  };
  const draw = () => {
    const variant = changed?.cycle && {
      name: "What if",
      series: "what-if",
      row: changed.design,
      allowed: changed.allowed,
      violations: changed.violations,
      ...cycleOf(changed.cycle),
    };
    const moving = [variant ?? main, ...others];
    rename();
    glance(moving);
    machines.show(moving);
    machines.fade(refused);
    series = variant ? [variant, main, ...others] : moving;
    charts.show(series);
    legend(places.curves, series);
    return () => {
      further.show(changed && changedNumbers);
      showNumbers(places.numbers, {
        designs: variant ? [main, variant, ...others] : moving,
        columns: main.columns,
        requirements: requirements.requirements,
        slow: requirements.slow_stroke,
        names,
      });
    };
  };
  const sliders = whatIf(places["what-if"], {
    job,
    path,
    base: main.row,
    columns: main.columns,
    ranges: requirements.ranges,
    requirements: requirements.requirements,
    objectives,
    front: rows,
    signal,
    start: linked.lengths ?? null,
    wrong: linked.wrong ?? "",
    /** @param {Api.WhatIf | null} answer @param {{ lengths?: Page.Numbers, impossible?: boolean, edited?: boolean }} [how] */
    changed(answer, { lengths, impossible = false, edited = false } = {}) {
      called = edited ? "" : called;
      changed = answer;
      refused = impossible;
      clearTimeout(later);
      later = setTimeout(draw(), SOON); // updates the tables once the length stays
      changedNumbers = lengths ?? null;
      for (const each of [files.show, charts.of]) each(changedNumbers);
      keepAll();
    },
  });
  rounding(places.rounding, {
    job,
    number,
    base: main.row,
    columns: main.columns,
    requirements,
    objectives,
    applied: (row, allowed) => {
      called = "Rounded";
      sliders.apply(row, allowed);
    },
    signal,
  });
  draw()();
  const costs = question(
    { title: "Cost of improvements", inputs: [], figure: false },
    { path: `${path}/trade-offs`, job, signal },
  );
  fill(places["trade-offs"], h("h2", {}, "Cost of improvements"), costs.node);
  costs.ask();
  for (const inverse of questions.filter(({ name }) => name === "inverse" && !isLever))
    inverseForm(places.inverse, inverse, {
      path,
      job,
      positions: main.curves.slider_position_mm,
      turnTo: (at) => hold(positionOfAngle(main, at, angle.angle), true),
      signal,
    });
  if (turns)
    get(`${path}/analysis`, { show: "extremes" }, signal)
      .then(({ analysis }) => {
        main.exact = endsOf(/** @type {Api.Extremes} */ (analysis.extremes), main);
        charts.show(series);
      })
      .catch(() => {}); // the analysis of that name reports it
  if (!matchMedia("(prefers-reduced-motion: reduce)").matches) angle.play();
  focusLastStep(place);
}

/**
 * Return the lengths in an address, or what is wrong with them; neither without lengths.
 * @param {URLSearchParams} query @returns {{ lengths?: Page.Numbers, wrong?: string }}
 */
function startOf(query) {
  const texts = LENGTHS.map((key) => /** @type {const} */ ([key, query.get(key)?.trim() || null]));
  if (texts.every(([, text]) => text === null)) return {};
  const bad = texts.find(([, text]) => !Number.isFinite(Number(text ?? NaN)));
  const [value, allow] = ["value", "allow"].map((key) => query.get(key)?.split(","));
  if (!bad)
    return {
      lengths: /** @type {Page.Numbers} */ (
        /** @type {unknown} */ ({
          ...Object.fromEntries(texts.map(([key, text]) => [key, Number(text)])),
          value,
          allow,
        })
      ),
    };
  const [name, text] = [bad[0].replace("_mm", ""), bad[1]];
  return {
    wrong: `A link must give crank, rod and offset as numbers; got ${text === null ? `no ${name}` : `“${text}” as the ${name}`}. The design itself is shown.`,
  };
}

/** @param {HTMLElement} place @param {{ series: number | string, name: string }[]} series */
function legend(place, series) {
  const old = place.querySelector(".legend");
  const items = series.map((one) => h("li", { "data-series": one.series }, one.name));
  const list = h("ul", { class: "legend", hidden: series.length < 2 }, items);
  if (old) old.replaceWith(list);
  else place.prepend(list);
}
