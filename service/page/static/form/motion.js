/** How the crank moves: it turns through, or swings between two angles; and what belongs to either. */

import { h } from "../lib/dom.js";
import { say } from "../lib/notices.js";
import { byschema, choice } from "./controls.js";
import { isTable } from "./path.js";
import { speed } from "./speed.js";

const PATH = ["motion"];
const FIRST = { kind: "swing", from: "0 deg", to: "60 deg", driver: "slider" };

/** Return whether the crank of a job swings. @param {Form.Whole} form */
export function swings(form) {
  return form.at([...PATH, "kind"]) === "swing";
}

/** Return whether a quantity can be asked of the motion of a job. @param {Form.Whole} form @param {Api.Quantity} quantity */
export function fits(form, { motion }) {
  return motion === "" || motion === (swings(form) ? "swing" : "turn");
}

/** Return the fields of the motion; turning: those that only a crank that turns through has. @param {Form.Whole} form @param {Dom.Child} turning */
export function motion(form, turning) {
  const kind = choice({ ...form, put: (_, value) => change(form, value) }, [...PATH, "kind"], { options: ["swing"], fallback: "turns through", label: "the crank", why: "It turns through, at a speed; or it swings forth and back between two angles, and need not be able to turn.", changed: () => form.redraw() });
  if (!swings(form)) return [kind, speed(form), turning];
  /** @param {string} key @param {string} label */
  const own = (key, label) => byschema(form, [...PATH, key], { label });
  const slow = (form.at([...PATH, "law"]) ?? "slow") === "slow";
  /** @param {string} key @param {string} label */
  const choosing = (key, label) => {
    const made = own(key, label);
    made?.querySelector("select")?.addEventListener("change", () => form.redraw());
    return made;
  };
  return [
    kind,
    own("from", "from crank angle"),
    own("to", "to crank angle"),
    choosing("driver", "driven end"),
    own("margin", "margin from dead points"),
    choosing("law", "motion over time"),
    slow ? null : own("duration", "duration of one way"),
    form.at([...PATH, "driver"]) === "slider" ? own("actuator_tolerance", "tolerance of the actuator") : null,
    turning,
    h("details", { class: "more" }, h("summary", {}, "Crank speed, of no matter to a swing"), h("div", { class: "fields" }, speed(form))),
  ];
}

/** Let the crank swing, or turn through; what cannot be asked of that is taken out, and said. @param {Form.Whole} form @param {unknown} kind */
function change(form, kind) {
  form.put(PATH, kind === undefined ? undefined : structuredClone(FIRST));
  /** @type {string[]} */
  const gone = [];
  for (const table of ["constraints", "objectives"]) {
    for (const name of Object.keys(form.at([table]) ?? {})) {
      const quantity = form.quantities.get(name);
      if (!(quantity ? fits(form, quantity) : name !== "slow_stroke" || kind === undefined)) {
        form.put([table, name], undefined);
        gone.push(quantity?.title ?? "slow stroke");
      }
    }
  }
  if (!isTable(form.at(["objectives"]))) {
    const first = form.judging().find((one) => swings(form) && one.motion === "swing" && one.kind === "force") ?? form.judging().find((one) => fits(form, one) && one.offered.includes("objective"));
    if (first) form.put(["objectives", first.name], first.better === "high" ? "maximise" : "minimise");
  }
  if (gone.length) say(`Taken out, as they are of a crank that ${kind === undefined ? "swings" : "turns through"}: ${[...new Set(gone)].join(", ")}.`);
}
