/** Parts of a curve chart: axes, dead centres, lines, minimum and maximum, and a description in words. */

import { svg } from "../lib/dom.js";
import { text, withUnit } from "../lib/numbers.js";
import { crankAt, extremes } from "./cycle.js";

/**
 * @import { Abscissa } from "./abscissa.js"
 * @import { Drawn, Shown } from "./curves.js"
 */

export const MARGIN = { left: 56, right: 12, top: 25, bottom: 24 };
const NARROW = 220; // pixels of a chart that has room for every second tick alone
const NAMES = { turn: ["inner", "outer"], swing: ["start", "end"] };

/** @typedef {{ x: Page.Scale, y: Page.Scale, abscissa: Abscissa, height: number }} Pen Scales of a chart, and what it is drawn over. */

/** @param {Pen} pen @param {number} width */
export function axes({ x, y, abscissa, height }, width) {
  const ticks =
    abscissa.ticks ??
    x.ticks.map((at, n, all) => ({
      at,
      text: n === all.length - 1 ? `${x.text(at)} ${abscissa.unit}` : x.text(at),
    }));
  return svg(
    "g",
    { class: "axes" },
    y.ticks.map((tick) => [
      svg("line", {
        class: tick === 0 ? "zero" : "grid",
        x1: MARGIN.left,
        x2: width - MARGIN.right,
        y1: y.at(tick),
        y2: y.at(tick),
      }),
      svg("text", { x: MARGIN.left - 5, y: y.at(tick) + 4, "text-anchor": "end" }, y.text(tick)),
    ]),
    ticks.map(
      ({ at, text: words }, n) =>
        (width > NARROW || n % 2 === 0) &&
        svg(
          "text",
          {
            x: x.at(at),
            y: height - 6,
            "text-anchor": x.at(at) > width - 3 * MARGIN.right ? "end" : "middle",
          },
          words,
        ),
    ),
  );
}

/** @param {Pen} pen @param {Shown | undefined} first */
export function centreLines({ x, abscissa, height }, first) {
  if (!first) return [];
  const again = first.turns === 2 ? first.centres.map((place) => place + 180) : [];
  return [...first.centres, ...again].map((angle, n) => {
    const pixel = x.at(abscissa.place(first, angle) ?? NaN);
    const share = (pixel - x.at(x.low)) / (x.at(x.high) - x.at(x.low));
    return svg(
      "g",
      { class: "centre" },
      svg("line", { x1: pixel, x2: pixel, y1: MARGIN.top, y2: height - MARGIN.bottom }),
      svg(
        "text",
        {
          x: pixel,
          y: MARGIN.top - 11,
          "text-anchor": share < 0.06 ? "start" : share > 0.94 ? "end" : "middle",
        },
        NAMES[first.turns ? "turn" : "swing"][n % 2],
      ),
    );
  });
}

/** @param {Drawn} one @param {Pen} pen */
export function curveLine(one, { x, y, abscissa }) {
  const { values, series } = one;
  let path = "";
  let pen = "M";
  for (const { x: at, n } of abscissa.path(one, values.length)) {
    const value = values[n];
    if (value === null || Number.isNaN(at)) {
      pen = "M";
      continue;
    }
    path += `${pen}${x.at(at).toFixed(1)} ${y.at(value).toFixed(1)}`;
    pen = "L";
  }
  return svg("path", { class: "curve", "data-series": series, d: path });
}

/**
 * Return the marks of a curve's minimum and maximum, none if they are unknown. Values known only from samples are marked as approximate.
 * @param {Drawn} one @param {Pen} pen
 */
export function peaks(one, { x, y, abscissa }) {
  const { values, ends, series } = one;
  if (ends === null) return null;
  const extremeValues = ends ?? extremes(values);
  if (!extremeValues || extremeValues.low.value === extremeValues.high.value) return null;
  return /** @type {const} */ (["low", "high"]).map((end) => {
    const { angle, value } = extremeValues[end];
    const size = Math.abs(value) < 1e-6 * Math.abs(y.high - y.low) ? 0 : value; // to every reader
    const pixel = x.at(abscissa.place(one, angle) ?? NaN);
    const share = (pixel - x.at(x.low)) / (x.at(x.high) - x.at(x.low));
    const anchor = share > 0.83 ? "end" : share < 0.11 ? "start" : "middle";
    return svg(
      "g",
      { class: "peak" },
      svg("circle", { cx: pixel, cy: y.at(value), r: 2.5, "data-series": series }),
      svg(
        "text",
        { x: pixel, y: y.at(value) + (end === "low" ? 13 : -5), "text-anchor": anchor },
        `${ends ? "" : "≈ "}${text(size, "", 4)}`,
      ),
    );
  });
}

/**
 * Return a sentence on a curve's minimum and maximum, if known, and where they are.
 * @param {string} words @param {string} unit @param {Shown[]} series @param {string} key @param {Abscissa} abscissa
 */
export function extremesSentence(words, unit, series, key, abscissa) {
  const known = series.filter(({ exact }) => exact?.[key] !== null);
  const each = known.map((one) => {
    const { name, curves, exact } = one;
    const extremeValues = exact?.[key] ?? extremes(curves[key]);
    if (!extremeValues) return `${name}: not defined`;
    /** @param {{ value: number, angle: number }} options */
    const describe = ({ value, angle }) =>
      `${exact?.[key] ? "" : "about "}${withUnit(value, unit, 4)} at ${text(crankAt(one, angle), "", 4)}°`;
    return `${series.length > 1 ? `${name}: ` : ""}least ${describe(extremeValues.low)}, greatest ${describe(extremeValues.high)}`;
  });
  return [`${words} over the ${abscissa.title}`, ...each].map((part) => `${part}.`).join(" ");
}
