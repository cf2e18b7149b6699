/** Sketch beside the form: a moving linkage within the ranges. */

import { h } from "../lib/dom.js";
import { withUnit } from "../lib/numbers.js";
import { drawing } from "../mechanism/drawing.js";

const TURN = 4000; // ms of a turn

/**
 * Return {node, show(example), swing(preview)}; show(null) removes the linkage. swing(preview): shows a swing between its two fixed ends.
 * @param {AbortSignal} signal
 */
export function sketch(signal) {
  const place = h("div", { class: "sketch" });
  const caption = h("p", { class: "quiet" });
  const button = h("button", {
    type: "button",
    hidden: true,
    onclick: () => {
      moving = !moving;
      label();
      if (moving) start();
      else drawn.turn(angle);
    },
  });
  const node = h("div", {}, place, h("div", { class: "row" }, caption, button));
  const drawn = drawing(place, { label: "A linkage within the ranges" });
  let moving = !matchMedia("(prefers-reduced-motion: reduce)").matches;
  let way = 1;
  let angle = 40;
  /** @type {number | null} */
  let before = null;
  let hasLinkage = false;
  /** @type {[number, number] | null} */
  let ends = null; // of a swing, deg
  let share = 0;
  const label = () => (button.textContent = moving ? "Pause" : "Move");
  label();
  /** @param {number} now */
  function step(now) {
    if (!moving || !hasLinkage || signal.aborted) {
      before = null;
      return;
    }
    if (before !== null && ends) {
      share = (share + (now - before) / TURN) % 1;
      angle = ends[0] + (ends[1] - ends[0]) * (0.5 - 0.5 * Math.cos(2 * Math.PI * share));
    } else if (before !== null) angle = (angle + (way * 360 * (now - before)) / TURN + 360) % 360;
    before = now;
    drawn.turn(angle, false);
    requestAnimationFrame(step);
  }
  const start = () => {
    if (before === null) requestAnimationFrame(step);
  };
  signal.addEventListener("abort", () => drawn.close());

  /**
   * Draw an example, or none for null, with a sentence below it.
   * @param {(Page.Lengths & { motion: Api.Curves, slider_ends_mm: Page.Point, feasible: boolean, outlines?: Api.Outlines | null }) | null} example @param {string} sentence @param {{ direction: number, dead_centres_deg?: Page.Point }} options
   */
  function draw(example, sentence, options) {
    hasLinkage = example !== null;
    place.hidden = button.hidden = !hasLinkage;
    caption.textContent = sentence;
    if (!example) return;
    const { crank_mm, rod_mm, offset_mm, motion, slider_ends_mm, feasible, outlines } = example;
    drawn.show({ crank_mm, rod_mm, offset_mm }, motion, {
      ...options,
      slider_ends_mm,
      outlines: outlines ?? undefined,
      angle,
      small: true,
    });
    drawn.fade(!feasible);
    drawn.turn(angle);
    if (moving) start();
  }

  return {
    node,
    /** @param {Api.Example | null} example @param {boolean} hasRanges whether the ranges are valid */
    show(example, hasRanges) {
      if (ends) [ends, angle] = [null, 40];
      node.classList.remove("swinging");
      way = example?.clockwise ? -1 : 1;
      const sentence = example
        ? `A design within the ranges that ${example.feasible ? "meets all checked requirements" : "rotates fully but does not meet every requirement"}: crank ${withUnit(example.crank_mm, "mm", 4)}, rod ${withUnit(example.rod_mm, "mm", 4)}, offset ${withUnit(example.offset_mm, "mm", 4)}, stroke ${withUnit(example.stroke_mm, "mm", 4)}`
        : hasRanges
          ? "No linkage within these ranges rotates fully."
          : "";
      draw(example, sentence, { direction: way });
    },
    /** @param {Api.SwingPreview} preview */
    swing({ example, from_deg, to_deg }) {
      if (!example || from_deg === null || to_deg === null)
        return draw(null, "No linkage within these ranges makes the swing.", { direction: 0 });
      if (!ends || ends[0] !== from_deg || ends[1] !== to_deg) [angle, share] = [from_deg, 0];
      ends = [from_deg, to_deg];
      node.classList.add("swinging");
      const { feasible, travel_mm, outlines } = example;
      draw(
        example,
        `${feasible ? "A design that meets all checked requirements" : "A design that makes the swing but does not meet every requirement"}: from ${withUnit(from_deg, "deg")} to ${withUnit(to_deg, "deg")}, the ${outlines ? "cylinder" : "slider"} travels ${withUnit(travel_mm, "mm", 4)}`,
        { direction: 0, dead_centres_deg: ends },
      );
    },
  };
}
