/** Choice by wishes: a class or a value for each objective, and the nearest optimal design, found by a new search. */

import { link, read } from "../lib/address.js";
import { get, isAbort, post } from "../lib/api.js";
import { fill, first, formOf, h, markInvalid, numberField } from "../lib/dom.js";
import { attempt } from "../lib/notices.js";
import { parseQuantity } from "../lib/quantity_text.js";
import { ends, inDisplayUnit, unitOf, withUnit } from "../lib/numbers.js";
import { bookmarkForm } from "../design/bookmark_form.js";
import { lengthsOf } from "../design/loading.js";
import { LENGTHS } from "./linkages.js";
import {
  wishRequest,
  nearest,
  locationOfRefusal,
  refersToDesign,
  wishesOf,
  mistakesIn,
} from "./wishes.js";
import { sentenceOf } from "../lib/refusals.js";
import { capitalised } from "../lib/words.js";
import { headedRow, headsOf, numberCell, scrolledTable } from "../lib/table.js";

/** @import { Explorer } from "./explorer.js" */
/** @import { Kind, Problem, Wish, Wishes } from "./wishes.js" */

/** @type {[Kind, string][]} */
const KINDS = [
  ["free", "is free"],
  ["value", "should reach"],
  ["improve", "improves"],
  ["keep", "keeps"],
  ["limit", "may worsen to"],
];
const SAME = 1e-9; // relative tolerance of rounding

