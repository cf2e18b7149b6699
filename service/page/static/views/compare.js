import { points, legendSymbol } from "../charts/points.js";
import { FrontData } from "../front/data.js";
import { badge } from "../jobs/states.js";
import { go, keepChoices, link } from "../lib/address.js";
import { get, isAbort, statusOf } from "../lib/api.js";
import { blocks } from "../lib/blocks.js";
import { fill, h } from "../lib/dom.js";
import { apiSystem, grouped, text, withUnit } from "../lib/numbers.js";
import { headed, helpLink } from "../front/columns.js";
import { attempt } from "../lib/notices.js";
import { sentenceOf } from "../lib/refusals.js";
import { headedRow, numberCell, table as tableOf } from "../lib/table.js";

export const title = "Compare runs";

const MOST = 6;
const MOST_DESIGNS = 300; // maximum number of designs per run in the picture

/** View of several runs: their fronts in one picture, and their best values side by side. @param {HTMLElement} place @param {Page.Visit} options */
export async function show(place, { query, signal }) {
  const numbers = [...new Set((query.get("jobs") ?? "").split(",").map(Number))].filter(
    (number) => Number.isInteger(number) && number > 0,
  );
  if (numbers.length < 2)
    throw new Error("A comparison needs two or more runs; tick them in the list.");
  /** @type {string[]} */
  const missing = [];
  const runs = (
    await Promise.all(
      numbers.slice(0, MOST).map(async (number) => {
        try {
          const [job, front] = await Promise.all([
            get(`jobs/${number}`, {}, signal),
            get(`jobs/${number}/front`, {}, signal),
          ]);
          if (front.count) return [{ job, front, data: new FrontData(number, front, signal) }];
          missing.push(`Run ${number} has no designs.`);
        } catch (problem) {
          if (isAbort(problem)) throw problem;
          missing.push(
            statusOf(problem) === 404 ? `Run ${number} no longer exists.` : sentenceOf(problem),
          );
        }
        return [];
      }),
    )
  ).flat();
  if (numbers.length > MOST) missing.push(`At most ${MOST} runs can be compared at once.`);

  const objectives = new Map(
    runs.flatMap(({ front }) => front.objectives.map((objective) => [objective.column, objective])),
  );
  const shared = runs.length
    ? [...objectives.keys()].filter((key) => runs.every(({ data }) => data.knows(key)))
    : [];
  /** @type {{ x: string, y: string }} */
  const axes = { x: chosen("x", shared[0]), y: chosen("y", shared[1]) };
  const picture = h("div");
  const readout = h("p", { class: "quiet readout" });
  const words = h("div");
  const table = h("div", { class: "scroll" });

  /** Return the quantity named by the address for an axis, if the runs share it. @type {(name: string, otherwise: string) => string} */
  function chosen(name, otherwise) {
    const requestedKey = query.get(name);
    return requestedKey !== null && shared.includes(requestedKey) ? requestedKey : otherwise;
  }

  /** Return an objective of the runs. @type {(key: string) => Api.Objective} */
  function known(key) {
    return /** @type {Api.Objective} */ (objectives.get(key));
  }

  function drawPicture() {
    const [x, y] = [axes.x, axes.y].map(known);
    const drawnRows = runs.map(({ data }) => spread(data.count));
    const series = runs.map(({ data, job }, n) => ({
      name: job.name,
      points: drawnRows[n].map((row) => [data.cell(axes.x, row), data.cell(axes.y, row)]),
    }));
    fill(
      picture,
      points(series, x, y, `The fronts of ${runs.length} runs`, null, {
        at: (n, place) => showComparison(n === null ? null : { n, row: drawnRows[n][place] }),
        open: (n, place) => go(["jobs", runs[n].job.id, "designs", drawnRows[n][place] + 1]),
      }),
    );
    showComparison(null);
  }

  /** Describe the design under the pointer. @param {{ n: number, row: number } | null} one */
  function showComparison(one) {
    if (!one) return fill(readout, "Point at a design to see its values; click to open it.");
    const { job, data } = runs[one.n];
    fill(
      readout,
      h("strong", {}, `Run ${job.id}, design ${one.row + 1}`),
      ` ${[...objectives.keys()]
        .filter((key) => data.has(key))
        .map(
          (key) => `${known(key).title} ${withUnit(data.cell(key, one.row), known(key).unit, 4)}`,
        )
        .join(" · ")}`,
    );
  }

  function drawTable() {
    /** Return the best design in one of the run's objectives; null if it has another. @param {(typeof runs)[0]} run @param {string} key */
    const bestDesign = ({ front }, key) => {
      const objective = front.objectives.find((objective) => objective.column === key);
      return objective ? front.extremes[objective.quantity] : null;
    };
    /** @param {string} key @param {string} sense @param {number | null | undefined} target @returns {Api.Row[string][]} */
    const bestValues = (key, sense, target) =>
      runs.map(({ front, data }) => {
        const objective = front.objectives.find((objective) => objective.column === key);
        if (objective) return data.cell(key, front.extremes[objective.quantity]);
        const { low, high } = data.range(key);
        return target === undefined ? (sense === "maximise" ? high : low) : null;
      });
    const rows = [...objectives.values()]
      .filter(({ column }) => runs.every(({ data }) => data.knows(column)))
      .map(({ column, sense, target }) => {
        const values = bestValues(column, sense, target);
        /** @param {Api.Row[string]} value */
        const rank = (value) =>
          typeof value !== "number"
            ? Infinity
            : target !== undefined && target !== null
              ? Math.abs(value - target)
              : sense === "maximise"
                ? -value
                : value;
        const { unit } = known(column);
        const [best] = [...values].sort((one, other) => rank(one) - rank(other));
        /** Whether a value equals the best one as displayed. @param {Api.Row[string]} value */
        const isBest = (value) => text(value, unit, 5) === text(best, unit, 5);
        return h(
          "tr",
          {},
          h(
            "th",
            { scope: "row" },
            h("a", { href: helpLink(column) }, `best ${headed(known(column))}`),
          ),
          values.map((value, n) =>
            numberCell(
              column,
              value,
              toDesign(runs[n].job.id, bestDesign(runs[n], column), text(value, unit, 5)),
              isBest(value) && !values.every(isBest)
                ? h("strong", { class: "best", title: "best of these runs" }, " ✓")
                : null,
            ),
          ),
        );
      });
    /** @param {string} name @param {(run: (typeof runs)[0]) => Dom.Child} value */
    const plain = (name, value) =>
      headedRow(
        name,
        runs.map((run) => h("td", { class: "number" }, value(run))),
      );
    fill(
      table,
      tableOf(
        "Runs side by side",
        [
          h("td", {}),
          runs.map(({ job }, index) =>
            h(
              "th",
              { scope: "col", class: "number" },
              legendSymbol(index),
              " ",
              h("a", { href: link(["jobs", job.id]) }, job.name),
              h("div", { class: "quiet" }, `run ${job.id}`),
            ),
          ),
        ],
        [
          plain("state", ({ job }) => badge(job)),
          plain("decision", ({ job }) => job.decision ?? "none"),
          rows,
          plain("designs", ({ front }) => grouped(front.count)),
          plain("evaluated", ({ front }) => grouped(front.evaluations)),
          plain("time", ({ front }) => withUnit(front.seconds, "s", 3)),
          plain("seed", ({ front }) => String(front.seed)),
        ],
      ),
    );
  }

  /**
   * Return words as a link to a design, counted from 0; plain text without a design.
   * @param {number} job @param {number | null} row @param {string} words
   */
  function toDesign(job, row, words) {
    return row === null ? words : h("a", { href: link(["jobs", job, "designs", row + 1]) }, words);
  }

  /** Show which run is better where, and the differences between the jobs. */
  async function drawWords() {
    const query = { job: runs.map(({ job }) => String(job.id)), units: apiSystem() };
    await attempt(
      async () => {
        const nodes = blocks((await get("comparison", query, signal)).blocks, title);
        const start = nodes.findIndex((node) => node.matches(".hint"));
        const end = nodes.findLastIndex((node) => node.matches("h3"));
        const measures = start < 0 ? [] : nodes.splice(start, end - start);
        fill(
          words,
          nodes,
          measures.length > 0 &&
            h("details", {}, h("summary", {}, "Measures of the fronts"), measures),
        );
      },
      (problem) => fill(words, h("p", { class: "error" }, sentenceOf(problem))),
    );
  }

  /** @param {string} label @param {"x" | "y"} name */
  const pick = (label, name) =>
    h(
      "label",
      {},
      `${label} `,
      h(
        "select",
        {
          name,
          onchange: (event) => {
            axes[name] = event.currentTarget.value;
            keepChoices({ jobs: numbers.join(","), ...axes });
            drawPicture();
          },
        },
        shared.map((key) =>
          h("option", { value: key, selected: key === axes[name] }, known(key).title),
        ),
      ),
    );

  await Promise.all(
    runs.map(({ data }) => data.need([...objectives.keys()].filter((key) => data.knows(key)))),
  );
  if (signal.aborted) return;
  fill(
    place,
    h("h1", {}, title),
    missing.map((sentence) => h("p", { class: "error" }, sentence)),
    runs.length < 2
      ? h("p", {}, h("a", { class: "button", href: "#/" }, "All runs"))
      : h(
          "div",
          { class: "columns compare" },
          h(
            "section",
            { class: "panel", "aria-labelledby": "fronts-title" },
            h("h2", { id: "fronts-title" }, "Fronts"),
            shared.length > 1
              ? [
                  h("div", { class: "row picks" }, pick("Across", "x"), pick("Up", "y")),
                  picture,
                  readout,
                  h(
                    "div",
                    { class: "legend" },
                    runs.map(({ job }, index) =>
                      h("span", {}, legendSymbol(index), ` ${job.name} (run ${job.id})`),
                    ),
                  ),
                ]
              : h(
                  "p",
                  {},
                  "These runs share fewer than two objectives, so their fronts cannot be drawn together.",
                ),
          ),
          h(
            "section",
            { class: "panel", "aria-labelledby": "best-title" },
            h("h2", { id: "best-title" }, "Side by side"),
            table,
          ),
          h(
            "section",
            { class: "panel", "aria-labelledby": "words-title" },
            h("h2", { id: "words-title" }, "Where each run is better"),
            words,
          ),
        ),
  );
  if (runs.length < 2) return;
  if (shared.length > 1) drawPicture();
  drawTable();
  await drawWords();
}

/** Return at most `SHOWN` rows, evenly spread. @param {number} count */
function spread(count) {
  const number = Math.min(count, MOST_DESIGNS);
  return Array.from({ length: number }, (_, index) =>
    Math.floor((index * (count - 1)) / Math.max(1, number - 1)),
  );
}
