/** Choices in the explorer of a front, as stored in the address. */

import { LENGTHS } from "./linkages.js";
import { wishesFrom, wishQuery } from "./wishes.js";

/**
 * @import { FrontData } from "./data.js"
 * @import { Limits } from "./limits.js"
 */

/**
 * @typedef {{ key: string, flipped: boolean }} Axis
 * @typedef {ReturnType<typeof choicesFrom>} Chosen
 */

const MOST = 3; // compared designs

/** Return the columns of what a job sizes: crank, rod, offset, extra variables, choices. @param {Api.Front} front */
export function sizesOf({ columns }) {
  return columns.filter(({ group }) => group === columns[0].group).map(({ key }) => key);
}

/**
 * Return the choices in an address, completed: axes, limits, log, x, y, colour, columns, sort, page, selected, weights, wish.
 * @param {URLSearchParams} query @param {Api.Front} front
 */
export function choicesFrom(query, front) {
  const keys = front.columns.map(({ key }) => key);
  /** @type {(key: string | null | undefined) => key is string} */
  const isColumn = (key) => typeof key === "string" && keys.includes(key);
  const objectives = front.objectives.map(({ column }) => column);
  const sizes = sizesOf(front).filter((key) => !objectives.includes(key));
  const strokes = front.strokes_differ ? ["slow_stroke"] : [];
  /** @param {string} name */
  const list = (name) => (query.get(name) ?? "").split(",").filter(Boolean);
  /** @param {string} name @param {string} otherwise */
  const columnOf = (name, otherwise) => {
    const key = query.get(name);
    return isColumn(key) ? key : otherwise;
  };
  /** @type {Axis[]} */
  const axes = list("axes")
    .map((text) => ({ key: text.replace(/^-/, ""), flipped: text.startsWith("-") }))
    .filter(({ key }) => isColumn(key));
  const standard = [...sizes, ...objectives];
  const usual = [...objectives, ...sizes, ...strokes];
  const columns = list("columns").filter(isColumn);
  const sort = (query.get("sort") ?? "").replace(/^-/, "");
  const weights = (query.get("weights") ?? "").split(",").map(Number);
  return {
    axes: axes.length ? axes : standard.map((key) => ({ key, flipped: false })),
    limits: limitsFrom(query, isColumn),
    lasso: lassoFrom(query, isColumn),
    log: list("log").filter(isColumn), // columns whose axes are logarithmic
    x: columnOf("x", objectives[0] ?? keys[0]),
    y: columnOf("y", objectives[1] ?? sizes[0] ?? keys[0]),
    colour: query.get("colour") === "none" ? "" : columnOf("colour", objectives[2] ?? ""),
    columns: columns.length ? columns : usual,
    sort: isColumn(sort) ? sort : "",
    reverse: (query.get("sort") ?? "").startsWith("-"),
    page: Math.max(1, Math.trunc(Number(query.get("page"))) || 1),
    selected: list("selected")
      .map(Number)
      .filter((number) => Number.isInteger(number) && number >= 1 && number <= front.count)
      .slice(0, MOST),
    weights:
      weights.length === objectives.length && weights.every((weight) => weight >= 0 && weight <= 10)
        ? weights
        : null,
    wish: wishesFrom(query, front.objectives),
    behind: query.get("behind") !== "none", // whether the previous run's front is shown
    standard: {
      axes: standard.join(","),
      x: objectives[0],
      y: objectives[1],
      colour: objectives[2] ?? "",
      columns: usual.join(","),
    },
  };
}

/**
 * Leave dimensions that are the same for all designs out of the usual axes and columns; the card of a design and the two choosers have it.
 * @param {Chosen} chosen @param {FrontData} data
 */
export function leaveOutConstants(chosen, data) {
  const { standard } = chosen;
  /** @param {string[]} keys */
  const varied = (keys) =>
    keys.filter(
      (key) =>
        data.count < 2 ||
        key === "slow_stroke" ||
        data.better(key) !== "" ||
        data.range(key).low < data.range(key).high,
    );
  const keys = chosen.axes.map(({ key, flipped }) => (flipped ? `-${key}` : key));
  if (keys.join(",") === standard.axes) {
    chosen.axes = varied(keys).map((key) => ({ key, flipped: false }));
    standard.axes = varied(keys).join(",");
  }
  if (chosen.columns.join(",") === standard.columns) {
    chosen.columns = varied(chosen.columns);
    standard.columns = chosen.columns.join(",");
  }
}

