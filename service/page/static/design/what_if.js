/** Sliders for other lengths ("What if?"), and where the change leaves the front. */

import { isAbort, post } from "../lib/api.js";
import { fill, h, numberField } from "../lib/dom.js";
import { parseQuantity } from "../lib/quantity_text.js";
import { inShown, text, unitOf, withUnit } from "../lib/numbers.js";
import { link } from "../lib/address.js";
import { frontMap } from "./front_map.js";
import { difference } from "./numbers.js";
import { lengthsOf } from "./loading.js";
import { bookmarkForm } from "./bookmark_form.js";
import { rankOf } from "./rank.js";
import { sentenceOf } from "../lib/refusals.js";
import { headedRow, headsOf, numberCell, table } from "../lib/table.js";

/** @type {[keyof Page.Lengths, string][]} */
const LENGTHS = [
  ["crank_mm", "Crank"],
  ["rod_mm", "Rod"],
  ["offset_mm", "Offset"],
];
const STEPS = 1000; // of a slider over its range
const SAME = 1e-9; // relative

/**
 * Put the sliders into `place`. path: of the design in the API; base: its row; ranges, requirements: of the API; objectives, front:
 * of the job; start: lengths to begin with, or null; wrong: why those of the link are none. changed(answer, {lengths, impossible}): the answer of the API that is drawn
 * and its numbers, null for the design itself; impossible: since the change has no answer. Returns {draw()}: once more, in other units, and {apply(row)}: to the numbers of another design.
 * @param {HTMLElement} place
 * @param {{
 *   job: string, path: `jobs/${string}/designs/${number}`, base: Api.Row, columns: Api.Column[], ranges: Api.Requirements["ranges"], requirements: Api.Requirement[],
 *   objectives: Api.Objective[], front: Api.Row[], start: Page.Numbers | null, wrong: string, signal: AbortSignal,
 *   changed: (answer: Api.WhatIf | null, how?: { lengths?: Page.Numbers, impossible?: boolean }) => void,
 * }} given
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
  const own = lengthsOf(base);
  const { value: linked = [], ...begun } = /** @type {Page.Numbers} */ (start ?? own);
  /** @type {Page.Lengths} */
  const lengths = begun;
  const further = Object.keys(ranges).filter((key) => !LENGTHS.some(([length]) => length === key)); // numbers that vary besides
  /** Of these those that are others than the design's. @type {Record<string, number>} */
  let values = Object.fromEntries(
    linked.map((text) => text.split("=")).map(([key, value]) => [key, Number(value)]),
  );
  /** @type {ReturnType<typeof lengthRow>[]} */
  let rows = [];
  const controls = h("div", { class: "lengths" });
  const besides = h("p", { class: "quiet besides", hidden: true });
  const verdict = h("div", { class: "verdict", "aria-live": "polite" });
  const equal = requirements.filter(({ lower, upper }) => lower !== null && lower === upper);
  const holding = h("input", {
    type: "checkbox",
    checked: equal.length > 0,
    onchange: () => {
      given = false;
      ask();
    },
  });
  const rule = equal.length
    ? h(
        "label",
        { class: "holding" },
        holding,
        ` The other lengths follow, to keep ${equal.map(({ title, lower, unit }) => `${title} ${withUnit(lower, unit)}`).join(" and ")}`,
      )
    : null;
  let last = "crank"; // the length that was moved last
  let given = start !== null; // the lengths of a link are shown as they are
  const results = h("div", { class: "results" });
  const picture = h("div", { class: "map" });
  const reset = h(
    "button",
    { type: "button", onclick: () => apply(base), disabled: true },
    "Reset",
  );
  const keep = bookmarkForm({
    job,
    design: Number(path.split("/").pop()),
    dimensions: () =>
      moved() ? { ...(answer ? lengthsOf(answer.design) : lengths), ...values } : null,
    lengths: () => ({ ...(answer ? lengthsOf(answer.design) : lengths) }),
  });
  fill(
    place,
    h("div", { class: "row heading" }, h("h2", {}, "What if?"), reset),
    controls,
    besides,
    rule,
    verdict,
    results,
    keep,
    picture,
  );
  const map = frontMap(picture, { objectives, front });
  /** @type {Api.WhatIf | null} */
  let answer = null;
  let busy = false;
  let again = false;

  /** Return what is wrong with a length that was typed; nothing with "". */
  const wrong = () => rows.map((row) => row.wrong()).find(Boolean) ?? "";
  const moved = () =>
    Object.keys(values).length > 0 ||
    LENGTHS.some(([key]) => Math.abs(lengths[key] - own[key]) > SAME * Math.abs(own[key] || 1));

  /** Go to the numbers of another design. @param {Api.Row} row */
  function apply(row) {
    Object.assign(lengths, lengthsOf(row));
    values = Object.fromEntries(
      further
        .map((key) => [key, Number(row[key])])
        .filter(
          ([key, value]) =>
            Math.abs(Number(value) - Number(base[key])) > SAME * Math.abs(Number(base[key])),
        ),
    );
    given = true;
    showLengths();
    ask();
  }

  /** One question at a time, the latest lengths next: questions that overtake each other would leave the slider without answer. */
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
      tell();
      return;
    }
    busy = true;
    try {
      const found = await post(
        `${path}/what-if`,
        { ...lengths, values, angles: 180, hold: holding.checked && !given ? last : null },
        { signal },
      );
      if (moved() && !wrong()) {
        answer = found;
        if (holding.checked && !given && !again) follow(found.design);
        const others = Object.entries(values).map(([key, value]) => `${key}=${value}`);
        changed(found, {
          lengths: { ...lengthsOf(found.design), ...(others.length ? { value: others } : {}) },
        });
        tell();
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

  /** Say why there is no answer, in its place. @param {string} sentence */
  function refuse(sentence) {
    answer = null;
    changed(null, { impossible: true });
    fill(verdict, h("p", { class: "bad", role: "alert" }, sentence));
    fill(results);
    map.show(base, null);
  }

  /** Let the other lengths stand where they followed to. @param {Api.Row} design */
  function follow(design) {
    const to = lengthsOf(design);
    for (const row of rows) {
      if (row.key === `${last}_mm`) continue;
      lengths[row.key] = to[row.key];
      row.show(to[row.key]);
    }
  }

  function tell() {
    map.show(base, answer?.design ?? null);
    if (!answer) {
      fill(
        verdict,
        unread
          ? h("p", { class: "bad", role: "alert" }, unread)
          : h(
              "p",
              { class: "quiet" },
              "Move a length; everything is computed anew as you move it.",
            ),
      );
      fill(results);
      return;
    }
    fill(verdict, sentences(answer, requirements, objectives, job));
    fill(results, comparison(objectives, base, answer.design));
  }

  function drawControls() {
    rows = LENGTHS.map(([key, title]) =>
      lengthRow(key, title, ranges[key], (value) => {
        if (value !== null) lengths[key] = value;
        last = key.replace("_mm", "");
        given = false;
        ask();
      }),
    );
    fill(
      controls,
      rows.map((row) => row.node),
    );
    showLengths();
  }

  function showLengths() {
    for (const row of rows) row.show(lengths[row.key]);
    const named = columns.filter(({ key }) => key in values);
    besides.hidden = named.length === 0;
    besides.textContent = `Changed too: ${named.map(({ key, title, unit }) => `${title} ${withUnit(values[key], unit)}, was ${text(base[key], unit)}`).join("; ")}`;
  }

  drawControls();
  tell();
  if (moved()) ask();
  return {
    apply,
    draw() {
      drawControls();
      map.arrange();
      tell();
    },
  };
}

/**
 * set(value): a length was chosen, null where what was typed is none.
 * @param {keyof Page.Lengths} key @param {string} title @param {readonly number[]} ends @param {(value: number | null) => void} set
 */
function lengthRow(key, title, [low, high], set) {
  const fixed = low === high;
  /** @param {number} value */
  const digits = (value) => Number(inShown(value, "mm").toPrecision(6));
  const id = `what-if-${key}`;
  const outside = h(
    "span",
    { class: "at-limit", role: "status", hidden: true },
    " · outside the job",
  );
  let refused = ""; // why what was typed is no length
  const number = numberField({
    id,
    disabled: fixed,
    oninput: type,
    onchange: order,
  });
  const understood = h("span", { class: "quiet ends", role: "status" }); // how a sum or another unit was read
  const slider = h("input", {
    type: "range",
    min: 0,
    max: STEPS,
    step: 1,
    disabled: fixed,
    "aria-label": `${title}, slider`,
    oninput: () => {
      const value = low + (Number(slider.value) / STEPS) * (high - low);
      const at = slider.value;
      show(value);
      slider.value = at;
      set(value);
    },
  });

  /** Return what the field says, or why it is no length. @returns {{ value?: number, said?: string | null, wrong?: string }} */
  function typed() {
    const found = parseQuantity(number.value, "mm");
    if (found.value !== undefined && (found.value > 0 || key === "offset_mm")) return found;
    return {
      wrong:
        found.wrong ??
        `${title} needs a length${key === "offset_mm" ? "" : " above 0"}${found.empty ? "" : `; got ${number.value.trim()}`}.`,
    };
  }

  function type() {
    const { value, said, wrong } = typed();
    refused = wrong ?? "";
    understood.textContent = said ?? "";
    number.setAttribute("aria-invalid", String(value === undefined));
    mark(value ?? low);
    if (value !== undefined) slide(value);
    set(value ?? null);
  }

  /** Put the length that was understood in place of what was typed, and leave in sight how. */
  function order() {
    const { value, said } = typed();
    if (value === undefined) return;
    show(value);
    understood.textContent = said ?? "";
  }

  /** @param {number} value */
  function slide(value) {
    slider.value = String(high > low ? (STEPS * (value - low)) / (high - low) : 0);
    slider.setAttribute("aria-valuetext", withUnit(value, "mm", 5));
  }

  /** @param {number} value */
  function show(value) {
    refused = understood.textContent = "";
    number.value = String(digits(value));
    number.setAttribute("aria-invalid", "false");
    mark(value);
    slide(value);
  }

  /** Say whether a length is outside of the ranges of the job. @param {number} value */
  function mark(value) {
    outside.hidden =
      fixed || (value >= low - SAME * Math.abs(low) && value <= high + SAME * Math.abs(high));
  }

  return {
    key,
    node: h(
      "div",
      { class: "length" },
      h("label", { for: id }, title),
      slider,
      number,
      h("span", { class: "quiet" }, unitOf("mm")),
      h(
        "span",
        { class: "quiet ends" },
        fixed ? "fixed by the job" : `${text(low, "mm", 4)} to ${withUnit(high, "mm", 4)}`,
        outside,
      ),
      understood,
    ),
    show,
    wrong: () => refused,
  };
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
        same ? null : h("span", { class: "quiet by" }, difference(to, from)),
      ),
    );
  });
  const heads = headsOf(["Objective", "before", "after", "change"], (n) => n === 1 || n === 2);
  const found = table("Objectives before and after the change", heads, rows);
  found.classList.add("before-after");
  return found;
}

