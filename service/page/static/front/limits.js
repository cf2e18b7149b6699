/** Limits on quantities, and which designs are within all of them. */

import { isInside } from "../charts/lasso.js";

/** @import { FrontData } from "./data.js" */

const NEAR = 1e-9; // relative tolerance: a design on a limit is within it, even if unit conversion rounded the limit

/**
 * Limits by column: {low, high} for numbers, each a number or null; {words: [...]} for words. Also a line drawn around designs, or null:
 * {x, y, line} with the keys of two columns and its corners in their units.
 */
export class Limits {
  chosen = 0; // number of designs within all limits
  /** @param {FrontData} data @param {Map<string, Page.Limit>} limits @param {Page.Lasso | null} lasso */
  constructor(data, limits = new Map(), lasso = null) {
    this.data = data;
    this.of = limits;
    this.lasso = lasso;
    this.mask = new Uint8Array(data.count);
  }

  /** Set the limit of a column; null removes it. @param {string} key @param {Page.Limit | null} limit */
  set(key, limit) {
    const open =
      !limit ||
      (limit.words ? limit.words.length === 0 : limit.low === null && limit.high === null);
    if (open) this.of.delete(key);
    else this.of.set(key, limit);
  }

  /** Find the designs within all limits; columns that are not loaded yet are ignored. */
  apply() {
    const { mask, data } = this;
    mask.fill(1);
    for (const [key, limit] of this.of) {
      if (!data.has(key)) continue;
      const numbers = data.numbers(key);
      if (limit.words) {
        const allowed = new Set(limit.words.map((word) => data.words(key)?.indexOf(word)));
        for (let row = 0; row < mask.length; row += 1)
          if (!allowed.has(numbers[row])) mask[row] = 0;
      } else {
        const low = limit.low === null ? -Infinity : limit.low - NEAR * Math.abs(limit.low);
        const high = limit.high === null ? Infinity : limit.high + NEAR * Math.abs(limit.high);
        // In this form, a design without a value is outside.
        for (let row = 0; row < mask.length; row += 1)
          if (!(numbers[row] >= low && numbers[row] <= high)) mask[row] = 0;
      }
    }
    if (this.lasso && data.has(this.lasso.x) && data.has(this.lasso.y)) {
      const [across, up] = [data.numbers(this.lasso.x), data.numbers(this.lasso.y)];
      for (let row = 0; row < mask.length; row += 1)
        if (mask[row] && !isInside(this.lasso.line, across[row], up[row])) mask[row] = 0;
    }
    let chosen = 0;
    for (let row = 0; row < mask.length; row += 1) chosen += mask[row];
    this.chosen = chosen;
  }

  /** Whether there are no limits. */
  get open() {
    return !this.of.size && !this.lasso;
  }

  /** Remove all limits. */
  clear() {
    this.of.clear();
    this.lasso = null;
  }

  /** Return the limits as conditions of the API, which does not support lines around designs. */
  conditions() {
    /** @type {string[]} */
    const conditions = [];
    for (const [key, limit] of this.of) {
      if (limit.words) {
        const others = (this.data.words(key) ?? []).filter((word) => !limit.words.includes(word));
        conditions.push(...others.map((word) => `${key} != ${word}`));
      } else {
        if (limit.low !== null) conditions.push(`${key} >= ${limit.low}`);
        if (limit.high !== null) conditions.push(`${key} <= ${limit.high}`);
      }
    }
    return conditions;
  }
}
