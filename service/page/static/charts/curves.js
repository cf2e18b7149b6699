/** Curves over a turn of the crank: one chart for each, a common cursor at the crank angle. */

import { fill, h, svg } from "../lib/dom.js";
import { inShown, text, unitOf, withUnit } from "../lib/numbers.js";
import { between, extremes } from "./cycle.js";
import { range, scale } from "./scale.js";

/**
 * What a chart shows of a design: its curves under a name; series: which colour it has.
 * @typedef {Pick<Page.Machine, "name" | "series" | "curves" | "centres">} Shown
 * @typedef {{ key: string } & Page.Heading} Panel
 * @typedef {Shown & { values: (number | null)[] }} Drawn
 */

const HEIGHT = 170;
const ROOM = { left: 52, right: 12, top: 18, bottom: 22 };
const QUARTERS = [0, 90, 180, 270, 360];
const SOON = 150; // ms after a change, until charts that are out of sight follow
const EVERY = 100; // ms between two readouts while it moves; faster ones cannot be read

/**
 * Put charts into `place`; turned(angle): called as the reader moves over a chart. Returns
 * - show(series, panels): series: each {name, series, curves, centres}, the first in front; centres: the dead centres, deg;
 *   panels: each {key, title, unit}, a curve of the API. - turn({angle, settled}). - close().
 * @param {HTMLElement} place @param {(angle: number, taken: boolean) => void} turned
 */
export function curveCharts(place, turned) {
  const grid = h("div", { class: "curves" });
  place.append(grid);
  /** @type {{ series: Shown[], panels: Panel[] } | null} */
  let shown = null;
  /** @type {ReturnType<typeof chart>[]} */
  let charts = [];
  let width = 0;
  let at = 0;
  let told = 0;
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let later = 0;
  let observed = false;
  /** @type {Set<Element>} */
  const inSight = new Set(); // charts that the reader sees

  function arrange() {
    if (!shown) return;
    const { series, panels } = shown;
    if (charts.map((one) => one.panel.key).join() !== panels.map((panel) => panel.key).join()) {
      charts = panels.map((panel) => chart(panel, turned));
      fill(grid, charts.map((one) => one.figure));
      sight.disconnect();
      observed = false;
      charts.forEach((one) => sight.observe(one.figure));
      width = 0;
    }
    width = Math.round(charts[0]?.plot.clientWidth ?? 0);
    if (width < 80) return;
    charts.forEach((one, n) => {
      one.stale = () => one.draw(panels[n], series, width);
      if (!observed || inSight.has(one.figure)) drawn(one);
    });
    turn({ angle: at, settled: true });
    clearTimeout(later);
    later = setTimeout(() => charts.forEach(drawn), SOON);
  }

  /** Draw a chart that has changed. @param {ReturnType<typeof chart>} one */
  function drawn(one) {
    one.stale?.();
    if (one.stale) one.turn(at, true);
    one.stale = null;
  }

  /** @param {{ angle: number, settled: boolean }} turn */
  function turn({ angle, settled }) {
    at = angle;
    if (!width) return;
    const now = performance.now();
    const read = settled || now - told > EVERY;
    if (read) told = now;
    for (const one of charts) if (settled || inSight.has(one.figure)) one.turn(angle, read);
  }

  const sight = new IntersectionObserver((seen) => {
    observed = true;
    for (const { target, isIntersecting } of seen) isIntersecting ? inSight.add(target) : inSight.delete(target);
    charts.filter((one) => inSight.has(one.figure)).forEach(drawn);
  });

  const watcher = new ResizeObserver(() => charts.length && Math.round(charts[0].plot.clientWidth) !== width && arrange());
  watcher.observe(grid);
  return {
    /** @param {Shown[]} series @param {Panel[]} panels */
    show(series, panels) {
      shown = { series, panels };
      arrange();
    },
    turn,
    close() {
      clearTimeout(later);
      for (const one of [watcher, sight]) one.disconnect();
    },
  };
}

