/** Sentences and tables of an answer, their numbers in the units that the reader prefers. */

import { h } from "./dom.js";
import { apiSystem, text } from "./numbers.js";
import { headsOf, scrolledTable } from "./table.js";

/** Return the nodes of blocks. title: of tables that no heading precedes. @param {Api.Block[]} found @param {string} title */
export function blocks(found, title) {
  const system = apiSystem() ?? "metric";
  /** @param {Api.Block["text"][number]} part */
  const shown = (part) =>
    typeof part === "string"
      ? part
      : "sign" in part
        ? numberText(part, part[system])
        : part[system];
  /** @param {Api.Block["text"]} parts */
  const words = (parts) => parts.map(shown).join("");
  let above = title;
  return found.map(({ text: parts, style, columns, rows }) => {
    if (style === "heading") return h("h3", {}, (above = words(parts)));
    if (!columns.length)
      return h("p", { class: style === "note" ? "quiet hint" : null }, words(parts));
    const heads = columns.map((column) => words(column.title));
    const lines = rows.map((cells) =>
      h(
        "tr",
        {},
        cells.map((cell, n) =>
          h(
            n ? "td" : "th",
            { scope: n ? null : "row", class: columns[n].right ? "number" : null },
            words(cell),
          ),
        ),
      ),
    );
    return scrolledTable(
      heads[0] ? `${above}: ${heads[0]}` : above,
      heads.some(Boolean) && headsOf(heads, (n) => columns[n].right),
      lines,
    );
  });
}

/** @param {Api.NumberPart} part @param {Api.NumberPart["metric"]} shown */
function numberText({ sign, missing }, { number, unit, digits, decimals }) {
  if (typeof number !== "number") return missing;
  const size =
    decimals === null ? text(number, "", digits) : number.toFixed(decimals).replace("-", "−");
  return `${sign && number > 0 ? "+" : ""}${size}${unit && `\u00a0${unit}`}`;
}
