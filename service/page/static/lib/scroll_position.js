/** Where the reader is in a view, down the page and with the focus: kept with its entry in the history, found again by back, forward and reload. */

import { byId } from "./dom.js";

const PAUSE = 150; // ms after the last movement
const PATIENCE = 20_000; // ms that a view has to become as long as it was
const QUIET = 2_000; // ms without a change of its length, after which it is taken as whole: what still comes above moves the place

/** @type {ReturnType<typeof setTimeout> | undefined} */
let timer;
let looking = false; // for a place: what moves meanwhile is not the reader

/** Note the place in this entry of the history. @param {Record<string, string | null>} [more] */
function note(more) {
  clearTimeout(timer);
  if (!looking) history.replaceState({ ...history.state, top: Math.round(scrollY), ...more }, "");
}

/** Return a selector for what is used in a view, to find it when the view is drawn again; null without one. @param {EventTarget | null} target */
function selectorOf(target) {
  const node =
    target instanceof Element ? target.closest("#main :is([id], a[href], [aria-label])") : null;
  const name = ["id", "href", "aria-label"].find((attribute) => node?.hasAttribute(attribute));
  return name ? `[${name}="${CSS.escape(node?.getAttribute(name) ?? "")}"]` : null;
}

/** Keep the place from now on; what leads elsewhere notes it before. */
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
        // Enter leads elsewhere without a click in a chart. Other keys are many, and browsers count the notes.
        const leads = !(event instanceof KeyboardEvent) || event.key === "Enter";
        if (leads) note({ focus: selectorOf(event.target) });
        else if (timer) note();
      },
      { capture: true },
    );
}

/**
 * Begin a view; the function that is returned goes to the place where it was left and gives back the focus, as soon as the view is long
 * enough for that, or to its beginning. The reader who moves meanwhile is left alone.
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
