/** Rank of an objective's value within a front. */

import { isConstant } from "../lib/constant.js";

/**
 * Return a number that is smaller for a better value of an objective.
 * @param {Api.Row[string] | undefined} value @param {Pick<Api.Objective, "sense" | "target">} objective
 */
export function rankOf(value, { sense, target }) {
  if (typeof value !== "number") return Infinity;
  if (typeof target === "number") return Math.abs(value - target);
  return sense === "maximise" ? -value : value;
}

/**
 * Return the rank of a value within the front, from 0 (worst) to 1 (best), and in words. changed: whether it belongs to a changed design,
 * which is not on the front, and whether that misses a requirement.
 * @param {Api.Objective} objective @param {Api.Row[]} front @param {Api.Row[string] | undefined} value @param {{ broken: boolean } | null} changed
 */
export function rankInFront(objective, front, value, changed) {
  const rank = rankOf(value, objective);
  const ranks = front.map((one) => rankOf(one[objective.column], objective));
  const [best, worst] = [Math.min(...ranks), Math.max(...ranks)];
  const size = objective.target ?? 0;
  const better = ranks.filter((other) => other < rank && !isConstant(other, rank, size)).length;
  const share = isConstant(best, worst, size)
    ? Number(!better)
    : Math.min(Math.max((worst - rank) / (worst - best), 0), 1);
  if (changed?.broken) return { share, words: "misses a requirement" };
  if (!better)
    return { share, words: changed ? "no design on the front is better" : "best on the front" };
  return {
    share,
    words:
      front.length === 1
        ? "the only design on the front is better"
        : `${better} of ${front.length} designs are better`,
  };
}
