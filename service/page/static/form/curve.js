/** Table of points as an editable curve: points are dragged or moved by keys; with the dead centres of a linkage within the ranges. */

import { extremes } from "../charts/cycle.js";
import { range, scale } from "../charts/scale.js";
import { fill, h, svg } from "../lib/dom.js";
import { convert } from "../lib/units.js";

/** @import { Column } from "./points.js" */
/** @typedef {{ at: number, name: string }} Centre */

const [WIDTH, HEIGHT] = [560, 220];
const AREA = { left: 62, right: 16, top: 22, bottom: 40 };
const FINE = 200; // minimum number of axis steps to which a dragged point is rounded
const KEYS = 50; // axis steps per key press
/** @type {Record<string, Page.Point>} */
const WAYS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

/**
 * Return {node, draw()} of the curve. read(): its points; none while they are invalid. write(points): called after a change. titles():
 * titles of both axes, with units. centres(): dead centres in the unit of the first column. steps: whether two points may share an
 * abscissa.
 * @param {{ read: () => Page.Point[] | null, write: (points: Page.Point[]) => void, titles: () => string[], centres: () => Centre[], steps: boolean }} options
 */
export function curve({ read, write, titles, centres, steps }) {
  const picture = svg("svg", {
    class: "curve-drawn",
    viewBox: `0 0 ${WIDTH} ${HEIGHT}`,
    onpointerdown: (event) => {
      dragged = numberOf(event);
      if (dragged < 0) return;
      event.preventDefault();
      picture.setPointerCapture(event.pointerId);
    },
    onpointermove: (event) => {
      if (dragged >= 0) move(dragged, valuesAt(event));
    },
    ondblclick: (event) => {
      const points = read();
      if (numberOf(event) >= 0 || !points || !scales) return;
      const [at, value] = valuesAt(event);
      const added = /** @type {Page.Point} */ ([rounded(at, scales.x), rounded(value, scales.y)]);
      if (points.some(([x]) => x === added[0])) return;
      write([...points, added].sort(([one], [other]) => one - other));
      draw();
    },
    onkeydown: (event) => {
      const [n, points] = [numberOf(event), read()];
      if (n < 0 || !points || !scales) return;
      const way = WAYS[event.key];
      if (way) {
        event.preventDefault();
        const step = [scales.x, scales.y].map(({ low, high }) => (high - low) / KEYS);
        move(n, [points[n][0] + way[0] * step[0], points[n][1] + way[1] * step[1]]);
      } else if (event.key === "Delete" && points.length > 2) {
        event.preventDefault();
        write(points.filter((_, other) => other !== n));
        draw(Math.min(n, points.length - 2));
      }
    },
  });
  const node = h(
    "figure",
    { class: "drawn-points" },
    picture,
    h(
      "figcaption",
      { class: "quiet" },
      "Drag a point, or move it with the arrow keys. Double-click the curve to add a point; press Delete to remove one." +
        (steps ? " Two points at one position make a step." : ""),
    ),
  );
  /** @type {{ x: Page.Scale, y: Page.Scale } | null} */
  let scales = null; // fixed while a point is dragged
  let dragged = -1;

  function draw(focus = -1) {
    const points = read();
    node.hidden = points === null || points.length < 2;
    if (points === null || points.length < 2) return;
    const marks = centres();
    if (dragged < 0) scales = scalesOf(points, marks);
    const { x, y } = /** @type {NonNullable<typeof scales>} */ (scales);
    const bottom = HEIGHT - AREA.bottom;
    const names = titles();
    const places = points.map((point) => [x.at(point[0]).toFixed(1), y.at(point[1]).toFixed(1)]);
    fill(
      picture,
      y.ticks.map((tick) => [
        svg("path", { class: "grid", d: `M${AREA.left} ${y.at(tick)}H${WIDTH - AREA.right}` }),
        svg("text", { x: AREA.left - 8, y: y.at(tick) + 4, "text-anchor": "end" }, y.text(tick)),
      ]),
      x.ticks.map((tick) =>
        svg("text", { x: x.at(tick), y: bottom + 18, "text-anchor": "middle" }, x.text(tick)),
      ),
      svg(
        "text",
        {
          class: "title",
          x: (AREA.left + WIDTH - AREA.right) / 2,
          y: HEIGHT - 4,
          "text-anchor": "middle",
        },
        names[0],
      ),
      svg("text", { class: "title", x: 4, y: 12 }, names[1]),
      marks.map(({ at, name }, n) => [
        svg("path", { class: "centre", d: `M${x.at(at)} ${AREA.top}V${bottom}` }),
        svg(
          "text",
          { x: x.at(at) + (n ? -5 : 5), y: bottom - 5, "text-anchor": n ? "end" : "start" },
          name,
        ),
      ]),
      svg("path", { class: "line", d: `M${places.map((place) => place.join(" ")).join("L")}` }),
      places.map(([cx, cy], n) =>
        svg("circle", {
          class: "point",
          cx,
          cy,
          r: 6,
          tabindex: 0,
          role: "slider",
          "data-n": n,
          "aria-label": `Point ${n + 1} of ${points.length}`,
          "aria-valuenow": points[n][1],
          "aria-valuetext": `${names[0]} ${points[n][0]}, ${names[1]} ${points[n][1]}`,
        }),
      ),
    );
    const focusedPoint = focus < 0 ? null : picture.querySelector(`[data-n="${focus}"]`);
    if (focusedPoint instanceof SVGElement) focusedPoint.focus();
  }

  /** Move a point between its neighbours, or onto one of them if the curve may step. @param {number} n @param {Page.Point} to */
  function move(n, to) {
    const points = read();
    if (!points || !scales) return;
    const [x, y] = [rounded(to[0], scales.x), rounded(to[1], scales.y)];
    const [before, after] = [points[n - 1]?.[0] ?? -Infinity, points[n + 1]?.[0] ?? Infinity];
    const equal = points.filter(([other], k) => k !== n && other === x).length;
    points[n] = [x >= before && x <= after && equal <= (steps ? 1 : 0) ? x : points[n][0], y];
    write(points);
    draw(n);
  }

  /** @param {MouseEvent} event @returns {Page.Point} */
  const valuesAt = ({ clientX, clientY }) => {
    const box = picture.getBoundingClientRect();
    const { x, y } = /** @type {NonNullable<typeof scales>} */ (scales);
    return [
      x.value(((clientX - box.left) / box.width) * WIDTH),
      y.value(((clientY - box.top) / box.height) * HEIGHT),
    ];
  };
  /** @param {Event} event */
  const numberOf = ({ target }) =>
    target instanceof SVGElement && target.dataset.n !== undefined ? Number(target.dataset.n) : -1;
  for (const name of /** @type {const} */ (["pointerup", "pointercancel"])) {
    picture.addEventListener(name, () => {
      if (dragged < 0) return;
      const last = dragged;
      dragged = -1;
      draw(last);
    });
  }
  return { node, draw: () => draw() };
}

