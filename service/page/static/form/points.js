/** Points of a table: two columns, typed or pasted from a spreadsheet, each with its unit; and their curve. */

import { post } from "../lib/api.js";
import { h } from "../lib/dom.js";
import { attempt } from "../lib/notices.js";
import { unitSelect } from "./controls.js";
import { centresOf, curve } from "./curve.js";
import { field } from "./field.js";
import { at, idOf, put, pathText } from "./path.js";
import { convert, join, measureOf, split } from "../lib/units.js";

/** @typedef {{ key: string, label: string, kind: string | null }} Column */

/**
 * Return the field for the points in two lists of a table, one point per line. optional: whether the lists may be omitted. steps: whether
 * two points may share an abscissa. files: whether a job may name a file of points.
 * @param {Form.Whole} form @param {Form.Path} path @param {[Column, Column]} columns @param {string} why @param {{ optional?: boolean, title?: string, steps?: boolean, files?: boolean }} options
 */
export function points(
  form,
  path,
  columns,
  why,
  { optional = false, title = "points, one per line", steps = false, files = true } = {},
) {
  const jobLists = columns.map(({ key }) => form.at([...path, key]));
  const lists = jobLists.map((one) => (Array.isArray(one) ? one : []));
  const units = columns.map(({ label, kind }, n) =>
    kind
      ? unitSelect(
          label,
          kind,
          split(lists[n][0], kind).unit,
          false,
          idOf([...path, columns[n].key], "u"),
        )
      : null,
  );
  const cells = lists.map((list, n) =>
    list.map((value) => {
      const { number, unit } = split(value, columns[n].kind);
      return unit ? convert(number, unit, units[n]?.value ?? unit, columns[n].kind) : number;
    }),
  );
  const rows = Array.from({ length: Math.max(...lists.map(({ length }) => length)) }, (_, n) =>
    cells.map((column) => column[n] ?? "").join("\t"),
  );
  const text = h("textarea", {
    id: idOf([...path, columns[0].key], "c"),
    rows: Math.min(Math.max(rows.length + 1, 4), 12),
    class: "points",
    spellcheck: "false",
    value: rows.join("\n"),
    oninput: () => {
      write();
      picture.draw();
    },
  });
  const drawn = text.value;
  const chosen = () => units.map((one) => one?.value ?? "");
  const begun = chosen().join(" ");
  const write = () => {
    delete text.dataset.wrong;
    const same = text.value === drawn && chosen().join(" ") === begun;
    const read = pointsOf(
      text.value,
      columns.map(({ kind }) =>
        Object.keys({ ...measureOf(kind).factors, ...measureOf(kind).spoken }),
      ),
    );
    if (read.wrong) text.dataset.wrong = read.wrong;
    read.units.forEach((unit, n) => {
      const select = units[n];
      if (unit && select)
        select.value = select.dataset.from = measureOf(columns[n].kind).spoken[unit] ?? unit;
    });
    const none = optional && !read.rows.length;
    columns.forEach(({ key }, n) =>
      form.put(
        [...path, key],
        same
          ? jobLists[n]
          : none
            ? undefined
            : read.rows.map(
                (row) => (units[n] ? join(row[n], units[n]?.value ?? "") : Number(row[n])) ?? "",
              ),
      ),
    );
  };
  const picture = curve({
    steps,
    read: () => {
      const { rows: cells, wrong } = pointsOf(text.value, []);
      const numbers = cells.map(([x, y]) => /** @type {Page.Point} */ ([Number(x), Number(y)]));
      return wrong || !numbers.flat().every(Number.isFinite) ? null : numbers;
    },
    write: (numbers) => {
      text.value = numbers.map((row) => row.join("\t")).join("\n");
      write();
    },
    titles: () =>
      columns.map(({ label }, n) => (units[n]?.value ? `${label}, ${units[n]?.value}` : label)),
    centres: () =>
      centresOf(
        form.said,
        columns[0],
        form.at([...path, "measured_from"]) ?? form.at([...path, "head"]),
        units[0]?.value ?? "",
      ),
  });
  units.forEach((select, n) =>
    select?.addEventListener("change", () => {
      const { rows: before } = pointsOf(text.value, []);
      for (const row of before)
        row[n] = convert(
          row[n],
          select.dataset.from ?? select.value,
          select.value,
          columns[n].kind,
        );
      text.value = before.map((row) => row.join("\t")).join("\n");
      select.dataset.from = select.value;
      write();
      picture.draw();
    }),
  );
  const titles = columns.map(({ label }, n) => [
    h("span", { class: "to" }, `${label} in`),
    units[n],
  ]);
  const node = field(
    form,
    [...path, columns[0].key],
    title,
    [text, h("span", { class: "row" }, titles)],
    `${why}; two columns, typed or pasted from a table; a first line may name the units, as in force (kN)`,
    { wide: true },
  );
  const error = h("p", { class: "error", id: `${text.id}-other-error`, hidden: true });
  node
    .querySelector(".field-controls")
    ?.append(...(files ? [fromFile(form, path, columns)] : []), picture.node);
  node.append(error);
  picture.draw();
  form.register({
    path: [...path, columns[1].key],
    key: pathText([...path, columns[1].key]),
    node,
    controls: [units[1] ?? text],
    error,
    tell: picture.draw,
  });
  return node;
}

