/** Sliders for other lengths ("What if?") and the changed design's place relative to the front. */

import { isAbort, post } from "../lib/api.js";
import { fill, h } from "../lib/dom.js";
import { inDisplayUnits, text, withUnit } from "../lib/numbers.js";
import { link } from "../lib/address.js";
import { frontMap } from "./front_map.js";
import { lengthRow, LENGTHS, SAME } from "./length_row.js";
import { difference } from "./numbers.js";
import { lengthsOf } from "./loading.js";
import { rankOf } from "./rank.js";
import { missText } from "./requirement_text.js";
import { capitalised } from "../lib/words.js";
import { sentenceOf } from "../lib/refusals.js";
import { headedRow, headsOf, numberCell, table } from "../lib/table.js";

/**
 * Put the sliders into `place`.
 * - path: address of the design in the API; base: its row.
 * - ranges, requirements: as the API gives them; objectives, front: those of the job.
 * - start: lengths to begin with, or null; wrong: why the lengths in the page's address cannot be used.
 * - changed(answer, {lengths, impossible}): called with the API's answer that is drawn, null for the design itself, and with the
 *   lengths it belongs to; edited: whether a number was moved or typed; impossible: true if the changed lengths have no answer.
 *
 * Returns {apply(row, allow), lengths(), dimensions()}: apply adopts the numbers of another design with its
 * allowed deviations, lengths returns the lengths that are shown, dimensions returns all changed and unchanged numbers, or null for the design itself.
 * @param {HTMLElement} place
 * @param {{
 *   job: string, path: `jobs/${string}/designs/${number}`, base: Api.Row, columns: Api.Column[], ranges: Api.Requirements["ranges"], requirements: Api.Requirement[],
 *   objectives: Api.Objective[], front: Api.Row[], start: Page.Numbers | null, wrong: string, signal: AbortSignal,
 *   changed: (answer: Api.WhatIf | null, how?: { lengths?: Page.Numbers, impossible?: boolean, edited?: boolean }) => void,
 * }} options
 */
