/**
 * Marked designs in the charts of a front: knee, extreme designs, choice by weights, bookmarks, wishes, selected designs, and the one
 * under the pointer.
 */

/** @import { Explorer } from "./explorer.js" */

/**
 * Return the marks of an explorer, each with its colour.
 * @param {Explorer} explorer @param {"lines" | "dots"} kind @returns {Page.Mark[]}
 */
export function marksOf(explorer, kind) {
  const { ink, front, picked, pointed, chosen } = explorer;
  /** @type {Page.Mark[]} */
  const marks = [];
  if (kind === "dots")
    for (const [row, names] of namesOf(explorer))
      marks.push({ row, colour: ink.text, name: names[0] });
  else if (front.knee !== null) marks.push({ row: front.knee, colour: ink.text, width: 2 });
  if (picked !== null)
    marks.push({ row: picked, colour: ink["series-3"], name: kind === "dots" ? "by weights" : "" });
  for (const { cells, name } of othersOf(explorer))
    marks.push({ cells, colour: ink["series-4"], name, width: 3 });
  for (const number of chosen.selected)
    marks.push({ row: number - 1, colour: ink["series-6"], name: `${number}`, width: 3 });
  if (pointed !== null)
    marks.push({
      row: pointed,
      colour: ink.mark,
      width: 3.5,
      name: kind === "dots" ? `${pointed + 1}` : "",
      read: true,
    });
  return marks;
}

/** Return the marked designs outside the front, each with its name. @param {Explorer} explorer */
export function othersOf({ wishing, kept }) {
  const wished = wishing?.cells();
  return [...(kept?.marks() ?? []), ...(wished ? [{ cells: wished, name: "wished" }] : [])];
}

/** Return the names of marked designs by their row: knee, best in an objective. @param {Explorer} explorer */
export function namesOf({ front, data }) {
  /** @type {Map<number, string[]>} */
  const names = new Map();
  /** @param {number} row @param {string} name */
  const add = (row, name) => names.set(row, [...(names.get(row) ?? []), name]);
  if (front.knee !== null) add(front.knee, "knee");
  for (const [quantity, row] of Object.entries(front.extremes)) {
    const title =
      data.objectives.find((objective) => objective.quantity === quantity)?.title ?? quantity;
    add(row, `best ${title}`);
  }
  return names;
}
