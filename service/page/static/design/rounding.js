/** Rounded dimensions for a design: a step for each number, permitted misses, the best rounded neighbours and the cost of each. */

import { isAbort, postWithProgress } from "../lib/api.js";
import { fill, formOf, h, markInvalid, numberField } from "../lib/dom.js";
import { inDisplayUnits, plainUnitOf, system, text, unitOf, withUnit } from "../lib/numbers.js";
import { parseNumber } from "../lib/number_text.js";
import { kindOf, measureOf } from "../lib/units.js";
import { capitalised } from "../lib/words.js";
import { rankOf } from "./rank.js";
import { difference } from "./numbers.js";
import { sentenceOf } from "../lib/refusals.js";
import { headsOf, numberCell, scrolledTable } from "../lib/table.js";

// mm, in; usual steps of drawings and stock, and a usual deviation of an exact length
const [USUAL, MISS] = [
  { si: "0.5", inch: "1/64" },
  { si: "0.05", inch: "0.002" },
];
const COUNT = 5;

/** @typedef {{ name: string, unit: string, input: HTMLInputElement, refuse: (sentence: string) => void, rule: string, node: HTMLElement }} Field */

/**
 * Put the form into `place`. base: row of the design. columns: its columns. applied(row): called to show the numbers of a row.
 * @param {HTMLElement} place
 * @param {{
 *   job: string, number: number, base: Api.Row, columns: Api.Column[], requirements: Api.Requirements, objectives: Api.Objective[],
 *   applied: (row: Api.Row, allowed: Record<string, number>) => void, signal: AbortSignal,
 * }} options
 */
export function rounding(
  place,
  { job, number, base, columns, requirements, objectives, applied, signal },
) {
  const { ranges } = requirements;
  const numbers = columns.filter(({ key }) => key in ranges);
  const free = numbers.filter(({ key }) => ranges[key][0] < ranges[key][1]);
  const wrong = h("p", { class: "bad", role: "alert", hidden: true });
  const answer = h("div", { "aria-live": "polite" });
  const button = h("button", {}, "Find round numbers");
  const steps = free.map(({ key, title, unit }) => {
    const kind = unit === "mm" ? "length" : "value";
    const usual = unit === "mm" ? USUAL[system()] : "";
    return field({
      id: `step-${key}`,
      name: key,
      label: `${capitalised(title)}, step`,
      unit,
      value: usual,
      rule: `The step of the ${title} must be a ${kind} above 0${usual && `, such as ${usual}`}; leave the field empty to keep the ${kind}.`,
    });
  });
  const [exact, bounds] = [true, false].map((equal) =>
    requirements.requirements
      .filter(({ lower, upper }) => (lower !== null && lower === upper) === equal)
      .map(({ quantity, column, title, unit }) =>
        field({
          id: `miss-${column}`,
          name: quantity,
          label: `${capitalised(title)}, allowed deviation`,
          unit,
          value: equal && unit === "mm" ? MISS[system()] : "",
          rule: `The allowed deviation of the ${title} must be above 0; leave the field empty to allow none.`,
        }),
      ),
  );
  /** @param {Field[]} fields */
  const fieldset = (fields) =>
    h(
      "div",
      { class: "steps" },
      fields.map(({ node }) => node),
    );
  const form = formOf(
    ask,
    fieldset(steps),
    fieldset(exact),
    bounds.length > 0 &&
      h("details", {}, h("summary", {}, "Allow small violations of bounds"), fieldset(bounds)),
    button,
    wrong,
  );
  fill(
    place,
    h("h2", {}, "Round it"),
    h(
      "p",
      { class: "quiet hint" },
      "Finds the best designs with round numbers near this one. They meet every requirement, or deviate by no more than you allow. A number without a step does not change.",
    ),
    form,
    answer,
  );
  place.hidden = free.length === 0;
  /** @type {AbortController | null} */
  let search = null;
  signal.addEventListener("abort", () => search?.abort(), { once: true });

  /** Show what is wrong with the whole form; an empty sentence clears it. @param {string} sentence */
  function refuse(sentence) {
    wrong.textContent = sentence;
    wrong.hidden = sentence === "";
  }

  async function ask() {
    const to = textsOf(steps);
    const allow = textsOf([...exact, ...bounds]);
    fill(answer);
    refuse(to?.length === 0 ? "No number has a step; enter at least one." : "");
    if (!to?.length || !allow) return;
    search?.abort();
    const control = new AbortController();
    search = control;
    button.disabled = true;
    const bar = h("progress", { "aria-label": "Progress of the search" });
    const progress = h("span", { class: "quiet" }, "Waiting");
    const stop = h("button", { type: "button", onclick: () => control.abort() }, "Stop");
    fill(answer, h("p", { class: "row searching" }, bar, progress, stop));
    stop.focus();
    /** @param {Record<string, unknown>} progress */
    const told = ({ stage, step, steps: count }) => {
      bar.max = Math.max(1, Number(count));
      bar.value = Number(step);
      progress.textContent = `${capitalised(String(stage))}: ${text(Number(step), "", 7)} of ${text(Number(count), "", 7)}`;
    };
    try {
      const event = await postWithProgress(
        `jobs/${job}/designs/${number}/rounded`,
        { to, allow, count: COUNT },
        { signal: control.signal, told },
      );
      showRounded(/** @type {Api.Rounded} */ (/** @type {unknown} */ (event.rounded)));
    } catch (error) {
      if (control !== search || signal.aborted) return;
      fill(answer, isAbort(error) && h("p", { class: "quiet" }, "Stopped."));
      if (!isAbort(error)) refuse(`${sentenceOf(error).replace(/^To must/, "A step must")}.`);
    } finally {
      if (control === search) button.disabled = false;
    }
  }

  /** @param {Api.Rounded} found */
  function showRounded(found) {
    const heads = [
      h("span", { class: "hidden" }, "Apply"),
      ...numbers.map(({ title }) => capitalised(title)),
      ...objectives.map(({ title }) => title),
      "Requirements",
    ];
    const lines = found.designs.map((row, n) =>
      h(
        "tr",
        {},
        h(
          "td",
          {},
          h(
            "button",
            {
              type: "button",
              "aria-label": `Apply round numbers ${n + 1}`,
              onclick: () => applied(row, found.allowed),
            },
            "Apply",
          ),
        ),
        numbers.map(({ key, unit }) => numberCell(key, row[key], withUnit(row[key], unit, 7))),
        objectives.map((objective) => cost(row, objective)),
        h("td", {}, judged(row)),
      ),
    );
    fill(
      answer,
      h("p", { class: found.met ? null : "bad" }, `${inDisplayUnits(capitalised(found.message))}.`),
      found.designs.length > 0 &&
        scrolledTable(
          "Round numbers and their cost",
          headsOf(heads, (n) => n && n < heads.length - 1),
          lines,
        ),
      found.designs.length > 1 &&
        h(
          "p",
          { class: "quiet hint" },
          "Sorted by the greatest loss in an objective, relative to its range over the front; least first.",
        ),
      found.notes.map((note) => h("p", { class: "quiet hint" }, `${capitalised(note)}.`)),
    );
  }

  /** @param {Api.RoundedRow} row @param {Api.Objective} objective */
  function cost(row, objective) {
    const [before, after] = [base[objective.column], row[objective.column]];
    const gain = rankOf(before, objective) - rankOf(after, objective);
    const by = difference(after, before);
    return numberCell(
      objective.column,
      after,
      withUnit(after, objective.unit),
      h("div", { class: by === "=" || !gain ? "quiet" : gain > 0 ? "good" : "bad" }, by),
    );
  }

  /** @param {Api.RoundedRow} row */
  function judged({ misses: beyond, tightest }) {
    if (beyond.length) return beyond.map(missed);
    const title = requirements.requirements.find(
      ({ quantity, lower, upper }) => quantity === tightest && lower !== upper,
    )?.title;
    return h("span", { class: "quiet" }, title ? `tightest: ${title}` : "all met");
  }
}

