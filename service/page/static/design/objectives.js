/** The objectives of a design at a glance: value, and where it stands in the front. */

import { isConstant } from "../lib/constant.js";
import { fill, h } from "../lib/dom.js";
import { withUnit } from "../lib/numbers.js";
import { helpLink } from "./numbers.js";

/** Return a number that is the smaller the better a value of an objective is. */
export function rankOf(value, { sense, target }) {
  if (typeof value !== "number") return Infinity;
  if (target !== null) return Math.abs(value - target);
  return sense === "maximise" ? -value : value;
}

/** Return what is wanted of an objective, in words. */
export function sense({ sense: way, target, unit }) {
  return target === null ? way : `target ${withUnit(target, unit)}`;
}

/** Put the objectives of the design into `place`; front: values of every design by column; designs: the first is told of. */
export function showObjectives(place, { objectives, front, designs, names }) {
  const [{ row }] = designs;
  fill(place, objectives.map((objective) => {
    const value = row[objective.column];
    const own = rankOf(value, objective);
    const ranks = front.map((one) => rankOf(one[objective.column], objective));
    const [best, worst] = [Math.min(...ranks), Math.max(...ranks)];
    const same = isConstant(best, worst, objective.target ?? 0);
    const better = same ? 0 : ranks.filter((rank) => rank < own).length;
    const share = !same ? Math.min(Math.max((worst - own) / (worst - best), 0), 1) : 1;
    const bar = h("span", { class: "share" }, h("span", {}));
    bar.firstChild.style.width = `${100 * share}%`;
    return h("div", { class: "panel objective" }, helpLink({ key: objective.column, title: objective.title }, names), h("span", { class: "quiet sense" }, sense(objective)),
      h("strong", { "data-key": objective.column, "data-value": String(value) }, withUnit(value, objective.unit)),
      bar, h("span", { class: "quiet" }, better === 0 ? "best of the front" : `${better} of ${front.length} designs are better`));
  }));
}
