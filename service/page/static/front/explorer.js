/** The explorer of a front: parallel coordinates, scatter, table and marks of the same designs, linked. */

import { parallel } from "../charts/parallel.js";
import { scatter } from "../charts/scatter.js";
import { colours } from "../charts/scale.js";
import { keepChoices, link } from "../lib/address.js";
import { h } from "../lib/dom.js";
import { counted, grouped, withUnit } from "../lib/numbers.js";
import { attempt } from "../lib/notices.js";
import { axisFields } from "./axes.js";
import { previousFront } from "./previous_front.js";
import { bindingPanel } from "./active_limits.js";
import { chooser } from "./chooser.js";
import { choicesFrom, leaveOutConstants, queryOf, toggled, neededColumns } from "./choices.js";
import { FrontData } from "./data.js";
import { bookmarksPanel } from "./bookmarks.js";
import { Limits } from "./limits.js";
import { storeOrder } from "./listed_order.js";
import { linkagePanel } from "./linkage_panel.js";
import { linkages } from "./linkages.js";
import { isLogarithmic } from "./logarithmic.js";
import { marksOf, othersOf } from "./chart_marks.js";
import { marksPanel } from "./marks.js";
import { saving } from "./save_button.js";
import { scatterPanel } from "./scatter_panel.js";
import { selectedBar } from "./selected_bar.js";
import { designTable } from "./table.js";
import { wishingPanel } from "./wishing_panel.js";

const OFTEN = 120; // ms between tables while limits are dragged: rows are the slowest to draw
const PAUSE = 300; // ms from the last change until the address is written: browsers limit the rate
const ORDER = ["marks", "table", "chosen", "all"];

/**
 * @import { Axis, Chosen } from "./choices.js"
 * @typedef {"marks" | "table" | "chosen" | "all"} What What a change asks to be drawn, each with those before it.
 */

/**
 * Fill a place with the explorer of a front; the promise resolves when it is drawn. values: columns already loaded. files: place for
 * links to its files. decision: place that names the chosen design.
 * @param {HTMLElement} place
 * @param {{ job: Api.Job, front: Api.Front, values: Api.Columns["values"], query: URLSearchParams, files: HTMLElement, decision: HTMLElement, signal: AbortSignal }} options
 */
export async function explore(place, { job, front, values, query, files, decision, signal }) {
  const data = new FrontData(job.id, front, signal);
  const chosen = choicesFrom(query, front);
  const limits = new Limits(data, chosen.limits, chosen.lasso);
  data.take(values);
  await data.need(neededColumns(chosen, limits));
  leaveOutConstants(chosen, data);
  if (!signal.aborted) new Explorer(place, { job, data, chosen, limits, files, decision, signal });
}

