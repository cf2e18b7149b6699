/** Sections of the form, in the order of an engineer's thinking. */

import { h } from "../lib/dom.js";
import { choices, choicesGiven } from "./catalogue.js";
import { byschema, choice, quantity } from "./controls.js";
import { formulaObjectives, formulaRequirements, namedFormulas, namesGiven } from "./formula.js";
import { link } from "./link_mass.js";
import { loads } from "./load.js";
import { appliesToMotion, isLever, motion, swings } from "./motion.js";
import { objective } from "./objective.js";
import { isTable } from "./path.js";
import { range } from "./range.js";
import { requirement } from "./bounds.js";
import { words } from "./schema.js";
import { speedProfile } from "./speed.js";
import { solving } from "./search_settings.js";
import { strength, strengthGiven } from "./strength.js";
import { targetMotion, targetMotionText } from "./target_motion.js";
import { varying, varyingNames } from "./extra_variables.js";

const LINE = 90; // maximum length of a group's summary
const FORM_TABLES = new Set([
  "name",
  "description",
  "mechanism",
  "load",
  "friction",
  "tolerances",
  "variables",
  "constraints",
  "objectives",
  "optimiser",
  "robust",
  "clearance",
  "quantity",
  "sections",
  "motion",
  "choice",
  "target_motion",
  "drive",
  "costs",
  "cylinder",
  "arm",
  "spring",
]);

/** Return the sections of the form for a job. @param {Form.Whole} form */
export function sections(form) {
  form.fields.length = 0;
  return [
    section(
      "Machine",
      fields(
        byschema(form, ["name"], { label: "name" }),
        byschema(form, ["description"], { label: "description", wide: true, long: true }),
      ),
    ),
    section(
      "Motion",
      fields(
        motion(form, [
          requirements(form, offered(form, "motion")),
          turning(form, "constraints.slow_stroke", () =>
            byschema(form, ["constraints", "slow_stroke"], { label: "slow stroke" }),
          ),
        ]),
      ),
      cranked(form, "mechanism.branch", () =>
        more(
          [
            swings(form)
              ? "Crossed branch"
              : "Acceleration of the crank, uneven speed, crossed branch",
            has(form, "mechanism.acceleration", "mechanism.speed_profile", "mechanism.branch"),
          ],
          turning(form, "mechanism.acceleration", () =>
            byschema(form, ["mechanism", "acceleration"]),
          ),
          turning(form, "mechanism.speed_profile", () => speedProfile(form)),
          byschema(form, ["mechanism", "branch"]),
        ),
      ),
      turning(form, "target_motion", () =>
        more(["Desired motion of the slider", targetMotionText(form)], targetMotion(form)),
      ),
    ),
    section(
      "Dimensions",
      h(
        "div",
        { class: "fields ranges" },
        ["crank", "rod", "offset"].map((name) =>
          range(form, ["variables", name], { label: name, why: form.why(name) }),
        ),
      ),
      more(["Extra variables", varyingNames(form).join(", ")], varying(form)),
      more(["Catalogues to choose from", choicesGiven(form)], choices(form)),
      h("h3", {}, "Proportions"),
      fields(requirements(form, offered(form, "proportions"))),
    ),
    section(
      "Masses and loads",
      fields(masses(form)),
      isLever(form) && [
        byschema(form, ["cylinder"], { label: "cylinder" }),
        swings(form)
          ? more(["Gas or coil spring", has(form, "spring")], byschema(form, ["spring"]))
          : more(["Arm and ram", has(form, "arm")], byschema(form, ["arm"])),
      ],
      cranked(form, "sections", () =>
        more(["Material and pins", strengthGiven(form)], strength(form)),
      ),
      cranked(form, "load", () => loads(form)),
      more(
        ["Counterweight", has(form, "mechanism.counterweight")],
        byschema(form, ["mechanism", "counterweight"]),
      ),
      turning(form, "mechanism.cylinders", () =>
        more(
          ["Several cylinders on one crankshaft", has(form, "mechanism.cylinders")],
          byschema(form, ["mechanism", "cylinders"]),
        ),
      ),
      cranked(form, "friction", () =>
        more(
          ["Friction", has(form, "friction")],
          byschema(form, ["friction", "guide"], { label: "coefficient of the guide" }),
          pins(form),
        ),
      ),
      turning(form, "drive", () =>
        more(
          ["Motor and flywheel: limits of the motor, losses, start-up", has(form, "drive")],
          byschema(form, ["drive"], { label: "drive" }),
        ),
      ),
    ),
    section(
      "Requirements",
      fields(requirements(form, offered(form, "requirement")), requirements(form, others(form))),
      adding(form),
      formulaRequirements(form),
      more(["Formulas with names", namesGiven(form).join(", ")], namedFormulas(form)),
    ),
    section(
      "Objectives",
      h(
        "p",
        { class: "quiet" },
        "The search finds the best compromises between the ticked objectives.",
      ),
      wishes(form),
      formulaObjectives(form),
    ),
    section(
      "Tolerances",
      h(
        "p",
        { class: "quiet" },
        `They determine the ${isLever(form) ? "error of the lever angle" : "position error"}.`,
      ),
      tolerances(form),
    ),
    section(
      "Search",
      solving(form),
      turning(form, "robust", () => more(["Robust designs", has(form, "robust")], robust(form))),
      turning(form, "clearance", () =>
        more(
          ["Loose joint, for simulating its impacts", has(form, "clearance")],
          byschema(form, ["clearance"], { label: "clearance" }),
        ),
      ),
    ),
    kept(form),
  ].filter(Boolean);
}

