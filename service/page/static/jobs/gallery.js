/** Included machines as starting points, each as an animated design. */

import { link } from "../lib/address.js";
import { get } from "../lib/api.js";
import { h } from "../lib/dom.js";
import { drawing } from "../mechanism/drawing.js";
import { motionOf } from "../mechanism/motion.js";

const TURN = 5000; // ms per turn, the same for all: real speeds are too fast to watch
const START = 50; // deg: no links overlap here

/** Return {node, begin()} of the included machines; begin(): requests them when they become visible. @param {AbortSignal} signal */
export function gallery(signal) {
  const node = h("nav", { class: "gallery", "aria-label": "Shipped machines" });
  let begun = false;
  const begin = async () => {
    if (begun) return;
    begun = true;
    const { presets } = await get("presets", {}, signal);
    for (const { name, title, sentence, design } of presets) {
      const picture = h("span", { class: "machine-picture" });
      node.append(
        h(
          "a",
          { class: "panel", href: link(["new"], { preset: name }) },
          picture,
          h("strong", {}, title),
          h("span", { class: "quiet" }, sentence),
        ),
      );
      move(picture, title, design, signal);
    }
  };
  return { node, begin: () => void begin().catch(() => {}) }; // without a response, a new run starts empty
}

/** @param {HTMLElement} place @param {string} title @param {Api.Preset["design"]} design @param {AbortSignal} signal */
function move(place, title, { from_deg: from, to_deg: to, outlines, ...linkage }, signal) {
  const drawn = drawing(place, { label: `${title}, a linkage that moves` });
  signal.addEventListener("abort", () => drawn.close());
  const { slider_position_mm: positions } = motionOf(linkage);
  /** @type {Page.Point | null} */
  const ends = from !== null && to !== null ? [from, to] : null;
  const within = positions.map((position, angle) =>
    !Number.isFinite(position) ||
    (ends && (angle < Math.floor(ends[0]) || angle > Math.ceil(ends[1])))
      ? null
      : position,
  );
  drawn.show(
    linkage,
    { slider_position_mm: within },
    {
      direction: 0,
      small: true,
      outlines,
      angle: ends ? ends[0] : START,
      ...(ends ? { dead_centres_deg: ends } : {}),
    },
  );
  if (matchMedia("(prefers-reduced-motion: reduce)").matches) return;
  /** @param {number} now */
  const step = (now) => {
    if (signal.aborted) return;
    requestAnimationFrame(step);
    if (document.hidden || !place.checkVisibility()) return;
    const share = (now / TURN) % 1;
    drawn.turn(
      ends
        ? ends[0] + (ends[1] - ends[0]) * (0.5 - 0.5 * Math.cos(2 * Math.PI * share))
        : (START + 360 * share) % 360,
      false,
    );
  };
  requestAnimationFrame(step);
}
