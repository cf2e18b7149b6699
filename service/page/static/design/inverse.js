/** The way back: crank angles, speeds and accelerations of a design that move its slider as given. */

import { get, isAbort } from "../lib/api.js";
import { fill, formOf, h, numberField } from "../lib/dom.js";
import { parseQuantity } from "../lib/quantity_text.js";
import { inShown, text, unitOf, withUnit } from "../lib/numbers.js";
import { sentenceOf } from "../lib/refusals.js";
import { capital } from "../lib/words.js";
import { headsOf, numberCell, scrolledTable } from "../lib/table.js";

/** @typedef {"slider_position_mm" | "slider_velocity_m_s" | "slider_acceleration_m_s2"} Key */
/** @type {[Key, string, string][]} */
const FIELDS = [
  ["slider_position_mm", "Slider position", "mm"],
  ["slider_velocity_m_s", "Slider velocity, if known", "m/s"],
  ["slider_acceleration_m_s2", "Slider acceleration, if known", "m/s^2"],
];

/**
 * Put a form into `place`. path: of the design in the API; positions: of its slider over the turn, mm; turnTo(angle): lets the crank
 * stand there, deg.
 * @param {HTMLElement} place
 * @param {{ path: `jobs/${string}/designs/${number}`, positions: (number | null)[], turnTo: (angle: number) => void, signal: AbortSignal }} given
 */
export function wayBack(place, { path, positions, turnTo, signal }) {
  const known = positions.filter((one) => one !== null);
  const ends = [Math.min(...known), Math.max(...known)];
  /** @type {Partial<Record<Key, number>>} */
  const asked = { slider_position_mm: Number(((ends[0] + ends[1]) / 2).toPrecision(4)) };
  /** @type {Api.Inverse | null} */
  let found = null;
  /** @type {Map<Key, string>} */
  const wrong = new Map(); // why what was typed is no value
  const fields = h("div", { class: "row" });
  const answer = h("div", { "aria-live": "polite" });
  const form = formOf(ask, fields);
  fill(
    place,
    h("h2", {}, "From the slider back to the crank"),
    h("div", { class: "panel" }, form, answer),
  );

  function drawFields() {
    wrong.clear();
    fill(
      fields,
      FIELDS.map(([key, title, unit]) => {
        const id = `way-back-${key}`;
        const value = asked[key];
        const input = numberField({
          id,
          class: null,
          value: value === undefined ? "" : String(Number(inShown(value, unit).toPrecision(8))),
          oninput: ({ currentTarget }) => take(currentTarget, key, unit),
        });
        return h(
          "div",
          { class: "asked-for" },
          h("label", { for: id }, title),
          h("div", {}, input, h("span", { class: "quiet" }, ` ${unitOf(unit)}`)),
        );
      }),
      h("button", { type: "submit" }, "Find crank angles"),
    );
  }

  /** Keep what was typed, in the unit of the API. @param {HTMLInputElement} input @param {Key} key @param {string} unit */
  function take(input, key, unit) {
    const typed = parseQuantity(input.value, unit);
    input.setAttribute("aria-invalid", String(typed.wrong !== undefined));
    if (typed.wrong === undefined) wrong.delete(key);
    else wrong.set(key, typed.wrong);
    if (typed.value === undefined) delete asked[key];
    else asked[key] = typed.value;
  }

  async function ask() {
    const [sentence] = wrong.values();
    if (sentence) return refuse(sentence);
    if (asked.slider_position_mm === undefined)
      return refuse(`A slider position is needed; it is ${reach()}.`);
    try {
      const { inverse } = await get(`${path}/inverse`, { ...asked }, signal);
      found = /** @type {Api.Inverse} */ (/** @type {unknown} */ (inverse));
      tell();
    } catch (error) {
      if (!isAbort(error)) refuse(`${sentenceOf(error)}.`);
    }
  }

  /** @param {string} sentence */
  function refuse(sentence) {
    found = null;
    fill(answer, h("p", { class: "bad", role: "alert" }, capital(sentence)));
  }

  const reach = () => `between ${text(ends[0], "mm")} and ${withUnit(ends[1], "mm")}`;

  function tell() {
    if (!found) {
      fill(
        answer,
        h(
          "p",
          { class: "quiet hint" },
          `The slider of this design is ${reach()} from the crank pivot. Its velocity gives the crank speed; with its acceleration, too, the crank's acceleration. The slider's are positive along +x, as in the curves above, the crank's counter-clockwise.`,
        ),
      );
      return;
    }
    const {
      solutions,
      note,
      slider_velocity_m_s: velocity,
      slider_acceleration_m_s2: further,
    } = found;
    const heads = [
      "Crank angle",
      "Stroke",
      ...(velocity === null ? [] : ["Crank speed"]),
      ...(further === null ? [] : ["Crank acceleration"]),
      "",
    ];
    /** @param {number | null} value @param {string} unit */
    const cell = (value, unit) => numberCell(null, value, withUnit(value, unit, 6));
    const rows = solutions.map(
      ({
        crank_angle_deg: at,
        stroke,
        crank_speed_rpm: speed,
        crank_acceleration_rad_s2: acceleration,
      }) =>
        h(
          "tr",
          {},
          h(
            "th",
            { scope: "row", class: "number", "data-value": String(at) },
            withUnit(at, "deg", 6),
          ),
          h("td", {}, stroke ?? "dead centre"),
          velocity === null ? null : cell(speed, "rpm"),
          further === null ? null : cell(acceleration, "rad/s^2"),
          h(
            "td",
            {},
            h(
              "button",
              {
                type: "button",
                onclick: () => turnTo(at),
                "aria-label": `Turn the crank to ${withUnit(at, "deg", 6)}`,
              },
              "Turn there",
            ),
          ),
        ),
    );
    fill(
      answer,
      scrolledTable(
        "Crank angles found",
        headsOf(heads, (n) => n !== 1 && heads[n]),
        rows,
      ),
      h(
        "p",
        { class: "quiet hint" },
        "Strokes are those of a crank that turns counter-clockwise.",
        note ? ` ${capital(note)}.` : null,
      ),
    );
  }

  const draw = () => [drawFields, tell].forEach((each) => each());
  draw();
  window.addEventListener("units", draw, { signal });
}
