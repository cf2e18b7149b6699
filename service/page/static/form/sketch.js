/** The sketch beside the form: a linkage within the ranges, moving. */

import { h } from "../lib/dom.js";
import { drawing } from "../mechanism/drawing.js";

const TURN = 4000; // ms of a turn

/** Return {node, show(example), close()}; show(null) takes the linkage away. @param {AbortSignal} signal */
export function sketch(signal) {
  const place = h("div", { class: "sketch" });
  const caption = h("p", { class: "quiet" });
  const button = h("button", { type: "button", hidden: true });
  const node = h("div", {}, place, h("div", { class: "row" }, caption, button));
  const drawn = drawing(place, { label: "A linkage within the ranges" });
  let moving = !matchMedia("(prefers-reduced-motion: reduce)").matches;
  let way = 1;
  let angle = 40;
  /** @type {number | null} */
  let before = null;
  let shown = false;
  const label = () => (button.textContent = moving ? "Pause" : "Move");
  label();
  button.addEventListener("click", () => {
    moving = !moving;
    label();
    if (moving) start();
    else drawn.turn(angle);
  });
  /** @param {number} now */
  function step(now) {
    if (!moving || !shown || signal.aborted) {
      before = null;
      return;
    }
    if (before !== null) angle = (angle + (way * 360 * (now - before)) / TURN + 360) % 360;
    before = now;
    drawn.turn(angle, false);
    requestAnimationFrame(step);
  }
  const start = () => {
    if (before === null) requestAnimationFrame(step);
  };
  signal.addEventListener("abort", () => drawn.close());
  return {
    node,
    /** @param {Api.Example | null} example */
    show(example) {
      shown = example !== null;
      place.hidden = button.hidden = !shown;
      if (!example) {
        caption.textContent = "No linkage of these ranges turns fully.";
        return;
      }
      way = example.clockwise ? -1 : 1;
      caption.textContent = example.feasible ? "One that meets all that was checked" : "One that turns, but does not meet every requirement";
      const { crank_mm, rod_mm, offset_mm, motion } = example;
      drawn.show({ crank_mm, rod_mm, offset_mm }, motion, { direction: way });
      drawn.fade(!example.feasible);
      drawn.turn(angle);
      if (moving) start();
    },
  };
}
