/** View of one mechanism: three lengths, typed or dragged, and its motion, without a search or a stored run. */

import { abscissaOf } from "../charts/abscissa.js";
import { curveCharts } from "../charts/curves.js";
import { extremes, wrappedAngle } from "../charts/cycle.js";
import { copyLink } from "../design/export_menu.js";
import { lengthRow, LENGTHS } from "../design/length_row.js";
import { mechanismsPanel } from "../design/mechanisms.js";
import { keepChoices, link } from "../lib/address.js";
import { isAbort, post } from "../lib/api.js";
import { fill, h, markInvalid, numberField, typeInto } from "../lib/dom.js";
import { inDisplayUnits, readySystem, text, unitOf } from "../lib/numbers.js";
import { parseQuantity } from "../lib/quantity_text.js";
import { sentenceOf } from "../lib/refusals.js";
import { readyKinds } from "../lib/units.js";
import { capitalised, inWords } from "../lib/words.js";
import { factsOf, reasonNotAssembled } from "../mechanism/facts.js";
import { grips } from "../mechanism/grips.js";
import { deadCentresOf, motionOf } from "../mechanism/motion.js";
import { playback } from "../mechanism/playback.js";
import { jobOf, statedIn } from "../mechanism/stated_mechanism.js";

/** @import { Stated } from "../mechanism/stated_mechanism.js" */

export const title = "One mechanism";

const WRONG = "look-wrong"; // id of the error message
const START = 50; // deg: no links overlap
/** @type {({ key: string } & Page.Heading)[]} */
const PANELS = [
  { key: "slider_position_mm", title: "Slider position", unit: "mm" },
  { key: "slider_velocity_m_s", title: "Slider velocity", unit: "m/s" },
  { key: "slider_acceleration_m_s2", title: "Slider acceleration", unit: "m/s^2" },
  { key: "transmission_angle_deg", title: "Transmission angle", unit: "deg" },
];

