/** The objectives of a design at a glance: value, and where it stands in the front. */

import { isConstant } from "../lib/constant.js";
import { fill, h } from "../lib/dom.js";
import { withUnit } from "../lib/numbers.js";
import { helpLink } from "./numbers.js";

const KEY = 4; // digits of a key figure; all of them are there when pointed at
const ALL = 12;

/**
 * Return a number that is the smaller the better a value of an objective is.
 * @param {Api.Row[string] | undefined} value @param {Pick<Api.Objective, "sense" | "target">} objective
 */
export function rankOf(value, { sense, target }) {
  if (typeof value !== "number") return Infinity;
  if (typeof target === "number") return Math.abs(value - target);
  return sense === "maximise" ? -value : value;
}

/** Return what is wanted of an objective, in words. @param {Api.Objective} objective */
export function sense({ sense: way, target, unit }) {
  return typeof target !== "number" ? way : `target ${withUnit(target, unit)}`;
}

/**
 * Put the objectives of the design into `place`; front: values of every design by column; row: of the design; whose: whose objectives they
 * are, "" for those of the design that the page is of.
 * @param {HTMLElement} place
 * @param {{ objectives: Api.Objective[], front: Api.Row[], row: Api.Row, whose: string, names: Record<string, string> }} given
 */
export function showObjectives(place, { objectives, front, row, whose, names }) {
  fill(place, whose && h("p", { class: "whose" }, whose), objectives.map((objective) => {
    const value = row[objective.column];
    const own = rankOf(value, objective);
    const ranks = front.map((one) => rankOf(one[objective.column], objective));
    const [best, worst] = [Math.min(...ranks), Math.max(...ranks)];
    const same = isConstant(best, worst, objective.target ?? 0);
    const better = same ? 0 : ranks.filter((rank) => rank < own).length;
    const share = !same ? Math.min(Math.max((worst - own) / (worst - best), 0), 1) : 1;
    const part = h("span", {});
    const bar = h("span", { class: "share" }, part);
    part.style.width = `${100 * share}%`;
    return h("div", { class: "panel objective" }, helpLink({ key: objective.column, title: objective.title }, names), h("span", { class: "quiet sense" }, sense(objective)),
      h("strong", { "data-key": objective.column, "data-value": String(value), title: withUnit(value, objective.unit, ALL) }, withUnit(value, objective.unit, KEY)),
      bar, h("span", { class: "quiet" }, better === 0 ? "best of the front" : `${better} of ${front.length} designs are better`));
  }));
}
