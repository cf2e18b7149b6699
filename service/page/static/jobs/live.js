/** Run in progress: its state, its growing front and its log. */

import { history } from "../charts/history.js";
import { points } from "../charts/points.js";
import { growingRange } from "../charts/growing_range.js";
import { columnOf } from "../front/columns.js";
import { get, isAbort, statusOf } from "../lib/api.js";
import { listenToJob } from "../lib/events.js";
import { fill, h } from "../lib/dom.js";
import { counted, grouped, inDisplayUnit, unitOf, withUnit } from "../lib/numbers.js";
import { capitalised, inWords } from "../lib/words.js";
import { growth } from "./growth.js";
import { stages } from "./stages.js";
import { stateWord } from "./states.js";
import { clock, duration } from "./times.js";

const OFTEN = 700; // ms between requests for the front
const AGAIN = 2000; // ms until the next attempt if the service does not respond
const PAST = 1000; // maximum number of past events in the log
const LOG = 200; // lines
const LONG = 10_000; // ms without events in the first rounds before the reason is shown
const STALE = 3; // rounds without events after which the remaining time is unknown
const AT_LEAST = 5000; // minimum of that time, ms

/**
 * Fill a place with a job's progress until it has ended. changed(job): called when its state changes, and with null once the job has been
 * deleted.
 * @param {HTMLElement} place @param {Api.Job} job @param {{ signal: AbortSignal, changed: (job: Api.Job | null) => unknown }} options
 */
