/** Small pictures of the linkage, each illustrating a quantity. The coordinates are those of one linkage, computed once. */

import { svg } from "../lib/dom.js";

/**
 * @typedef {{ pin: Page.Point, slider: Page.Point }} Pose
 * @type {Page.Point}
 */
const O = [75, 112]; // crank pivot
const LINE = 86; // slider line
/** @type {Pose} */
const POSE = { pin: [94, 79.1], slider: [223.8, LINE] };
/** @type {Pose} */
const STEEP = { pin: [75, 150], slider: [188.2, LINE] }; // crank normal to the slider line, pointing away: the least transmission angle
/** @type {Pose} */
const OUT = { pin: [112.5, 106.1], slider: [241, LINE] };
/** @type {Pose} */
const IN = { pin: [38.5, 122.7], slider: [163.2, LINE] };
const RADIUS = 38;

/** Return the picture for a kind of quantity. title: text for screen readers. @param {string} kind @param {string} title */
export function picture(kind, title) {
  const { pose = POSE, marks } = PICTURES[kind] ?? { marks: () => [] };
  return svg(
    "svg",
    { class: "picture", viewBox: "0 30 296 146", role: "img", "aria-label": `Picture: ${title}` },
    still(),
    linkage(pose),
    marks(),
  );
}

/** @type {Record<string, { pose?: Pose, marks: () => Dom.Child }>} */
const PICTURES = {
  crank: { marks: () => [bold(O, POSE.pin), label(42, 92, "crank")] },
  rod: { marks: () => [bold(POSE.pin, POSE.slider), label(140, 72, "rod")] },
  offset: { marks: () => [size([24, O[1]], [24, LINE]), label(4, 80, "offset")] },
  stroke: {
    marks: () => [
      ghost(OUT),
      ghost(IN),
      size([IN.slider[0], 118], [OUT.slider[0], 118]),
      drop(IN.slider, 122),
      drop(OUT.slider, 122),
      label(180, 135, "stroke"),
    ],
  },
  "time ratio": {
    marks: () => [
      ghost(OUT),
      ghost(IN),
      dashedLine(O, OUT.pin),
      dashedLine(O, IN.pin),
      wide(OUT.pin, IN.pin, 1),
      label(18, 62, "slow stroke"),
      label(84, 148, "fast"),
    ],
  },
  "transmission angle": {
    pose: STEEP,
    marks: () => [
      dashedLine(STEEP.slider, [STEEP.slider[0], 150]),
      stroked(`M${STEEP.slider[0]} 122A36 36 0 0 1 ${STEEP.slider[0] - 31.3} ${LINE + 17.7}`),
      label(162, 142, "µ"),
    ],
  },
  "self-locking": {
    pose: STEEP,
    marks: () => [
      arrow(STEEP.pin, [STEEP.slider[0] - 14, LINE + 8]),
      arrow([STEEP.slider[0], LINE + 42], [STEEP.slider[0], LINE + 13]),
      label(200, 132, "guide"),
    ],
  },
  torque: { marks: () => [turning(), label(20, 52, "torque")] },
  power: { marks: () => [turning(), label(20, 52, "power")] },
  inertia: {
    marks: () => [
      bold(O, POSE.pin),
      bold(POSE.pin, POSE.slider),
      box(POSE.slider, "mark"),
      turning(),
    ],
  },
  "position error": {
    marks: () => [
      box([POSE.slider[0] - 9, LINE], "dashed"),
      box([POSE.slider[0] + 9, LINE], "dashed"),
      size([POSE.slider[0] - 9, 116], [POSE.slider[0] + 9, 116]),
      label(206, 134, "± error"),
    ],
  },
  "desired motion": {
    marks: () => [
      ...[30, 58, 82, 104, 130, 160].map((x, place) =>
        dot([120 + x, 150 - [4, 12, 17, 16, 10, 3][place]]),
      ),
      stroked("M138 152C170 134 205 126 232 136S270 150 286 152"),
      label(140, 172, "points of the motion"),
    ],
  },
  cylinder: {
    marks: () => [
      ghost(OUT),
      ghost(IN),
      svg("rect", {
        class: "mark dashed",
        x: IN.slider[0] + 18,
        y: LINE - 12,
        width: OUT.slider[0] - IN.slider[0],
        height: 24,
      }),
      label(172, 140, "swept volume"),
    ],
  },
  footprint: {
    marks: () => [
      svg("rect", { class: "mark dashed", x: 37, y: 74, width: 204, height: 76 }),
      label(150, 166, "footprint"),
    ],
  },
  "pivot force": { marks: () => [arrow(O, [40, 142]), label(18, 160, "pivot")] },
  "crank pin force": { marks: () => [arrow(POSE.pin, [62, 48]), label(44, 40, "crank pin")] },
  "slider pin force": {
    marks: () => [arrow(POSE.slider, [180, 56]), label(150, 48, "slider pin")],
  },
  "guide force": {
    pose: STEEP,
    marks: () => [
      arrow([STEEP.slider[0], LINE + 50], [STEEP.slider[0], LINE + 13]),
      label(198, 134, "guide force"),
    ],
  },
  speed: {
    marks: () => [
      arrow([POSE.slider[0] - 22, 58], [POSE.slider[0] - 66, 58]),
      label(160, 48, "speed"),
    ],
  },
  acceleration: {
    marks: () => [
      arrow([POSE.slider[0] - 16, 58], [POSE.slider[0] - 66, 58]),
      arrow([POSE.slider[0] - 16, 58], [POSE.slider[0] - 54, 58]),
      label(150, 48, "acceleration"),
    ],
  },
  "shaking force": {
    marks: () => [arrow(O, [30, O[1]]), arrow(O, [120, O[1]]), label(20, 136, "on the frame")],
  },
  "shaking moment": { marks: () => [turning(), label(14, 166, "on the frame")] },
};

