/** Keyboard access to the designs of a chart: arrows move between them, Enter opens one, Space selects it; each is read out. */

import { h } from "../lib/dom.js";

const ARROWS = ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown"];

/**
 * Make a chart reachable. mask(): the designs that may be gone to. next(row, key): where an arrow goes from a design, as a number of
 * every design and the direction in which it grows; a design is stayed at. say(row): what is read out.
 * @param {HTMLElement} place
 * @param {{
 *   mask: () => ArrayLike<number>, next: (row: number, key: string) => number | { of: (row: number) => number, by: 1 | -1 },
 *   say: (row: number) => string, point: (row: number | null) => void, open: (row: number) => void, select: (row: number) => void,
 * }} chart
 */
export function byKeys(place, { mask, next, say, point, open, select }) {
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
      here = typeof way === "number" ? way : following(from, selectable, way);
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
 * Return the design of a mask that follows one by a number, ties by their place; the same one at the end.
 * @param {number} from @param {ArrayLike<number>} mask @param {{ of: (row: number) => number, by: 1 | -1 }} way
 */
export function following(from, mask, { of, by }) {
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
