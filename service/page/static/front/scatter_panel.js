/** Scatter plot with the choice of its quantities and its colour legend. */

import { link } from "../lib/address.js";
import { fill, h } from "../lib/dom.js";
import { ends } from "../lib/numbers.js";
import { headed } from "./columns.js";
import { correlations } from "./correlation.js";
import { setLogarithmic, isLogarithmic, mayBeLogarithmic } from "./logarithmic.js";

/**
 * @import { Explorer } from "./explorer.js"
 * @import { scatter } from "../charts/scatter.js"
 */

/**
 * Return {place, draw(), legend()} around the scatter of an explorer.
 * @param {Explorer} explorer @param {ReturnType<typeof scatter>} dots
 */
export function scatterPanel(explorer, dots) {
  const { data, chosen } = explorer;
  /** @param {string} label @param {"x" | "y" | "colour"} name @param {string} none */
  const pick = (label, name, none = "") => {
    const select = h(
      "select",
      {
        name,
        onchange: ({ currentTarget }) => explorer.change({ [name]: currentTarget.value }, "all"),
      },
      none && h("option", { value: "" }, none),
      data.columns.map(({ key, title }) => h("option", { value: key }, title)),
    );
    const log = h("input", {
      type: "checkbox",
      "aria-label": `Logarithmic, ${label.toLowerCase()}`,
      onchange: () => setLogarithmic(explorer, chosen[name]),
    });
    const logs = h("label", { class: "log", title: "Logarithmic axis" }, log, " log");
    return {
      name,
      select,
      log,
      logs,
      node: h(
        "span",
        { class: "pick" },
        h("label", {}, `${label} `, select),
        name !== "colour" && logs,
      ),
    };
  };
  const drag = h(
    "label",
    {},
    "Drag ",
    h(
      "select",
      { name: "drag", onchange: (event) => dots.byHand(event.currentTarget.value === "line") },
      h("option", { value: "box" }, "a box"),
      h("option", { value: "line" }, "by hand"),
    ),
  );
  const picks = [pick("Across", "x"), pick("Up", "y"), pick("Colour", "colour", "none")];
  const key = h("div", { class: "legend" });
  const together = correlations(explorer);
  const before = h("div", { class: "legend before", hidden: true });
  const place = h(
    "section",
    { class: "panel trade-off", "aria-labelledby": "scatter-title" },
    h("h2", { id: "scatter-title" }, "Trade-offs"),
    h(
      "div",
      { class: "row picks" },
      picks.map(({ node }) => node),
      drag,
    ),
    h("div", { class: "dots" }, dots.place),
    key,
    before,
    together.place,
    h(
      "p",
      { class: "quiet hint" },
      "Drag a box or a line around designs to keep only those. Click a design to open it; Shift-click selects it.",
    ),
  );

  function draw() {
    for (const picker of picks) {
      picker.select.value = chosen[picker.name];
      picker.logs.hidden = !mayBeLogarithmic(explorer, chosen[picker.name]);
      picker.log.checked = isLogarithmic(explorer, chosen[picker.name]);
    }
  }

  /** State whose front is drawn behind. */
  function drawBefore() {
    const { before: run } = explorer;
    before.hidden = !run;
    if (!run || before.firstChild) return;
    const toggle = h("input", {
      type: "checkbox",
      checked: chosen.behind,
      onchange: ({ currentTarget }) => explorer.change({ behind: currentTarget.checked }, "all"),
    });
    fill(
      before,
      h(
        "label",
        {},
        toggle,
        h("span", { class: "ring", "aria-hidden": "true" }),
        ` Behind it: the front of run ${run.run}`,
      ),
      h(
        "a",
        { href: link(["compare"], { jobs: `${run.run},${explorer.job.id}` }) },
        "Compare them",
      ),
    );
  }

  function legend() {
    drawBefore();
    if (!chosen.colour) {
      fill(key);
      return;
    }
    const column = data.column(chosen.colour);
    const words = data.words(chosen.colour);
    const inks = dots.colours();
    /** @param {string} ink @param {boolean} [wide] */
    const patch = (ink, wide) => {
      const node = h("span", { class: wide ? "shade" : "patch" });
      node.style.background = ink;
      return node;
    };
    if (words) {
      fill(
        key,
        h("span", {}, `${column.title}:`),
        words.map((word, index) => h("span", {}, patch(inks[index % inks.length]), ` ${word}`)),
      );
      return;
    }
    const [low, high] = ends(data.range(chosen.colour), column.unit);
    fill(
      key,
      h("span", {}, headed(column)),
      h("span", {}, low),
      h(
        "span",
        { class: "shades", title: "viridis: equal steps look equally large" },
        inks.map((ink) => patch(ink, true)),
      ),
      h("span", {}, high),
    );
  }

  return { place, draw, legend, together };
}
