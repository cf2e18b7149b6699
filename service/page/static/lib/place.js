/** Where the reader is in a view, down the page: kept with its entry in the history, and found again by back, forward and reload. */

const SETTLED = 150; // ms after the last movement
const PATIENCE = 20_000; // ms that a view has to become as long as it was

/** @type {ReturnType<typeof setTimeout> | undefined} */
let timer;
let looking = false; // for a place: what moves meanwhile is not the reader

/** Note the place in this entry of the history. */
function note() {
  clearTimeout(timer);
  if (!looking) history.replaceState({ ...history.state, top: Math.round(scrollY) }, "");
}

/** Keep the place from now on; what leads elsewhere notes it before. */
export function keepPlaces() {
  history.scrollRestoration = "manual";
  window.addEventListener("scroll", () => {
    clearTimeout(timer);
    timer = setTimeout(note, SETTLED);
  }, { passive: true });
  for (const name of ["click", "keydown"]) document.addEventListener(name, () => timer && note(), { capture: true });
}

/**
 * Begin a view; the function that is returned goes to the place where it was left, as soon as it is long enough for that, or to its
 * beginning. The reader who moves meanwhile is left alone.
 * @param {AbortSignal} signal of the view
 */
export function lookForPlace(signal) {
  clearTimeout(timer);
  looking = true;
  const top = Number(history.state?.top ?? 0);
  const until = performance.now() + PATIENCE;
  const ended = new AbortController();
  const end = () => {
    looking = false;
    ended.abort();
    longer.disconnect();
  };
  const reach = () => {
    window.scrollTo(0, top);
    if (Math.abs(scrollY - top) <= 1 || performance.now() > until) end();
  };
  const longer = new ResizeObserver(reach);
  signal.addEventListener("abort", () => longer.disconnect(), { once: true });
  return () => {
    if (signal.aborted) return;
    for (const name of ["wheel", "touchstart", "pointerdown", "keydown"]) window.addEventListener(name, end, { signal: ended.signal, passive: true });
    reach();
    if (looking) longer.observe(document.body);
  };
}
