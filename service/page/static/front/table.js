/** Remaining designs as a sorted, paged table with keyboard access. */

import { fill, first as firstOf, focused, h } from "../lib/dom.js";
import { grouped, inDisplayUnit, text } from "../lib/numbers.js";
import { headed, helpLink } from "./columns.js";
import { namesOf } from "./chart_marks.js";

/** @import { Explorer } from "./explorer.js" */

const PAGE = 20;
/** @type {Record<string, number>} */
const STEPS = { ArrowDown: 1, ArrowUp: -1 };

/** Return {place, draw(), mark(), numbers()} of the table of an explorer. @param {Explorer} explorer */
export function designTable(explorer) {
  const head = h("thead");
  const body = h("tbody", { onkeydown: keys });
  const caption = h("caption", { class: "hidden" }, "The listed designs");
  const pages = h("nav", { class: "row pages", "aria-label": "Pages of designs" });
  const place = h(
    "div",
    {},
    h("div", { class: "scroll" }, h("table", { class: "designs" }, caption, head, body)),
    pages,
  );

  function rows() {
    const { chosen, data, limits } = explorer;
    const { mask } = limits;
    const rowNumbers = new Uint32Array(limits.chosen);
    let count = 0;
    if (!chosen.sort || !data.has(chosen.sort)) {
      for (let row = 0; row < mask.length; row += 1) if (mask[row]) rowNumbers[count++] = row;
      return rowNumbers;
    }
    const numbers = data.numbers(chosen.sort);
    for (const row of data.order(chosen.sort)) if (mask[row]) rowNumbers[count++] = row;
    let defined = count;
    while (defined > 0 && Number.isNaN(numbers[rowNumbers[defined - 1]])) defined -= 1; // these stay last in either direction
    if (chosen.reverse) rowNumbers.subarray(0, defined).reverse();
    return rowNumbers;
  }

  function draw() {
    const { chosen, data, limits } = explorer;
    const listedRows = rows();
    const last = Math.max(1, Math.ceil(listedRows.length / PAGE));
    const page = Math.min(chosen.page, last);
    const columns = chosen.columns.filter((key) => data.has(key));
    const focusedAct = focused(place)?.dataset.act;
    fill(
      head,
      h(
        "tr",
        {},
        h("th", { scope: "col" }, h("span", { class: "hidden" }, "Selected")),
        h("th", { scope: "col" }, "design"),
        columns.map(heading),
      ),
    );
    const names = namesOf(explorer);
    fill(
      body,
      [...listedRows.slice((page - 1) * PAGE, page * PAGE)].map((row) => line(row, columns, names)),
    );
    if (!listedRows.length)
      fill(
        body,
        h("tr", {}, h("td", { colspan: columns.length + 2 }, "No design is within all limits.")),
      );
    /** @param {string} sign @param {string} label @param {number} to @param {boolean} disabled */
    const turn = (sign, label, to, disabled) =>
      h(
        "button",
        {
          type: "button",
          "aria-label": label,
          "data-act": label,
          disabled,
          onclick: () => explorer.change({ page: to }, "table"),
        },
        sign,
      );
    const first = (page - 1) * PAGE;
    fill(
      pages,
      turn("«", "First page", 1, page === 1),
      turn("‹", "Previous page", page - 1, page === 1),
      h(
        "span",
        {},
        listedRows.length
          ? `${first + 1}–${Math.min(listedRows.length, first + PAGE)} of ${grouped(limits.chosen)}`
          : "0",
      ),
      turn("›", "Next page", page + 1, page === last),
      turn("»", "Last page", last, page === last),
    );
    if (focusedAct)
      firstOf(place, `[data-act="${CSS.escape(focusedAct)}"]:not(:disabled)`)?.focus();
    mark();
  }

  /** @param {string} key */
  function heading(key) {
    const column = explorer.data.column(key);
    const { sort, reverse } = explorer.chosen;
    const sorted = sort === key ? (reverse ? "descending" : "ascending") : "none";
    const words = explorer.data.words(key);
    return h(
      "th",
      { scope: "col", class: words ? null : "number", "aria-sort": sorted },
      h(
        "button",
        {
          type: "button",
          class: "sort",
          "data-act": `sort-${key}`,
          title: `Sort by ${column.title}`,
          onclick: () => explorer.sortBy(key),
        },
        headed(column),
        h(
          "span",
          { "aria-hidden": "true" },
          { ascending: " ▲", descending: " ▼", none: "" }[sorted],
        ),
      ),
      h(
        "div",
        { class: "way" },
        explorer.data.better(key),
        h(
          "a",
          { class: "what-is", href: helpLink(key), "aria-label": `What is ${column.title}?` },
          "?",
        ),
      ),
    );
  }

  /** @param {number} row @param {string[]} columns @param {Map<number, string[]>} names */
  function line(row, columns, names) {
    const { data, chosen } = explorer;
    const number = row + 1;
    return h(
      "tr",
      {
        "data-row": row,
        onpointerenter: () => explorer.point(row),
        onpointerleave: () => explorer.point(null),
      },
      h(
        "td",
        {},
        h("input", {
          type: "checkbox",
          "data-act": `select-${row}`,
          checked: chosen.selected.includes(number),
          "aria-label": `Select design ${number}`,
          onchange: () => explorer.select(row),
        }),
      ),
      h(
        "td",
        {},
        h(
          "a",
          {
            href: explorer.hrefOf(row),
            "data-act": `open-${row}`,
            onfocus: () => explorer.focus(row),
            onblur: () => explorer.focus(null),
          },
          `${number}`,
        ),
        (names.get(row) ?? []).map((name) => h("span", { class: "mark-name" }, name)),
      ),
      columns.map((key) => {
        const value = data.cell(key, row);
        return h(
          "td",
          { class: data.words(key) ? null : "number" },
          aligned(value, data.column(key).unit, data.range(key)),
        );
      }),
    );
  }

  /** Arrow keys move between rows, Enter opens, the space bar selects. @param {KeyboardEvent} event */
  function keys(event) {
    const step = STEPS[event.key];
    const target = event.target instanceof Element ? event.target : body;
    const row = target.closest("tr");
    if (event.key === " " && row && target.matches("a")) {
      event.preventDefault();
      explorer.select(Number(row.dataset.row));
    }
    if (!step || !row) return;
    event.preventDefault();
    const other = step > 0 ? row.nextElementSibling : row.previousElementSibling;
    other?.querySelector("a")?.focus();
  }

  /** Show which designs are selected and which one is highlighted. */
  function mark() {
    for (const row of body.rows) {
      const design = Number(row.dataset.row);
      const selected = explorer.chosen.selected.includes(design + 1);
      row.classList.toggle("selected", selected);
      row.classList.toggle("pointed", explorer.pointed === design);
      const tick = row.querySelector("input");
      if (tick) tick.checked = selected;
    }
  }

  /** Return the numbers of the designs in the order of the table, on all its pages. */
  const numbers = () => Array.from(rows(), (row) => row + 1);

  return { place, draw, mark, numbers };
}

/**
 * Return a value with as many decimals as its column, so that decimal points align; other values unchanged.
 * @param {Api.Row[string]} value @param {string} unit @param {Page.Range} range
 */
function aligned(value, unit, { low, high }) {
  const greatest = Math.max(
    Math.abs(inDisplayUnit(low, unit)),
    Math.abs(inDisplayUnit(high, unit)),
  );
  if (typeof value !== "number" || !(greatest >= 1e-2 && greatest < 1e6))
    return text(value, unit, 5);
  const places = Math.max(0, 4 - Math.floor(Math.log10(greatest)));
  const shown = inDisplayUnit(value, unit).toFixed(places);
  return Number(shown) === 0 && value !== 0 ? text(value, unit, 3) : shown.replace("-", "−");
}
