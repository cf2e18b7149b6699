/** Sentences and tables of an answer, with numbers in display units. */

import { h } from "./dom.js";
import { apiSystem, text, withUnitSigns } from "./numbers.js";
import { headsOf, scrolledTable } from "./table.js";

/**
 * Return the nodes of blocks. title: caption of tables without a preceding heading. action(n): last cell of row n in a table.
 * @param {Api.Block[]} found @param {string} title @param {(n: number) => Dom.Child} [action]
 */
export function blocks(found, title, action = undefined) {
  const system = apiSystem() ?? "metric";
  /** @param {Api.Block["text"][number]} part */
  const partText = (part) =>
    typeof part === "string"
      ? part
      : "sign" in part
        ? numberText(part, part[system])
        : part[system];
  /** @param {Api.Block["text"]} parts */
  const words = (parts) => withUnitSigns(parts.map(partText).join(""));
  let above = title;
  return found.map(({ text: parts, style, columns, rows }) => {
    if (style === "heading") return h("h3", {}, (above = words(parts)));
    if (!columns.length)
      return h("p", { class: style === "note" ? "quiet hint" : null }, words(parts));
    const heads = [...columns.map((column) => words(column.title)), ...(action ? [""] : [])];
    const lines = rows.map((cells, row) =>
      h(
        "tr",
        {},
        cells.map((cell, n) =>
          h(
            n ? "td" : "th",
            {
              scope: n ? null : "row",
              class: columns[n].right ? "number" : null,
              "data-value": numberOf(cell),
            },
            words(cell),
          ),
        ),
        action && h("td", {}, action(row)),
      ),
    );
    return scrolledTable(
      heads[0] ? `${above}: ${heads[0]}` : above,
      heads.some(Boolean) && headsOf(heads, (n) => columns[n]?.right),
      lines,
    );
  });
}

/** Return the metric number of a cell that consists of one number, for tests and scripts; null for other cells. @param {Api.Block["text"]} cell */
function numberOf([part, ...others]) {
  return typeof part === "object" && "sign" in part && !others.length ? part.metric.number : null;
}

/** @param {Api.NumberPart} part @param {Api.NumberPart["metric"]} shown */
function numberText({ sign, missing }, { number, unit, digits, decimals }) {
  if (typeof number !== "number") return missing;
  const size =
    decimals === null ? text(number, "", digits) : number.toFixed(decimals).replace("-", "−");
  return `${sign && number > 0 ? "+" : ""}${size}${unit && `\u00a0${unit}`}`;
}