/** @param {Page.Point[]} points @param {Centre[]} marks */
function scalesOf(points, marks) {
  const across = range([...points.map(([x]) => x), ...marks.map(({ at }) => at)], 0.03);
  const up = range([0, ...points.map(([, y]) => y)], 0.12);
  return {
    x: scale(across.low, across.high, AREA.left, WIDTH - AREA.right, 6),
    y: scale(up.low, up.high, HEIGHT - AREA.bottom, AREA.top, 4),
  };
}

/** Return a value rounded to a visible digit. @param {number} value @param {Page.Range} axis */
function rounded(value, { low, high }) {
  const step = 10 ** Math.floor(Math.log10((high - low) / FINE) + 1e-9);
  return Number((Math.round(value / step) * step).toPrecision(12));
}

/**
 * Return the dead centres of the preview's example, for a table over crank angle or slider position.
 * @param {Api.Preview | null} said @param {Column} column @param {unknown} datum what the table counts from @param {string} unit that is shown
 * @returns {Centre[]}
 */
export function centresOf(said, { kind }, datum, unit) {
  const example = said?.example;
  const motionEnds = example ? extremes(example.motion.slider_position_mm) : null;
  if (!example || !motionEnds) return [];
  const [inner, outer] = example.slider_ends_mm.map((end) => {
    const { angle } =
      Math.abs(motionEnds.low.value - end) < Math.abs(motionEnds.high.value - end)
        ? motionEnds.low
        : motionEnds.high;
    return { angle, value: Math.abs(end) }; // a table has distances, also on the crossed branch
  });
  /** @type {(value: number) => number} */
  let counted = (value) => value;
  if (kind === "length") {
    if (datum === "inner dead centre") counted = (value) => value - inner.value;
    if (datum === "outer dead centre") counted = (value) => outer.value - value;
  } else if (datum === "inner dead centre" || datum === "outer dead centre") {
    const zero = datum === "inner dead centre" ? inner.angle : outer.angle;
    counted = (angle) => ((example.clockwise ? zero - angle : angle - zero) + 720) % 360;
  }
  const [mine, key] =
    kind === "length"
      ? ["mm", /** @type {const} */ ("value")]
      : ["deg", /** @type {const} */ ("angle")];
  /** @param {string} name @param {typeof inner} end @returns {Centre} */
  const centre = (name, end) => ({
    name,
    at: Number(convert(String(counted(end[key])), mine, unit, kind)),
  });
  return [centre("inner dead centre", inner), centre("outer dead centre", outer)].sort(
    (one, other) => one.at - other.at,
  );
}