/** @param {string} title @param {...Dom.Child} content */
function section(title, ...content) {
  const id = `s-${title.toLowerCase().replaceAll(" ", "-")}`;
  return h("section", { class: "panel", "aria-labelledby": id }, h("h2", { id }, title), content);
}

/** @param {...Dom.Child} content */
function fields(...content) {
  return h("div", { class: "fields" }, content);
}

/** @param {string | [string, string]} title of the part, and what it has, in a line @param {...Dom.Child} content */
function more(title, ...content) {
  const [name, has] = [title].flat();
  return h(
    "details",
    { class: "more" },
    h("summary", {}, name, has ? h("span", { class: "has" }, has) : null),
    h("div", { class: "fields" }, content),
  );
}

/**
 * Return a part for a fully rotating crank with a slider; for another machine only if the job has it, so that it can be removed.
 * @param {Form.Whole} form @param {string} place @param {() => Dom.Child} part
 */
function turning(form, place, part) {
  const isOther = swings(form) || isLever(form);
  return isOther && form.at(place.split(".")) === undefined ? null : part();
}

/**
 * Return a part that does not apply to a lever, only if its job has it, so that it can be removed.
 * @param {Form.Whole} form @param {string} place @param {() => Dom.Child} part
 */
function cranked(form, place, part) {
  return isLever(form) && form.at(place.split(".")) === undefined ? null : part();
}

/** Return the job's values at some paths in one line; "" for none. @param {Form.Whole} form @param {...string} places */
function has(form, ...places) {
  /** @param {unknown} part @param {string} key @returns {string[]} */
  const entriesOf = (part, key) => {
    if (part === undefined) return [];
    if (Array.isArray(part)) return [`${key} ${part.join(", ")}`];
    return isTable(part)
      ? Object.entries(part).flatMap(([inner, value]) => entriesOf(value, words(inner)))
      : [`${key} ${part}`];
  };
  const text = places
    .flatMap((place) => entriesOf(form.at(place.split(".")), words(place.split(".").at(-1) ?? "")))
    .join("; ");
  return text.length > LINE ? `${text.slice(0, LINE)} …` : text;
}

/**
 * Return the names of the quantities that a part of the form offers by default, and those present that belong to another motion.
 * @param {Form.Whole} form
 * @param {string} part
 */
function offered(form, part) {
  return [...form.quantities.values()]
    .filter(
      (one) =>
        one.offered.includes(part) &&
        (appliesToMotion(form, one) || form.at(["constraints", one.name]) !== undefined),
    )
    .map(({ name }) => name);
}

/** @param {Form.Whole} form */
function requirementOptions(form) {
  return ["motion", "proportions", "requirement"].flatMap((part) => offered(form, part));
}

/**
 * @param {Form.Whole} form
 * @param {string[]} names
 */
function requirements(form, names) {
  return names.map((name) => requirement(form, form.quantity(name)));
}

/** Return further quantities with requirements in the job. @param {Form.Whole} form */
function others(form) {
  const usual = new Set(requirementOptions(form));
  return Object.keys(form.at(["constraints"]) ?? {}).filter(
    (name) => !usual.has(name) && form.quantities.has(name),
  );
}

