/** Pointer access to the designs in a chart: hover, open or select by click; the chart defines the effect of a drag. */

/** @typedef {{ x: number, y: number }} Place pixels in the chart */

/**
 * Give a chart pointer access. under(here): the design at a position, or null. cursor(here, row): pointer shape at a position.
 * begin(here, event): whether a drag may begin there. drag(here): continues a drag. end(dragged): called when the button is released,
 * with or without a drag; returns whether a press without a drag may open a design.
 * @param {HTMLElement} top
 * @param {{ point: (row: number | null) => void, open: (row: number) => void, select: (row: number) => void }} chart
 * @param {{
 *   isDrawn: () => boolean, under: (here: Place) => number | null, cursor: (here: Place, row: number | null) => string,
 *   begin: (here: Place, event: PointerEvent) => boolean, drag: (here: Place) => boolean, end: (here: Place) => boolean,
 * }} handlers drag: whether it has moved far enough to be one
 */
export function addPointerAccess(top, chart, { isDrawn, under, cursor, begin, drag, end }) {
  let [pressed, drags, moved] = [false, false, false];
  /** @param {MouseEvent} event @returns {Place} */
  const at = (event) => {
    const box = top.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  };
  top.addEventListener("pointerdown", (event) => {
    if (!isDrawn() || event.button !== 0) return;
    [pressed, drags, moved] = [true, begin(at(event), event), false];
    if (drags) top.setPointerCapture(event.pointerId);
  });
  top.addEventListener("pointermove", (event) => {
    if (!isDrawn()) return;
    const here = at(event);
    if (drags) {
      moved = drag(here) || moved;
      return;
    }
    const row = under(here);
    top.style.cursor = cursor(here, row);
    chart.point(row);
  });
  /** @param {PointerEvent} event */
  const ended = (event) => {
    if (!pressed) return;
    const isClick = end(at(event)) && !moved && event.type === "pointerup";
    [pressed, drags] = [false, false];
    const row = isClick ? under(at(event)) : null;
    if (row !== null)
      (event.shiftKey || event.ctrlKey || event.metaKey ? chart.select : chart.open)(row);
  };
  top.addEventListener("pointerup", ended);
  top.addEventListener("pointercancel", ended);
  top.addEventListener("pointerleave", () => {
    if (drags) return;
    pressed = false;
    chart.point(null);
  });
  return at;
}

/**
 * Return the index of the nearest of `count` items; null if none is nearer than `least`. distance(n): distance of item n.
 * @param {number} count @param {(n: number) => number} distance @param {number} least
 */
export function nearest(count, distance, least) {
  /** @type {number | null} */
  let found = null;
  for (let n = 0; n < count; n += 1) {
    const here = distance(n);
    if (here < least) [found, least] = [n, here];
  }
  return found;
}
