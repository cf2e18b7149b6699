/** Heads of the axes: name, and a menu with fields for limits and position. */

import { fill, first, focused, h, markInvalid, numberField } from "../lib/dom.js";
import { menu } from "../lib/menu.js";
import { ends, text } from "../lib/numbers.js";
import { parseQuantity } from "../lib/quantity_text.js";
import { headed, helpLink } from "./columns.js";
import { setLogarithmic, isLogarithmic, mayBeLogarithmic } from "./logarithmic.js";

/** @import { Explorer } from "./explorer.js" */
/** @import { Axis } from "./choices.js" */

const MOST_WORDS = 8; // as check boxes; the table has the others

/**
 * Return {node, draw(), limits()} for the axes of an explorer: call draw after a change of axes, and limits after a change of limits.
 * @param {Explorer} explorer
 */
export function axisFields(explorer) {
  const node = h("div", {
    class: "axis-heads",
    role: "toolbar",
    "aria-label": "Axes of the chart",
    onkeydown: ({ key, target }) => {
      const heads = [...node.querySelectorAll("summary")];
      const index = heads.findIndex((one) => one === target);
      if (index >= 0)
        heads[index + Number(key === "ArrowRight") - Number(key === "ArrowLeft")]?.focus();
    },
  });
  /** @type {{ key: string, node: HTMLElement, show: (limit: Page.Limit | undefined) => void }[]} */
  let fields = [];

  function draw() {
    const { axes } = explorer.chosen;
    node.style.gridTemplateColumns = `repeat(${Math.max(1, axes.length)}, minmax(0, 1fr))`;
    const focusedAct = focused(node)?.dataset.act;
    const open = node.querySelector("details[open] > summary")?.getAttribute("data-act");
    fields = axes.map(({ key }) => field(key));
    fill(
      node,
      axes.map((axis, index) => head(axis, index, axes.length)),
    );
    first(node, `[data-act="${CSS.escape(open ?? "")}"]`)?.parentElement?.setAttribute("open", "");
    if (focusedAct) first(node, `[data-act="${CSS.escape(focusedAct)}"]:not(:disabled)`)?.focus();
    limits();
  }

  /** Return the head of an axis, a menu; arrow keys move between the heads. @param {Axis} options @param {number} index @param {number} count */
  function head({ key, flipped }, index, count) {
    const column = explorer.data.column(key);
    /** @param {string} label @param {() => void} doing @param {boolean} disabled @param {boolean} [pressed] */
    const act = (label, doing, disabled = false, pressed = undefined) =>
      h(
        "button",
        {
          type: "button",
          class: "linked",
          "aria-pressed": pressed === undefined ? null : String(pressed),
          "aria-label": `${label}: ${column.title}`,
          disabled,
          "data-act": `${label}-${key}`,
          onclick: doing,
        },
        label,
      );
    const more = menu(
      headed(column).replace(",\u00a0", ", "), // an axis is narrow
      h(
        "div",
        { class: "chooser-list panel" },
        fields[index].node,
        act("Move left", () => explorer.moveAxis(index, -1), index === 0),
        act("Move right", () => explorer.moveAxis(index, 1), index === count - 1),
        act("Flip", () => explorer.flipAxis(index)),
        mayBeLogarithmic(explorer, key) &&
          act(
            "Logarithmic",
            () => setLogarithmic(explorer, key),
            false,
            isLogarithmic(explorer, key),
          ),
        act(
          "Leave out",
          () => explorer.setAxes(explorer.chosen.axes.filter((_, other) => other !== index)),
          count === 1,
        ),
        h("a", { href: helpLink(key) }, `What is ${column.title}?`),
      ),
      { act: `axis-${key}` },
    );
    const summary = /** @type {HTMLElement} */ (first(more, "summary"));
    summary.tabIndex = index ? -1 : 0;
    summary.draggable = true;
    summary.title = headed(column);
    return h(
      "div",
      {
        class: "axis-head",
        "data-axis": key,
        ondragstart: ({ dataTransfer }) => dataTransfer?.setData("text/axis", String(index)),
        ondragover: (event) =>
          event.dataTransfer?.types.includes("text/axis") && event.preventDefault(),
        ondrop: (event) => {
          event.preventDefault();
          const from = Number(event.dataTransfer?.getData("text/axis"));
          if (from !== index) explorer.moveAxis(from, index - from);
        },
      },
      more,
      h("span", { class: "way" }, wayOf(key, flipped)),
    );
  }

  /** Return an arrow towards the better end of an axis; for a target, words. @param {string} key @param {boolean} flipped */
  function wayOf(key, flipped) {
    const better = explorer.data.better(key);
    if (!better || better.startsWith("best near")) return better;
    return (explorer.data.sense(key) === "maximise") !== flipped ? "↑ better" : "↓ better";
  }

  /** @param {string} key */
  function field(key) {
    const column = explorer.data.column(key);
    const words = explorer.data.words(key);
    if (words) return ofWords(key, column, words.slice(0, MOST_WORDS));
    const [low, high] = ends(explorer.data.range(key), column.unit);
    /** @param {string} side @param {string} placeholder @param {string} label */
    const input = (side, placeholder, label) =>
      numberField({
        "data-limit": `${side}.${key}`,
        placeholder,
        "aria-label": `${label} ${headed(column)}`,
        onchange: take,
      });
    const least = input("min", low, "At least");
    const most = input("max", high, "At most");
    function take() {
      const [from, to] = [least, most].map((node) => number(node, column.unit));
      const bad = from === undefined || to === undefined;
      if (!bad) explorer.limit(key, { low: from, high: to });
    }
    return {
      key,
      node: h(
        "div",
        { class: "axis-limit", role: "group", "aria-label": `Limits of ${column.title}` },
        least,
        "to",
        most,
      ),
      /** @param {Page.Limit | undefined} limit */
      show(limit) {
        for (const [end, node] of /** @type {const} */ ([
          ["low", least],
          ["high", most],
        ])) {
          const value = limit?.[end];
          if (
            document.activeElement === node &&
            node.value.trim() &&
            number(node, column.unit) === value
          )
            continue;
          node.value = value === null || value === undefined ? "" : text(value, column.unit, 6);
          node.removeAttribute("aria-invalid");
        }
      },
    };
  }

  /** @param {string} key @param {Api.Column} column @param {string[]} words */
  function ofWords(key, column, words) {
    /** @type {HTMLInputElement[]} */
    const ticks = words.map((word) =>
      h("input", {
        type: "checkbox",
        value: word,
        "data-limit": `is.${key}`,
        onchange: () => {
          const wanted = ticks.filter(({ checked }) => checked).map(({ value }) => value);
          explorer.limit(key, wanted.length === words.length ? null : { words: wanted });
        },
      }),
    );
    return {
      key,
      node: h(
        "div",
        { class: "axis-limit", role: "group", "aria-label": `Only ${column.title}` },
        ticks.map((tick) => h("label", {}, tick, ` ${tick.value}`)),
      ),
      /** @param {Page.Limit | undefined} limit */
      show(limit) {
        for (const tick of ticks) tick.checked = !limit?.words || limit.words.includes(tick.value);
      },
    };
  }

  function limits() {
    for (const { key, show } of fields) show(explorer.limits.of.get(key));
  }
  return { node, draw, limits };
}

/**
 * Return the number in a field in the unit of the API; null for an empty field; undefined, with the field marked, for other text.
 * @param {HTMLInputElement} node @param {string} unit @returns {number | null | undefined}
 */
function number(node, unit) {
  const { value, wrong } = parseQuantity(node.value, unit);
  markInvalid(node, wrong);
  node.title = wrong ?? "";
  return wrong === undefined ? (value ?? null) : undefined;
}
