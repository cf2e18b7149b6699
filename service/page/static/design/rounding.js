/** Round numbers for a design: a step for each number, misses that are allowed, the best rounded neighbours and what each of them costs. */

import { isAbort, postFollowed } from "../lib/api.js";
import { fill, formOf, h, numberField } from "../lib/dom.js";
import { inShownUnits, plainUnitOf, system, text, unitOf, withUnit } from "../lib/numbers.js";
import { parseNumber } from "../lib/number_text.js";
import { kindOf, measureOf } from "../lib/units.js";
import { capital } from "../lib/words.js";
import { rankOf } from "./rank.js";
import { difference } from "./numbers.js";
import { sentenceOf } from "../lib/refusals.js";
import { headsOf, numberCell, scrolledTable } from "../lib/table.js";

const USUAL = { si: "0.5", inch: "1/64" }; // mm, in: what drawings and stock are made to
const COUNT = 5;

/** @typedef {{ name: string, label: string, unit: string, input: HTMLInputElement, said: HTMLElement, wrong: () => string }} Field */

/**
 * Put the steps into `place`. base: row of the design; columns: of it; applied(row): the numbers of a row are to be shown. Returns {draw()}: anew,
 * in other units.
 * @param {HTMLElement} place
 * @param {{
 *   job: string, number: number, base: Api.Row, columns: Api.Column[], requirements: Api.Requirements, objectives: Api.Objective[],
 *   applied: (row: Api.Row) => void, signal: AbortSignal,
 * }} given
 */