/** @param {Panel} panel @param {(angle: number, taken: boolean) => void} turned */
function chart(panel, turned) {
  const readout = h("span", { class: "readout number" });
  const title = h("span", { class: "title" });
  const picture = svg("svg", { class: "chart", role: "img" });
  // Cursor and dots lie over the picture, which is not painted again as they move.
  const cursor = h("div", { class: "cursor" });
  const plot = h("div", { class: "plot" }, picture);
  const figure = h("figure", { "data-key": panel.key }, h("figcaption", {}, title, readout), plot);
  cursor.style.height = `${HEIGHT - ROOM.top - ROOM.bottom}px`;
  /** @type {Page.Scale & { width: number } | null} */
  let x = null;
  /** @type {Page.Scale} */
  let y;
  /** @type {Drawn[]} */
  let series = [];
  /** @type {HTMLElement[]} */
  let dots = [];
  let lit = false;

  /** @param {PointerEvent} event */
  const move = (event) => {
    if (!x) return;
    const box = picture.getBoundingClientRect();
    turned(Math.min(Math.max(x.value(((event.clientX - box.left) * x.width) / box.width), 0), 359.99), lit);
  };
  picture.addEventListener("pointerdown", (event) => {
    lit = true;
    picture.setPointerCapture(event.pointerId);
    move(event);
  });
  picture.addEventListener("pointermove", (event) => (lit || event.pointerType === "mouse") && move(event));
  for (const end of ["pointerup", "pointercancel"]) picture.addEventListener(end, () => (lit = false));

  return {
    panel,
    figure,
    plot,
    /** @type {(() => void) | null} */
    stale: null, // draws what has changed
    /** @param {Panel} given @param {Shown[]} all @param {number} width */
    draw({ key, title: words, unit }, all, width) {
      series = all.filter(({ curves }) => curves[key]).map((one) => ({ ...one, values: one.curves[key].map((value) => value === null ? null : inShown(value, unit)) }));
      title.textContent = `${words} (${unitOf(unit)})`;
      const { low, high } = range(series.flatMap(({ values }) => values), 0.14);
      const across = { ...scale(0, 360, ROOM.left, width - ROOM.right), width };
      x = across;
      y = scale(low, high, HEIGHT - ROOM.bottom, ROOM.top, 4);
      picture.setAttribute("viewBox", `0 0 ${width} ${HEIGHT}`);
      picture.setAttribute("aria-label", summary(words, unit, series, key));
      dots = series.map((one) => h("div", { class: "dot", "data-series": one.series }));
      fill(picture, axes(across, y, width), centreLines(across, series[0]), series.map((one) => line(one, across, y)).reverse(), series[0] && peaks(series[0], across, y));
      fill(plot, picture, cursor, dots.toReversed());
    },
    /** @param {number} angle @param {boolean} read */
    turn(angle, read) {
      if (!x) return;
      const across = x.at(angle).toFixed(1);
      cursor.style.transform = `translate(${across}px, ${ROOM.top}px)`;
      const values = series.map((one) => between(one.values, angle));
      values.forEach((value, n) => (dots[n].style.transform = value === null ? "translate(-99px, 0)" : `translate(${across}px, ${y.at(value).toFixed(1)}px)`));
      if (read) readout.textContent = values.map((value) => (value === null ? "–" : text(value, "", 4))).join("  ·  ");
    },
  };
}

/** @param {Page.Scale} x @param {Page.Scale} y @param {number} width */
function axes(x, y, width) {
  return svg(
    "g",
    { class: "axes" },
    y.ticks.map((tick) => [
      svg("line", { class: tick === 0 ? "zero" : "grid", x1: ROOM.left, x2: width - ROOM.right, y1: y.at(tick), y2: y.at(tick) }),
      svg("text", { x: ROOM.left - 5, y: y.at(tick) + 4, "text-anchor": "end" }, y.text(tick)),
    ]),
    QUARTERS.map((tick) => svg("text", { x: x.at(tick), y: HEIGHT - 6, "text-anchor": "middle" }, `${tick}°`)),
  );
}

/** @param {Page.Scale} x @param {Shown | undefined} first */
function centreLines(x, first) {
  return (first?.centres ?? []).map((angle, n) =>
    svg("g", { class: "centre" },
      svg("line", { x1: x.at(angle), x2: x.at(angle), y1: ROOM.top, y2: HEIGHT - ROOM.bottom }),
      svg("text", { x: x.at(angle), y: ROOM.top - 4, "text-anchor": angle < 20 ? "start" : angle > 340 ? "end" : "middle" }, n ? "outer" : "inner")));
}

/** @param {Drawn} given @param {Page.Scale} x @param {Page.Scale} y */
function line({ values, series }, x, y) {
  let path = "";
  let pen = "M";
  const step = 360 / values.length;
  for (let n = 0; n <= values.length; n += 1) {
    const value = values[n % values.length];
    if (value === null) {
      pen = "M";
      continue;
    }
    path += `${pen}${x.at(n * step).toFixed(1)} ${y.at(value).toFixed(1)}`;
    pen = "L";
  }
  return svg("path", { class: "curve", "data-series": series, d: path });
}

/** @param {Drawn} given @param {Page.Scale} x @param {Page.Scale} y */
function peaks({ values, series }, x, y) {
  const found = extremes(values);
  if (!found || found.low.value === found.high.value) return null;
  return /** @type {const} */ (["low", "high"]).map((end) => {
    const { angle, value } = found[end];
    const anchor = angle > 300 ? "end" : angle < 40 ? "start" : "middle";
    return svg("g", { class: "peak" },
      svg("circle", { cx: x.at(angle), cy: y.at(value), r: 2.5, "data-series": series }),
      svg("text", { x: x.at(angle), y: y.at(value) + (end === "low" ? 12 : -5), "text-anchor": anchor }, text(value, "", 4)));
  });
}

/**
 * Return a sentence for a curve: its least and greatest value, and where.
 * @param {string} words @param {string} unit @param {Shown[]} series @param {string} key
 */
function summary(words, unit, series, key) {
  const each = series.map(({ name, curves }) => {
    const found = extremes(curves[key]);
    if (!found) return `${name}: not defined`;
    /** @param {{ value: number, angle: number }} given */
    const at = ({ value, angle }) => `${withUnit(value, unit, 4)} at ${text(angle, "", 4)}°`;
    return `${series.length > 1 ? `${name}: ` : ""}least ${at(found.low)}, greatest ${at(found.high)}`;
  });
  return `${words} over the crank angle. ${each.join(". ")}.`;
}
