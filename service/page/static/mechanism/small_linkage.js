/** Thumbnail of a linkage. */

import { svg } from "../lib/dom.js";
import { motionOf } from "./motion.js";

/** @import { Frame } from "./frame.js" */

const WIDTH = 88;
const HEIGHTS = [26, 64];
const ANGLES = [60, 30, 90, 0, 120, 330, 180, 270]; // crank angles, deg: no links overlap at the first, but not every linkage closes there

/**
 * Return a picture of a linkage in a frame that several share, so that they have one scale.
 * @param {Page.Lengths} linkage @param {Frame} frame
 */
export function smallLinkage(linkage, frame) {
  const { crank_mm: r, offset_mm: e } = linkage;
  const [wide, tall] = [frame.right - frame.left, frame.high - frame.low];
  const unit = WIDTH / wide;
  const height = Math.min(Math.max(unit * tall, HEIGHTS[0]), HEIGHTS[1]);
  /** @param {number} millimetres */
  const x = (millimetres) => (unit * (millimetres - frame.left)).toFixed(1);
  /** @param {number} millimetres */
  const y = (millimetres) =>
    (height / 2 + unit * ((frame.high + frame.low) / 2 - millimetres)).toFixed(1);
  const positions = motionOf(linkage).slider_position_mm;
  const degrees = ANGLES.find((at) => Number.isFinite(positions[at])) ?? ANGLES[0];
  const angle = (degrees * Math.PI) / 180;
  const [across, up] = [r * Math.cos(angle), r * Math.sin(angle)];
  const slider = Number.isFinite(positions[degrees]) ? positions[degrees] : 0;
  return svg(
    "svg",
    {
      class: "small-linkage",
      viewBox: `0 0 ${WIDTH} ${height.toFixed(0)}`,
      width: WIDTH,
      height: height.toFixed(0),
      "aria-hidden": "true",
    },
    svg("line", { class: "way", x1: x(frame.left), x2: x(frame.right), y1: y(e), y2: y(e) }),
    svg("circle", { class: "way", cx: x(0), cy: y(0), r: (unit * r).toFixed(1) }),
    svg("path", {
      class: "links",
      d: `M${x(0)} ${y(0)}L${x(across)} ${y(up)}L${x(slider)} ${y(e)}`,
    }),
    svg("rect", {
      class: "block",
      x: Number(x(slider)) - 5,
      y: Number(y(e)) - 3.5,
      width: 10,
      height: 7,
      rx: 1,
    }),
    svg("circle", { class: "pivot", cx: x(0), cy: y(0), r: 2 }),
  );
}
