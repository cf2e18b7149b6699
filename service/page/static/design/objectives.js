/** Objectives of a design at a glance: value and rank within the front. */

import { fill, h } from "../lib/dom.js";
import { text, withUnit } from "../lib/numbers.js";
import { difference, helpLink } from "./numbers.js";
import { rankInFront, rankOf } from "./rank.js";

const KEY = 4; // digits of a key figure; a tooltip has all of them
const ALL = 12;

/** Return the sense of an objective in words. @param {Api.Objective} objective */
export function sense({ sense: way, target, unit }) {
  return typeof target !== "number" ? way : `target ${withUnit(target, unit)}`;
}

/**
 * Put the objectives of the design into `place`. front: values of every design by column. row: values of the design. others: designs beside
 * it. changed: what-if change, see `rankInFront`. before: the unchanged design, or null. whose: owner of the objectives, "" for the
 * displayed design.
 * @param {HTMLElement} place
 * @param {{ objectives: Api.Objective[], front: Api.Row[], row: Api.Row, others: { name: string, series: number | string, row: Api.Row }[], before: Api.Row | null, changed: { broken: boolean } | null, whose: string, names: Record<string, string> }} options
 */
export function showObjectives(
  place,
  { objectives, front, row, others, before, changed, whose, names },
) {
  fill(
    place,
    whose && h("p", { class: "whose" }, whose),
    objectives.map((objective) => {
      const value = row[objective.column];
      const { share, words } = rankInFront(objective, front, value, changed);
      const part = h("span", {});
      const bar = h("span", { class: "share" }, part);
      part.style.width = `${100 * share}%`;
      return h(
        "div",
        { class: "panel objective" },
        helpLink({ key: objective.column, title: objective.title }, names),
        h("span", { class: "quiet sense" }, sense(objective)),
        h(
          "strong",
          {
            "data-key": objective.column,
            "data-value": String(value),
            title: withUnit(value, objective.unit, ALL),
          },
          before &&
            h(
              "span",
              { class: "quiet was" },
              `${text(before[objective.column], objective.unit, KEY)} → `,
            ),
          withUnit(value, objective.unit, KEY),
        ),
        bar,
        h("span", { class: "quiet ranked" }, words),
        others.map((other) => {
          const by = rankOf(other.row[objective.column], objective) - rankOf(value, objective);
          const word = by > 0 ? "worse" : by < 0 ? "better" : "same";
          const sign = { worse: "▼ ", better: "▲ ", same: "" }[word];
          return h(
            "span",
            { class: "of-other", "data-series": other.series },
            h("span", { class: "name" }, other.name),
            h("b", {}, withUnit(other.row[objective.column], objective.unit, KEY)),
            h(
              "span",
              { class: { worse: "bad", better: "good", same: "quiet" }[word], title: word },
              `${sign}${difference(other.row[objective.column], value, objective.unit)}`,
              h("span", { class: "hidden" }, ` ${word}`),
            ),
          );
        }),
      );
    }),
  );
}
