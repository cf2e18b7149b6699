/** Parts of a view that are computed once they come near, or before they are printed. */

const NEAR = "300px"; // before it is in sight
/** What completes the parts that are in a view. @type {Set<() => Promise<unknown>>} */
const parts = new Set();

/**
 * Start once, when a place comes into view.
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
