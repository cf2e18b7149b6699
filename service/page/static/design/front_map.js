/** Small picture of the front: all designs in two objectives, the displayed design, and the effect of a change. */

import { fill, h, svg } from "../lib/dom.js";
import { counted, inDisplayUnit, withUnit } from "../lib/numbers.js";
import { range, scale } from "../charts/scale.js";
import { sense } from "./objectives.js";

const [WIDTH, HEIGHT] = [340, 230];
const MARGIN = { left: 52, right: 12, top: 10, bottom: 24 };

/**
 * Put the picture into `place`; returns {show(row, changed)}: the design, and the changed one or null.
 * @param {HTMLElement} place @param {{ objectives: Api.Objective[], front: Api.Row[] }} options
 */
export function frontMap(place, { objectives, front }) {
  // The front is a separate picture, so that thousands of points are not repainted when one moves.
  const [cloud, moving] = ["", "moving"].map((kind) =>
    svg("svg", { class: `chart ${kind}`, viewBox: `0 0 ${WIDTH} ${HEIGHT}` }),
  );
  const picture = h("div", { class: "front-map", role: "img" }, cloud, moving);
  const chosen = [0, Math.min(1, objectives.length - 1)];
  /** @param {number} n @param {string} label */
  const choice = (n, label) =>
    h(
      "label",
      {},
      h("span", { class: "quiet" }, `${label} `),
      h(
        "select",
        {
          onchange: (event) => {
            chosen[n] = Number(event.currentTarget.value);
            arrange();
          },
        },
        objectives.map((objective, at) =>
          h(
            "option",
            { value: at, selected: at === chosen[n] },
            `${objective.title} (${sense(objective)})`,
          ),
        ),
      ),
    );
  /** @type {Page.Scale} */
  let x; // empty before the first drawing, like y
  /** @type {Page.Scale} */
  let y;
  /** @type {[Api.Row | null, Api.Row | null]} */
  let rows = [null, null];
  fill(place, h("div", { class: "axes-choice" }, choice(0, "Across"), choice(1, "Up")), picture);

  /** @param {Api.Row | null} row @param {Api.Objective} objective @returns {number} */
  const value = (row, objective) => {
    const cell = row?.[objective.column];
    return typeof cell === "number" ? inDisplayUnit(cell, objective.unit) : NaN;
  };

  function arrange() {
    const [across, up] = chosen.map((n) => objectives[n]);
    const points = front
      .map((row) => [value(row, across), value(row, up)])
      .filter((point) => point.every(Number.isFinite));
    const drawnRows = rows.filter((row) => row !== null);
    const wide = range(
      [...points.map(([one]) => one), ...drawnRows.map((row) => value(row, across))],
      0.06,
    );
    const tall = range(
      [...points.map(([, one]) => one), ...drawnRows.map((row) => value(row, up))],
      0.08,
    );
    x = scale(wide.low, wide.high, MARGIN.left, WIDTH - MARGIN.right, 5);
    y = scale(tall.low, tall.high, HEIGHT - MARGIN.bottom, MARGIN.top, 4);
    fill(
      cloud,
      svg(
        "g",
        { class: "axes" },
        y.ticks.map((tick) => [
          svg("line", {
            class: "grid",
            x1: MARGIN.left,
            x2: WIDTH - MARGIN.right,
            y1: y.at(tick),
            y2: y.at(tick),
          }),
          svg(
            "text",
            { x: MARGIN.left - 5, y: y.at(tick) + 4, "text-anchor": "end" },
            y.text(tick),
          ),
        ]),
        x.ticks.map((tick) =>
          svg(
            "text",
            { x: Math.min(x.at(tick), WIDTH - 18), y: HEIGHT - 6, "text-anchor": "middle" },
            x.text(tick),
          ),
        ),
      ),
      svg("path", {
        class: "cloud",
        d: points
          .map(([one, other]) => `M${x.at(one).toFixed(1)} ${y.at(other).toFixed(1)}h0`)
          .join(""),
      }),
    );
    move();
  }

  function move() {
    const [across, up] = chosen.map((n) => objectives[n]);
    const [from, to] = rows.map((row) => row && [x.at(value(row, across)), y.at(value(row, up))]);
    const drawn = [];
    if (from && to && to.every(Number.isFinite))
      drawn.push(
        svg("line", { class: "trail", x1: from[0], y1: from[1], x2: to[0], y2: to[1] }),
        svg("circle", { class: "changed", cx: to[0], cy: to[1], r: 6 }),
      );
    if (from && from.every(Number.isFinite))
      drawn.push(svg("circle", { class: "own", cx: from[0], cy: from[1], r: 5 }));
    fill(moving, drawn);
    /** @param {Api.Row | null} row */
    const describe = (row) =>
      [across, up]
        .map(
          (objective) =>
            `${objective.title} ${withUnit(row?.[objective.column], objective.unit, 4)}`,
        )
        .join(", ");
    picture.setAttribute(
      "aria-label",
      `The front, ${counted(front.length, "design")}. This design: ${describe(rows[0])}.${rows[1] ? ` Changed: ${describe(rows[1])}.` : ""}`,
    );
  }

  return {
    /** @param {Api.Row} row @param {Api.Row | null} changed */
    show(row, changed) {
      rows = [row, changed];
      const inside =
        x &&
        (!changed ||
          [x, y].every((axis, n) => {
            const coordinate = value(changed, objectives[chosen[n]]);
            return coordinate >= axis.low && coordinate <= axis.high;
          }));
      if (inside) move();
      else arrange();
    },
  };
}