export function whatIf(
  place,
  {
    job,
    path,
    base,
    columns,
    ranges,
    requirements,
    objectives,
    front,
    start,
    wrong: unread,
    changed,
    signal,
  },
) {
  const designLengths = lengthsOf(base);
  const {
    value: linked = [],
    allow: granted = [],
    ...begun
  } = /** @type {Page.Numbers} */ (start ?? designLengths);
  /** @type {Page.Lengths} */
  const lengths = begun;
  const further = Object.keys(ranges).filter((key) => !LENGTHS.some(([length]) => length === key)); // extra variables
  /** Values that differ from the design's. @type {Record<string, number>} */
  let values = numbersOf(linked);
  let allow = numbersOf(granted);
  const rows = LENGTHS.map(([key, title]) =>
    lengthRow(key, title, ranges[key], (value) => {
      if (value !== null) lengths[key] = value;
      last = key.replace("_mm", "");
      keepsLengths = false;
      ask();
    }),
  );
  const extras = columns
    .filter(({ key }) => further.includes(key))
    .map(({ key, title, unit }) =>
      lengthRow(
        key,
        capitalised(title),
        ranges[key],
        (value) => {
          if (value !== null) values[key] = value;
          if (isSame(values[key], base[key])) delete values[key];
          keepsLengths = false;
          ask();
        },
        { unit },
      ),
    );
  const verdict = h("div", { class: "verdict", "aria-live": "polite" });
  const equal = requirements.filter(({ lower, upper }) => lower !== null && lower === upper);
  const holding = h("input", {
    type: "checkbox",
    checked: equal.length > 0,
    onchange: () => {
      keepsLengths = false;
      ask();
    },
  });
  const kept = equal
    .map(({ title, lower, unit }) => `${title} ${withUnit(lower, unit)}`)
    .join(" and ");
  const rule = equal.length
    ? h("label", { class: "holding" }, holding, ` The other lengths follow, to keep ${kept}`)
    : null;
  let last = "crank"; // the last moved length
  let keepsLengths = start !== null; // lengths from a link are shown unchanged
  const results = h("div", { class: "results" });
  const picture = h("div", { class: "map" });
  const reset = h(
    "button",
    { type: "button", onclick: () => apply(base), disabled: true },
    "Reset",
  );
  fill(
    place,
    h("div", { class: "row heading" }, h("h2", {}, "What if?"), reset),
    h(
      "div",
      { class: "lengths" },
      [...rows, ...extras].map((row) => row.node),
    ),
    rule,
    verdict,
    results,
    picture,
  );
  const map = frontMap(picture, { objectives, front });
  /** @type {Api.WhatIf | null} */
  let answer = null;
  let busy = false;
  let again = false;

  /** Return what is wrong with a typed length, or "". */
  const wrong = () => [...rows, ...extras].map((row) => row.wrong()).find(Boolean) ?? "";
  const moved = () =>
    Object.keys(values).length > 0 ||
    LENGTHS.some(([key]) => !isSame(lengths[key], designLengths[key]));

  /** Adopt the numbers of another design. @param {Api.Row} row @param {Record<string, number>} [allowed] */
  function apply(row, allowed = {}) {
    allow = allowed;
    Object.assign(lengths, lengthsOf(row));
    values = Object.fromEntries(
      further
        .map((key) => [key, Number(row[key])])
        .filter(([key, value]) => !isSame(Number(value), base[key])),
    );
    keepsLengths = true;
    showLengths();
    ask();
  }

  /** Ask one question at a time, the latest lengths next: overlapping questions would leave the slider without an answer. */
  async function ask() {
    unread = "";
    reset.disabled = !moved() && !wrong();
    if (busy) {
      again = true;
      return;
    }
    if (wrong()) return refuse(wrong());
    if (!moved()) {
      answer = null;
      changed(null);
      showDesign();
      return;
    }
    busy = true;
    try {
      const reply = await post(
        `${path}/what-if`,
        {
          ...lengths,
          values,
          allow,
          angles: 180,
          hold: holding.checked && !keepsLengths ? last : null,
          nearest: true,
        },
        { signal },
      );
      if (moved() && !wrong()) {
        answer = reply;
        if (holding.checked && !keepsLengths && !again) adoptLengths(reply.design);
        const [value, allow] = [values, reply.allowed].map((numbers) =>
          Object.entries(numbers).map((pair) => pair.join("=")),
        );
        changed(reply, {
          lengths: { ...lengthsOf(reply.design), value, allow },
          edited: !keepsLengths,
        });
        showDesign();
      }
    } catch (error) {
      if (isAbort(error)) return;
      if (moved()) refuse(wrong() || sentenceOf(error));
    } finally {
      busy = false;
      if (again && !signal.aborted) {
        again = false;
        ask();
      }
    }
  }

  /** Show why there is no answer. @param {string} sentence */
  function refuse(sentence) {
    answer = null;
    changed(null, { impossible: true });
    fill(verdict, h("p", { class: "bad", role: "alert" }, sentence));
    fill(results);
    map.show(base, null);
  }

  /** Show the resulting lengths. @param {Api.Row} design */
  function adoptLengths(design) {
    const to = lengthsOf(design);
    for (const row of rows) {
      if (row.key === `${last}_mm`) continue;
      lengths[row.key] = to[row.key];
      row.show(to[row.key]);
    }
  }

  function showDesign() {
    map.show(base, answer?.design ?? null);
    if (!answer) {
      fill(
        verdict,
        unread
          ? h("p", { class: "bad", role: "alert" }, unread)
          : h("p", { class: "quiet" }, "Change a number; all results are recomputed as you do so."),
      );
      fill(results);
      return;
    }
    fill(verdict, stopped(), sentences(answer, { ranges, requirements }, objectives, job));
    fill(results, comparison(objectives, base, answer.design));
  }

  /** Return why the moved length stops before its slider, with both ways to continue; null if it does not. */
  function stopped() {
    const row = rows.find(({ key }) => key === `${last}_mm`);
    const reached = Number(answer?.design[`${last}_mm`]);
    if (!row || !rule || Math.abs(reached - lengths[row.key]) <= SAME * Math.abs(reached))
      return null;
    const [asked, nearest] = [lengths[row.key], reached].map((value) => withUnit(value, "mm", 4));
    /** @param {string} label @param {() => void} act */
    const way = (label, act) =>
      h("button", { type: "button", onclick: () => [act(), ask()] }, label);
    return h(
      "div",
      { class: "warning" },
      h(
        "p",
        {},
        `With ${kept}, the ${last} reaches ${nearest}, not ${asked}. Results are for ${nearest}.`,
      ),
      way(`Stay at ${nearest}`, () => row.show((lengths[row.key] = reached))),
      way(`Drop ${kept}`, () => (holding.checked = false)),
    );
  }

  function showLengths() {
    for (const row of rows) row.show(lengths[row.key]);
    for (const row of extras) row.show(values[row.key] ?? Number(base[row.key]));
  }

  showLengths();
  showDesign();
  if (moved()) ask();
  const lengthsNow = () => ({ ...(answer ? lengthsOf(answer.design) : lengths) });
  return {
    apply,
    lengths: lengthsNow,
    dimensions: () => (moved() ? { ...lengthsNow(), ...values } : null),
  };
}

