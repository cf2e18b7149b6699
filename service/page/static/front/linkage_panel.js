/** Linkage of the highlighted design beside the charts, at one scale for all designs; it moves while a design is highlighted. */

import { get } from "../lib/api.js";
import { fill, h } from "../lib/dom.js";
import { withUnit } from "../lib/numbers.js";
import { withResultants } from "../design/panels.js";
import { drawing } from "../mechanism/drawing.js";
import { motionOf } from "../mechanism/motion.js";
import { playback } from "../mechanism/playback.js";
import { sizesOf } from "./choices.js";
import { namesOf } from "./chart_marks.js";

/** @import { Explorer } from "./explorer.js" */

const START = 60; // deg: no links overlap here
const SOON = 120; // ms of highlighting before the swing of a design is requested
const ENDS = /** @type {Page.Point} */ ([0, 180]); // points of the swing

/** Return {place, draw(what), close()} of the linkage of an explorer. @param {Explorer} explorer */
export function linkagePanel(explorer) {
  const { data, front } = explorer;
  const sizes = sizesOf(front);
  const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
  const title = h("h2", { id: "linkage-title" });
  const way = h("a", { class: "button primary" });
  const picture = h("div", { class: "linkage-picture" });
  const numbers = h("dl", { class: "terms" });
  const place = h(
    "section",
    { class: "panel linkage", "aria-labelledby": "linkage-title" },
    h("div", { class: "row spread" }, title, way),
    picture,
    numbers,
  );
  const drawn = drawing(picture, { label: "" });
  /** @type {ReturnType<typeof playback> | null} */
  let motion = null; // once the service has returned the direction of rotation
  /** @type {number | null} */
  let drawnRow = null;
  let isRequested = false;
  const swings = !front.columns.some(({ key }) => key === "stroke_mm"); // every design that turns has one
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let later;
  let within = false; // whether the pointer or the focus is in the panel itself
  for (const [name, inside] of /** @type {const} */ ([
    ["pointerenter", true],
    ["focusin", true],
    ["pointerleave", false],
    ["focusout", false],
  ])) {
    place.addEventListener(name, () => {
      within = inside;
      move();
    });
  }

  /** Request the crank speed once; without a response, the crank turns counter-clockwise. */
  async function ask() {
    isRequested = true;
    const rpm = await get(
      `jobs/${explorer.job.id}/designs/1/requirements`,
      {},
      explorer.signal,
    ).then(
      ({ speed_rpm }) => speed_rpm ?? 0,
      () => 0,
    );
    if (explorer.signal.aborted) return;
    motion = playback(rpm, explorer.signal);
    motion.set(START);
    motion.listen(({ angle, settled }) => drawn.turn(angle, settled));
    draw("all");
  }

  /** Animate while a design or the panel is pointed at. */
  function move() {
    const wanted = !still && (within || explorer.pointed !== null);
    if (wanted && !isRequested) ask();
    if (!motion || wanted === motion.playing) return;
    if (wanted) motion.play();
    else motion.pause();
  }

  /** Draw a design that swings between its ends, once the service has returned its motion. @param {number} row */
  async function showSwing(row) {
    const cycle = await explorer.linkages.cycle(row);
    if (!cycle || drawnRow !== row || explorer.signal.aborted) return;
    const { outlines } = cycle;
    drawn.show(explorer.linkages.of(row), withResultants(cycle).curves, {
      frame: explorer.linkages.frame(),
      direction: 0,
      small: true,
      turns: 0,
      dead_centres_deg: ENDS,
      ...(outlines.lever && { outlines }),
    });
    if (!motion) drawn.turn(START);
  }

  /** @param {string} what */
  function draw(what) {
    const row =
      explorer.pointed ?? drawnRow ?? (explorer.chosen.selected[0] ?? (front.knee ?? 0) + 1) - 1;
    if (row !== drawnRow || what === "all") {
      drawnRow = row;
      const linkage = explorer.linkages.of(row);
      const names = namesOf(explorer).get(row) ?? [];
      fill(
        title,
        `Design ${row + 1}`,
        names.length > 0 && h("span", { class: "quiet" }, ` ${names.join(", ")}`),
      );
      fill(way, "Open", h("span", { class: "hidden" }, " the design of the picture"));
      way.href = explorer.hrefOf(row);
      drawn.node.setAttribute("aria-label", `Linkage of design ${row + 1}`);
      if (swings) {
        clearTimeout(later);
        later = setTimeout(() => showSwing(row), explorer.linkages.isRequested(row) ? 0 : SOON);
      } else {
        drawn.show(linkage, motionOf(linkage), {
          frame: explorer.linkages.frame(),
          direction: motion?.direction ?? 0,
          small: true,
        });
        if (!motion) drawn.turn(START);
      }
      fill(
        numbers,
        [...data.objectives.map(({ column }) => column), ...sizes]
          .filter((key) => data.has(key))
          .map((key) => {
            const { title: words, unit } = data.column(key);
            return h(
              "div",
              { class: sizes.includes(key) ? "length" : null },
              h("dt", {}, words),
              h("dd", { class: "number" }, withUnit(data.cell(key, row), unit, 4)),
            );
          }),
      );
    }
    move();
  }
  return { place, draw, close: () => [clearTimeout(later), drawn.close()] };
}
