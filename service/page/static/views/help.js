/** View of the help: how the search works, and every quantity with a sentence, a picture, its formula and its source. */

import { formula, symbolsOf } from "../help/formula.js";
import { picture } from "../help/picture.js";
import { keepChoices } from "../lib/address.js";
import { get } from "../lib/api.js";
import { fill, h } from "../lib/dom.js";
import { unitOf } from "../lib/numbers.js";

export const title = "Help";

/** @type {[string, string, string | null, string | null][]} */
const STEPS = [
  [
    "Ask",
    "State what the machine must do: speed, stroke, loads, ranges of the dimensions, and the objectives. Start from an example if one is similar.",
    "#/new",
    "New run",
  ],
  [
    "Watch",
    "The search needs no help. Its front of best compromises grows as you watch; you can stop it and resume later.",
    "#/",
    "Runs",
  ],
  [
    "Explore",
    "Narrow the front down to acceptable designs and inspect them: how they move, what they need, and what an improvement costs. Say what should improve: a new search finds the nearest optimal design.",
    null,
    null,
  ],
  [
    "Decide",
    "Round the lengths of a design, compare it with others, and choose it with a reason. Export a drawing for CAD, its numbers, the motion, and a report for the review.",
    null,
    null,
  ],
];
/** Terms of docs/glossary.md that the page uses. */
const TERMS = [
  [
    "dead centre",
    "slider position at which the motion reverses, because crank and rod are in line: outer (stretched) or inner (folded)",
  ],
  ["quick return", "a time ratio above 1: the machine works slowly and returns quickly"],
  ["requirement, constraint", "a quantity that must stay within bounds, or equal a value"],
  [
    "front, Pareto front",
    "the feasible designs that no other design dominates; better in one objective then means worse in another",
  ],
  [
    "knee",
    "the design on the front nearest to the ideal point, with objectives scaled to their ranges",
  ],
  [
    "ideal point",
    "the best value of each objective, all together; no single design reaches it unless the objectives agree",
  ],
  ["trade-off rate", "the cost in other objectives of an improvement in one, to first order"],
  ["active constraint", "a bound that a design lies on"],
  [
    "aspiration level, wish",
    "a value that you would like an objective to reach; it is not a bound. The search finds the optimal design nearest to all of them",
  ],
  [
    "rounding, allowed deviation",
    "the best designs with round numbers near a design; the amount by which they may miss a requirement",
  ],
  [
    "comparison of runs",
    "which front is better, what a change of the job costs, and which designs the other run lacks",
  ],
  [
    "bookmark, decision",
    "a design that people save, with a note; the design that they choose, with the reason",
  ],
  [
    "hypervolume",
    "volume in the space of the objectives that a front dominates; it grows as the front improves",
  ],
  ["certificate", "a proven bound on what any other design could gain over the front"],
];
const DOCUMENTS = [
  ["docs/page.md", "this page: fronts, wishes, rounding, decisions, comparison"],
  [
    "docs/jobs.md",
    "job files beyond the basics: friction, motors, choices, desired motions, robust designs",
  ],
  ["docs/glossary.md", "the terms of machine, problem, search and program, with a sketch"],
  ["docs/theory.md", "every equation, derived, with its source"],
  ["docs/optimisers.md", "how the search works, and when another method helps"],
  ["docs/own-quantities.md", "custom quantities as Python functions"],
  ["docs/service.md", "running the service"],
  ["docs/api.md", "the API that this page uses"],
];

/** Show one quantity, or all with a field to search. @param {HTMLElement} place @param {Page.Visit} options */
export async function show(place, { parts, query, signal }) {
  const { quantities } = await get("quantities", {}, signal);
  const name = parts[1];
  if (!name) return overview(place, quantities, query.get("search") ?? "");
  const quantity = quantities.find((one) => one.name === name || one.column === name);
  if (!quantity) throw new Error(`No quantity is called "${name}"; the help lists them all.`);
  document.title = `${quantity.title} · slidercrank`;
  one(place, quantity, quantities);
}

