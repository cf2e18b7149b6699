/** One mechanism: three lengths, typed or dragged, and how it moves; nothing is searched, and no run is stored. */

import { abscissaOf } from "../charts/abscissa.js";
import { curveCharts } from "../charts/curves.js";
import { extremes, turned } from "../charts/cycle.js";
import { copyLink } from "../design/export_menu.js";
import { lengthRow, LENGTHS } from "../design/length_row.js";
import { mechanismsPanel } from "../design/mechanisms.js";
import { keep, link } from "../lib/address.js";
import { isAbort, post } from "../lib/api.js";
import { fill, h, markInvalid, numberField } from "../lib/dom.js";
import { readySystem, system, text, unitOf, withUnit } from "../lib/numbers.js";
import { parseQuantity } from "../lib/quantity_text.js";
import { sentenceOf } from "../lib/refusals.js";
import { readyKinds } from "../lib/units.js";
import { capital, inWords } from "../lib/words.js";
import { grips } from "../mechanism/grips.js";
import { deadCentresOf, motionOf } from "../mechanism/motion.js";
import { playback } from "../mechanism/playback.js";

export const title = "One mechanism";

/** @typedef {Page.Lengths & { rpm: number }} Stated */

/** @type {Record<"si" | "inch", Stated>} */
const FIRST = {
  si: { crank_mm: 50, rod_mm: 150, offset_mm: 40, rpm: 60 },
  inch: { crank_mm: 50.8, rod_mm: 152.4, offset_mm: 38.1, rpm: 60 },
};
const START = 50; // deg, where all links are apart
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
  place.classList.add("of-design"); // whose drawing, curves and lengths it has
  const stated = startOf(query);
  const angle = playback(0, signal); // at paces of the screen: the speed changes
  angle.set(START);
  const [stage, strip, curves, wrong, facts, next] = [
    h("section", { class: "panel stage" }),
    h("div", { class: "panel row strip", role: "group", "aria-label": "Motion" }),
    h("section", { class: "curves" }, h("h2", {}, "Over one turn")),
    h("p", { class: "bad", role: "alert" }),
    h("dl", { class: "facts" }),
    h("a", { class: "button primary", hidden: true }, "Search from here"),
  ];
  const machines = mechanismsPanel(
    stage,
    strip,
    angle,
    1,
    grips({
      changed(lengths, at) {
        angle.pause();
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
    { large: PANELS.slice(0, 3).map(({ key }) => key), onChoice: () => {} },
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
        if (value === null) fault();
        else take({ [key]: value }, key);
      },
      { isOfJob: false },
    ),
  );
  let typedSpeed = ""; // why what was typed is no speed
  const speed = numberField({
    id: "look-speed",
    value: text(stated.rpm, "rpm"),
    oninput: () => {
      const { value, wrong: sentence = "" } = parseQuantity(speed.value, "rpm");
      typedSpeed = value ? "" : sentence || "Speed needs a value other than 0.";
      markInvalid(speed, typedSpeed);
      if (value) take({ rpm: value });
      else fault();
    },
  });
  let busy = false;
  let again = false;

  /** Return why something that was typed is no number; nothing with "". */
  const unread = () => rows.map((row) => row.wrong()).find(Boolean) || typedSpeed;
  const fault = () => (wrong.textContent = unread());

  /** Go to other lengths, or another speed. @param {Partial<Stated>} other @param {string} [typed] key of the length that was typed */
  function take(other, typed = "") {
    Object.assign(stated, other);
    for (const row of rows) if (row.key !== typed && row.key in other) row.show(stated[row.key]);
    keep({ ...stated });
    draw();
    ask();
  }

  /** Draw the mechanism from its lengths, until the service has looked at them. @param {Api.Example | null} [example] */
  function draw(example = null) {
    const { rpm, ...row } = stated;
    const motion = motionOf(row);
    const { inner, outer } = deadCentresOf(row);
    const positions = motion.slider_position_mm.map((x) => (Number.isFinite(x) ? Number(x) : null));
    const reached = positions.findIndex((x) => x !== null);
    if (reached < 0) return machines.fade(true); // it cannot even be put together
    const locks = positions.includes(null);
    if (locks) {
      angle.pause();
      angle.set(nearest(positions, angle.angle));
    }
    /** @type {Page.Machine} */
    const machine = {
      name: "The mechanism",
      series: 1,
      row,
      violations: [],
      turns: 1,
      curves: example?.motion ?? { ...motion, slider_position_mm: positions },
      curveColumns: [],
      centres: example?.dead_centres_deg ?? ends(positions),
      sliderEnds: example?.slider_ends_mm ?? (locks ? [NaN, NaN] : [inner, outer]),
    };
    angle.direction = rpm < 0 ? -1 : 1;
    machines.show([machine]);
    machines.fade(locks);
    curves.hidden = locks;
    if (example) charts.show([machine], PANELS, abscissaOf("angle", rpm));
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
        wrong: mistakes,
      } = await post("preview", { job: jobOf(stated) }, { signal });
      if (!again)
        update(example, [
          ...(allowed?.said ?? []),
          ...mistakes
            .filter(({ path }) => /^(variables|mechanism)/.test(path))
            .map(({ sentence }) => sentence),
        ]);
    } catch (error) {
      if (isAbort(error)) return;
      wrong.textContent = sentenceOf(error);
    } finally {
      busy = false;
      if (again && !signal.aborted) ask();
    }
  }

  /** Show what the service says. @param {Api.Example | null} example @param {string[]} faults */
  function update(example, faults) {
    wrong.textContent =
      unread() || (example ? "" : faults.map((one) => `${capital(inWords(one))}.`).join(" "));
    next.hidden = facts.hidden = !example;
    draw(example);
    if (!example) return;
    next.href = link(["new"], {
      around: [
        stated.crank_mm,
        stated.rod_mm,
        stated.offset_mm,
        example.stroke_mm,
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
      "Type three lengths or drag the drawing. The address holds them: share it as a link.",
    ),
    h(
      "div",
      { class: "design-columns" },
      h("div", {}, stage, strip),
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
  draw();
  await ask();
  if (!matchMedia("(prefers-reduced-motion: reduce)").matches) angle.play();
}

/** Return what the address states; where it says nothing that can be read, the first mechanism. @param {URLSearchParams} query @returns {Stated} */
function startOf(query) {
  const first = FIRST[system()];
  const read = /** @param {keyof Stated} key */ (key) => {
    const value = Number(query.get(key)?.trim() || NaN);
    return Number.isFinite(value) && (value > 0 || key === "offset_mm" || (key === "rpm" && value))
      ? value
      : first[key];
  };
  return {
    crank_mm: read("crank_mm"),
    rod_mm: read("rod_mm"),
    offset_mm: read("offset_mm"),
    rpm: read("rpm"),
  };
}

/** Return the job that asks the service to look. @param {Stated} stated */
function jobOf({ crank_mm, rod_mm, offset_mm, rpm }) {
  return {
    mechanism: { speed: `${rpm} rpm` },
    variables: { crank: `${crank_mm} mm`, rod: `${rod_mm} mm`, offset: `${offset_mm} mm` },
  };
}

/** @param {Api.Example} example */
function factsOf({
  stroke_mm,
  time_ratio,
  slow_stroke,
  least_transmission_angle_deg,
  slider_ends_mm,
  dead_centres_deg,
  clockwise,
}) {
  const [inner, outer] = dead_centres_deg;
  const forward = (((clockwise ? inner - outer : outer - inner) % 360) + 360) % 360;
  /** @param {number} n */
  const centre = (n) =>
    `slider at ${withUnit(slider_ends_mm[n], "mm")}, crank at ${text(dead_centres_deg[n], "deg", 4)}°`;
  /** @type {[string, string][]} */
  const lines = [
    ["Stroke", withUnit(stroke_mm, "mm")],
    [
      "Time ratio",
      `${text(time_ratio, "", 4)}${slow_stroke === "equal" ? "" : `, slow ${slow_stroke}`}`,
    ],
    ["Outward stroke", `over ${text(forward, "deg", 4)}° of the crank`],
    ["Inward stroke", `over ${text(360 - forward, "deg", 4)}°`],
    ["Least transmission angle", withUnit(least_transmission_angle_deg, "deg", 4)],
    ["Inner dead centre", centre(0)],
    ["Outer dead centre", centre(1)],
  ];
  return lines.map(([name, value]) => [h("dt", {}, name), h("dd", {}, value)]);
}

/** Return where the slider is innermost and outermost, deg. @param {(number | null)[]} positions @returns {Page.Point} */
function ends(positions) {
  const found = extremes(positions);
  return found ? [found.low.angle, found.high.angle] : [0, 180];
}

/** Return the crank angle nearest to another that a mechanism reaches, deg. @param {(number | null)[]} positions @param {number} angle */
function nearest(positions, angle) {
  let [best, least] = [0, Infinity];
  positions.forEach((position, n) => {
    const off = Math.abs(turned(n - angle + 180) - 180);
    if (position !== null && off < least) [best, least] = [n, off];
  });
  return best;
}
