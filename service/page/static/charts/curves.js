/** Curves of a cycle: one chart for each, large or small, with a common cursor at the crank angle. */

import { fill, h, svg } from "../lib/dom.js";
import { inDisplayUnit, text, unitOf } from "../lib/numbers.js";
import { abscissaOf } from "./abscissa.js";
import { axes, centreLines, curveLine, peaks, MARGIN, extremesSentence } from "./curve_parts.js";
import { interpolatedValue } from "./cycle.js";
import { range, scale } from "./scale.js";

/**
 * @import { Abscissa } from "./abscissa.js"
 *
 * Curves of a design in a chart, with its name; series: its colour.
 * @typedef {Pick<Page.Machine, "name" | "series" | "curves" | "exact" | "centres" | "sliderEnds" | "turns">} Shown
 * @typedef {{ key: string } & Page.Heading} Panel
 * @typedef {Shown & { values: (number | null)[], ends?: Page.Ends | null }} Drawn as it is shown: in the reader's units
 */

const HEIGHTS = { large: 250, small: 140 };
const SOON = 150; // ms from a change until charts outside the screen are redrawn
const EVERY = 100; // ms between readouts during motion; faster changes are unreadable

/**
 * Put charts into `place`; turned(angle): called as the pointer moves over a chart. Returns show(series, panels, abscissa), turn({angle,
 * settled}) and close(). series: {name, series, curves, centres} of each design, the first in front; centres: dead centres, deg. panels:
 * {key, title, unit} of each curve. large: keys of the large charts, at most `most`; onChoice(keys): called when the user makes other
 * charts large.
 * @param {HTMLElement} place @param {(angle: number, taken: boolean) => void} turned
 * @param {{ large: string[], most?: number, onChoice: (large: string[]) => void }} sizes
 */
export function curveCharts(place, turned, sizes) {
  const [wide, grid] = ["curves large", "curves small"].map((name) => h("div", { class: name }));
  place.append(wide, grid);
  let abscissa = abscissaOf("angle", 0);
  let { large } = sizes;
  const { most = 3 } = sizes;
  /** @type {{ series: Shown[], panels: Panel[] } | null} */
  let content = null;
  /** @type {ReturnType<typeof chart>[]} */
  let charts = [];
  let width = 0;
  let cycleAngle = 0;
  let lastRead = 0;
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let later = 0;
  let observed = false;
  /** @type {Set<Element>} */
  const inSight = new Set(); // charts in sight

  function arrange() {
    if (!content) return;
    const { series, panels } = content;
    if (charts.map((one) => one.panel.key).join() !== panels.map((panel) => panel.key).join()) {
      charts = panels.map((panel) => chart(panel, turned, resize));
      sort();
      sight.disconnect();
      observed = false;
      charts.forEach((one) => sight.observe(one.figure));
      width = 0;
    }
    width = Math.round(place.clientWidth);
    if (width < 80) return;
    charts.forEach((one, n) => {
      one.stale = () => one.draw(panels[n], series, abscissa);
      if (!observed || inSight.has(one.figure)) drawn(one);
    });
    turn({ angle: cycleAngle, settled: true });
    clearTimeout(later);
    later = setTimeout(() => charts.forEach(drawn), SOON);
  }

  /** Arrange the charts: large ones first, in their order. */
  function sort() {
    const first = large.flatMap((key) => charts.find((one) => one.panel.key === key) ?? []);
    const chosen = (first.length ? first : charts).slice(0, most);
    for (const one of charts) one.size(chosen.includes(one));
    fill(
      wide,
      chosen.map((one) => one.figure),
    );
    fill(
      grid,
      charts.filter((one) => !chosen.includes(one)).map((one) => one.figure),
    );
  }

  /** Make a curve large, in place of the last large one, or small. @param {string} key */
  function resize(key) {
    const now = charts
      .filter((one) => one.figure.parentElement === wide)
      .map((one) => one.panel.key);
    const rest = now.filter((one) => one !== key);
    large = now.includes(key) ? (rest.length ? rest : now) : [key, ...rest].slice(0, most);
    sizes.onChoice(large);
    sort();
    arrange();
    charts.find((one) => one.panel.key === key)?.sizer.focus();
  }

  /** Draw a chart that has changed. @param {ReturnType<typeof chart>} one */
  function drawn(one) {
    one.stale?.();
    if (one.stale) one.turn(cycleAngle, true);
    one.stale = null;
  }

  /** @param {{ angle: number, settled: boolean }} turn */
  function turn({ angle, settled }) {
    cycleAngle = angle;
    if (!width) return;
    const now = performance.now();
    const read = settled || now - lastRead > EVERY;
    if (read) lastRead = now;
    for (const one of charts) if (settled || inSight.has(one.figure)) one.turn(angle, read);
  }

  const sight = new IntersectionObserver((seen) => {
    observed = true;
    for (const { target, isIntersecting } of seen)
      isIntersecting ? inSight.add(target) : inSight.delete(target);
    charts.filter((one) => inSight.has(one.figure)).forEach(drawn);
  });

  const watcher = new ResizeObserver(
    () => charts.length && Math.round(place.clientWidth) !== width && arrange(),
  );
  watcher.observe(place);
  return {
    /** @param {Shown[]} series @param {Panel[]} panels @param {Abscissa} over */
    show(series, panels, over) {
      content = { series, panels };
      abscissa = over;
      arrange();
    },
    turn,
    close() {
      clearTimeout(later);
      for (const one of [watcher, sight]) one.disconnect();
    },
  };
}