/** Show the mechanism that the address names. @param {HTMLElement} place @param {Page.Visit} options */
export async function show(place, { query, signal }) {
  await Promise.all([readySystem(), readyKinds()]);
  if (signal.aborted) return;
  place.classList.add("of-design"); // reuses the styles of drawing, curves and lengths
  const { stated, unread } = statedIn(query);
  const angle = playback(0, signal); // at screen speeds: the crank speed changes
  angle.set(START);
  const [stage, strip, nothing, curves, wrong, facts, next] = [
    h("section", { class: "panel stage" }),
    h("div", { class: "panel row strip", role: "group", "aria-label": "Motion" }),
    h("div", { class: "panel quiet", hidden: true }, "No mechanism to show."),
    h("section", { class: "curves" }, h("h2", {}, "Over one turn")),
    h("p", { id: WRONG, class: "bad", role: "alert" }),
    h("dl", { class: "facts" }),
    h("a", { class: "button primary", hidden: true }, "Search from here"),
  ];
  const mend = h("button", { type: "button", hidden: true });
  const machines = mechanismsPanel(
    stage,
    strip,
    angle,
    1,
    grips({
      changed(lengths, at) {
        angle.pause();
        angle.arc = null; // until its lengths are drawn
        if (at !== null) angle.set(at);
        take(lengths);
      },
      released: () => draw(),
    }),
  );
  const charts = curveCharts(
    curves,
    (at, taken) => {
      if (taken) angle.pause();
      if (!angle.playing) angle.set(at);
    },
    { large: PANELS.map(({ key }) => key), most: PANELS.length, onChoice: () => {} },
  );
  angle.listen(charts.turn);
  signal.addEventListener("abort", () => [machines, charts].forEach((part) => part.close()));
  const longest = 2 * (stated.crank_mm + stated.rod_mm + Math.abs(stated.offset_mm));
  const rows = LENGTHS.map(([key, name]) =>
    lengthRow(
      key,
      name,
      key === "offset_mm" ? [-longest / 2, longest / 2] : [longest / 1000, longest],
      (value) => {
        if (value === null) refuse();
        else take({ [key]: value }, key);
      },
      { isOfJob: false, describedBy: WRONG },
    ),
  );
  let typedSpeed = ""; // why the typed text is not a speed
  const speed = numberField({
    id: "look-speed",
    value: text(stated.rpm, "rpm"),
    oninput: () => {
      const { value, wrong: sentence = "" } = parseQuantity(speed.value, "rpm");
      typedSpeed = value ? "" : sentence || "Speed needs a value other than 0.";
      markInvalid(speed, typedSpeed, WRONG);
      if (value) take({ rpm: value });
      else refuse();
    },
  });
  let busy = false;
  let again = false;

  /** Return why the typed texts do not state a mechanism, or "". */
  const mistakes = () => [...rows.map((row) => row.wrong()), typedSpeed].filter(Boolean).join(" ");

  /** Store the stated values in the address, invalid text as typed. */
  function keepStated() {
    const typed = rows.filter((row) => row.wrong()).map((row) => [row.key, row.text()]);
    keepChoices({
      ...stated,
      ...Object.fromEntries(typed),
      ...(typedSpeed && { rpm: speed.value }),
    });
  }

  /** Hide the mechanism while a field is invalid. */
  function refuse() {
    keepStated();
    draw();
  }

  /** Set other lengths or another speed. @param {Partial<Stated>} other @param {string} [typed] key of the length that was typed */
  function take(other, typed = "") {
    for (const [key, value] of Object.entries(other))
      stated[/** @type {keyof Stated} */ (key)] = Number(value.toPrecision(10)); // 60 mm, also from inches
    for (const row of rows) if (row.key !== typed && row.key in other) row.show(stated[row.key]);
    keepStated();
    draw();
    ask();
  }

  /** Draw the mechanism from its lengths until the service has checked them; return whether there is one. @param {Api.Example | null} [example] */
  function draw(example = null) {
    const { rpm, ...row } = stated;
    const motion = motionOf(row);
    const { inner, outer } = deadCentresOf(row);
    const positions = motion.slider_position_mm.map((x) => (Number.isFinite(x) ? Number(x) : null));
    const isReached = positions.some((x) => x !== null);
    const locks = positions.includes(null);
    const fault = mistakes() || (isReached ? "" : reasonNotAssembled(row));
    nothing.hidden = !fault;
    for (const part of [stage, strip]) part.hidden = Boolean(fault);
    for (const part of [curves, facts, next]) part.hidden ||= Boolean(fault) || locks;
    facts.ariaBusy = String(!example);
    mend.hidden ||= Boolean(fault);
    if (fault) {
      wrong.textContent = fault;
      return false;
    }
    angle.arc = locks ? arcAround(positions, nearest(positions, angle.angle)) : null;
    angle.set(angle.angle);
    /** @type {Page.Machine} */
    const machine = {
      name: "The mechanism",
      series: 1,
      row,
      violations: [],
      turns: 1,
      curves: example?.motion ?? { ...motion, slider_position_mm: positions },
      curveColumns: [],
      exact: example ? marked(example) : {},
      centres: example?.dead_centres_deg ?? ends(positions),
      arc: angle.arc,
      sliderEnds: example?.slider_ends_mm ?? (locks ? [NaN, NaN] : [inner, outer]),
    };
    angle.direction = rpm < 0 ? -1 : 1;
    machines.show([machine]);
    if (example) {
      curves.hidden = false;
      charts.show([machine], PANELS, abscissaOf("angle", rpm));
    }
    return true;
  }

  /** Ask the service, one question at a time, the latest lengths next. */
  async function ask() {
    if (busy) {
      again = true;
      return;
    }
    [busy, again] = [true, false];
    try {
      const {
        example,
        allowed,
        wrong: found,
      } = await post("preview", { job: jobOf(stated) }, { signal });
      if (!again)
        update(
          example,
          [
            ...(allowed?.said ?? []),
            ...found
              .filter(({ path }) => /^(variables|mechanism)/.test(path))
              .map(({ sentence }) => sentence),
          ].map((one) => `${capitalised(inWords(one))}.`),
          allowed?.changes.find(({ path }) => path === "variables.rod"),
        );
    } catch (error) {
      if (isAbort(error)) return;
      update(null, [sentenceOf(error)]);
    } finally {
      busy = false;
      if (again && !signal.aborted) ask();
    }
  }

  /** Show the answer of the service. @param {Api.Example | null} example @param {string[]} faults @param {Api.Change} [change] to a rod that lets the crank rotate */
  function update(example, faults, change) {
    mend.hidden = !change;
    if (change) {
      const { value } = parseQuantity(String(change.value), "mm");
      mend.textContent = inDisplayUnits(change.label);
      mend.onclick = () => take({ rod_mm: value });
    }
    if (!draw(example)) return;
    wrong.textContent = example ? "" : faults.join(" ");
    for (const part of [curves, facts, next]) part.hidden = !example;
    if (!example) return;
    next.href = link(["new"], {
      around: [
        stated.crank_mm,
        stated.rod_mm,
        stated.offset_mm,
        Number(example.stroke_mm.toPrecision(10)),
        stated.rpm,
      ].join(),
    });
    fill(facts, factsOf(example));
  }

  fill(
    place,
    h("h1", {}, title),
    h(
      "p",
      { class: "quiet" },
      "Type three lengths or drag the drawing. The page address contains them, so you can share it as a link.",
    ),
    h(
      "div",
      { class: "design-columns" },
      h("div", {}, stage, strip, nothing),
      h(
        "section",
        { class: "panel" },
        rows.map((row) => row.node),
        h(
          "div",
          { class: "length" },
          h("label", { for: "look-speed" }, "Speed"),
          h("span", { class: "quiet" }, "negative: clockwise"),
          speed,
          h("span", { class: "quiet" }, unitOf("rpm")),
        ),
        wrong,
        mend,
        facts,
        h(
          "p",
          { class: "row" },
          next,
          h("button", { type: "button", onclick: copyLink }, "Copy link"),
        ),
      ),
    ),
    curves,
  );
  for (const row of rows) row.show(stated[row.key]);
  for (const row of rows) row.type(unread[row.key]);
  if (unread.rpm) typeInto(speed, unread.rpm);
  draw();
  await ask();
  if (!facts.hidden && !matchMedia("(prefers-reduced-motion: reduce)").matches) angle.play();
}

