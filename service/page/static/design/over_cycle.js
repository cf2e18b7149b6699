/** Curves of a design over crank angle, time or slider displacement, three of them large, and as CSV. */

import { abscissaOf, OVER, OVER_LEVER, OVER_SWING } from "../charts/abscissa.js";
import { curveCharts } from "../charts/curves.js";
import { address } from "../lib/api.js";
import { h } from "../lib/dom.js";
import { apiSystem } from "../lib/numbers.js";
import { panelsOf } from "./panels.js";

const CURVE_STORAGE = "large curves";
const SWING_STORAGE = "large curves of a swing";
const LARGE = ["way_mm", "torque_Nm", "transmission_angle_deg"]; // by default
const LARGE_OF_SWING = [
  ...["slider_position_mm", "drive_N", "drive_Nm", "transmission_angle_deg"],
  ...["length_mm", "push_N"], // of a lever
];

/**
 * Put the curves into `place`; turned: handler of the charts. told(over): called with the chosen abscissa. Returns show(series),
 * of(lengths), and turn and close of the charts. series: {name, series, curves, curveColumns, centres} of each design, the first in
 * front. lengths: those of a changed design, for the file, or null.
 * @param {HTMLElement} place
 * rpm: cycles per minute; turns: crank revolutions per cycle, 0 for a swing; lever: whether a cylinder moves a lever.
 * @param {{ path: string, rpm: number, turns: number, lever: boolean, over: string, turned: (angle: number, taken: boolean) => void, told: (over: string) => void }} options
 */
export function overCycle(place, { path, rpm, turns, lever, over, turned, told: choose }) {
  const storageKey = turns ? CURVE_STORAGE : SWING_STORAGE;
  const titles = lever ? OVER_LEVER : turns ? OVER : OVER_SWING;
  const choices = titles.filter(({ name }) => name !== "time" || rpm !== 0);
  let chosen = choices.some(({ name }) => name === over) ? over : "angle";
  const choice = h(
    "select",
    {
      name: "over",
      onchange: ({ currentTarget }) => {
        chosen = currentTarget.value;
        draw();
        choose(chosen === "angle" ? "" : chosen);
      },
    },
    choices.map(({ name, title }) =>
      h("option", { value: name, selected: name === chosen }, title),
    ),
  );
  const file = h(
    "a",
    {
      class: "button",
      download: "",
      title: lever
        ? "The swing from start to end, all curves"
        : turns
          ? "A row for each degree, all curves"
          : "Both strokes, all curves",
    },
    "Curves as CSV",
  );
  place.append(
    h(
      "div",
      { class: "row spread" },
      h("h2", {}, turns ? "Over the cycle" : "Over the swing"),
      h("label", {}, "Over ", choice),
      file,
    ),
  );
  const charts = curveCharts(place, turned, {
    large: hasLargeCurves(storageKey, turns ? LARGE : LARGE_OF_SWING),
    onChoice: (keys) => localStorage.setItem(storageKey, keys.join()),
  });
  /** @type {Page.Machine[]} */
  let machines = [];
  const draw = () => {
    const abscissa = abscissaOf(chosen, rpm, turns); // in the current units
    const named = lever && OVER_LEVER.slice(2).find(({ name }) => name === chosen);
    if (named) abscissa.title = named.title;
    charts.show(machines, panelsOf(machines[0].curveColumns, machines), abscissa);
  };
  /** @type {Page.Numbers | null} */
  let lengths = null;
  const link = () => (file.href = address(`${path}/cycle.csv`, { ...lengths, units: apiSystem() }));
  link();
  return {
    /** @param {Page.Machine[]} series */
    show(series) {
      machines = series;
      draw();
      link();
    },
    /** @param {Page.Numbers | null} other */
    of(other) {
      lengths = other;
      link();
    },
    turn: charts.turn,
    close: charts.close,
  };
}

/** @param {string} name @param {string[]} usual */
function hasLargeCurves(name, usual) {
  const storedKeys = (localStorage.getItem(name) ?? "").split(",").filter(Boolean);
  return storedKeys.length ? storedKeys : usual;
}
