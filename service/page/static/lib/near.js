/** Parts of a view that are computed once they come near, or before they are printed. */

import { beforePrinting } from "./printing.js";

const NEAR = "300px"; // before it is in sight

/**
 * Begin once, when a place comes near.
 * @param {Element} place @param {() => Promise<unknown>} begin @param {AbortSignal} signal of the view
 */
export function whenNear(place, begin, signal) {
  /** @type {Promise<unknown> | null} */
  let begun = null;
  const once = () => (begun ??= begin());
  const watcher = new IntersectionObserver(
    (seen) => seen.some(({ isIntersecting }) => isIntersecting) && once(),
    { rootMargin: NEAR },
  );
  watcher.observe(place);
  beforePrinting(once, signal);
  signal.addEventListener("abort", () => watcher.disconnect(), { once: true });
}