/** Return {place, cells()} for wishes on the front of an explorer. @param {Explorer} explorer */
export function wishingPanel(explorer) {
  const { data, chosen, job } = explorer;
  const { objectives } = data;
  const shown = read().query.get("show") === "wishing"; // a link leads here
  const rows = objectives.map(row);
  const design = h("input", {
    type: "text",
    inputmode: "numeric",
    id: "wish-design",
    class: "number",
    "aria-describedby": "wish-design-wrong",
    oninput: clean,
  });
  const wrongDesign = h("p", { class: "error", id: "wish-design-wrong" });
  const from = h(
    "div",
    { class: "wish-from" },
    h("label", { for: "wish-design" }, "“Improves” and “keeps” refer to design "),
    design,
    wrongDesign,
  );
  const solve = h("button", { class: "primary" }, "Solve");
  const none = h("button", { type: "button", onclick: () => take(null) }, "Clear wishes");
  const wrong = h("p", { class: "error", role: "alert" });
  const answer = h("div", { class: "wish-answer", "aria-live": "polite" });
  const before = h("div", { class: "wish-history" });
  const form = formOf(
    submit,
    h(
      "div",
      { class: "wish-rows" },
      rows.map(({ node }) => node),
    ),
    from,
    h("div", { class: "row" }, solve, none),
    wrong,
  );
  const place = h(
    "section",
    { class: "panel wishing", "aria-labelledby": "wishing-title" },
    h("h2", { id: "wishing-title" }, "Choose by wishing"),
    h(
      "p",
      { class: "quiet hint" },
      "State the values you would like. The nearest Pareto-optimal design is computed; it need not be in the list. Desired values are aims, not bounds.",
    ),
    h("div", { class: "wish-columns" }, form, answer),
    before,
  );
  place.hidden = objectives.length < 2 || data.count === 0;
  /** @type {Api.Wished | null} */
  let answered = null;
  let near = 0; // number of the nearest design on the front
  let way = "";
  let turn = 0;
  /** @type {Wishes[]} */
  let earlierWishes = []; // everyone's wishes for the run

  /** @param {Api.Objective} objective */
  function row({ quantity, title, unit, column }) {
    const id = `wish-${quantity}`;
    const kind = h(
      "select",
      {
        id,
        onchange: () => {
          shape();
          clean();
        },
      },
      KINDS.map(([value, words]) => h("option", { value }, words)),
    );
    const value = numberField({
      "aria-label": `Value for ${title}`,
      "aria-describedby": `${id}-wrong`,
      oninput: clean,
    });
    const units = h("span", { class: "quiet" });
    const refused = h("p", { class: "error", id: `${id}-wrong` });
    function shape() {
      const wanted = kind.value === "value" || kind.value === "limit";
      for (const node of [value, units]) node.hidden = !wanted;
      units.textContent = unitOf(unit);
      if (data.has(column)) value.placeholder = ends(data.range(column), unit).join(" to ");
    }
    return {
      quantity,
      value,
      refused,
      shape,
      node: h(
        "div",
        { class: "wish-row" },
        h("label", { for: id }, title),
        kind,
        h("span", { class: "wish-value" }, value, units),
        refused,
      ),
      /** @returns {Wish | null} */
      get() {
        if (kind.value === "free") return null;
        const wanted = /** @type {Kind} */ (kind.value);
        return value.hidden
          ? { kind: wanted }
          : { kind: wanted, value: parseQuantity(value.value, unit).value ?? NaN };
      },
      /** @param {Wish | undefined} wish */
      set(wish) {
        kind.value = wish?.kind ?? "free";
        value.value =
          wish?.value === undefined
            ? ""
            : String(Number(inDisplayUnit(wish.value, unit).toPrecision(10))).replace("-", "−");
        shape();
      },
    };
  }

  /** Return the wishes in the fields. @returns {Wishes} */
  function said() {
    /** @type {[string, Wish][]} */
    const entries = rows.flatMap((one) => {
      const wish = one.get();
      return wish ? [[one.quantity, wish]] : [];
    });
    return {
      of: new Map(entries),
      design: design.value.trim() === "" ? null : Number(design.value),
    };
  }

  /** Show the wishes of the address, or none, in the fields. */
  function showFields() {
    for (const one of rows) one.set(chosen.wish?.of.get(one.quantity));
    design.value = String(
      chosen.wish?.design ?? explorer.chosen.selected[0] ?? (explorer.front.knee ?? 0) + 1,
    );
    clean();
  }

  function clean() {
    showProblems([]);
    from.classList.toggle("wanted", refersToDesign(said()));
  }

  /** Show mistakes at their fields. @param {Problem[]} problems */
  function showProblems(problems) {
    /** @param {string} id */
    const textsAt = (id) =>
      problems
        .filter((one) => one.id === id)
        .map((one) => one.text)
        .join(" ");
    for (const one of [...rows, { quantity: "design", value: design, refused: wrongDesign }]) {
      one.refused.textContent = textsAt(one.quantity);
      markInvalid(one.value, textsAt(one.quantity));
    }
    wrong.textContent = textsAt("");
    rows.find(({ quantity }) => textsAt(quantity))?.value.focus();
  }

  function submit() {
    const wishes = said();
    const problems = mistakesIn(wishes, objectives, data.count);
    if (problems.length) showProblems(problems);
    else take(wishes);
  }

  /** Adopt wishes, null for none, and request the design. @param {Wishes | null} wishes */
  function take(wishes) {
    explorer.change(
      { wish: wishes && { ...wishes, design: refersToDesign(wishes) ? wishes.design : null } },
      "marks",
    );
    showFields();
    ask();
  }

  async function ask() {
    const { wish } = chosen;
    const request = (turn += 1);
    if (!wish) {
      answered = null;
      return show();
    }
    solve.setAttribute("aria-busy", "true"); // not disabled, since the wishes may have changed in the meantime
    try {
      const reply = await post(`jobs/${job.id}/wish`, wishRequest(wish, objectives), {
        signal: explorer.signal,
      });
      if (request !== turn) return;
      if (reply.design) await locate(reply.design);
      if (request !== turn) return; // withdrawn or changed meanwhile
      answered = reply;
      show();
      askBefore();
    } catch (problem) {
      if (request !== turn || isAbort(problem)) return;
      answered = null;
      show();
      showProblems([
        {
          ...locationOfRefusal(problem instanceof Error ? problem.message : "", objectives),
          text: `${sentenceOf(problem)}.`,
        },
      ]);
    } finally {
      if (request === turn) solve.removeAttribute("aria-busy");
    }
  }

  /** Find the nearest design on the front, and the link to the resulting design if it differs in lengths alone. @param {Api.Row} wished */
  async function locate(wished) {
    await data.need(objectives.map(({ column }) => column));
    near = nearest(wished, objectives, data);
    const path = /** @type {const} */ (`jobs/${job.id}/designs/${near}`);
    const [{ ranges }, { design: other }] = await Promise.all([
      get(`${path}/requirements`, {}, explorer.signal),
      get(path, {}, explorer.signal),
    ]);
    const further = Object.keys(ranges).filter((key) => !LENGTHS.includes(key));
    const choices = Object.keys(wished).filter((key) => key.startsWith("choice_"));
    free = [...LENGTHS, ...further, ...choices];
    way = choices.every((key) => wished[key] === other[key])
      ? link(["jobs", job.id, "designs", near], {
          ...Object.fromEntries(LENGTHS.map((key) => [key, Number(wished[key])])),
          value: further.map((key) => `${key}=${wished[key]}`).join(",") || null,
          as: "Wished",
        })
      : "";
    beside = other;
  }
  /** @type {Api.Row} */
  let beside = {}; // the nearest design
  /** @type {string[]} */
  let free = []; // columns of the dimensions and variables

  function show() {
    drawOutcome();
    drawBefore();
    explorer.update("all");
  }

  function drawOutcome() {
    none.hidden = !chosen.wish;
    if (!answered) return fill(answer);
    const [head] = answered.sentences;
    const sentence = h("p", { class: answered.possible ? "good" : null }, `${capitalised(head)}.`);
    const { design: wished } = answered;
    if (!wished) return fill(answer, h("p", { class: "bad" }, `${sentence.textContent}`));
    const nearby = h("a", { href: explorer.hrefOf(near - 1) }, `design ${near}`);
    const remarks = bookmarkForm({
      job: `${job.id}`,
      design: near,
      dimensions: () => Object.fromEntries(free.map((key) => [key, wished[key] ?? 0])),
      kept: () => explorer.kept?.ask(),
      lengths: () => lengthsOf(wished),
    });
    remarks.show({
      number: null,
      title: `Wished, near design ${near}`,
      faults: [],
      deviations: [],
    });
    fill(
      answer,
      sentence,
      outcomes(answered, nearby),
      h(
        "div",
        { class: "row" },
        way
          ? h("a", { class: "button", href: way }, "Open the resulting design")
          : h("span", { class: "quiet" }, "It has another choice; all values are shown."),
        remarks.node,
      ),
      h(
        "details",
        { open: !way },
        h("summary", {}, "All of its numbers"),
        numbers(answered, wished),
      ),
    );
  }

  /** @param {Api.Wished} wished @param {Node} nearby */
  function outcomes(wished, nearby) {
    const lines = wished.objectives.map((one) => {
      const objective = objectives.find(({ quantity }) => quantity === one.quantity);
      const value = objective && Number(beside[objective.column]);
      const words = {
        free: "free",
        improve: `better than ${withUnit(one.before, one.unit, 4)}`,
        keep: `as ${withUnit(one.before, one.unit, 4)}`,
        value: withUnit(one.wished, one.unit, 4),
        limit: `to ${withUnit(one.wished, one.unit, 4)}`,
      }[one.wish];
      return headedRow(
        one.title,
        h("td", { class: "number quiet" }, words),
        numberCell(one.quantity, one.reached, withUnit(one.reached, one.unit)),
        h(
          "td",
          { class: "number" },
          one.wish === "free"
            ? null
            : h(
                "span",
                { class: one.met ? "good" : "at-limit" },
                one.met
                  ? "✓ met"
                  : `${objective?.sense === "maximise" ? "short" : "over"} by ${withUnit(one.short, one.unit, 3)}`,
              ),
        ),
        h(
          "td",
          { class: "number quiet" },
          value === undefined ? "" : signed(one.reached, value, one.unit),
        ),
      );
    });
    const unseen = h("span", { class: "hidden" }, "met");
    return scrolledTable(
      "Desired and achieved values",
      headsOf(
        ["Objective", "desired", "reached", unseen, ["against ", nearby]],
        (n) => n && n !== 3,
      ),
      lines,
    );
  }

  /** @param {Api.Wished} options @param {Api.Row} wished */
  function numbers({ columns }, wished) {
    const listedColumns = columns.filter(({ key }) => !key.startsWith("slack_"));
    return scrolledTable(
      "All values of the resulting design",
      headsOf(["Quantity", "resulting design", `design ${near}`], (n) => n),
      listedColumns.map(({ key, title, unit }) =>
        headedRow(
          title,
          numberCell(key, wished[key], withUnit(wished[key], unit)),
          h("td", { class: "number quiet" }, withUnit(beside[key], unit)),
        ),
      ),
    );
  }

  /** Request everyone's wishes for the run. */
  async function askBefore() {
    await attempt(async () => {
      earlierWishes = (await get(`jobs/${job.id}/wishes`, {}, explorer.signal)).made.map(wishesOf);
      drawBefore();
    });
  }

  /** Offer earlier wishes. */
  function drawBefore() {
    const open = first(before, "details")?.hasAttribute("open");
    const items = earlierWishes.map((wishes) =>
      h(
        "li",
        {},
        h(
          "button",
          { type: "button", class: "linked", onclick: () => take(wishes) },
          inWords(wishes),
        ),
      ),
    );
    fill(
      before,
      items.length > 0 &&
        h(
          "details",
          { open },
          h("summary", {}, `Wishes so far (${items.length})`),
          h("p", { class: "quiet hint" }, "From everyone with access, newest first."),
          h("ol", {}, items),
        ),
    );
  }

  /** @param {Wishes} wishes */
  function inWords(wishes) {
    const parts = objectives.flatMap(({ quantity, title, unit }) => {
      const wish = wishes.of.get(quantity);
      if (!wish) return [];
      const value = withUnit(wish.value ?? null, unit, 5);
      return [
        `${title} ${{ value, limit: `may worsen to ${value}`, improve: "improves", keep: "keeps", free: "" }[wish.kind]}`,
      ];
    });
    return `${parts.join(", ")}${wishes.design ? `, from design ${wishes.design}` : ""}`;
  }

  showFields();
  drawOutcome();
  if (chosen.wish) ask().then(() => shown && place.scrollIntoView());
  else if (!place.hidden) askBefore();
  return { place, cells: () => answered?.design ?? null };
}

/**
 * Return the signed difference between two values as text, or "=" if they are equal within rounding.
 * @param {number} value @param {number} other @param {string} unit
 */
function signed(value, other, unit) {
  const by = value - other;
  return Math.abs(by) <= SAME * Math.abs(other)
    ? "="
    : `${by > 0 ? "+" : ""}${withUnit(by, unit, 3)}`;
}
