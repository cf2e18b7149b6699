/** Printing a view whole: parts that are computed only once they come into sight say how they are completed. */

/** @type {Set<() => Promise<unknown>>} */
const parts = new Set();

/** Have a part of a view completed before it is printed. @param {() => Promise<unknown>} complete @param {AbortSignal} signal of the view */
export function beforePrinting(complete, signal) {
  parts.add(complete);
  signal.addEventListener("abort", () => parts.delete(complete), { once: true });
}

/** Complete the view, then print it. */
export async function printWhole() {
  await Promise.all([...parts].map((complete) => complete()));
  window.print();
}