export function showProgress(place, job, { signal, changed }) {
  const bar = h("progress", { "aria-label": "Rounds", max: 1, value: 0 });
  const figures = h("dl", { class: "figures" });
  const course = stages();
  const extent = growingRange();
  const lost = h(
    "p",
    { class: "lost", role: "status", hidden: true },
    "The connection to the service was lost. This page continues when the service is back up.",
  );
  const curve = h("div", { class: "course" });
  const front = h("div");
  const near = h(
    "p",
    { class: "quiet", hidden: true },
    "None of these meets every requirement yet: the search moves them until they do.",
  );
  const log = h("ol", { class: "log", reversed: true, tabindex: 0, "aria-label": "What happened" });
  const why = h(
    "p",
    { class: "quiet", hidden: true },
    "The first search after installation compiles the machine model; this happens once and takes a minute or two.",
  );
  /** @type {{ x: number, y: number }} */
  const axes = { x: 0, y: 1 };
  const pickers = h("div", { class: "row picks" });
  /** @type {Api.Progress[]} */
  const rounds = [];
  /** @type {Api.FrontProgress | null} */
  let latest = null;
  /** @type {ReturnType<typeof setTimeout> | null} */
  let timer = null;
  let over = false;
  let asking = false;
  let silent = setTimeout(explain, LONG);
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let stale;
  /** @type {number | null} */
  let left = null; // s
  /** @type {number | null} */
  let drawing = null;

  function rest() {
    for (const pending of [timer, silent, stale]) clearTimeout(pending ?? undefined);
  }

  function explain() {
    why.hidden = over || job.state !== "running" || rounds.length > 2;
  }

  fill(
    place,
    lost,
    h(
      "section",
      { class: "panel", "aria-labelledby": "progress-title" },
      h("h2", { id: "progress-title" }, "Progress"),
      figures,
      bar,
      course.node,
      why,
    ),
    h(
      "section",
      { class: "panel so-far", "aria-labelledby": "so-far-title" },
      h("h2", { id: "so-far-title" }, "Front so far"),
      pickers,
      front,
      near,
    ),
    h(
      "div",
      { class: "growing" },
      h(
        "section",
        { class: "panel", "aria-labelledby": "history-title" },
        h("h2", { id: "history-title" }, "Hypervolume of the front"),
        curve,
      ),
      h(
        "section",
        { class: "panel", "aria-labelledby": "log-title" },
        h("h2", { id: "log-title" }, "Log"),
        log,
      ),
    ),
  );

  /** @param {Api.Event} event */
  function takeEvent(event) {
    if (event.kind === "progress") {
      const data = /** @type {Api.Progress} */ (event.data);
      if (!data.steps) grow(data);
      course.add(data);
      why.hidden = true;
      clearTimeout(silent);
      silent = setTimeout(explain, LONG);
      showState(data);
      soon();
    } else if (event.kind === "state") {
      const { state, reason } = /** @type {Api.Job} */ (event.data);
      note(event.at, `${stateWord(state)}${reason ? `: ${inWords(reason)}` : ""}`);
      if (event.number > job.events || state !== job.state) soon(0);
    } else note(event.at, String(event.data.text));
  }

  /** @param {number} at @param {string} sentence */
  function note(at, sentence) {
    log.prepend(h("li", {}, h("span", { class: "quiet number" }, clock(at)), ` ${sentence}`));
    while (log.children.length > LOG) log.lastElementChild?.remove();
  }

  /** Add the end of a round; a restarted search replaces the one before. @param {Api.Progress} data */
  function grow(data) {
    while (rounds.length && rounds[rounds.length - 1].round >= data.round) rounds.pop();
    rounds.push(data);
    // once for all events replayed together
    drawing ??= requestAnimationFrame(() => {
      drawing = null;
      drawCurve();
    });
  }

  function drawCurve() {
    fill(
      curve,
      history(
        rounds.map(({ round, hypervolume }) => [round, hypervolume]),
        "Hypervolume",
        rounds[rounds.length - 1].rounds,
        curve.clientWidth,
      ),
    );
  }

  /** Show a state; an event within a round keeps the estimate. @param {Api.Progress} data @param {boolean} running */
  function showState(data, running = true) {
    bar.max = data.rounds || 1;
    bar.value = data.round;
    if (!data.steps || data.round === data.rounds) {
      const [before] = rounds.slice(-2, -1);
      const seconds = data.seconds ?? 0;
      const each = before ? seconds - (before.seconds ?? 0) : seconds / data.round;
      clearTimeout(stale);
      left =
        running && data.round > 1 && data.round < data.rounds
          ? each * (data.rounds - data.round)
          : null;
      if (left !== null)
        stale = setTimeout(
          () => {
            left = null;
            showFigures(data);
          },
          Math.max(AT_LEAST, 1000 * STALE * each),
        );
    }
    showFigures(data);
  }

  /** @param {Api.Progress} data */
  function showFigures(data) {
    const gained = growth(rounds.map(({ hypervolume }) => hypervolume));
    const rows = [
      ["round", data.rounds ? `${grouped(data.round)} of ${grouped(data.rounds)}` : "–"],
      ["evaluated", grouped(data.evaluations)],
      ["feasible", grouped(data.feasible)],
      [
        gained && gained.rounds > 1
          ? `gained in the last ${gained.rounds} rounds`
          : "gained in the last round",
        gained?.text ?? "–",
      ],
      ["so far", duration(data.seconds ?? 0)],
      ["time left", left === null ? "not known" : `about ${duration(left)}`],
    ];
    fill(
      figures,
      rows.map(([name, value]) => h("div", {}, h("dt", {}, name), h("dd", {}, value))),
    );
  }

  /** Request the job's front so far and its state soon. @param {number} wait */
  function soon(wait = OFTEN) {
    if (timer !== null) {
      if (wait > 0) return;
      clearTimeout(timer);
    }
    timer = setTimeout(look, wait);
  }

  async function look() {
    timer = null;
    if (over || signal.aborted) return;
    if (asking) return soon(); // a response under way may be older than the event
    asking = true;
    try {
      const now = await get(`jobs/${job.id}`, {}, signal);
      lost.hidden = true;
      if (now.progress?.front) drawFront(now.progress.front);
      else if (!latest) noFront(now);
      if (now.state !== job.state || now.cancel_asked !== job.cancel_asked) {
        job = now;
        changed(now);
      }
    } catch (problem) {
      if (statusOf(problem) === 404) end(null);
      else if (!isAbort(problem)) {
        lost.hidden = false;
        soon(AGAIN);
      }
    } finally {
      asking = false;
    }
  }

  /** @param {Api.FrontProgress} found */
  function drawFront(found) {
    latest = found;
    const columns = found.columns.map(columnOf);
    if (columns.length > 2 && !pickers.childElementCount) {
      /** @param {string} label @param {"x" | "y"} name */
      const pick = (label, name) =>
        h(
          "label",
          {},
          `${label} `,
          h(
            "select",
            {
              onchange: (event) => {
                axes[name] = Number(event.currentTarget.value);
                drawFront(found);
              },
            },
            columns.map(({ title }, index) =>
              h("option", { value: index, selected: index === axes[name] }, title),
            ),
          ),
        );
      fill(pickers, pick("Across", "x"), pick("Up", "y"));
    }
    if (columns.length < 2) {
      fill(
        front,
        h(
          "p",
          {},
          `Best ${columns[0].title} so far: ${withUnit(found.points[0]?.[0], columns[0].unit)}`,
        ),
      );
      return;
    }
    near.hidden = rounds.at(-1)?.hypervolume !== 0;
    const frontPoints = found.points.map((point) => [point[axes.x], point[axes.y]]);
    /** @param {"x" | "y"} name @param {0 | 1} place */
    const heldRange = (name, place) => {
      const { title, unit } = columns[axes[name]];
      return extent(
        `${title} ${unitOf(unit)}`,
        frontPoints.map((point) =>
          typeof point[place] === "number" ? inDisplayUnit(point[place], unit) : null,
        ),
      );
    };
    fill(
      front,
      points(
        [{ points: frontPoints }],
        columns[axes.x],
        columns[axes.y],
        `The front so far: ${counted(frontPoints.length, "design")}`,
        [heldRange("x", 0), heldRange("y", 1)],
        undefined,
        sizeIn(front.clientWidth),
      ),
    );
  }

  /** Return the size of a picture that fills its place in width and the screen in height. @param {number} width @returns {Page.Point} */
  function sizeIn(width) {
    const wide = Math.max(width, 340);
    return [wide, Math.round(Math.max(340, Math.min(0.61 * wide, 0.52 * innerHeight)))];
  }

  /** @param {Api.Job} now */
  function noFront(now) {
    const waits = now.state === "queued";
    fill(
      front,
      h(
        "p",
        { class: "quiet" },
        waits
          ? `Waiting for a worker. ${now.reason && `${capitalised(inWords(now.reason))}.`}`
          : now.progress?.round
            ? "No finished design yet."
            : "The front appears with the first finished designs.",
      ),
    );
    if (waits) soon(AGAIN); // the reason for waiting changes without an event
  }

  /** @param {null} now */
  function end(now) {
    over = true;
    stop();
    changed(now);
  }

  // Events stop when the service is unreachable or the job has ended; a request for the job tells which.
  /** @param {boolean} yes */
  const connected = (yes) => soon(yes ? OFTEN : 0);
  const stop = listenToJob(job.id, {
    after: Math.max(0, job.events - PAST),
    signal,
    told: takeEvent,
    connected,
  });
  signal.addEventListener("abort", rest);
  noFront(job);
  fill(curve, h("p", { class: "quiet" }, "The curve begins with the first round."));
  if (job.progress) {
    course.add(job.progress);
    showState(job.progress, job.state === "running");
    if (job.progress.front) drawFront(job.progress.front);
  }
  let drawnWidth = front.clientWidth;
  const sizes = new ResizeObserver(() => {
    if (front.clientWidth === drawnWidth) return;
    drawnWidth = front.clientWidth;
    if (rounds.length) drawCurve();
    if (latest) drawFront(latest);
  });
  sizes.observe(front);
  return () => {
    over = true;
    rest();
    sizes.disconnect();
    stop();
  };
}