/** @param {Panel} panel @param {(angle: number, taken: boolean) => void} turned @param {(key: string) => void} resize */
function chart(panel, turned, resize) {
  const sizer = h("button", {
    type: "button",
    class: "small sizer",
    onclick: () => resize(panel.key),
  });
  const readout = h("span", { class: "readout number" });
  const title = h("span", { class: "title" });
  const picture = svg("svg", {
    class: "chart",
    role: "img",
    onpointerdown: (event) => {
      lit = true;
      picture.setPointerCapture(event.pointerId);
      move(event);
    },
    onpointermove: (event) => (lit || event.pointerType === "mouse") && move(event),
  });
  // Cursor and dots have a separate layer, so that the picture is not repainted as they move.
  const cursor = h("div", { class: "cursor" });
  const plot = h("div", { class: "plot" }, picture);
  const figure = h(
    "figure",
    { "data-key": panel.key },
    h("figcaption", {}, title, readout, sizer),
    plot,
  );
  let height = HEIGHTS.small;
  /** @type {Page.Scale & { width: number } | null} */
  let x = null;
  /** @type {Abscissa} */
  let abscissa;
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
    const at = [event.clientX - box.left, event.clientY - box.top].map(
      (pixel) => (pixel * /** @type {{ width: number }} */ (x).width) / box.width,
    );
    turned(
      abscissa.angle
        ? Math.min(Math.max(abscissa.angle(x.value(at[0])), 0), 359.99)
        : nearest(at[0], at[1]),
      lit,
    );
  };

  /**
   * Return the crank angle of the nearest point on the first curve; a displacement alone has two crank angles.
   * @param {number} right @param {number} down
   */
  function nearest(right, down) {
    const [{ values }] = series;
    let [best, least] = [0, Infinity];
    for (const { x: at, n } of abscissa.path(series[0], values.length)) {
      const value = values[n];
      const distance =
        value === null || !x ? Infinity : Math.hypot(x.at(at) - right, y.at(value) - down);
      if (distance < least) [best, least] = [n, distance];
    }
    return (360 * best) / values.length;
  }

  for (const end of ["pointerup", "pointercancel"])
    picture.addEventListener(end, () => (lit = false));

  return {
    panel,
    figure,
    plot,
    sizer,
    /** @param {boolean} yes */
    size(yes) {
      height = yes ? HEIGHTS.large : HEIGHTS.small;
      cursor.style.height = `${height - MARGIN.top - MARGIN.bottom}px`;
      sizer.textContent = yes ? "−" : "+";
      sizer.title = yes ? "Make it small" : "Make it large";
      sizer.setAttribute("aria-label", `${sizer.title}: ${panel.title}`);
    },
    /** @type {(() => void) | null} */
    stale: null, // draws what has changed
    /** @param {Panel} options @param {Shown[]} all @param {Abscissa} over */
    draw({ key, title: words, unit }, all, over) {
      const width = Math.max(80, Math.round(plot.clientWidth));
      abscissa = over;
      series = all
        .filter(({ curves }) => curves[key])
        .map((one) => ({
          ...one,
          values: one.curves[key].map((value) =>
            value === null ? null : inDisplayUnit(value, unit),
          ),
          ends: endsOf(one.exact?.[key], unit),
        }));
      title.textContent = `${words} (${unitOf(unit)})`;
      const { low, high } = range(
        series.flatMap(({ values }) => values),
        0.14,
      );
      const span = abscissa.span(series);
      x = {
        ...scale(span.low, span.high, MARGIN.left, width - MARGIN.right, width > 300 ? 6 : 3),
        width,
      };
      y = scale(low, high, height - MARGIN.bottom, MARGIN.top, height > 200 ? 6 : 3);
      picture.setAttribute("viewBox", `0 0 ${width} ${height}`);
      picture.setAttribute("aria-label", extremesSentence(words, unit, series, key, abscissa));
      dots = series.map((one) => h("div", { class: "dot", "data-series": one.series }));
      const pen = { x, y, abscissa, height };
      fill(
        picture,
        axes(pen, width),
        centreLines(pen, series[0]),
        series.map((one) => curveLine(one, pen)).reverse(),
        series[0] && peaks(series[0], pen),
      );
      fill(plot, picture, cursor, dots.toReversed());
    },
    /** @param {number} angle @param {boolean} read */
    turn(angle, read) {
      if (!x) return;
      const scaled = x;
      const places = series.map((one) => scaled.at(abscissa.place(one, angle) ?? NaN));
      cursor.style.transform = `translate(${(places[0] ?? 0).toFixed(1)}px, ${MARGIN.top}px)`;
      const values = series.map((one) => interpolatedValue(one.values, angle));
      values.forEach(
        (value, n) =>
          (dots[n].style.transform =
            value === null
              ? "translate(-99px, 0)"
              : `translate(${places[n].toFixed(1)}px, ${y.at(value).toFixed(1)}px)`),
      );
      if (read)
        readout.textContent = values
          .map((value) => (value === null ? "–" : text(value, "", 4)))
          .join("  ·  ");
    },
  };
}

/** Return the exact extremes of a curve in display units. @param {Page.Ends | null | undefined} exact @param {string} unit */
function endsOf(exact, unit) {
  if (!exact) return exact;
  const { low, high } = exact;
  return {
    low: { ...low, value: inDisplayUnit(low.value, unit) },
    high: { ...high, value: inDisplayUnit(high.value, unit) },
  };
}