export function rounding(
  place,
  { job, number, base, columns, requirements, objectives, applied, signal },
) {
  const { ranges } = requirements;
  const numbers = columns.filter(({ key }) => key in ranges);
  const free = numbers.filter(({ key }) => ranges[key][0] < ranges[key][1]);
  const steps = h("div", { class: "steps" });
  const misses = h("div", { class: "steps" });
  const others = h("div", { class: "steps" });
  const wrong = h("p", { class: "bad", role: "alert", hidden: true });
  const answer = h("div", { "aria-live": "polite" });
  const button = h("button", {}, "Find round numbers");
  const exact = requirements.requirements.filter(
    ({ lower, upper }) => lower !== null && lower === upper,
  );
  const bounds = requirements.requirements.filter((one) => !exact.includes(one));
  const form = formOf(
    ask,
    steps,
    misses,
    bounds.length > 0 && h("details", {}, h("summary", {}, "Allow misses of bounds"), others),
    button,
    wrong,
  );
  fill(
    place,
    h("h2", {}, "Round it"),
    h(
      "p",
      { class: "quiet hint" },
      "The best designs of round numbers near this one that keep every requirement, or miss it by no more than you allow. Without a step a number stays as it is.",
    ),
    form,
    answer,
  );
  place.hidden = free.length === 0;
  /** @type {{ steps: Field[], misses: Field[] }} */
  let fields = { steps: [], misses: [] };
  /** @type {AbortController | null} */
  let search = null;
  signal.addEventListener("abort", () => search?.abort(), { once: true });

  function draw() {
    search?.abort();
    fields = {
      steps: free.map(({ key, title, unit }) => {
        const kind = unit === "mm" ? "a length" : "a value";
        return field({
          id: `step-${key}`,
          name: key,
          label: `${capital(title)}, step`,
          unit,
          value: unit === "mm" ? USUAL[system()] : "",
          wrong: () =>
            `The step of the ${title} is ${kind} above 0${unit === "mm" ? `, such as ${USUAL[system()]}` : ""}; leave it empty to keep the ${kind.slice(2)}.`,
        });
      }),
      misses: [...exact, ...bounds].map(({ quantity, column, title, unit }) =>
        field({
          id: `miss-${column}`,
          name: quantity,
          label: `${capital(title)}, allowed miss`,
          unit,
          value: "",
          wrong: () =>
            `The allowed miss of the ${title} is a value above 0; leave it empty to allow none.`,
        }),
      ),
    };
    fill(steps, fields.steps.map(shown));
    fill(misses, fields.misses.slice(0, exact.length).map(shown));
    fill(others, fields.misses.slice(exact.length).map(shown));
    fill(answer);
    refuse("");
  }

  /** Say what is wrong with all of it; nothing with an empty sentence. @param {string} sentence */
  function refuse(sentence) {
    wrong.textContent = sentence;
    wrong.hidden = sentence === "";
  }

  async function ask() {
    const to = textsOf(fields.steps);
    const allow = textsOf(fields.misses);
    fill(answer);
    refuse(to?.length === 0 ? "No number has a step; write one of them." : "");
    if (!to?.length || !allow) return;
    search?.abort();
    const own = new AbortController();
    search = own;
    button.disabled = true;
    const bar = h("progress", { "aria-label": "Progress of the search" });
    const at = h("span", { class: "quiet" }, "Waiting for its turn");
    const stop = h("button", { type: "button", onclick: () => own.abort() }, "Stop");
    fill(answer, h("p", { class: "row searching" }, bar, at, stop));
    stop.focus();
    /** @param {Record<string, unknown>} progress */
    const told = ({ stage, step, steps: count }) => {
      bar.max = Math.max(1, Number(count));
      bar.value = Number(step);
      at.textContent = `${capital(String(stage))}: ${text(Number(step), "", 7)} of ${text(Number(count), "", 7)}`;
    };
    try {
      const found = await postFollowed(
        `jobs/${job}/designs/${number}/rounded`,
        { to, allow, count: COUNT },
        { signal: own.signal, told },
      );
      tell(/** @type {Api.Rounded} */ (/** @type {unknown} */ (found.rounded)));
    } catch (error) {
      if (own !== search || signal.aborted) return;
      fill(answer, isAbort(error) && h("p", { class: "quiet" }, "Stopped."));
      if (!isAbort(error)) refuse(`${sentenceOf(error).replace(/^To must/, "A step must")}.`);
    } finally {
      if (own === search) button.disabled = false;
    }
  }

  /** @param {Api.Rounded} found */
  function tell(found) {
    const heads = [
      h("span", { class: "hidden" }, "Apply"),
      ...numbers.map(({ title }) => capital(title)),
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
              onclick: () => applied(row),
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
      h("p", { class: found.met ? null : "bad" }, `${inShownUnits(capital(found.message))}.`),
      found.designs.length > 0 &&
        scrolledTable(
          "Round numbers and what they cost",
          headsOf(heads, (n) => n && n < heads.length - 1),
          lines,
        ),
      found.notes.map((note) => h("p", { class: "quiet hint" }, `${capital(note)}.`)),
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
    const title = requirements.requirements.find(({ quantity }) => quantity === tightest)?.title;
    return h("span", { class: "quiet" }, title ? `tightest: ${title}` : "all kept");
  }

  draw();
  return { draw };
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

/** @param {{ id: string, name: string, label: string, unit: string, value: string, wrong: () => string }} of @returns {Field} */
function field({ id, name, label, unit, value, wrong }) {
  const said = h("p", { class: "bad", id: `${id}-wrong` });
  /** @type {HTMLInputElement} */
  const input = numberField({
    id,
    value,
    "aria-describedby": `${id}-wrong`,
    oninput: () => say(input, said, ""),
  });
  return { name, label, unit, input, said, wrong };
}

/** @param {Field} of */
function shown({ input, said, unit, label }) {
  return h(
    "div",
    { class: "step" },
    h("label", { for: input.id }, label),
    input,
    h("span", { class: "quiet" }, unitOf(unit)),
    said,
  );
}

/** @param {HTMLInputElement} input @param {HTMLElement} place @param {string} sentence */
function say(input, place, sentence) {
  place.textContent = sentence;
  if (sentence) input.setAttribute("aria-invalid", "true");
  else input.removeAttribute("aria-invalid");
}

/** Return what fields say as the service takes it; null where one is wrong. @param {Field[]} fields @returns {string[] | null} */
function textsOf(fields) {
  let fine = true;
  const found = fields.flatMap(({ name, unit, input, said, wrong }) => {
    const plain = plainUnitOf(unit);
    const typed = parseNumber(input.value, { unit: plain, ...measureOf(kindOf(plain)) });
    if (typed.empty) return [];
    const sentence =
      typed.wrong ??
      (Number(typed.number) > 0 && Number.isFinite(Number(typed.number)) ? "" : wrong());
    say(input, said, sentence);
    if (sentence && fine) input.focus();
    fine &&= !sentence;
    return [`${name}=${typed.number} ${typed.number === undefined ? "" : typed.unit}`.trim()];
  });
  return fine ? found : null;
}