/** Return the exact extremes of each curve, to mark them. @param {Api.Example} example @returns {Record<string, Page.Ends | null>} */
function marked({ extremes }) {
  const ends = Object.entries(extremes ?? {}).map(([key, found]) => {
    const [low, high] = found.map(({ value, crank_angle_deg: angle }) => ({ value, angle }));
    return [key, { low, high }];
  });
  return Object.fromEntries(ends);
}

/** Return the crank angles of the innermost and outermost slider position, deg. @param {(number | null)[]} positions @returns {Page.Point} */
function ends(positions) {
  const found = extremes(positions);
  return found ? [found.low.angle, found.high.angle] : [0, 180];
}

/** Return the ends of the arc around a crank angle that a mechanism reaches, whole deg. @param {(number | null)[]} positions @param {number} angle @returns {Page.Point} */
function arcAround(positions, angle) {
  let [low, high] = [angle, angle];
  while (positions[wrappedAngle(low - 1)] !== null) low -= 1;
  while (positions[wrappedAngle(high + 1)] !== null) high += 1;
  return [low, high];
}

/** Return the crank angle nearest to another that a mechanism reaches, deg. @param {(number | null)[]} positions @param {number} angle */
function nearest(positions, angle) {
  let [best, least] = [0, Infinity];
  positions.forEach((position, n) => {
    const off = Math.abs(wrappedAngle(n - angle + 180) - 180);
    if (position !== null && off < least) [best, least] = [n, off];
  });
  return best;
}
