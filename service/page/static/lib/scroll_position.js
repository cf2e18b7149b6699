/** Scroll position and focus in a view, stored with its history entry and restored by back, forward and reload. */

import { byId } from "./dom.js";

const PAUSE = 150; // ms after the last movement
const PATIENCE = 20_000; // ms within which a view must regain its length
const QUIET = 2_000; // ms without a change of length after which a view counts as complete

/** @type {ReturnType<typeof setTimeout> | undefined} */
let timer;
let looking = false; // a restoration is pending: scrolling is not by the user

/** Store the position in the current history entry. @param {Record<string, string | null>} [more] */
function note(more) {
  clearTimeout(timer);
  if (!looking) history.replaceState({ ...history.state, top: Math.round(scrollY), ...more }, "");
}

/** Return a selector for the focused element of a view, to find it after a redraw; null without one. @param {EventTarget | null} target */
function selectorOf(target) {
  const node =
    target instanceof Element ? target.closest("#main :is([id], a[href], [aria-label])") : null;
  const name = ["id", "href", "aria-label"].find((attribute) => node?.hasAttribute(attribute));
  return name ? `[${name}="${CSS.escape(node?.getAttribute(name) ?? "")}"]` : null;
}

/** Store the position from now on, and before navigation. */
export function rememberScroll() {
  history.scrollRestoration = "manual";
  window.addEventListener(
    "scroll",
    () => {
      clearTimeout(timer);
      timer = setTimeout(note, PAUSE);
    },
    { passive: true },
  );
  for (const name of ["click", "keydown"])
    document.addEventListener(
      name,
      (event) => {
        // In a chart, Enter navigates without a click. Other keys are frequent, and browsers limit history updates.
        const leads = !(event instanceof KeyboardEvent) || event.key === "Enter";
        if (leads) note({ focus: selectorOf(event.target) });
        else if (timer) note();
      },
      { capture: true },
    );
}

/**
 * Prepare a view. The returned function restores scroll position and focus as soon as the view is long enough, or goes to its beginning;
 * it does nothing if the user has scrolled in the meantime.
 * @param {AbortSignal} signal of the view
 */
export function restoreScroll(signal) {
  clearTimeout(timer);
  looking = true;
  const { top = 0, focus = null } = history.state ?? {};
  const until = performance.now() + PATIENCE;
  const ended = new AbortController();
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let whole;
  const end = () => {
    clearTimeout(whole);
    looking = false;
    ended.abort();
    longer.disconnect();
  };
  const refocus = () => {
    const node = focus && document.querySelector(focus);
    const at = document.activeElement;
    if (node && (at === document.body || at === byId("main"))) node.focus({ preventScroll: true });
    return node || !focus;
  };
  const reach = () => {
    window.scrollTo(0, top);
    clearTimeout(whole);
    if ((refocus() && top === 0) || performance.now() > until) end();
    else if (Math.abs(scrollY - top) <= 1) whole = setTimeout(end, QUIET);
  };
  const longer = new ResizeObserver(reach);
  signal.addEventListener("abort", () => [longer.disconnect(), clearTimeout(whole)], {
    once: true,
  });
  return () => {
    if (signal.aborted) return;
    for (const name of ["wheel", "touchstart", "pointerdown", "keydown"])
      window.addEventListener(name, end, { signal: ended.signal, passive: true });
    reach();
    if (looking) longer.observe(document.body);
  };
}
