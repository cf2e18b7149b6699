/** Thumbnail of a front. */

import { svg } from "../lib/dom.js";
import { isPoint } from "./points.js";
import { range, scale } from "./scale.js";

const WIDTH = 96;
const HEIGHT = 48;

/**
 * Return a picture of points [[x, y], ...] without axes; for a single objective, its values in order.
 * @param {Api.Row[string][][]} points @param {string} label
 */
export function thumbnail(points, label) {
  const places = points
    .map((point, index) => (point.length > 1 ? point : [index, point[0]]))
    .filter(isPoint);
  const across = range(
    places.map(([x]) => x),
    0.02,
  );
  const up = range(
    places.map(([, y]) => y),
    0.02,
  );
  const x = scale(across.low, across.high, 4, WIDTH - 4);
  const y = scale(up.low, up.high, HEIGHT - 4, 4);
  return svg(
    "svg",
    { class: "thumbnail", viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "img", "aria-label": label },
    places.map(([a, b]) =>
      svg("circle", { cx: x.at(a).toFixed(1), cy: y.at(b).toFixed(1), r: 1.8 }),
    ),
  );
}
