/** Table of contents of a long view: shows the current part and links to the others. */

import { h } from "../lib/dom.js";

/**
 * Return a select of the parts of a view; its value follows scrolling.
 * @param {[string, HTMLElement][]} parts their titles, and where they are, from the top @param {AbortSignal} signal
 */
export function contents(parts, signal) {
  const choice = h(
    "select",
    {
      class: "contents",
      "aria-label": "Go to",
      onchange: () => {
        const [, part] = parts[choice.selectedIndex];
        part.scrollIntoView({ block: "start" });
        part.tabIndex = -1;
        part.focus({ preventScroll: true });
      },
    },
    parts.map(([title]) => h("option", {}, title)),
  );
  /** @type {Set<Element>} */
  const seen = new Set();
  const watcher = new IntersectionObserver(
    (entries) => {
      for (const { target, isIntersecting } of entries)
        isIntersecting ? seen.add(target) : seen.delete(target);
      const here = parts.findIndex(([, part]) => seen.has(part));
      if (here >= 0) choice.selectedIndex = here;
    },
    { rootMargin: "-10% 0px -60% 0px" }, // the part in the upper third of the screen
  );
  for (const [, part] of parts) watcher.observe(part);
  signal.addEventListener("abort", () => watcher.disconnect(), { once: true });
  return choice;
}