/** @param {URLSearchParams} query @param {(key: string) => boolean} known */
function limitsFrom(query, known) {
  /** @type {Map<string, Page.Limit>} */
  const limits = new Map();
  for (const [name, text] of query) {
    const [, side, key] = /^(min|max|is)\.(.+)$/.exec(name) ?? [];
    if (!side || !known(key)) continue;
    if (side === "is") limits.set(key, { words: text.split("|") });
    else if (text !== "" && Number.isFinite(Number(text))) {
      const { low = null, high = null } = limits.get(key) ?? {};
      limits.set(key, side === "min" ? { low: Number(text), high } : { low, high: Number(text) });
    }
  }
  return limits;
}

/** @param {URLSearchParams} query @param {(key: string | undefined) => key is string} known @returns {Page.Lasso | null} */
function lassoFrom(query, known) {
  const [x, y, ...corners] = (query.get("lasso") ?? "").split(",");
  const numbers = corners.map(Number);
  if (
    !known(x) ||
    !known(y) ||
    numbers.length < 6 ||
    numbers.length % 2 ||
    !numbers.every(Number.isFinite)
  )
    return null;
  return {
    x,
    y,
    line: Array.from({ length: numbers.length / 2 }, (_, index) => [
      numbers[2 * index],
      numbers[2 * index + 1],
    ]),
  };
}

/** Return the query of an address without defaults. @param {Chosen} chosen @param {Page.Lasso | null} lasso */
export function queryOf(chosen, lasso) {
  const { standard } = chosen;
  /** @param {string} value @param {string | undefined} usual */
  const unless = (value, usual) => (value === usual ? "" : value);
  /** @type {Record<string, Dom.Value>} */
  const query = {
    axes: unless(
      chosen.axes.map(({ key, flipped }) => `${flipped ? "-" : ""}${key}`).join(","),
      standard.axes,
    ),
    log: chosen.log.join(","),
    x: unless(chosen.x, standard.x),
    y: unless(chosen.y, standard.y),
    colour:
      unless(chosen.colour, standard.colour) ||
      (chosen.colour === "" && standard.colour ? "none" : ""),
    columns: unless(chosen.columns.join(","), standard.columns),
    sort: chosen.sort ? `${chosen.reverse ? "-" : ""}${chosen.sort}` : "",
    page: chosen.page > 1 ? chosen.page : "",
    selected: chosen.selected.join(","),
    weights: chosen.weights?.join(",") ?? "",
    lasso: lasso
      ? [
          lasso.x,
          lasso.y,
          ...lasso.line.flat().map((number) => Number(number.toPrecision(5))),
        ].join(",")
      : "",
    behind: chosen.behind ? "" : "none",
    ...wishQuery(chosen.wish),
  };
  for (const [key, limit] of chosen.limits) {
    if (limit.words) query[`is.${key}`] = limit.words.join("|");
    if (limit.low !== undefined && limit.low !== null) query[`min.${key}`] = limit.low;
    if (limit.high !== undefined && limit.high !== null) query[`max.${key}`] = limit.high;
  }
  return query;
}

/**
 * Return the selected designs with one design added or removed; the first is dropped if there are too many.
 * @param {number[]} selected @param {number} number
 */
export function toggled(selected, number) {
  if (selected.includes(number)) return selected.filter((one) => one !== number);
  return [...selected, number].slice(-MOST);
}

/** Return the columns that are drawn, shown or limited. @type {(chosen: Chosen, limits: Limits) => string[]} */
export function neededColumns({ axes, x, y, colour, columns, sort }, { of, lasso }) {
  const keys = [
    ...LENGTHS,
    ...axes.map(({ key }) => key),
    x,
    y,
    colour,
    ...columns,
    sort,
    ...of.keys(),
    lasso?.x ?? "",
    lasso?.y ?? "",
  ];
  return keys.filter((key) => key !== "");
}
