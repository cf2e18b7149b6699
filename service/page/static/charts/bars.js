/** Bars: signed ones in a table, and a histogram. */

import { fill, h, svg } from "../lib/dom.js";
import { range, scale } from "./scale.js";
import { headedRow } from "../lib/table.js";

const [HEIGHT, ROOM] = [200, { left: 12, right: 12, top: 26, bottom: 22 }];

/**
 * Return a table of signed bars, the longest first. rows: each {title, value, text} and kink where neither way is better; values that are null have no bar; largest: what
 * a whole bar is; good(value): true, false, or null where neither way is better; caption: what the table is called; signed: whether
 * bars go both ways.
 * @param {{ title: string, value: number | null, text: string, kink?: boolean }[]} rows
 * @param {{ largest: number, good: (value: number) => boolean | null, caption: string, signed?: boolean }} looks
 */
export function tornado(rows, { largest, good, caption, signed = true }) {
  const ordered = [...rows].sort(
    (one, other) => Math.abs(other.value ?? 0) - Math.abs(one.value ?? 0),
  );
  return h(
    "table",
    { class: "tornado" },
    h("caption", {}, caption),
    h(
      "tbody",
      {},
      ordered.map(({ title, value, text, kink = false }) => {
        const bar = h("span", { class: "bar" });
        const share = largest > 0 && value ? Math.min(Math.abs(value) / largest, 1) : 0;
        const whole = signed ? 50 : 100;
        bar.style.width = `${whole * share}%`;
        bar.style.left = signed ? `${value && value < 0 ? 50 - 50 * share : 50}%` : "0";
        const way = value && !kink ? good(value) : null;
        if (way !== null) bar.classList.add(way ? "better" : "worse");
        return headedRow(
          title,
          h("td", { class: signed ? "bars" : "bars plain", "aria-hidden": "true" }, bar),
          h("td", { class: "number" }, text),
        );
      }),
    ),
  );
}

/**
 * Put a histogram into `place`. edges: of the bins; counts: in them; marks: each {value, title}, drawn as lines; axis(value): text
 * of a value; label: for screen readers. It fills the width of its place; returns {close()}.
 * @param {HTMLElement} place @param {{ edges: number[], counts: number[], marks: { value: number, title: string }[], label: string }} given
 */
export function histogram(place, { edges, counts, marks, label }) {
  const picture = svg("svg", { class: "chart histogram", role: "img", "aria-label": label });
  fill(place, picture);
  let width = 0;
  const draw = () => {
    width = Math.round(place.clientWidth);
    if (width < 80) return;
    const { high } = range([...edges, ...marks.map(({ value }) => value)], 0.05);
    const x = scale(0, high, ROOM.left, width - ROOM.right, Math.min(8, width / 70));
    const y = scale(0, Math.max(...counts), HEIGHT - ROOM.bottom, ROOM.top, 4);
    picture.setAttribute("viewBox", `0 0 ${width} ${HEIGHT}`);
    const ordered = [...marks].sort((one, other) => one.value - other.value);
    fill(
      picture,
      counts.map((count, n) =>
        svg("rect", {
          x: x.at(edges[n]),
          width: Math.max(x.at(edges[n + 1]) - x.at(edges[n]) - 1, 0.5),
          y: y.at(count),
          height: y.at(0) - y.at(count),
        }),
      ),
      svg("line", {
        class: "zero",
        x1: ROOM.left,
        x2: width - ROOM.right,
        y1: y.at(0),
        y2: y.at(0),
      }),
      x.ticks.map((tick) =>
        svg("text", { x: x.at(tick), y: HEIGHT - 6, "text-anchor": "middle" }, x.text(tick)),
      ),
      ordered.map(({ value, title }, n) => {
        const across = x.at(value);
        const end = across > 0.7 * width;
        return svg(
          "g",
          { class: "mark" },
          svg("line", {
            x1: across,
            x2: across,
            y1: ROOM.top - 8 + 13 * (n % 3),
            y2: HEIGHT - ROOM.bottom,
          }),
          svg(
            "text",
            {
              x: across + (end ? -4 : 4),
              y: ROOM.top - 2 + 13 * (n % 3),
              "text-anchor": end ? "end" : "start",
            },
            title,
          ),
        );
      }),
    );
  };
  draw();
  const watcher = new ResizeObserver(() => Math.round(place.clientWidth) !== width && draw());
  watcher.observe(place);
  return { close: () => watcher.disconnect() };
}
