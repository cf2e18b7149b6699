/** All numbers of designs side by side, in groups. */

import { fill, h } from "../lib/dom.js";
import { link } from "../lib/address.js";
import { text, unitOf, withPower, withUnit } from "../lib/numbers.js";
import { requirementText } from "./requirement_text.js";
import { headedRow, scrolled, scrolledTable } from "../lib/table.js";

/** @typedef {{ name: string, series: number | string, row: Api.Row, allowed?: Api.WhatIf["allowed"] }} Shown A design of the tables. */

const QUALITY = ["status", "residual"];
const MET = 1e-8; // relative tolerance of bounds

/**
 * Put the numbers of designs into `place`. designs: {name, row} of each; the others are compared with the first. columns: columns of the
 * first. requirements, slow (stroke): from the API. names: names of quantities by column.
 * @param {HTMLElement} place
 * @param {{ designs: Shown[], columns: Api.Column[], requirements: Api.Requirement[], slow: string | null | undefined, names: Record<string, string> }} options
 */
export function showNumbers(place, { designs, columns, requirements, slow, names }) {
  /** @param {Api.Column} column */
  const hasValue = ({ key }) =>
    designs.some(({ row }) => row[key] !== null && row[key] !== undefined);
  const groups = groupsOf(columns);
  const shown = groups
    .map(({ title, columns: own }) => ({ title, columns: own.filter(hasValue) }))
    .filter(({ columns: own }) => own.length > 0);
  const missing = groups.flatMap(({ columns: own }) => own.filter((column) => !hasValue(column)));
  const several = designs.length > 1;
  const tables = several
    ? h("section", { class: "panel group together" }, table("All numbers", designs, shown, names))
    : shown.map((group) =>
        h(
          "section",
          { class: "panel group" },
          h("h3", {}, group.title),
          table(group.title, designs, [group], names),
        ),
      );
  const without =
    missing.length > 0 &&
    h(
      "section",
      { class: "panel group" },
      h(
        "details",
        {},
        h("summary", {}, `Quantities that are not defined for this machine (${missing.length})`),
        table("Quantities without a value", designs, [{ title: "", columns: missing }], names),
      ),
    );
  fill(
    place,
    h("h2", {}, "All numbers"),
    several && tables,
    several && limits(designs, requirements, slow, names),
    h(
      "div",
      { class: "groups" },
      !several && tables,
      !several && limits(designs, requirements, slow, names),
      quality(designs, columns),
      without,
    ),
  );
}

/** Return a link to the help of a column. @param {{ key: string, title: string }} column @param {Record<string, string>} names */
export function helpLink({ key, title }, names) {
  return h("a", { href: link(["help", names[key] ?? key]), class: "help-link" }, title);
}

/**
 * Return a cell with a number, which carries its full precision.
 * @param {Api.Row[string] | undefined} value @param {{ key: string, unit: string }} column
 * @param {{ tag?: "td" | "strong", digits?: number, name?: string }} looks
 */
function cell(value, column, { tag = "td", digits = 5, name = "" } = {}) {
  return h(
    tag,
    {
      class: typeof value === "number" ? "number" : "number word",
      "data-key": column.key,
      "data-design": name || null,
      "data-value": value === null || value === undefined ? "" : String(value),
    },
    text(value, column.unit, digits),
  );
}

/**
 * Return the difference of a value from another as text: "+1.2 %", of an angle "+1.2°"; empty if it has no meaning.
 * @param {Api.Row[string] | undefined} value @param {Api.Row[string] | undefined} from @param {string} [unit]
 */
export function difference(value, from, unit = "") {
  if (typeof value !== "number" || typeof from !== "number") return "";
  if (unit === "deg" && Math.abs(value - from) >= 0.0005)
    return `${value > from ? "+" : ""}${withUnit(value - from, unit, 3)}`;
  if (from === 0) return "";
  const percent = (100 * (value - from)) / Math.abs(from);
  if (Math.abs(percent) < 0.005) return "=";
  return `${percent > 0 ? "+" : "−"}${Math.abs(percent) >= 1000 ? Math.round(Math.abs(percent)) : Number(Math.abs(percent).toPrecision(3))} %`;
}

/**
 * Return a table of designs by groups of numbers; the others with their change from the first.
 * @param {string} caption @param {Shown[]} designs @param {{ title: string, columns: Api.Column[] }[]} groups @param {Record<string, string>} names
 */
function table(caption, designs, groups, names) {
  const [first, ...others] = designs;
  const head = h(
    "tr",
    {},
    h("th", { scope: "col" }, "Quantity"),
    heading(first),
    others.map((one) => [heading(one), h("th", { scope: "col", class: "number" }, "change")]),
  );
  /** @param {Api.Column} column */
  const line = (column) =>
    headedRow(
      [
        helpLink(column, names),
        others.length > 0 &&
          column.unit && [", ", h("span", { class: "quiet unit" }, unitOf(column.unit))],
      ],
      cell(first.row[column.key], column, { name: first.name }),
      others.map(({ row, name }) => [
        cell(row[column.key], column, { name }),
        h(
          "td",
          { class: "number quiet" },
          difference(row[column.key], first.row[column.key], column.unit),
        ),
      ]),
      others.length === 0 && h("td", { class: "quiet" }, unitOf(column.unit)),
    );
  const bodies = groups.map(({ title, columns }) =>
    h(
      "tbody",
      {},
      groups.length > 1 &&
        h(
          "tr",
          { class: "group-title" },
          h("th", { scope: "rowgroup", colspan: 2 + 2 * others.length }, title),
        ),
      columns.map(line),
    ),
  );
  return scrolled(
    caption,
    h(
      "table",
      {},
      h("caption", { class: "hidden" }, caption),
      h("thead", { class: others.length ? null : "hidden" }, head),
      bodies,
    ),
  );
}

