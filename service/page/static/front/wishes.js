/** Wishes for the objectives of a front: in the address, and in requests and responses of the service. */

import { rankOf } from "../design/rank.js";
import { capitalised } from "../lib/words.js";

/**
 * @typedef {"free" | "value" | "improve" | "keep" | "limit"} Kind
 * @typedef {{ kind: Kind, value?: number }} Wish value: in the unit of the API
 * @typedef {{ of: Map<string, Wish>, design: number | null }} Wishes by quantity; what is not there is free. design: that classes speak of
 * @typedef {{ id: string, text: string }} Problem At an objective, at the "design", or about all: "".
 */

const SAME = 1e-9; // relative difference of equal values
const CLASSES = ["improve", "keep"];

/**
 * Return the wishes in an address, or null.
 * @param {URLSearchParams} query @param {readonly { quantity: string }[]} objectives @returns {Wishes | null}
 */
export function wishesFrom(query, objectives) {
  /** @type {Map<string, Wish>} */
  const byQuantity = new Map();
  for (const { quantity } of objectives) {
    const text = query.get(`wish.${quantity}`) ?? "";
    const [, limit, number] = /^(to )?(.+)$/.exec(text) ?? [];
    if (CLASSES.includes(text)) byQuantity.set(quantity, { kind: /** @type {Kind} */ (text) });
    else if (number && Number.isFinite(Number(number)))
      byQuantity.set(quantity, { kind: limit ? "limit" : "value", value: Number(number) });
  }
  const design = Number(query.get("wish.design"));
  return byQuantity.size
    ? { of: byQuantity, design: Number.isInteger(design) && design > 0 ? design : null }
    : null;
}

/** Return the part of an address with wishes. @param {Wishes | null} wishes */
export function wishQuery(wishes) {
  /** @type {Record<string, string>} */
  const query = {};
  for (const [quantity, { kind, value }] of wishes?.of ?? [])
    query[`wish.${quantity}`] =
      kind === "limit" ? `to ${value}` : kind === "value" ? String(value) : kind;
  if (wishes?.design) query["wish.design"] = String(wishes.design);
  return query;
}

/**
 * Return the wishes of somebody who prefers a design to another one: improve the objectives in which it is better, and let the
 * objectives in which it is worse become worse again by at most the same amount.
 * @param {readonly Api.Objective[]} objectives @param {{ number: number, row: Api.Row }} preferred @param {{ row: Api.Row }} other
 * @returns {Wishes}
 */
export function wishesOfPreference(objectives, preferred, other) {
  /** @type {[string, Wish][]} */
  const wishes = objectives.flatMap((objective) => {
    const [value, against] = [preferred, other].map(({ row }) => Number(row[objective.column]));
    const gain = rankOf(against, objective) - rankOf(value, objective);
    if (!(Math.abs(gain) > SAME * Math.abs(value))) return [];
    const limit = Number((2 * value - against).toPrecision(5));
    const wish = gain > 0 ? { kind: "improve" } : { kind: "limit", value: limit };
    return [[objective.quantity, /** @type {Wish} */ (wish)]];
  });
  return { of: new Map(wishes), design: preferred.number };
}

/**
 * Return wishes in the form of the service.
 * @param {Wishes} wishes @param {readonly { quantity: string, unit: string }[]} objectives
 */
export function wishRequest({ of, design }, objectives) {
  const units = new Map(objectives.map(({ quantity, unit }) => [quantity, unit]));
  const texts = [...of].map(([quantity, { kind, value }]) => {
    const number = `${value} ${units.get(quantity) ?? ""}`.trim();
    return [
      quantity,
      kind === "value" ? number : kind === "limit" ? `may worsen to ${number}` : kind,
    ];
  });
  return { at: Object.fromEntries(texts), design: refersToDesign({ of, design }) ? design : null };
}

/** Whether any wish refers to a design. @param {Wishes} wishes */
export function refersToDesign({ of }) {
  return [...of.values()].some(({ kind }) => CLASSES.includes(kind));
}

/**
 * Return mistakes in wishes that can be found without the service, each with its location.
 * @param {Wishes} wishes @param {readonly { quantity: string }[]} objectives @param {number} count of designs @returns {Problem[]}
 */
export function mistakesIn(wishes, objectives, count) {
  const { of, design } = wishes;
  /** @type {Problem[]} */
  const problems = [];
  for (const [quantity, { kind, value }] of of) {
    if ((kind === "value" || kind === "limit") && !Number.isFinite(value ?? NaN))
      problems.push({
        id: quantity,
        text: "A number is needed here; write one, or choose “free”.",
      });
  }
  const kinds = objectives.map(({ quantity }) => of.get(quantity)?.kind ?? "free");
  if (
    refersToDesign(wishes) &&
    (design === null || !Number.isInteger(design) || design < 1 || design > count)
  )
    problems.push({
      id: "design",
      text: `“Improve” and “keep” refer to a design on the front; give its number, 1 to ${count}.`,
    });
  if (!kinds.some((kind) => kind === "value" || kind === "improve"))
    problems.push({
      id: "",
      text: "There is no wish yet; give one objective a value, or let it improve.",
    });
  else if (kinds.every((kind) => CLASSES.includes(kind)))
    problems.push({
      id: "",
      text: "Nothing can improve unless another objective is freed or allowed to worsen.",
    });
  return problems;
}

/**
 * Return the location of a refusal by the service: the objective that it names first.
 * @param {string} detail @param {readonly { quantity: string }[]} objectives @returns {Problem}
 */
export function locationOfRefusal(detail, objectives) {
  const named = objectives
    .map(({ quantity }) => ({ quantity, at: detail.indexOf(quantity) }))
    .filter(({ at }) => at >= 0);
  named.sort((one, other) => one.at - other.at || other.quantity.length - one.quantity.length);
  const text = `${capitalised(detail)}.`;
  return { id: named.length === 1 ? named[0].quantity : "", text };
}

/** Return recorded wishes from a response of the service. @param {Api.MadeWish} made @returns {Wishes} */
export function wishesOf({ wishes, design }) {
  const byQuantity = Object.entries(wishes).map(
    ([quantity, { wish, value }]) =>
      /** @type {[string, Wish]} */ ([
        quantity,
        value === null ? { kind: wish } : { kind: wish, value },
      ]),
  );
  return { of: new Map(byQuantity), design };
}

/**
 * Return the number of the design, from 1, whose objectives are nearest to a row, each as a share of its range over the front.
 * @param {Api.Row} row @param {{ column: string }[]} objectives
 * @param {{ count: number, numbers: (key: string) => Float64Array, range: (key: string) => Page.Range }} data
 */
export function nearest(row, objectives, data) {
  let [best, least] = [0, Infinity];
  for (let other = 0; other < data.count; other += 1) {
    let sum = 0;
    for (const { column } of objectives) {
      const { low, high } = data.range(column);
      sum += ((data.numbers(column)[other] - Number(row[column])) / (high - low || 1)) ** 2;
    }
    if (sum < least) [best, least] = [other, sum];
  }
  return best + 1;
}
