/** Growing line of a value over the rounds. */

import { svg } from "../lib/dom.js";
import { grouped, text } from "../lib/numbers.js";
import { isPoint } from "./points.js";
import { range, scale } from "./scale.js";

const [LEAST, HEIGHT] = [460, 190]; // px; shrinks on a phone
const AREA = { left: 76, right: 24, top: 12, bottom: 40 };

/**
 * Return a picture of points [[round, value], ...] under a heading.
 * @param {readonly [number, number | null][]} points @param {string} heading @param {number} rounds @param {number} room px
 */
export function history(points, heading, rounds, room) {
  const width = Math.max(LEAST, room);
  const up = range(
    points.map(([, value]) => value),
    0.08,
  );
  const x = scale(1, Math.max(2, rounds), AREA.left, width - AREA.right, 8);
  const y = scale(up.low, up.high, HEIGHT - AREA.bottom, AREA.top, 4);
  const bottom = HEIGHT - AREA.bottom;
  const places = points
    .filter(isPoint)
    .map(([round, value]) => `${x.at(round).toFixed(1)} ${y.at(value).toFixed(1)}`);
  const [last] = points.slice(-1);
  return svg(
    "svg",
    {
      class: "points",
      viewBox: `0 0 ${width} ${HEIGHT}`,
      role: "img",
      "aria-label": `${heading}: ${last ? `${text(last[1])} after round ${last[0]}` : "none yet"}`,
    },
    x.ticks
      .filter(Number.isInteger)
      .map((tick) =>
        svg("text", { x: x.at(tick), y: bottom + 18, "text-anchor": "middle" }, grouped(tick)),
      ),
    y.ticks.map((tick) => [
      svg("path", { class: "grid", d: `M${AREA.left} ${y.at(tick)}H${width - AREA.right}` }),
      svg("text", { x: AREA.left - 7, y: y.at(tick) + 4, "text-anchor": "end" }, y.text(tick)),
    ]),
    svg(
      "text",
      {
        class: "title",
        x: (AREA.left + width - AREA.right) / 2,
        y: HEIGHT - 4,
        "text-anchor": "middle",
      },
      "round",
    ),
    places.length > 1 && svg("path", { class: "curve", d: `M${places.join("L")}` }),
    svg(
      "g",
      { class: "series-1" },
      places.map((place) =>
        svg("circle", { cx: place.split(" ")[0], cy: place.split(" ")[1], r: 2.6 }),
      ),
    ),
  );
}
