"use strict";
/** @type {(id: string) => HTMLElement} */
const at = (id) => /** @type {HTMLElement} */ (document.getElementById(id)); // player.html has them all
/**
 * Curves have a value for each degree of one turn or two. For a crank that swings, they have one for each 360th of the
 * back-and-forth motion, and `angles` are its crank angles. Lengths are mm, angles deg.
 * @type {{ crank: number, offset: number, direction: number, turns: number, perSecond: number, times: string, angles?: number[], slider: number[], rod: number[], pin?: number, curves: Record<string, (number | null)[]> }}
 */
const data = JSON.parse(at("data").textContent ?? "");
const slide = /** @type {HTMLInputElement} */ (at("angle"));
const speed = /** @type {HTMLSelectElement} */ (at("speed"));
const count = data.slider.length;
const whole = 360 * data.turns;
const cursors = [...document.querySelectorAll(".strip .now")];
const outputs = /** @type {HTMLOutputElement[]} */ ([
  ...document.querySelectorAll("output[data-curve]"),
]);
let angle = 0;
let playing = !matchMedia("(prefers-reduced-motion: reduce)").matches;
/** @type {number | null} */
let before = null;

/** A value between those one degree apart; none next to a gap. @type {(values: (number | null)[], degrees: number) => number | null} */
function between(values, degrees) {
  const place = (degrees / whole) * count;
  const low = Math.floor(place) % count;
  const high = (low + 1) % count;
  const [from, to] = [values[low], values[high]];
  if (from === null || to === null) return null;
  let step = to - from;
  if (values === data.rod && Math.abs(step) > 180) step -= 360 * Math.sign(step);
  return from + (place - Math.floor(place)) * step;
}

/** @type {(value: number | null) => string} */
function numberText(value) {
  if (value === null) return "\u2013";
  return String(Number(value.toPrecision(4))).replace("-", "\u2212");
}

/** @type {(id: string, x: number, y: number, turn?: number) => void} */
function put(id, x, y, turn = 0) {
  at(id).setAttribute("transform", `translate(${x} ${-y}) rotate(${-turn})`);
}

function draw() {
  const crank = data.angles ? (between(data.angles, angle) ?? NaN) : angle;
  const radians = ((crank + (data.pin ?? 0)) * Math.PI) / 180;
  const x = data.crank * Math.cos(radians);
  const y = data.crank * Math.sin(radians);
  const slider = between(data.slider, angle) ?? NaN;
  put("crank", 0, 0, crank);
  put("crank-pin", x, y);
  const rod = between(data.rod, angle) ?? NaN;
  put("rod", x, y, rod);
  put("slider", slider, data.offset, data.pin === undefined ? 0 : rod); // the barrel of a lever's cylinder turns
  put("slider-pin", slider, data.offset);
  if (document.getElementById("push")) put("push", slider, data.offset);
  for (const cursor of cursors) {
    cursor.setAttribute("x1", String(angle / data.turns));
    cursor.setAttribute("x2", String(angle / data.turns));
  }
  for (const output of outputs)
    output.textContent = numberText(between(data.curves[output.dataset.curve ?? ""], angle));
  at("angle-now").textContent = `${crank.toFixed(0).replace("-", "\u2212")}\u00b0`;
  if (document.activeElement !== slide || playing) slide.value = String(angle);
}

/** @type {(now: number) => void} */
function frame(now) {
  if (!playing) return;
  if (before !== null) {
    const turns = ((now - before) / 1000) * Number(speed.value) * data.direction;
    angle = (((angle + 360 * turns) % whole) + whole) % whole;
    draw();
  }
  before = now;
  requestAnimationFrame(frame);
}

/** @type {(on: boolean) => void} */
function play(on) {
  playing = on;
  before = null;
  at("play").textContent = on ? "Pause" : "Play";
  if (on) requestAnimationFrame(frame);
}

if (data.perSecond > 0 && data.perSecond <= 5) {
  const option = document.createElement("option");
  option.value = String(data.perSecond);
  option.textContent = `as it runs, ${Number((60 * data.perSecond).toPrecision(4))} ${data.times}`;
  speed.append(option);
}
at("play").addEventListener("click", () => play(!playing));
slide.addEventListener("input", () => {
  play(false);
  angle = Number(slide.value) % whole;
  draw();
});
draw();
play(playing);
