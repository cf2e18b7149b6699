/** Parts of a view that are computed when they come near the screen, or before printing. */

const NEAR = "300px"; // before it becomes visible
/** Functions that complete the parts of a view. @type {Set<() => Promise<unknown>>} */
const parts = new Set();

/**
 * Start once, when a place comes near the screen.
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
  parts.add(once);
  signal.addEventListener("abort", () => [watcher.disconnect(), parts.delete(once)], {
    once: true,
  });
}

/** Complete the view, then print it. */
export async function printComplete() {
  await Promise.all([...parts].map((complete) => complete()));
  window.print();
}