/**
 * Return the button that reads points from a file, and a summary of the read points.
 * @param {Form.Whole} form @param {Form.Path} path @param {Column[]} columns
 */
function fromFile(form, path, columns) {
  const input = h("input", {
    type: "file",
    id: idOf(path, "file"),
    class: "hidden",
    tabindex: "-1",
    "aria-label": "File of points",
    onchange: async () => {
      const [file] = input.files ?? [];
      input.value = "";
      if (!file) return;
      const job = structuredClone(form.job);
      const otherEntries = Object.entries(form.at(path) ?? {}).filter(
        ([key]) => key !== "source" && !columns.some((one) => one.key === key),
      );
      put(job, path, { ...Object.fromEntries(otherEntries), file: file.name });
      await attempt(async () => {
        const parsed = await post("parse", { job, files: { [file.name]: await bytesOf(file) } });
        form.put(path, at(parsed.job, path)); // the units of its columns identify the table
        form.redraw();
      });
    },
  });
  const source = form.at([...path, "source"]);
  return h(
    "p",
    { class: "row" },
    h("button", { type: "button", onclick: () => input.click() }, "Read a file …"),
    input,
    source ? h("span", { class: "quiet" }, String(source)) : null,
  );
}

/** Return the content of a file as a data URL, which keeps its bytes whatever their encoding. @param {File} file @returns {Promise<string>} */
function bytesOf(file) {
  return new Promise((resolve, reject) => {
    const reader = new FileReader();
    reader.addEventListener("load", () => resolve(String(reader.result)));
    reader.addEventListener("error", () => reject(reader.error));
    reader.readAsDataURL(file);
  });
}

/**
 * Return the rows of a pasted text, and the units in its first line: {rows, units, wrong}. Cells are separated by tabs or semicolons,
 * with which decimal commas are permitted, or by spaces or commas.
 * @param {string} text @param {string[][]} known units of each column
 * @returns {{ rows: string[][], units: string[], wrong: string | null }}
 */
export function pointsOf(text, known) {
  const lines = text
    .split(/\r?\n/)
    .map((line) => line.trim())
    .filter(Boolean);
  const apart = lines.map((line) => {
    const parts = /[\t;]/.test(line)
      ? line.split(/[\t;]/)
      : /\d\s+[-+\d.,]/.test(line) && !/,\s/.test(line)
        ? line.split(/\s+/)
        : line.split(",");
    return parts.map((part) => part.trim());
  });
  /** @type {string[]} */
  let units = [];
  if (apart.length && /[A-Za-zµ°]/.test(apart[0].join("")) && !/^[-+\d.,]/.test(apart[0][0])) {
    units =
      apart
        .shift()
        ?.map((cell) => /[([]([^)\]]+)[)\]]/.exec(cell)?.[1].trim() ?? "")
        .map((unit, n) => (known[n]?.includes(unit) ? unit : "")) ?? [];
  }
  const skipped = lines.length - apart.length;
  const bad = apart.findIndex((row) => row.length !== 2 || row.some((cell) => cell === ""));
  const wrong =
    bad < 0
      ? null
      : `Line ${bad + skipped + 1} must have two numbers, with a tab, a semicolon or a space between them; got “${lines[bad + skipped].slice(0, 40)}”.`;
  const rows = apart.map((row) =>
    [0, 1].map((n) => (row[n] ?? "").replace(/^([-+]?\d*),(\d+)$/, "$1.$2")),
  );
  return { rows, units, wrong };
}
