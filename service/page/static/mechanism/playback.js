/** Position in the cycle (for a revolution, the crank angle) shared by all parts of the view, and its playback. */

import { wrappedAngle } from "../charts/cycle.js";

/** @typedef {{ seconds: number, title: string, chosen: boolean }} Pace */

const READABLE = [1, 8]; // s; minimum duration of a revolution shown at real speed
const TURNS = [16, 8, 4, 2, 1]; // s per revolution, to choose from
const SHORTEST = 0.2; // s; shortest revolution that a screen can show

/**
 * Return the shared crank angle: {angle, direction, playing, arc, pace, paces, set(angle), play(), pause(), choose(pace), listen(told)}.
 * - rpm: cycles a minute; its sign gives the direction of the crank.
 * - arc: angles between which the crank stays, deg, or null for a whole turn.
 * - cycle: name of a cycle in texts.
 * - told({angle, playing, settled}): called at every change and every frame; settled: whether nothing moves, so that parts that take
 *   longer to draw can be drawn.
 * @param {number} rpm @param {AbortSignal} signal @param {string} cycle
 */
export function playback(rpm, signal, cycle = "one turn") {
  /** @type {((turn: Page.Turn) => void)[]} */
  const listeners = [];
  const paces = pacesOf(rpm, cycle);
  let frame = 0;
  let last = 0;
  let sense = 1; // turned round at the ends of an arc
  const state = {
    angle: 0,
    direction: rpm < 0 ? -1 : 1,
    playing: false,
    /** @type {Page.Point | null} */
    arc: null,
    pace: paces.find((pace) => pace.chosen) ?? paces[0],
    paces,
  };

  const tell = () =>
    listeners.forEach((listener) =>
      listener({ angle: state.angle, playing: state.playing, settled: !state.playing }),
    );
  /** @param {number} now */
  const step = (now) => {
    const seconds = last ? Math.min((now - last) / 1000, 0.1) : 0; // after a suspension of the browser, continue from the same angle
    last = now;
    const next = state.angle + (sense * state.direction * 360 * seconds) / state.pace.seconds;
    state.angle = within(next, state.arc);
    if (Math.abs(signed(next - state.angle)) > 1e-9) sense = -sense;
    tell();
    frame = requestAnimationFrame(step);
  };
  const pause = () => {
    cancelAnimationFrame(frame);
    frame = 0;
    state.playing = false;
    tell();
  };
  signal.addEventListener("abort", () => cancelAnimationFrame(frame), { once: true });
  return Object.assign(state, {
    /** @param {number} angle */
    set(angle) {
      state.angle = within(angle, state.arc);
      if (!frame) tell();
    },
    play() {
      if (frame) return;
      last = 0;
      state.playing = true;
      tell();
      frame = requestAnimationFrame(step);
    },
    pause,
    /** @param {Pace} pace */
    choose(pace) {
      state.pace = pace;
    },
    /** @param {(turn: Page.Turn) => void} listener */
    listen(listener) {
      listeners.push(listener);
      listener({ angle: state.angle, playing: state.playing, settled: !state.playing });
    },
  });
}

/** Return an angle in [-180, 180). @param {number} angle */
function signed(angle) {
  return wrappedAngle(angle + 180) - 180;
}

/** Return an angle, or the end of an arc that is nearer to it, in [0, 360). @param {number} angle @param {Page.Point | null} arc */
function within(angle, arc) {
  if (!arc) return wrappedAngle(angle);
  const [middle, half] = [(arc[0] + arc[1]) / 2, (arc[1] - arc[0]) / 2];
  return wrappedAngle(middle + Math.min(Math.max(signed(angle - middle), -half), half));
}

/**
 * Return the available speeds, each {seconds, title, chosen}, slowest first. seconds: duration of a revolution on the screen.
 * @param {number} rpm @param {string} cycle @returns {Pace[]}
 */
function pacesOf(rpm, cycle) {
  const real = rpm ? 60 / Math.abs(rpm) : null;
  const paces = TURNS.map((seconds) => ({
    seconds,
    title: `${turn(seconds, cycle)}${real ? `, ${share(real / seconds)}` : ""}`,
  }));
  if (real && real >= SHORTEST) {
    const same = paces.findIndex(({ seconds }) => Math.abs(seconds / real - 1) < 1e-9);
    if (same >= 0) paces.splice(same, 1);
    paces.push({ seconds: real, title: `${turn(real, cycle)}, real speed` });
    paces.sort((one, other) => other.seconds - one.seconds);
  }
  const chosen = real && real >= READABLE[0] && real <= READABLE[1] ? real : 4;
  return paces.map((pace) => ({ ...pace, chosen: pace.seconds === chosen }));
}

/** @param {number} seconds @param {string} cycle */
function turn(seconds, cycle) {
  if (seconds >= 120) return `${cycle} in ${Number((seconds / 60).toPrecision(3))} min`;
  return `${cycle} in ${Number(seconds.toPrecision(3))} s`;
}

/** @param {number} ratio */
function share(ratio) {
  if (Math.abs(ratio - 1) < 1e-9) return "real speed";
  return ratio < 1
    ? `1/${Number((1 / ratio).toPrecision(3))} of real speed`
    : `${Number(ratio.toPrecision(3))} times real speed`;
}
