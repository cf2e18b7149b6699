/** Requirements of a job in words, and how a design misses them. */

import { text, withUnit } from "../lib/numbers.js";

/** @typedef {Pick<Api.Requirement, "title" | "unit" | "lower" | "upper">} Asked A requirement, or a range. */

/** Return a requirement in words. @param {Omit<Asked, "title">} requirement @param {number} digits */
export function requirementText({ lower, upper, unit }, digits = 5) {
  if (lower !== null && lower === upper) return `exactly ${withUnit(lower, unit, digits)}`;
  if (upper === null) return `at least ${withUnit(lower, unit, digits)}`;
  if (lower === null) return `at most ${withUnit(upper, unit, digits)}`;
  return `${text(lower, unit, digits)} to ${withUnit(upper, unit, digits)}`;
}

/**
 * Return how a design misses a requirement or a range, with enough digits to distinguish the value from the bound.
 * @param {Api.Row[string] | undefined} value @param {Asked} requirement @param {string} fault
 */
export function missText(value, requirement, fault = "Misses a requirement") {
  const { title, unit, lower, upper } = requirement;
  const sentence = `${fault}: ${title}`;
  if (typeof value !== "number")
    return `${sentence} has no value; must be ${requirementText(requirement)}.`;
  const low = lower !== null && value < lower;
  const miss = Math.abs(value - Number(low ? lower : upper));
  const digits = Math.min(12, Math.max(5, Math.ceil(Math.log10(Math.abs(value) / miss)) + 2));
  const by = `${withUnit(miss, unit, 2)} ${low ? "more" : "less"}`;
  return `${sentence} ${withUnit(value, unit, digits)}; must be ${requirementText(requirement, digits)}, ${by}.`;
}
