/** Grips that change the lengths of a mechanism: crank pin, slider and guide, by pointer or keys. */

import { svg } from "../lib/dom.js";
import { fromDisplayUnit, inDisplayUnit, withUnit } from "../lib/numbers.js";
import { placeIn } from "./frame.js";

/**
 * @import { View } from "./frame.js"
 * @typedef {ReturnType<typeof grips>} Grips
 */

/** @type {{ key: keyof Page.Lengths, title: string }[]} */
const PARTS = [
  { key: "offset_mm", title: "Guide: drag it to change the offset" },
  { key: "rod_mm", title: "Slider: drag it to change the rod" },
  { key: "crank_mm", title: "Crank pin: drag it to change the crank" },
];
/** @type {Record<string, number>} */
const KEYS = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -10, PageUp: 10 }; // steps
const ROUNDING = 1e-6; // of a step
const WIDTH = 24; // pixels; size of a touch target

/**
 * Return the grips of a drawing: {nodes, isHeld(), move}. changed(lengths, angle): called when a length is dragged or changed by a key,
 * with the crank angle, deg, or null if unchanged. released(): called when the pointer is released.
 * @param {{ changed: (lengths: Page.Lengths, angle: number | null) => void, released: () => void }} told
 */
export function grips({ changed, released }) {
  /** @type {{ view: View, pin: Page.Point, linkage: Page.Lengths, slider: Page.Point } | null} */
  let drawn = null;
  /** @type {keyof Page.Lengths | null} */
  let held = null;
  let from = /** @type {Page.Point} */ ([0, 0]); // from grip to pointer, mm
  /** @type {View | null} */
  let taken = null; // in which the grip was taken: a pointer keeps its scale
  const nodes = PARTS.map(({ key, title }) => {
    /** @type {Element} */
    const node = svg(key === "crank_mm" ? "circle" : key === "rod_mm" ? "rect" : "path", {
      class: `grip ${key.replace("_mm", "")}`,
      ...(key === "crank_mm" ? { r: 0.6 * WIDTH } : { width: 2 * WIDTH, height: 2 * WIDTH }),
      role: "slider",
      tabindex: 0,
      "aria-label": title,
      onpointerdown: (event) => {
        if (event.button !== 0 || !drawn) return;
        event.preventDefault();
        node.setPointerCapture(event.pointerId);
        held = key;
        taken = drawn.view;
        const [x, y] = pointed(node, event);
        const at = key === "crank_mm" ? drawn.pin : drawn.slider;
        from = [
          (at[0] - drawn.view.x(0)) / drawn.view.unit - x,
          (drawn.view.y(0) - at[1]) / drawn.view.unit - y,
        ];
      },
      onpointermove: (event) => {
        if (held === key) drag(key, pointed(node, event));
      },
      onkeydown: (event) => {
        const steps = KEYS[event.key];
        if (!steps || !drawn) return;
        event.preventDefault();
        change(key, drawn.linkage[key] + steps * 2 * stepOf(drawn.view), null);
      },
    });
    for (const end of /** @type {const} */ (["pointerup", "pointercancel"]))
      node.addEventListener(end, () => {
        if (held) [held] = [null, released()];
      });
    return node;
  });

  /** @param {Element} node @param {PointerEvent} event */
  const pointed = (node, { clientX, clientY }) =>
    placeIn(
      /** @type {Element} */ (node.parentElement),
      /** @type {View} */ (taken),
      clientX,
      clientY,
    );

  /** @param {keyof Page.Lengths} key @param {Page.Point} to of the pointer, mm */
  function drag(key, [right, up]) {
    if (!drawn) return;
    const { view, pin } = drawn;
    const [x, y] = [right + from[0], up + from[1]];
    if (key === "crank_mm") change(key, Math.hypot(x, y), (Math.atan2(y, x) * 180) / Math.PI);
    else if (key === "offset_mm") change(key, y, null);
    else {
      const across = Math.max(x - (pin[0] - view.x(0)) / view.unit, 0);
      change(
        key,
        Math.hypot(across, drawn.linkage.offset_mm - (view.y(0) - pin[1]) / view.unit),
        null,
      );
    }
  }

  /** @param {keyof Page.Lengths} key @param {number} length @param {number | null} angle */
  function change(key, length, angle) {
    if (!drawn) return;
    const step = stepOf(drawn.view);
    const round = step * Math.round(inDisplayUnit(length, "mm") / step);
    const [low, high] = boundsOf(drawn.linkage)[key].map(
      (bound) => inDisplayUnit(bound, "mm") / step,
    );
    const within = Math.min(
      Math.max(round, step * (Math.floor(low + ROUNDING) + 1)),
      step * (Math.ceil(high - ROUNDING) - 1),
    );
    const value = fromDisplayUnit(Number(within.toPrecision(9)), "mm");
    changed({ ...drawn.linkage, [key]: value }, angle);
  }

  return {
    nodes,
    isHeld: () => held !== null,
    /** @param {View} view @param {Page.Point} pin @param {Page.Point} slider @param {Page.Lengths} linkage */
    move(view, pin, slider, linkage) {
      drawn = { view, pin, slider, linkage };
      const [guide, block, crank] = nodes;
      guide.setAttribute("d", `M0 ${slider[1]}H${view.width}`);
      block.setAttribute("x", String(slider[0] - WIDTH));
      block.setAttribute("y", String(slider[1] - WIDTH));
      crank.setAttribute("cx", String(pin[0]));
      crank.setAttribute("cy", String(pin[1]));
      const bounds = boundsOf(linkage);
      PARTS.forEach(({ key }, n) => {
        ["min", "max"].forEach((end, side) => {
          const bound = bounds[key][side];
          if (Number.isFinite(bound)) nodes[n].setAttribute(`aria-value${end}`, String(bound));
        });
        nodes[n].setAttribute("aria-valuenow", String(linkage[key]));
        nodes[n].setAttribute("aria-valuetext", withUnit(linkage[key], "mm"));
      });
    },
  };
}

/**
 * Return the open interval of a length, mm, in which a mechanism with the other lengths can be assembled: |e| < r + l.
 * @param {Page.Lengths} linkage @returns {Record<keyof Page.Lengths, Page.Point>}
 */
function boundsOf({ crank_mm: r, rod_mm: l, offset_mm: e }) {
  return {
    crank_mm: [Math.max(Math.abs(e) - l, 0), Infinity],
    rod_mm: [Math.max(Math.abs(e) - r, 0), Infinity],
    offset_mm: [-(r + l), r + l],
  };
}

/** Return the step of lengths for a screen: a power of ten in the display unit, about one pixel. @param {View} view */
function stepOf({ unit }) {
  return 10 ** Math.floor(Math.log10(inDisplayUnit(1, "mm") / unit));
}
