/** Scatter plot as SVG for some hundreds of points: a growing front, or several fronts. */

import { svg } from "../lib/dom.js";
import { inDisplayUnit } from "../lib/numbers.js";
import { headed } from "../front/columns.js";
import { nearest } from "./pointer_access.js";
import { range, scale } from "./scale.js";

/** Default width and height of a picture, in its own units. @type {Page.Point} */
const SIZE = [560, 340];
const NEAR = 14; // pixels of the picture
const AREA = { left: 76, right: 14, top: 12, bottom: 46 };
/** @type {((x: number, y: number) => SVGElement)[]} */
const SHAPES = [
  (x, y) => svg("circle", { cx: x, cy: y, r: 3.6 }),
  (x, y) => svg("rect", { x: x - 3.2, y: y - 3.2, width: 6.4, height: 6.4 }),
  (x, y) => svg("path", { d: `M${x} ${y - 4.4} ${x + 4.2} ${y + 3.2} ${x - 4.2} ${y + 3.2}Z` }),
  (x, y) => svg("path", { d: `M${x} ${y - 4.8} ${x + 4.8} ${y} ${x} ${y + 4.8} ${x - 4.8} ${y}Z` }),
];

/**
 * Return a picture of series [{points: [[x, y], ...], name}] on axes given by columns {title, unit}. Series differ in colour and shape.
 * held: axis ranges in display units, if other than those of the points. told.at: called with series and index of the point under the
 * pointer, or null; told.open: called for a clicked point.
 * @param {{ points: Api.Row[string][][], name?: string }[]} series @param {Page.Heading} x @param {Page.Heading} y @param {string} label
 * @param {[Page.Range, Page.Range] | null} held
 * @param {{ at: (series: number | null, point: number) => void, open: (series: number, point: number) => void }} [handlers]
 * @param {Page.Point} [size] width and height of the picture
 */
export function points(series, x, y, label, held = null, handlers = undefined, size = SIZE) {
  const [width, height] = size;
  const drawn = series.map((one) => one.points.filter(isPoint));
  const places = drawn.flat();
  /** @param {0 | 1} index @param {Page.Heading} column @param {number} start @param {number} end */
  const axis = (index, column, start, end) => {
    const values = places.map((point) => inDisplayUnit(point[index], column.unit));
    const { low, high } = held?.[index] ?? range(values);
    return scale(low, high, start, end);
  };
  const across = axis(0, x, AREA.left, width - AREA.right);
  const up = axis(1, y, height - AREA.bottom, AREA.top);
  const bottom = height - AREA.bottom;
  const middle = (AREA.top + bottom) / 2;
  const picture = svg(
    "svg",
    { class: "points", viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": label },
    across.ticks.map((tick) => [
      svg("path", { class: "grid", d: `M${across.at(tick)} ${AREA.top}V${bottom}` }),
      svg(
        "text",
        { x: across.at(tick), y: bottom + 18, "text-anchor": "middle" },
        across.text(tick),
      ),
    ]),
    up.ticks.map((tick) => [
      svg("path", { class: "grid", d: `M${AREA.left} ${up.at(tick)}H${width - AREA.right}` }),
      svg("text", { x: AREA.left - 7, y: up.at(tick) + 4, "text-anchor": "end" }, up.text(tick)),
    ]),
    svg(
      "text",
      {
        class: "title",
        x: (AREA.left + width - AREA.right) / 2,
        y: height - 6,
        "text-anchor": "middle",
      },
      headed(x),
    ),
    svg(
      "text",
      {
        class: "title",
        x: 17,
        y: middle,
        transform: `rotate(-90 17 ${middle})`,
        "text-anchor": "middle",
      },
      headed(y),
    ),
    drawn.map((own, index) =>
      svg(
        "g",
        { class: `series-${1 + (index % 6)}` },
        own.map(([a, b]) =>
          SHAPES[index % SHAPES.length](
            round(across.at(inDisplayUnit(a, x.unit))),
            round(up.at(inDisplayUnit(b, y.unit))),
          ),
        ),
      ),
    ),
  );
  if (handlers)
    trackPointer(
      picture,
      series,
      (point) => [
        across.at(inDisplayUnit(point[0], x.unit)),
        up.at(inDisplayUnit(point[1], y.unit)),
      ],
      handlers,
    );
  return picture;
}

/**
 * Mark and report the point under the pointer.
 * @param {SVGSVGElement} picture @param {{ points: Api.Row[string][][] }[]} series @param {(point: Page.Point) => Page.Point} place
 * @param {{ at: (series: number | null, point: number) => void, open: (series: number, point: number) => void }} told
 */
function trackPointer(picture, series, place, { at, open }) {
  const all = series.flatMap((one, number) =>
    one.points.flatMap((point, row) => (isPoint(point) ? [{ number, row, at: place(point) }] : [])),
  );
  const ring = svg("circle", { class: "ring", r: 8, cx: -99, cy: -99 });
  picture.append(ring);
  /** @param {MouseEvent} event */
  const under = ({ clientX, clientY }) => {
    const box = picture.getBoundingClientRect();
    const { width, height } = picture.viewBox.baseVal;
    const [x, y] = [
      ((clientX - box.left) * width) / box.width,
      ((clientY - box.top) * height) / box.height,
    ];
    const found = nearest(
      all.length,
      (n) => (all[n].at[0] - x) ** 2 + (all[n].at[1] - y) ** 2,
      NEAR * NEAR,
    );
    return found === null ? null : all[found];
  };
  /** @param {(typeof all)[0] | null} one */
  const mark = (one) => {
    ring.setAttribute("cx", String(one ? one.at[0] : -99));
    ring.setAttribute("cy", String(one ? one.at[1] : -99));
    picture.style.cursor = one ? "pointer" : "default";
    at(one?.number ?? null, one?.row ?? 0);
  };
  picture.addEventListener("pointermove", (event) => mark(under(event)));
  picture.addEventListener("pointerleave", () => mark(null));
  picture.addEventListener("click", (event) => {
    const one = under(event);
    if (one) open(one.number, one.row);
  });
}

/** Whether both coordinates of a point are defined. @type {(point: readonly unknown[]) => point is Page.Point} */
export function isPoint(point) {
  return point.every(Number.isFinite);
}

/** Return the legend symbol of a series. @param {number} index */
export function legendSymbol(index) {
  return svg(
    "svg",
    { class: "sign", viewBox: "0 0 12 12", "aria-hidden": "true" },
    svg("g", { class: `series-${1 + (index % 6)}` }, SHAPES[index % SHAPES.length](6, 6)),
  );
}

/** @param {number} pixel */
function round(pixel) {
  return Math.round(10 * pixel) / 10;
}
