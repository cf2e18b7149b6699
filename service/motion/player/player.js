"use strict";
const data = JSON.parse(document.getElementById("data").textContent);
const at = (id) => document.getElementById(id);
const count = data.slider.length;
const cursors = [...document.querySelectorAll(".strip .now")];
const outputs = [...document.querySelectorAll("output[data-curve]")];
let angle = 0;
let playing = !matchMedia("(prefers-reduced-motion: reduce)").matches;
let before = null;

/** A value between those one degree apart; none beside a gap. */
function between(values, degrees) {
  const place = (degrees / 360) * count;
  const low = Math.floor(place) % count;
  const high = (low + 1) % count;
  if (values[low] === null || values[high] === null) return null;
  let step = values[high] - values[low];
  if (values === data.rod && Math.abs(step) > 180) step -= 360 * Math.sign(step);
  return values[low] + (place - Math.floor(place)) * step;
}

function shown(value) {
  if (value === null) return "\u2013";
  return String(Number(value.toPrecision(4))).replace("-", "\u2212");
}

function put(id, x, y, turn = 0) {
  at(id).setAttribute("transform", `translate(${x} ${-y}) rotate(${-turn})`);
}

function draw() {
  const radians = (angle * Math.PI) / 180;
  const x = data.crank * Math.cos(radians);
  const y = data.crank * Math.sin(radians);
  const slider = between(data.slider, angle);
  put("crank", 0, 0, angle);
  put("crank-pin", x, y);
  put("rod", x, y, between(data.rod, angle));
  put("slider", slider, data.offset);
  put("slider-pin", slider, data.offset);
  for (const cursor of cursors) {
    cursor.setAttribute("x1", angle);
    cursor.setAttribute("x2", angle);
  }
  for (const output of outputs) output.textContent = shown(between(data.curves[output.dataset.curve], angle));
  at("angle-now").textContent = `${angle.toFixed(0)}\u00b0`;
  if (document.activeElement !== at("angle") || playing) at("angle").value = angle;
}

function frame(now) {
  if (!playing) return;
  if (before !== null) {
    const turns = ((now - before) / 1000) * Number(at("speed").value) * data.direction;
    angle = (((angle + 360 * turns) % 360) + 360) % 360;
    draw();
  }
  before = now;
  requestAnimationFrame(frame);
}

function play(on) {
  playing = on;
  before = null;
  at("play").textContent = on ? "Pause" : "Play";
  if (on) requestAnimationFrame(frame);
}

if (data.turnsPerSecond > 0 && data.turnsPerSecond <= 5) {
  const option = document.createElement("option");
  option.value = data.turnsPerSecond;
  option.textContent = `as it runs, ${Number((60 * data.turnsPerSecond).toPrecision(4))} turns a minute`;
  at("speed").append(option);
}
at("play").addEventListener("click", () => play(!playing));
at("angle").addEventListener("input", () => {
  play(false);
  angle = Number(at("angle").value) % 360;
  draw();
});
draw();
play(playing);