/** @param {Shown} design */
function heading({ name, series }) {
  return h("th", { scope: "col", class: "number", "data-series": series }, name);
}

/** @param {Shown[]} designs @param {Api.Requirement[]} requirements @param {string | null | undefined} slow @param {Record<string, string>} names */
function limits(designs, requirements, slow, names) {
  const ofStroke =
    slow &&
    h(
      "tr",
      {},
      h(
        "th",
        { scope: "row" },
        helpLink({ key: "slow_stroke", title: "slow stroke" }, names),
        h("span", { class: "quiet asked" }, ` ${slow}`),
      ),
      designs.map(({ row, name }) => [
        cell(row.slow_stroke, { key: "slow_stroke", unit: "" }, { name }),
        h(
          "td",
          {},
          h(
            "span",
            { class: row.slow_stroke === slow ? "good" : "bad" },
            row.slow_stroke === slow ? "met" : "broken",
          ),
        ),
      ]),
    );
  const rows = requirements.map((asked) => {
    const column = { key: asked.column, title: asked.title, unit: asked.unit };
    return h(
      "tr",
      {},
      h(
        "th",
        { scope: "row" },
        helpLink(column, names),
        h("span", { class: "quiet asked" }, ` ${requirementText(asked)}`),
      ),
      designs.map(({ row, name, allowed }) => [
        cell(row[asked.column], column, { name }),
        h("td", {}, met(row, asked, allowed)),
      ]),
    );
  });
  const heads = [
    h("th", { scope: "col" }, "Requirement"),
    designs.map((one) => [heading(one), h("th", { scope: "col" }, "how close")]),
  ];
  return h(
    "section",
    { class: "panel group limits" },
    h("h3", {}, "Requirements of the job"),
    requirements.length || slow
      ? scrolledTable("Requirements of the job", heads, [ofStroke, rows])
      : h("p", { class: "quiet" }, "The job sets none."),
  );
}

/** @param {Api.Row} row @param {Api.Requirement} requirement @param {Shown["allowed"]} allowed deviations by column */
function met(row, { column, lower, upper, slack, unit }, allowed) {
  const left = row[slack];
  const size = Math.max(Math.abs(lower ?? 0), Math.abs(upper ?? 0), 1e-300);
  const data = { "data-key": slack, "data-value": left === null ? "" : String(left) };
  if (typeof left !== "number") return h("span", data, lower === upper ? "–" : "far from it");
  const [miss, most] = [-left, allowed?.[column] ?? 0];
  if (miss > MET * size)
    return miss <= most * (1 + MET)
      ? h(
          "span",
          { ...data, class: "at-limit" },
          `off by ${withUnit(miss, unit, 3)}, ${withUnit(most, unit, 3)} allowed`,
        )
      : h("span", { ...data, class: "bad" }, `missed by ${withUnit(miss, unit, 3)}`);
  if (left <= MET * size)
    return h("span", { ...data, class: "at-limit" }, lower === upper ? "met" : "at its limit");
  return h("span", { ...data, class: "good" }, `${withUnit(left, unit, 3)} to spare`);
}

/** @param {Shown[]} designs @param {Api.Column[]} columns */
function quality(designs, columns) {
  if (!columns.some(({ key }) => key === "status")) return null;
  /** @param {Api.Row} row */
  const words = (row) =>
    row.status === "stationary"
      ? "A local optimum: no small change improves one objective without worsening another."
      : "The best design found; a small change might still improve it.";
  return h(
    "section",
    { class: "panel group" },
    h("h3", {}, "Quality of the optimum"),
    designs
      .filter(({ row }) => row.status)
      .map(({ row, name }) =>
        h(
          "div",
          {},
          designs.length > 1 ? h("h4", {}, name) : null,
          h("p", {}, words(row)),
          h(
            "dl",
            { class: "facts" },
            h("dt", {}, "status"),
            h("dd", { "data-key": "status", "data-value": row.status }, String(row.status)),
            h("dt", {}, "stationarity residual"),
            h(
              "dd",
              {
                class: "number",
                "data-key": "residual",
                "data-value": row.residual === null ? "" : String(row.residual),
              },
              row.residual === null ? "not known" : withPower(Number(row.residual), 2),
            ),
          ),
        ),
      ),
  );
}

/**
 * Return [{title, columns}]: every column of a design except slacks and optimality, by the groups from the service.
 * @param {Api.Column[]} columns
 */
function groupsOf(columns) {
  /** @type {Map<string, { title: string, columns: Api.Column[] }>} */
  const groups = new Map();
  for (const column of columns
    .filter(({ key }) => !key.startsWith("slack_") && !QUALITY.includes(key))
    .sort((a, b) => (a.group_place ?? 0) - (b.group_place ?? 0))) {
    const title = column.group ?? "Further quantities";
    const { columns: found } = groups.get(title) ?? { columns: /** @type {Api.Column[]} */ ([]) };
    found.push(column);
    groups.set(title, { title, columns: found });
  }
  return [...groups.values()];
}