/** @param {Api.WhatIf} answer @param {Api.Requirement[]} requirements @param {Api.Objective[]} objectives @param {string} job */
function sentences(answer, requirements, objectives, job) {
  const {
    broken,
    dominated_by: better,
    dominated_by_count: count,
    dominates_count: beaten,
    design,
    undefined: missing,
  } = answer;
  const found = broken.map((column) => {
    if (column === "slow_stroke")
      return h(
        "p",
        { class: "bad" },
        design.slow_stroke === "equal"
          ? "Misses a requirement: neither stroke is the slow one."
          : `Misses a requirement: the slow stroke is the ${design.slow_stroke} one.`,
      );
    const asked = requirements.find((one) => one.column === column);
    return asked
      ? h(
          "p",
          { class: "bad" },
          `Misses a requirement: ${asked.title} ${design[column] === null ? "has no value" : withUnit(design[column], asked.unit)}; must be ${bounds(asked)}.`,
        )
      : null;
  });
  const reasons = [...broken, ...objectives.map(({ column }) => column)]
    .map((column) => missing[column])
    .filter(Boolean);
  found.push(
    ...[...new Set(reasons)].map((reason) => h("p", { class: "bad" }, `No value: ${reason}.`)),
  );
  if (count) {
    const shown = better
      .slice(0, 3)
      .map((number, n) => [
        n ? ", " : "",
        h("a", { href: link(["jobs", job, "designs", number]) }, `design ${number}`),
      ]);
    found.push(
      h(
        "p",
        {},
        `Behind the front: ${count === 1 ? "one design is" : `${count} designs are`} at least as good in every objective: `,
        shown,
        count > 3 ? ", …" : "",
      ),
    );
  } else if (broken.length) {
    found.push(
      h(
        "p",
        {},
        "No design of the front is better in every objective, but this one misses a requirement.",
      ),
    );
  } else {
    found.push(
      h(
        "p",
        { class: "good" },
        beaten
          ? `Beyond the front: it beats ${beaten === 1 ? "one design" : `${beaten} designs`} of it in every objective.`
          : "On the front as far as the objectives tell: no design of it is better in every objective.",
      ),
    );
  }
  return found;
}

/** @param {Api.Requirement} requirement */
function bounds({ lower, upper, unit }) {
  if (lower === null) return `at most ${withUnit(upper, unit)}`;
  if (upper === null) return `at least ${withUnit(lower, unit)}`;
  return lower === upper
    ? `exactly ${withUnit(lower, unit)}`
    : `${text(lower, unit)} to ${withUnit(upper, unit)}`;
}
