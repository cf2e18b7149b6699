/** The designs of a front by columns, fetched when they are first needed. */

import { get } from "../lib/api.js";
import { isConstant } from "../lib/constant.js";
import { withUnit } from "../lib/numbers.js";

/** @typedef {{ numbers: Float64Array, words: string[] | null, range: Page.Range }} Kept A column as it is kept. */

/** Front of a job. front: response of /jobs/N/front. */
export class FrontData {
  /** @type {Map<string, Kept>} */
  kept = new Map();
  /** @type {Map<string, Uint32Array>} */
  orders = new Map();
  /** @param {number} job @param {Api.Front} front @param {AbortSignal} [signal] */
  constructor(job, front, signal) {
    this.job = job;
    this.front = front;
    this.count = front.count;
    this.columns = front.columns;
    this.objectives = front.objectives;
    this.signal = signal;
    this.known = new Map(front.columns.map((column) => [column.key, column]));
  }

  /** Return {key, title, unit} of a column of this front. @param {string} key @returns {Api.Column} */
  column(key) {
    return /** @type {Api.Column} */ (this.known.get(key));
  }

  /** Whether the designs have a column. @param {string} key */
  knows(key) {
    return this.known.has(key);
  }

  /** Fetch the missing ones of some columns, in one request. @param {string[]} keys */
  async need(keys) {
    const wanted = [...new Set(keys)].filter((key) => this.known.has(key) && !this.kept.has(key));
    if (!wanted.length || !this.count) return;
    const { values } = await get(
      `jobs/${this.job}/columns`,
      { columns: wanted.join(",") },
      this.signal,
    );
    this.take(values);
  }

  /** Add columns from the service: {key: cells}. @param {Record<string, Api.Row[string][]>} values */
  take(values) {
    for (const [key, cells] of Object.entries(values)) this.kept.set(key, stored(cells));
  }

  /** Whether a column is loaded. @param {string} key */
  has(key) {
    return this.kept.has(key);
  }

  /** Return a loaded column. @param {string} key */
  of(key) {
    return /** @type {Kept} */ (this.kept.get(key));
  }

  /** Return the numbers of a column, NaN for missing values; for words, their indices in `words(key)`. @param {string} key */
  numbers(key) {
    return this.of(key).numbers;
  }

  /** Return the different words of a column in alphabetical order, null for a column of numbers. @param {string} key */
  words(key) {
    return this.kept.get(key)?.words ?? null;
  }

  /** Return {low, high} of the numbers of a column, equal if it is constant, both 0 if all are undefined. @param {string} key */
  range(key) {
    return this.of(key).range;
  }

  /** Return the cell of a design, counted from 0, in a column: a number, a word, or null. @param {string} key @param {number} row */
  cell(key, row) {
    const { numbers, words } = this.of(key);
    const number = numbers[row];
    if (Number.isNaN(number)) return null;
    return words ? words[number] : number;
  }

  /** Return "maximise" for a column in which more is better, else "minimise". @param {string} key */
  sense(key) {
    return this.objectives.find(({ column }) => column === key)?.sense ?? "minimise";
  }

  /** Return the better direction of a column in words; empty without an objective. @param {string} key */
  better(key) {
    const objective = this.objectives.find(({ column }) => column === key);
    if (!objective) return "";
    if (typeof objective.target === "number")
      return `best near ${withUnit(objective.target, objective.unit, 4)}`;
    return objective.sense === "maximise" ? "more is better" : "less is better";
  }

  /** Return all designs in the order of a column, smallest first, those without a value last. @param {string} key */
  order(key) {
    let order = this.orders.get(key);
    if (!order) {
      const numbers = this.numbers(key);
      /** @type {(row: number) => number} */
      const size = (row) => (Number.isNaN(numbers[row]) ? Infinity : numbers[row]);
      order = Uint32Array.from(numbers.keys()).sort((a, b) => size(a) - size(b) || a - b);
      this.orders.set(key, order);
    }
    return order;
  }
}

/**
 * Return a column in its stored form. With 10,000 designs and more, iterators would take five times as long as these loops.
 * @param {Api.Row[string][]} cells @returns {Kept}
 */
function stored(cells) {
  const words = cells.some((cell) => typeof cell === "string")
    ? [...new Set(cells.filter((cell) => cell !== null).map(String))].sort()
    : null;
  const place = new Map((words ?? []).map((word, index) => [word, index]));
  const numbers = new Float64Array(cells.length);
  let [low, high] = [Infinity, -Infinity];
  for (let row = 0; row < cells.length; row += 1) {
    const cell = cells[row];
    const number =
      cell === null
        ? NaN
        : typeof cell === "number" && !words
          ? cell
          : (place.get(String(cell)) ?? NaN);
    numbers[row] = number;
    if (number < low) low = number;
    if (number > high) high = number;
  }
  if (low > high) [low, high] = [0, 0];
  return { numbers, words, range: { low, high: isConstant(low, high) ? low : high } };
}