function still() {
  return [
    svg("circle", { class: "faint", cx: O[0], cy: O[1], r: RADIUS }),
    svg("path", { class: "faint", d: `M20 ${O[1]}H130M20 ${LINE}H290` }),
    svg("path", { class: "guide", d: `M140 ${LINE - 13}H285M140 ${LINE + 13}H285` }),
  ];
}

/** @param {Pose} pose */
function linkage({ pin, slider }) {
  return [
    box(slider, "part"),
    svg("path", { class: "part", d: `M${O}L${pin}L${slider}` }),
    [O, pin, slider].map(([cx, cy]) => svg("circle", { class: "pin", cx, cy, r: 4 })),
  ];
}

/** @param {Pose} pose */
function ghost({ pin, slider }) {
  return [svg("path", { class: "ghost", d: `M${O}L${pin}L${slider}` }), box(slider, "ghost")];
}

/** @param {Page.Point} centre @param {string} kind */
function box([x, y], kind) {
  return svg("rect", {
    class: kind === "dashed" ? "mark dashed" : kind,
    x: x - 18,
    y: y - 12,
    width: 36,
    height: 24,
    rx: 2,
  });
}

/** @param {Page.Point} from @param {Page.Point} to */
function bold(from, to) {
  return svg("path", { class: "mark thick", d: `M${from}L${to}` });
}

/** @param {Page.Point} from @param {Page.Point} to */
function dashedLine(from, to) {
  return svg("path", { class: "mark dashed", d: `M${from}L${to}` });
}

/** @param {Page.Point} from @param {number} to */
function drop([x, y], to) {
  return svg("path", { class: "mark dashed", d: `M${x} ${y}V${to}` });
}

/** @param {Page.Point} centre */
function dot([cx, cy]) {
  return svg("circle", { class: "mark full", cx, cy, r: 4 });
}

/** @param {string} d */
function stroked(d) {
  return svg("path", { class: "mark", d });
}

/** @param {Page.Point} from @param {Page.Point} to @param {number} way */
function wide(from, to, way) {
  return svg("path", { class: "mark", d: `M${from}A${RADIUS} ${RADIUS} 0 1 ${way ? 0 : 1} ${to}` });
}

function turning() {
  return svg("path", { class: "mark", d: "M48.1 85.1A38 38 0 0 0 42 130M34.5 122L42 130L46 120" });
}

/** A line with an arrow head at its end. @param {Page.Point} from @param {Page.Point} to @param {boolean} both */
function arrow(from, to, both = false) {
  /** @param {Page.Point} tip @param {Page.Point} other */
  const head = (tip, other) => {
    const way = Math.atan2(other[1] - tip[1], other[0] - tip[0]);
    /** @param {number} by */
    const wing = (by) =>
      [tip[0] + 8 * Math.cos(way + by), tip[1] + 8 * Math.sin(way + by)].map((value) =>
        value.toFixed(1),
      );
    return `M${wing(0.45)}L${tip}L${wing(-0.45)}`;
  };
  return svg("path", {
    class: "mark",
    d: `M${from}L${to}${head(to, from)}${both ? head(from, to) : ""}`,
  });
}

/** @param {Page.Point} from @param {Page.Point} to */
function size(from, to) {
  return arrow(from, to, Math.hypot(to[0] - from[0], to[1] - from[1]) > 12);
}

/** @param {number} x @param {number} y @param {string} text */
function label(x, y, text) {
  return svg("text", { x, y }, text);
}