/** Return whether a number is that of the design, within rounding. @param {number} value @param {Api.Row[string]} own */
function isSame(value, own) {
  return Math.abs(value - Number(own)) <= SAME * Math.abs(Number(own) || 1);
}

/** Return numbers by column from texts such as "stroke_mm=0.05". @param {string[]} texts @returns {Record<string, number>} */
function numbersOf(texts) {
  return Object.fromEntries(
    texts.map((text) => text.split("=")).map(([key, value]) => [key, Number(value)]),
  );
}

/** @param {Api.Objective[]} objectives @param {Api.Row} before @param {Api.Row} after */
function comparison(objectives, before, after) {
  const rows = objectives.map((objective) => {
    const [from, to] = [before, after].map((row) => row[objective.column]);
    const gain = rankOf(from, objective) - rankOf(to, objective);
    const same = Math.abs(gain) <= SAME * Math.abs(Number(from) || 1);
    const word = same ? "same" : gain > 0 ? "better" : "worse";
    return headedRow(
      objective.title,
      h("td", { class: "number quiet" }, text(from, objective.unit)),
      numberCell(objective.column, to, withUnit(to, objective.unit)),
      h(
        "td",
        { class: same ? "quiet" : gain > 0 ? "good" : "bad" },
        same ? "= same" : `${gain > 0 ? "▲" : "▼"} ${word}`,
        same ? null : h("span", { class: "quiet by" }, difference(to, from, objective.unit)),
      ),
    );
  });
  const heads = headsOf(["Objective", "before", "after", "change"], (n) => n === 1 || n === 2);
  const node = table("Objectives before and after the change", heads, rows);
  node.classList.add("before-after");
  return node;
}

/**
 * Return the faults of a changed design and its place relative to the front.
 * @param {Api.WhatIf} answer @param {Pick<Api.Requirements, "ranges" | "requirements">} asked @param {Api.Objective[]} objectives @param {string} job
 */
function sentences(answer, { ranges, requirements }, objectives, job) {
  const {
    broken,
    deviations,
    outside,
    dominated_by: better,
    dominated_by_count: count,
    dominates_count: beaten,
    design,
    undefined: missing,
  } = answer;
  const reasons = [...broken, ...objectives.map(({ column }) => column)]
    .map((column) => missing[column])
    .filter(Boolean);
  const faults = [
    ...broken.flatMap((column) => missed(column, design, requirements)),
    ...[...new Set(reasons)].map((reason) => `No value: ${reason}.`),
  ];
  const verdict = count
    ? [
        `Dominated: ${count === 1 ? "one design on the front is" : `${count} designs on the front are`} at least as good in every objective: `,
        better
          .slice(0, 3)
          .map((number, n) => [
            n ? ", " : "",
            h("a", { href: link(["jobs", job, "designs", number]) }, `design ${number}`),
          ]),
        count > 3 ? ", …" : "",
      ]
    : broken.length
      ? "No listed design is better in every objective, but this one misses a requirement."
      : beaten
        ? `Beyond the front: it dominates ${beaten === 1 ? "one design" : `${beaten} designs`} of it.`
        : "No listed design is better in every objective.";
  return [
    faults.map((sentence) => h("p", { class: "bad" }, sentence)),
    deviations.map((words) =>
      h("p", { class: "at-limit" }, `${inDisplayUnits(capitalised(words))}.`),
    ),
    LENGTHS.filter(([key]) => outside.includes(key)).map(([key, title]) => {
      const [lower, upper] = ranges[key];
      const range = { title: title.toLowerCase(), unit: "mm", lower, upper };
      return h("p", { class: "at-limit" }, missText(design[key], range, "Outside the job"));
    }),
    h("p", { class: count || broken.length ? null : "good" }, verdict),
  ];
}

/** Return a sentence on a missed requirement. @param {string} column @param {Api.Row} design @param {Api.Requirement[]} requirements */
function missed(column, design, requirements) {
  if (column === "slow_stroke")
    return design.slow_stroke === "equal"
      ? "Misses a requirement: neither stroke is the slow one."
      : `Misses a requirement: the slow stroke is the ${design.slow_stroke} one.`;
  return requirements
    .filter((one) => one.column === column)
    .map((one) => missText(design[column], one));
}
