/** Stages of a search in their order, each with its progress. */

import { fill, h } from "../lib/dom.js";
import { grouped } from "../lib/numbers.js";
import { duration } from "./times.js";

/** @typedef {{ name: string, rounds: [number, number], step: number, steps: number, from: number, to: number }} Stage */

/** Return {node, told(progress), end()}. told: takes a progress report. end: marks the search as ended. */
export function stages() {
  const node = h("ol", { class: "stages", "aria-label": "Stages" });
  /** @type {Stage[]} */
  let stageList = [];
  let seconds = 0;
  let over = false;
  return {
    node,
    /** @param {Api.Progress} data */
    add(data) {
      stageList = stagesAfter(stageList, data, seconds);
      seconds = data.seconds ?? 0;
      draw();
    },
    end() {
      over = true;
      draw();
    },
  };

  function draw() {
    fill(
      node,
      stageList.map((one, place) => row(one, !over && place === stageList.length - 1)),
    );
  }
}

/**
 * Return the stages after an event: the last one continues or another one begins; a restarted search starts again.
 * @param {readonly Stage[]} before @param {Api.Progress} data @param {number} seconds of the event before @returns {Stage[]}
 */
export function stagesAfter(before, data, seconds) {
  const { stage: name, round, step = 0, steps = 0 } = data;
  const now = data.seconds ?? 0;
  const stageList = before.slice();
  const last = stageList.at(-1);
  if (last && (now < last.from || round < last.rounds[0]))
    return stagesAfter([], data, Math.min(seconds, now));
  if (last?.name === name)
    stageList[stageList.length - 1] = {
      ...last,
      rounds: [last.rounds[0], round],
      step,
      steps,
      to: now,
    };
  else
    stageList.push({
      name,
      rounds: [round, round],
      step,
      steps,
      from: Math.min(seconds, now),
      to: now,
    });
  return stageList;
}

/** @param {Stage} stage @param {boolean} now */
function row({ name, rounds: [first, last], step, steps, from, to }, now) {
  const counted = steps
    ? `${grouped(step)} of ${grouped(steps)}`
    : first === last
      ? `round ${last}`
      : `rounds ${first} to ${last}`;
  return h(
    "li",
    { "aria-current": now ? "step" : null },
    h(
      "span",
      { class: "stage" },
      h("span", { "aria-hidden": "true" }, now ? "▸ " : "✓ "),
      h("span", {}, name),
    ),
    now && steps ? h("progress", { max: steps, value: step, "aria-label": name }) : h("span", {}),
    h("span", { class: "quiet number" }, counted),
    h("span", { class: "quiet number" }, duration(Math.max(0, to - from))),
  );
}