/** State of the explorer and its parts, which report the reader's actions to it. */
export class Explorer {
  /** @type {number | null} */
  pointed = null;
  /** @type {number | null} */
  focused = null;
  /** @type {number | null} */
  picked = null; // by weights
  /** @type {What | null} */
  waiting = null;
  frame = 0;
  width = 0;
  ink = colours();
  tabled = -Infinity; // time of the last drawing of the table, ms
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  settling;
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  tabling;
  /** @type {Awaited<ReturnType<typeof previousFront>>} */
  before = null; // the run that this one was copied from
  count = h("p", { class: "count", role: "status" });
  /** @param {HTMLElement} place @param {{ job: Api.Job, data: FrontData, chosen: Chosen, limits: Limits, files: HTMLElement, decision: HTMLElement, signal: AbortSignal }} options */
  constructor(place, { job, data, chosen, limits, files, decision, signal }) {
    this.decision = decision;
    this.place = place;
    this.job = job;
    this.front = data.front;
    this.signal = signal;
    this.data = data;
    this.chosen = chosen;
    this.limits = limits;
    this.linkages = linkages(data, signal);
    this.clearing = h(
      "button",
      { type: "button", onclick: () => this.clear() },
      "Clear all limits",
    );
    this.saving = saving(this);
    this.fields = axisFields(this);
    this.lines = parallel({
      data,
      limits,
      axes: () => chosen.axes,
      colour: () => chosen.colour,
      marks: () => marksOf(this, "lines"),
      limit: (key, limit) => this.limit(key, limit),
      log: (key) => isLogarithmic(this, key),
      say: (row) => this.said(row),
      point: (row) => this.point(row),
      open: (row) => this.open(row),
      select: (row) => this.select(row),
    });
    this.dots = scatter({
      data,
      limits,
      x: () => chosen.x,
      y: () => chosen.y,
      colour: () => chosen.colour,
      marks: () => marksOf(this, "dots"),
      others: () => othersOf(this).map(({ cells }) => cells),
      log: (key) => isLogarithmic(this, key),
      say: (row) => this.said(row),
      behind: () => (chosen.behind && this.before ? this.before.rows(chosen.x, chosen.y) : []),
      point: (row) => this.point(row),
      open: (row) => this.open(row),
      select: (row) => this.select(row),
      box: (x, y) => {
        this.limits.set(chosen.x, x);
        this.limit(chosen.y, y);
      },
      lasso: (line) => this.surround(line),
    });
    this.scatterPanel = scatterPanel(this, this.dots);
    this.table = designTable(this);
    this.marksPanel = marksPanel(this);
    this.linkagePanel = linkagePanel(this);
    this.selected = selectedBar(this);
    this.kept = bookmarksPanel(this);
    this.wishing = wishingPanel(this);
    const columns = data.columns;
    files.replaceChildren(h("li", {}, this.saving.node), this.kept.file);
    place.replaceChildren(
      h(
        "section",
        { class: "panel all-designs", "aria-labelledby": "lines-title" },
        h(
          "div",
          { class: "row spread" },
          h("h2", { id: "lines-title" }, "All designs"),
          this.count,
          h(
            "div",
            { class: "row" },
            this.clearing,
            chooser(
              "Axes",
              columns,
              () => chosen.axes.map(({ key }) => key),
              (keys) => this.chooseAxes(keys),
            ),
          ),
        ),
        h(
          "p",
          { class: "quiet hint" },
          "Drag along an axis to set limits; double-click to clear them. Click the name of an axis for a menu with fields for the same limits.",
        ),
        h(
          "div",
          { class: "scroll lines" },
          h("div", { class: "lines-inner" }, this.fields.node, this.lines.place),
        ),
      ),
      this.scatterPanel.place,
      h(
        "section",
        { class: "panel the-table", "aria-labelledby": "table-title" },
        h(
          "div",
          { class: "row spread" },
          h("h2", { id: "table-title" }, "Designs"),
          this.selected.place,
          chooser(
            "Columns",
            columns,
            () => chosen.columns,
            (keys) => this.change({ columns: keys.length ? keys : chosen.columns }, "table"),
          ),
        ),
        this.table.place,
      ),
      this.kept.place,
      bindingPanel(this),
      this.wishing.place,
      h("div", { class: "at-side" }, this.linkagePanel.place, this.marksPanel.place),
    );
    const again = () => this.update("all");
    place.addEventListener(
      "click",
      ({ target }) => target instanceof Element && target.closest("a") && this.keepAddress(),
    );
    const sizes = new ResizeObserver(() => this.width !== place.clientWidth && again());
    sizes.observe(place);
    this.signal.addEventListener("abort", () => {
      sizes.disconnect();
      this.linkagePanel.close();
      storeOrder(job.id, limits.open && !chosen.sort ? null : this.table.numbers());
      clearTimeout(this.settling);
      clearTimeout(this.tabling);
      cancelAnimationFrame(this.frame);
    });
    window.addEventListener("scheme", again, { signal: this.signal });
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", again, {
      signal: this.signal,
    });
    this.draw("all");
    const { origin } = job;
    if (origin) attempt(() => this.drawPreviousFront(origin));
  }

  /** Show the previous run's front once it is loaded. @param {number} run */
  async drawPreviousFront(run) {
    this.before = await previousFront(run, this.signal);
    await this.before?.need([this.chosen.x, this.chosen.y]);
    this.update("all");
  }

  /**
   * Adopt choices and redraw what they affect: "marks", "table", "chosen" (designs) or "all".
   * @param {Partial<Chosen>} choices @param {What} what
   */
  async change(choices, what) {
    Object.assign(this.chosen, choices);
    await attempt(async () => {
      await Promise.all([
        this.data.need(neededColumns(this.chosen, this.limits)),
        this.before?.need([this.chosen.x, this.chosen.y]),
      ]);
      this.update(what);
    });
  }

  /** Set a limit; null removes it. @param {string} key @param {Page.Limit | null} limit */
  limit(key, limit) {
    this.limits.set(key, limit);
    this.chosen.page = 1;
    if (this.data.has(key)) this.update("chosen");
    else this.change({}, "chosen");
  }

  /** Keep the designs within a line [[x, y], ...] in the scatter plot; null removes it. @param {Page.Point[] | null} line */
  surround(line) {
    this.limits.lasso = line && { x: this.chosen.x, y: this.chosen.y, line };
    this.chosen.page = 1;
    this.update("chosen");
  }

  clear() {
    this.limits.clear();
    this.change({ page: 1 }, "chosen");
    this.update("marks"); // a line around designs is drawn with them
  }

  /** Draw in the next frame; several changes within a frame are drawn once. @param {What} what */
  update(what) {
    if (!this.waiting || ORDER.indexOf(what) > ORDER.indexOf(this.waiting)) this.waiting = what;
    if (this.frame || this.signal.aborted) return;
    this.frame = requestAnimationFrame(() => {
      const { waiting } = this;
      this.frame = 0;
      this.waiting = null;
      if (waiting) this.draw(waiting);
      clearTimeout(this.settling);
      this.settling = setTimeout(() => this.keepAddress(), PAUSE);
    });
  }

  /** Write the choices into the address, so that the browser's Back button returns here. */
  keepAddress() {
    clearTimeout(this.settling);
    keepChoices(queryOf(this.chosen, this.limits.lasso));
  }

  /** @param {What} what */
  draw(what) {
    if (what === "all" || what === "chosen") {
      this.limits.apply();
      const { chosen } = this.limits;
      this.count.textContent = `${grouped(chosen)} of ${counted(this.data.count, "design")} listed`;
      this.clearing.disabled = this.limits.open;
      this.saving.draw();
      this.scatterPanel.together.draw();
    }
    if (what === "all") {
      this.width = this.place.clientWidth;
      this.ink = colours();
      this.fields.draw();
      this.scatterPanel.draw();
    } else if (what === "chosen") this.fields.limits();
    if (what !== "table") this.dots.draw(what);
    if (what === "all") this.scatterPanel.legend();
    if (what !== "table") this.lines.draw(what); // after the panel beside it, whose height it fills
    if (what === "marks") this.table.mark();
    else this.drawTable(what === "chosen");
    this.marksPanel.draw(what);
    this.linkagePanel.draw(what);
    this.kept.draw();
    this.selected.draw();
  }

  /** Draw the table; if it may wait, after the current frame, and at most once per interval. @param {boolean} waits */
  drawTable(waits) {
    clearTimeout(this.tabling);
    if (waits) {
      this.tabling = setTimeout(
        () => this.drawTable(false),
        OFTEN - (performance.now() - this.tabled),
      );
      return;
    }
    this.tabled = performance.now();
    this.table.draw();
  }

  /** Highlight a design; null: the one with the focus, if any. @param {number | null} row */
  point(row) {
    const pointed = row ?? this.focused;
    if (pointed === this.pointed) return;
    this.pointed = pointed;
    this.update("marks");
  }

  /** Record which design has the focus, and highlight it. @param {number | null} row */
  focus(row) {
    this.focused = row;
    this.point(row);
  }

  /** @param {number} row */
  open(row) {
    this.keepAddress();
    location.hash = this.hrefOf(row);
  }

  /** Return the link of a design, beside the selected ones if it is one of them. @param {number} row */
  hrefOf(row) {
    return link(["jobs", this.job.id, "designs", row + 1]);
  }

  /** @param {number} row */
  select(row) {
    this.chosen.selected = toggled(this.chosen.selected, row + 1);
    this.update("marks");
  }

  /** @param {string} key */
  sortBy(key) {
    const { sort, reverse } = this.chosen;
    const best = this.data.sense(key) === "maximise";
    this.change({ sort: key, reverse: sort === key ? !reverse : best, page: 1 }, "table");
  }

  /** @param {Axis[]} axes */
  setAxes(axes) {
    this.change({ axes }, "all");
  }

  /** @param {string[]} keys */
  chooseAxes(keys) {
    if (!keys.length) return;
    const { axes } = this.chosen;
    this.setAxes(
      keys.map((key) => axes.find((axis) => axis.key === key) ?? { key, flipped: false }),
    );
  }

  /** Return a design in words, with its objectives. @param {number} row */
  said(row) {
    const { data } = this;
    return `Design ${row + 1}: ${data.objectives.map(({ column, title, unit }) => `${title} ${withUnit(data.has(column) ? data.cell(column, row) : null, unit, 4)}`).join(", ")}`;
  }

  /** @param {number} index @param {number} by */
  moveAxis(index, by) {
    const axes = [...this.chosen.axes];
    axes.splice(index + by, 0, ...axes.splice(index, 1));
    this.setAxes(axes);
  }

  /** @param {number} index */
  flipAxis(index) {
    this.setAxes(
      this.chosen.axes.map((axis, other) =>
        other === index ? { ...axis, flipped: !axis.flipped } : axis,
      ),
    );
  }
}