/** @param {HTMLElement} place @param {Api.Quantity[]} quantities @param {string} sought */
function overview(place, quantities, sought) {
  const list = h("ul", { class: "quantities" });
  const terms = h("dl", { class: "terms" });
  const none = h("p", { class: "quiet", role: "status" });
  const search = h("input", {
    type: "search",
    id: "help-search",
    value: sought,
    autocomplete: "off",
    placeholder: "torque, error, stroke …",
    oninput: () => {
      draw();
      keepChoices({ search: search.value });
    },
  });
  const draw = () => {
    const words = search.value.toLowerCase().split(/\s+/).filter(Boolean);
    /** @param {string[]} parts */
    const isMatch = (parts) => {
      const all = parts.join(" ").toLowerCase();
      return words.every((word) => all.includes(word));
    };
    const matchingTerms = TERMS.filter(isMatch);
    fill(
      terms,
      matchingTerms.map(([term, meaning]) => [h("dt", {}, term), h("dd", {}, meaning)]),
    );
    const matches = quantities.filter(({ title: heading, name, column, sentence, advice }) =>
      isMatch([heading, name, column, sentence, advice]),
    );
    fill(
      list,
      [...new Set(matches.map(({ group }) => group))].map((group) => [
        h("li", { class: "group" }, h("h3", {}, group)),
        matches.filter((one) => one.group === group).map(card),
      ]),
    );
    none.textContent =
      matches.length || matchingTerms.length
        ? `${matches.length} of ${quantities.length} quantities, ${matchingTerms.length} of ${TERMS.length} terms`
        : "Nothing matches these words.";
  };
  fill(
    place,
    h(
      "div",
      { class: "help" },
      h("h1", {}, title),
      h(
        "section",
        { "aria-labelledby": "how" },
        h("h2", { id: "how" }, "How it works"),
        h(
          "ol",
          { class: "steps" },
          STEPS.map(([verb, sentence, href, link]) =>
            h(
              "li",
              { class: "panel" },
              h("h3", {}, verb),
              h("p", {}, sentence),
              href ? h("p", {}, h("a", { href }, link)) : null,
            ),
          ),
        ),
        h(
          "p",
          {},
          "To see how a single mechanism moves, without a search: ",
          h("a", { href: "#/look" }, "Look at one mechanism"),
          ".",
        ),
      ),
      h(
        "section",
        { "aria-labelledby": "all" },
        h("h2", { id: "all" }, "Terms and quantities"),
        h("p", { class: "row" }, h("label", { for: "help-search" }, "Search"), search, none),
        terms,
        list,
      ),
      h(
        "section",
        { "aria-labelledby": "more" },
        h("h2", { id: "more" }, "The documentation"),
        h("p", {}, "These files come with the software:"),
        h(
          "ul",
          {},
          DOCUMENTS.map(([file, what]) => h("li", {}, h("code", {}, file), ` – ${what}`)),
          h(
            "li",
            {},
            h("a", { href: "api/v1/docs" }, "API reference"),
            " – describes every request and lets you try it on this service",
          ),
        ),
      ),
    ),
  );
  draw();
}

/** @param {Api.Quantity} quantity */
function card(quantity) {
  return h(
    "li",
    { class: "panel" },
    picture(quantity.picture, quantity.title),
    h(
      "div",
      {},
      h("h4", {}, h("a", { href: `#/help/${quantity.name}` }, quantity.title)),
      h("p", {}, quantity.sentence),
    ),
  );
}

/** @param {HTMLElement} place @param {Api.Quantity} quantity @param {Api.Quantity[]} quantities */
function one(place, quantity, quantities) {
  const unit = unitOf(quantity.unit);
  /** @param {string} term @param {Dom.Child} text */
  const row = (term, text) => [h("dt", {}, term), h("dd", {}, text)];
  const symbols = symbolsOf(quantity.formula, quantities);
  const alike = quantities.filter(
    (other) => other.picture === quantity.picture && other.name !== quantity.name,
  );
  fill(
    place,
    h(
      "article",
      { class: "help one" },
      h("p", {}, h("a", { href: "#/help" }, "All quantities")),
      h("h1", {}, quantity.title),
      h("div", { class: "panel figure" }, picture(quantity.picture, quantity.title)),
      h("p", { class: "lead" }, quantity.sentence),
      quantity.advice ? h("p", {}, quantity.advice) : null,
      h(
        "dl",
        { class: "terms" },
        row("formula", formula(quantity.formula)),
        symbols.length
          ? row(
              "with",
              symbols.map(([symbol, meaning, name], place) => [
                place ? ", " : "",
                symbol,
                " ",
                name && name !== quantity.name
                  ? h("a", { href: `#/help/${name}` }, meaning)
                  : meaning,
              ]),
            )
          : null,
        row("unit", unit || "none, a ratio"),
        row("in job files", h("code", {}, quantity.name)),
        row("in tables and JSON", h("code", {}, quantity.column)),
        row("derived in", [h("code", {}, "docs/theory.md"), `, section ${quantity.section}`]),
        row("source", quantity.source),
      ),
      alike.length
        ? h(
            "p",
            {},
            "See also ",
            alike.map((other, place) => [
              place ? ", " : "",
              h("a", { href: `#/help/${other.name}` }, other.title),
            ]),
            ".",
          )
        : null,
    ),
  );
}
