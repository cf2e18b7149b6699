/** Tables: a caption for screen readers, a row of heads, and rows. */

import { h } from "./dom.js";

/**
 * Return a table. heads: cells of the head row; without them, no head row.
 * @param {string} caption @param {Dom.Child} heads @param {Dom.Child} rows
 */
export function table(caption, heads, rows) {
  return h(
    "table",
    {},
    h("caption", { class: "hidden" }, caption),
    heads && h("thead", {}, h("tr", {}, heads)),
    h("tbody", {}, rows),
  );
}

/**
 * Return the heads of columns; a column without a title has an empty cell.
 * @param {readonly Dom.Child[]} titles @param {(n: number) => unknown} isNumber whether column n has numbers
 */
export function headsOf(titles, isNumber) {
  return titles.map((title, n) =>
    h(
      title ? "th" : "td",
      { scope: title ? "col" : null, class: isNumber(n) ? "number" : null },
      title,
    ),
  );
}

/** Return a table row that begins with a row heading. @param {Dom.Child} title @param {...Dom.Child} cells */
export function headedRow(title, ...cells) {
  return h("tr", {}, h("th", { scope: "row" }, title), cells);
}

/**
 * Return the cell of a number, whose attributes serve tests and scripts.
 * @param {string | null} key of the column @param {string | number | null | undefined} value @param {...Dom.Child} shown
 */
export function numberCell(key, value, ...shown) {
  return h("td", { class: "number", "data-key": key, "data-value": String(value ?? "") }, shown);
}

/** Return a node within a region that scrolls sideways, also by keyboard. @param {string} label @param {Element} node */
export function scrolled(label, node) {
  return h("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": label }, node);
}

/** Return such a region with a table; both have the same name. @param {string} caption @param {Dom.Child} heads @param {Dom.Child} rows */
export function scrolledTable(caption, heads, rows) {
  return scrolled(caption, table(caption, heads, rows));
}
