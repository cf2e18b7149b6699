/**
 * Keyboard access to the designs in a chart: arrow keys move between designs, Enter opens one, Space selects it; screen readers
 * announce each design.
 */

import { h } from "../lib/dom.js";

const ARROWS = ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown"];

/**
 * Give a chart keyboard access. mask(): selectable designs. next(row, key): the design that an arrow key leads to, or a value by which
 * designs are ordered and the direction to go. say(row): the announcement of a design.
 * @param {HTMLElement} place
 * @param {{
 *   mask: () => ArrayLike<number>, next: (row: number, key: string) => number | { of: (row: number) => number, by: 1 | -1 },
 *   say: (row: number) => string, point: (row: number | null) => void, open: (row: number) => void, select: (row: number) => void,
 * }} chart
 */
export function addKeyboardAccess(place, { mask, next, say, point, open, select }) {
  const status = h("p", { class: "hidden", role: "status" });
  /** @type {number | null} */
  let here = null;
  place.tabIndex = 0;
  place.setAttribute("role", "application");
  place.append(status);
  place.addEventListener("keydown", (event) => {
    const { key } = event;
    const selectable = mask();
    if (here !== null && !selectable[here]) here = null;
    if (ARROWS.includes(key)) {
      event.preventDefault();
      const from = here ?? firstOf(selectable);
      if (from === null) return;
      const way = here === null ? from : next(from, key);
      here = typeof way === "number" ? way : nextDesign(from, selectable, way);
      point(here);
      status.textContent = say(here);
    } else if (here !== null && (key === "Enter" || key === " ")) {
      event.preventDefault();
      (key === "Enter" ? open : select)(here);
    } else if (key === "Escape") point(null);
  });
  place.addEventListener("blur", () => point(null));
  place.addEventListener("focus", () => here !== null && mask()[here] && point(here));
}

/** Return the first design of a mask. @param {ArrayLike<number>} mask */
function firstOf(mask) {
  for (let row = 0; row < mask.length; row += 1) if (mask[row]) return row;
  return null;
}

/**
 * Return the next design of a mask in the order of a value, ties by position; the same design at the end.
 * @param {number} from @param {ArrayLike<number>} mask @param {{ of: (row: number) => number, by: 1 | -1 }} way
 */
export function nextDesign(from, mask, { of, by }) {
  const start = of(from);
  let [best, least] = [from, Infinity];
  for (let row = 0; row < mask.length; row += 1) {
    if (!mask[row] || row === from) continue;
    const ahead = by * (of(row) - start);
    if (
      (ahead > 0 || (ahead === 0 && by * (row - from) > 0)) &&
      (ahead < least || (ahead === least && by * (row - best) < 0))
    )
      [best, least] = [row, ahead];
  }
  return best;
}