/** @param {Form.Whole} form */
function adding(form) {
  const taken = new Set([
    ...requirementOptions(form),
    ...Object.keys(form.at(["constraints"]) ?? {}),
  ]);
  const left = form.judging().filter((one) => !taken.has(one.name) && appliesToMotion(form, one));
  const select = h(
    "select",
    {
      id: "add-requirement",
      onchange: () => {
        if (!select.value) return;
        const name = select.value;
        const side = form.quantity(name).better === "high" ? "min" : "max";
        form.put(["constraints", name], { [side]: "" });
        form.redraw(`f-constraints-${name}-${side}`);
      },
    },
    h("option", { value: "" }, "choose a quantity …"),
    left.map(({ name, title }) => h("option", { value: name }, title)),
  );
  return h(
    "p",
    { class: "row" },
    h("label", { for: "add-requirement" }, "Another requirement"),
    select,
  );
}

/** @param {Form.Whole} form */
function masses(form) {
  const slider = {
    kind: "mass",
    label: "slider mass",
    why: form.schema.property(["mechanism", "slider", "mass"])?.description,
  };
  return [
    link(form, ["mechanism", "crank"], "crank"),
    cranked(form, "mechanism.rod", () => link(form, ["mechanism", "rod"], "rod")),
    cranked(form, "mechanism.slider", () => [
      quantity(form, ["mechanism", "slider", "mass"], slider),
      ["dead_centre", "touch_distance", "dwell_distance", "guide_distance"].map((key) =>
        byschema(form, ["mechanism", "slider", key]),
      ),
    ]),
    byschema(form, ["mechanism", "gravity"]),
    byschema(form, ["mechanism", "gravity_direction"]),
  ];
}

/** @param {Form.Whole} form */
function pins(form) {
  return ["crank_pivot", "crank_pin", "slider_pin"].map((name) =>
    byschema(form, ["friction", name]),
  );
}

/** @param {Form.Whole} form */
function wishes(form) {
  const objectives = Object.keys(form.at(["objectives"]) ?? {});
  const main = new Set([...offered(form, "objective"), ...objectives]);
  const all = form
    .judging()
    .filter((one) => appliesToMotion(form, one) || objectives.includes(one.name));
  return [
    h(
      "div",
      { class: "fields" },
      all.filter(({ name }) => main.has(name)).map((one) => objective(form, one)),
    ),
    h(
      "details",
      { class: "more" },
      h("summary", {}, "More quantities"),
      h(
        "div",
        { class: "fields" },
        all.filter(({ name }) => !main.has(name)).map((one) => objective(form, one)),
      ),
    ),
  ];
}

/** @param {Form.Whole} form */
function tolerances(form) {
  /** @param {string} key */
  const dimension = (key) =>
    byschema(form, ["tolerances", key], { label: `${key.replace("_", " ")} tolerance` });
  return [
    h(
      "div",
      { class: "fields" },
      ["crank", "rod", "offset"].map(dimension),
      cranked(form, "tolerances.crank_angle", () => dimension("crank_angle")),
    ),
    cranked(form, "tolerances.clearances", () =>
      more(
        [
          "Clearances, and where the position matters",
          has(form, "tolerances.clearances", "tolerances.during", "tolerances.part_of_stroke"),
        ],
        byschema(form, ["tolerances", "clearances"]),
        byschema(form, ["tolerances", "during"]),
        byschema(form, ["tolerances", "part_of_stroke"]),
      ),
    ),
    turning(form, "costs", () =>
      more(
        ["Costs of tolerances, to find the cheapest ones", has(form, "costs")],
        byschema(form, ["costs"], { label: "costs" }),
      ),
    ),
  ];
}

/** @param {Form.Whole} form */
function robust(form) {
  const on = form.at(["robust"]) !== undefined;
  const select = choice(
    {
      ...form,
      at: () => (on ? "yes" : undefined),
      put: (_, value) => form.put(["robust"], value ? { kind: "percentile" } : undefined),
      register: () => {},
    },
    ["robust", "on"],
    {
      options: ["yes"],
      label: "within the tolerances",
      fallback: "no",
      why: "Objectives and requirements hold within the tolerances, not only at the nominal dimensions.",
      changed: () => form.redraw(),
    },
  );
  return [select, on ? byschema(form, ["robust"], { label: "robust" }) : null];
}

/** Return the parts of the job without fields. @param {Form.Whole} form */
function kept(form) {
  const parts = Object.keys(form.job).filter((key) => !FORM_TABLES.has(key));
  const functions = Object.entries(form.at(["quantity"]) ?? {})
    .filter(([, part]) => !(isTable(part) && "formula" in part))
    .map(([name]) => `the function ${name}`);
  const names = [...parts, ...functions];
  if (!names.length) return null;
  return section(
    "Other parts of the job",
    h(
      "p",
      {},
      `This job also has ${names.join(", ")}. They stay as they are; see the job file below.`,
    ),
  );
}
