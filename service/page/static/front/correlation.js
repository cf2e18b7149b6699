/** Rank correlation of two quantities, in words and for every pair of objectives. */

import { fill, h } from "../lib/dom.js";
import { capitalised } from "../lib/words.js";
import { headedRow, headsOf, table } from "../lib/table.js";

/** @import { Explorer } from "./explorer.js" */

const WAIT = 150; // ms after a change of the designs
const WORDS = /** @type {const} */ ([
  [0.95, "almost always"],
  [0.7, "mostly"],
  [0.3, "often"],
]);

/**
 * Return the ranks of numbers from 1; ties get their mean rank.
 * @param {ArrayLike<number>} numbers @returns {Float64Array}
 */
export function ranks(numbers) {
  const order = Uint32Array.from(numbers, (_, n) => n).sort((a, b) => numbers[a] - numbers[b]);
  const rankOf = new Float64Array(numbers.length);
  for (let start = 0; start < order.length;) {
    let end = start;
    while (end < order.length && numbers[order[end]] === numbers[order[start]]) end += 1;
    for (let n = start; n < end; n += 1) rankOf[order[n]] = (start + 1 + end) / 2;
    start = end;
  }
  return rankOf;
}

/**
 * Return Spearman's rank correlation of two columns over the masked rows that have both; null without variation.
 * @param {ArrayLike<number>} a @param {ArrayLike<number>} b @param {ArrayLike<number>} mask
 */
export function rankCorrelation(a, b, mask) {
  /** @type {number[]} */
  const rows = [];
  for (let row = 0; row < mask.length; row += 1)
    if (mask[row] && !Number.isNaN(a[row]) && !Number.isNaN(b[row])) rows.push(row);
  const [one, other] = [a, b].map((column) => ranks(rows.map((row) => column[row])));
  const mean = (rows.length + 1) / 2;
  let [both, first, second] = [0, 0, 0];
  for (let n = 0; n < rows.length; n += 1) {
    const [x, y] = [one[n] - mean, other[n] - mean];
    both += x * y;
    first += x * x;
    second += y * y;
  }
  return first > 0 && second > 0 ? both / Math.sqrt(first * second) : null;
}

/** Return a correlation in words. @param {string} x @param {string} y @param {number | null} value @param {number} count */
export function inWords(x, y, value, count) {
  if (value === null || count < 3)
    return `${x} and ${y} cannot be compared: too few designs differ in both.`;
  const [, often] = WORDS.find(([least]) => Math.abs(value) >= least) ?? [];
  const numbers = `(rank correlation ${value.toFixed(2).replace("-", "−")}, ${count} designs)`;
  return often
    ? `Designs with a higher ${x} ${often} have a ${value > 0 ? "higher" : "lower"} ${y} ${numbers}.`
    : `${capitalised(x)} and ${y} are hardly related ${numbers}.`;
}

/** Return {place, draw()}: the correlation of the plotted pair in words, and all pairs of objectives as choices. @param {Explorer} explorer */
export function correlations(explorer) {
  const { data, limits, chosen } = explorer;
  const sentence = h("p", { class: "correlation" });
  const matrix = h("div", {
    class: "scroll pairs",
    tabindex: 0,
    role: "region",
    "aria-label": "Every pair of objectives",
  });
  const all = h(
    "details",
    { ontoggle: ({ currentTarget }) => currentTarget.open && drawMatrix() },
    h("summary", {}, "Every pair of objectives"),
    matrix,
  );
  const several = data.objectives.length > 2;
  const place = h("div", {}, sentence, several && all);
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let later;
  explorer.signal.addEventListener("abort", () => clearTimeout(later));

  function showCorrelation() {
    const { x, y } = chosen;
    const apt = [x, y].every((key) => data.has(key) && !data.words(key)) && x !== y;
    sentence.hidden = !apt;
    if (apt)
      sentence.textContent = inWords(
        data.column(x).title,
        data.column(y).title,
        rankCorrelation(data.numbers(x), data.numbers(y), limits.mask),
        limits.chosen,
      );
    if (all.open) drawMatrix();
  }

  async function drawMatrix() {
    await data.need(data.objectives.map(({ column }) => column));
    const columns = data.objectives.map(({ column, title }) => ({ column, title }));
    const rows = columns.slice(1).map((up, n) =>
      headedRow(
        up.title,
        columns.slice(0, -1).map((across, m) => {
          if (m > n) return h("td", {});
          const value = rankCorrelation(
            data.numbers(across.column),
            data.numbers(up.column),
            limits.mask,
          );
          const valueText = value === null ? "–" : value.toFixed(2).replace("-", "−");
          const chosenNow = chosen.x === across.column && chosen.y === up.column;
          return h(
            "td",
            {},
            h(
              "button",
              {
                type: "button",
                "aria-pressed": String(chosenNow),
                "aria-label": `Plot ${up.title} against ${across.title}, rank correlation ${valueText}`,
                onclick: () => explorer.change({ x: across.column, y: up.column }, "all"),
              },
              valueText,
            ),
          );
        }),
      ),
    );
    fill(
      matrix,
      table(
        "Rank correlation of every pair of objectives",
        headsOf(["", ...columns.slice(0, -1).map(({ title }) => title)], () => false),
        rows,
      ),
    );
  }

  function draw() {
    clearTimeout(later);
    later = setTimeout(showCorrelation, WAIT);
  }
  return { place, draw };
}
