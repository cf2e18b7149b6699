/** Marked designs of a front: the extremes, the knee with its trade-offs, and the choice by weights. */

import { get, isAbort, statusOf } from "../lib/api.js";
import { fill, h } from "../lib/dom.js";
import { sayProblem } from "../lib/notices.js";
import { apiSystem, inDisplayUnits, withUnit, withUnitSigns } from "../lib/numbers.js";
import { inWords } from "../lib/words.js";
import { smallLinkage } from "../mechanism/small_linkage.js";
import { namesOf } from "./chart_marks.js";

/** @import { Explorer } from "./explorer.js" */

const PAUSE = 150; // ms after a slider has moved

/** Return {place, draw(what)} of the marks of an explorer. @param {Explorer} explorer */
export function marksPanel(explorer) {
  const { data, front, chosen } = explorer;
  const list = h("ul", { class: "marks" });
  const picked = h("p", { role: "status" });
  const costs = h("ul", { class: "trade-offs" });
  const beyondAllowed = h("div", {});
  const sliders = data.objectives.map((objective, index) => slider(objective, index));
  const off = h("button", { type: "button", onclick: () => weigh(null) }, "Without weights");
  const several = data.objectives.length > 1;
  const place = h(
    "section",
    { class: "panel worth", "aria-labelledby": "marks-title" },
    h("h2", { id: "marks-title" }, "Worth a look"),
    beyondAllowed,
    front.warnings.map((sentence) => h("p", { class: "error" }, `Warning: ${inWords(sentence)}.`)),
    list,
    front.trade_offs.length > 0 && [h("h3", {}, "Trade-offs at the knee"), costs],
    several && [
      h("h3", { class: "weights" }, "Weigh the objectives"),
      h(
        "p",
        { class: "quiet hint" },
        "The design nearest to the ideal and farthest from the worst by these weights (TOPSIS), among those within all limits.",
      ),
      h(
        "div",
        { class: "weights" },
        sliders.map(({ node }) => node),
      ),
      picked,
      off,
    ],
  );
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let timer;
  let pendingQuestion = "";
  explorer.signal.addEventListener("abort", () => clearTimeout(timer));

  /** @param {Api.Objective} options @param {number} index */
  function slider({ title }, index) {
    const value = h("output", { class: "number" });
    const input = h("input", {
      type: "range",
      min: 0,
      max: 10,
      step: 1,
      name: `weight-${index}`,
      oninput: () => {
        const weights = chosen.weights ? [...chosen.weights] : data.objectives.map(() => 1);
        weights[index] = Number(input.value);
        weigh(weights);
      },
    });
    return { input, value, node: h("label", {}, h("span", {}, title), input, value) };
  }

  /** @param {number[] | null} weights */
  function weigh(weights) {
    explorer.change({ weights }, "marks");
  }

  /** Request the design selected by the weights, unless already requested. */
  function ask() {
    clearTimeout(timer);
    const { weights } = chosen;
    if (!weights || weights.every((weight) => weight === 0)) {
      pendingQuestion = "";
      if (explorer.picked !== null) {
        explorer.picked = null;
        explorer.update("marks");
      }
      picked.textContent = weights ? "Set at least one weight." : "";
      return;
    }
    const topsis = data.objectives
      .map(({ quantity }, index) => `${quantity}=${weights[index]}`)
      .join(", ");
    const where = explorer.limits.conditions();
    const question = JSON.stringify([topsis, where]);
    if (question === pendingQuestion) return;
    timer = setTimeout(async () => {
      pendingQuestion = question;
      try {
        const { number } = await get(
          `jobs/${explorer.job.id}/pick`,
          { topsis, where },
          explorer.signal,
        );
        if (pendingQuestion !== question) return;
        explorer.picked = number - 1;
        fill(
          picked,
          "These weights choose ",
          h("a", { href: explorer.hrefOf(number - 1) }, `design ${number}`),
          ".",
        );
      } catch (problem) {
        if (pendingQuestion !== question || isAbort(problem)) return;
        explorer.picked = null;
        if (statusOf(problem) === 404) picked.textContent = "No design is within all limits.";
        else sayProblem(problem);
      }
      explorer.update("marks");
    }, PAUSE);
  }

  /** Return the thumbnail of a design; that of a lever is drawn once the service has returned its position. @param {number} row */
  function thumbnail(row) {
    const { linkages } = explorer;
    if (!front.extent_mm) return smallLinkage(linkages.of(row), linkages.frame());
    const picture = h("span", {});
    linkages
      .cycle(row)
      .then((cycle) =>
        picture.replaceWith(
          smallLinkage(linkages.of(row), linkages.frame(), cycle?.outlines.lever),
        ),
      );
    return picture;
  }

  /** @param {number} row @param {string} name */
  function item(row, name) {
    const of = data.objectives
      .map(({ column, title, unit }) => `${title} ${withUnit(data.cell(column, row), unit, 4)}`)
      .join(" · ");
    return h(
      "li",
      { onpointerenter: () => explorer.point(row), onpointerleave: () => explorer.point(null) },
      thumbnail(row),
      h(
        "div",
        {},
        h(
          "a",
          {
            href: explorer.hrefOf(row),
            onfocus: () => explorer.focus(row),
            onblur: () => explorer.focus(null),
          },
          `Design ${row + 1}`,
        ),
        ` ${name}`,
        h("div", { class: "quiet" }, of),
      ),
    );
  }

  /** Show the trade-offs at the knee in display units; in stored units they are already known. */
  async function drawCosts() {
    if (!front.trade_offs.length || front.knee === null) return;
    const units = apiSystem();
    const asked =
      units &&
      get(
        `jobs/${explorer.job.id}/designs/${front.knee + 1}/trade-offs`,
        { units },
        explorer.signal,
      );
    const sentences = asked ? (await asked).trade_offs : front.trade_offs;
    if (units === apiSystem())
      fill(
        costs,
        sentences.map((sentence) => h("li", {}, withUnitSigns(sentence))),
      );
  }

  /** @param {string} what */
  async function draw(what) {
    sliders.forEach(({ input, value }, index) => {
      input.value = String(chosen.weights?.[index] ?? 1);
      value.textContent = chosen.weights ? String(chosen.weights[index]) : "–";
    });
    off.hidden = !chosen.weights;
    ask();
    if (what !== "all") return;
    fill(
      beyondAllowed,
      front.violations.map((sentence) =>
        h("p", { class: "error" }, `Beyond the allowable value: ${inDisplayUnits(sentence)}.`),
      ),
    );
    drawCosts().catch((problem) => !isAbort(problem) && sayProblem(problem));
    await data.need(data.objectives.map(({ column }) => column)).catch(sayProblem);
    fill(
      list,
      [...namesOf(explorer)].map(([row, names]) => item(row, names.join(", "))),
    );
  }
  return { place, draw };
}