/** @param {Api.Miss} miss */
function missed({ quantity, title, amount, unit, side, allowed }) {
  return h(
    "div",
    {
      class: amount > allowed ? "bad" : "at-limit",
      "data-miss": quantity,
      "data-value": String(amount),
    },
    `${title} ${withUnit(amount, unit, 4)} ${side === "above" ? "too high" : "too low"}${allowed ? `, ${withUnit(allowed, unit, 4)} allowed` : ""}`,
  );
}

/** @param {{ id: string, name: string, label: string, unit: string, value: string, rule: string }} of @returns {Field} */
function field({ id, name, label, unit, value, rule }) {
  const error = h("p", { class: "bad", id: `${id}-wrong` });
  /** @param {string} sentence */
  const refuse = (sentence) => {
    error.textContent = sentence;
    markInvalid(input, sentence);
  };
  /** @type {HTMLInputElement} */
  const input = numberField({
    id,
    value,
    "aria-describedby": error.id,
    oninput: () => refuse(""),
  });
  const node = h(
    "div",
    { class: "step" },
    h("label", { for: id }, label),
    input,
    h("span", { class: "quiet" }, unitOf(unit)),
    error,
  );
  return { name, unit, input, refuse, rule, node };
}

/** Return the values of the fields for the service; null if one is invalid. @param {Field[]} fields @returns {string[] | null} */
function textsOf(fields) {
  const values = fields.map(({ name, unit, input, refuse, rule }) => {
    const plain = plainUnitOf(unit);
    const typed = parseNumber(input.value, { unit: plain, ...measureOf(kindOf(plain)) });
    const right =
      typed.empty || (Number(typed.number) > 0 && Number.isFinite(Number(typed.number)));
    refuse(typed.wrong ?? (right ? "" : rule));
    if (typed.number === undefined) return typed.empty ? "" : false;
    return right && `${name}=${typed.number} ${typed.unit}`.trim();
  });
  const first = values.indexOf(false);
  if (first >= 0) fields[first].input.focus();
  return first < 0
    ? values.filter((text) => typeof text === "string" && text !== "").map(String)
    : null;
}
