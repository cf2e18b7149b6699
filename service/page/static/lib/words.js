/** Sentences of the service in the words of the page: titles replace the keys of job files. */

import { inDisplayUnits } from "./numbers.js";

/** Titles of form sections by table of the job. @type {Record<string, string>} */
const PARTS = {
  mechanism: "Masses and loads",
  motion: "Motion",
  load: "Masses and loads",
  friction: "Friction",
  tolerances: "Tolerances",
  variables: "Dimensions",
  constraints: "Requirements",
  objectives: "Objectives",
  sections: "Material and pins",
  choice: "Choices",
  optimiser: "Search",
  quantity: "Formulas with names",
  drive: "Motor and flywheel",
  clearance: "Loose joint",
  costs: "Tolerances",
};
/** Titles of form sections that contain only some keys of a table. @type {Record<string, string>} */
const PART_TITLES = {
  "mechanism.speed": "Motion",
  "mechanism.cycle_time": "Motion",
  "mechanism.strokes_per_minute": "Motion",
  "mechanism.speed_profile": "Motion",
  "mechanism.cylinders": "Several cylinders on one crankshaft",
  "mechanism.counterweight": "Counterweight",
};

/** Replacements, in order. @type {[RegExp, string | ((...found: string[]) => string)][]} */
const SAID = [
  [/\bunknown (?:key|heading)\b/g, "unknown entry"],
  [
    / belong below the heading (\S+); got them [^;]+; write [^;]+/g,
    " belong under $1; move them there",
  ],
  [
    /each [\w.]+ must begin with \S+ in double brackets; got a single one; write [^;]+/g,
    "must be a list; got a single entry; put it in a list",
  ],
  [
    /there must be only one \S+ in single brackets; got (a list of \d+); write [^;]+/g,
    "must be a single entry; got $1; keep one of them",
  ],
  [/ unless cycle_time or strokes_per_minute is given/g, ""],
  [/\bcycle_time\b/g, "cycle time"],
  [/(?:\bdrive\.)?\b(rated|greatest)_torque\b/g, "$1 torque"],
  [/\bstrokes_per_minute\b/g, "strokes per minute"],
  [/\bdirection = "([a-z-]+)"/g, (_, way) => `the direction ${way}`],
  [
    /(?:add|write|set) \[motion\] kind = "swing" with from and to/g,
    () => "let the crank swing, under Motion",
  ],
  [
    /\b(?:for example, )?(?:add|write)(?: to the job)?(?: an?)? \[\[?([a-z]+)(?:\.[a-z]+)*\]\]?(?: (?:with )?([a-z_]+))?(?:(?!, or (?:use|leave) )[^;])*/g,
    (whole, table, key) =>
      PARTS[table] ? `give it under “${PART_TITLES[`${table}.${key}`] ?? PARTS[table]}”` : whole,
  ],
  [
    /add gravity = "[^"]+", or gravity = 0/g,
    () => "give the gravity under “Masses and loads”, 0 for none",
  ],
  [/got \[motion\] kind = "swing"/g, "got one that swings"],
  [/write kind = "swing"/g, "let the crank swing"],
  [
    /must have two options or more, or a file; got (\d+); add \[\[choice\.option\]\] tables/g,
    (_, count) => `must have at least two options; got ${count}; paste a table of them`,
  ],
  [/(?:set )?\[motion\] driver = "(\w+)"/g, (_, end) => `let the ${end} be the driven end`],
  [
    /for example, add law_times = \[([^\]]+)\], law_shares = \[([^\]]+)\]/g,
    (_, times, ways) => `for example, give the times ${times} and the fractions of travel ${ways}`,
  ],
  [/by slider_from and slider_to\b/g, "by two slider positions"],
  [/\blaw_times\b/g, "fractions of the time"],
  [/\blaw_shares\b/g, "fractions of the travel"],
  [/got driver = "(\w+)"/g, (_, end) => `got the ${end} as the driven end`],
  [/, or as a plain number in [^;.]+/g, ""],
  [/ \(a plain number is in rad\)/g, ""],
  [
    /for example, (write|add) (?:it )?[a-z_]+ = ("?)([^{}[\]"]+)\2(?=$|;)/g,
    (_, verb, __, value) => `for example, ${verb} ${value}`,
  ],
  [
    /(min|max|equals|step|target) = "([^"]+)"/g,
    (_, word, value) => `${WORDS[word] ?? word} ${value}`,
  ],
  [/\[\[?(\w+)\]\]?/g, (whole, table) => (PARTS[table] ? `“${PARTS[table]}”` : whole)],
  [/got constraints\.\w+ with equals/g, "got “exactly” among the requirements"],
  [/\bgot (equals|min) (?=[\d.−-])/g, (_, word) => `got ${WORDS[word]} `],
  [/\bgot max (?=[\d.−-])/g, "got at most "],
  [/\b(got at least \S+(?: [^\d\s;]\S*)*) and max /g, "$1 and at most "],
  [
    /\b(constraints|objectives)\.(\w+)/g,
    (_, table, name) =>
      `the ${table === "constraints" ? "requirement on" : "objective"} ${name.replaceAll("_", " ")}`,
  ],
  [/\b(?:variables|mechanism|tolerances|motion)\.(?=[a-z])/g, ""],
  [
    /must be an? ([a-z ]+): one number and one unit; got ""; write it like /g,
    (_, kind) => `needs a number: a ${kind}, such as `,
  ],
  [/is missing, but required; for example, (?:add|write) /g, "is missing; give a value, such as "],
  [
    /^slow_stroke = "(\w+)" leaves/,
    (_, stroke) => `a slow stroke that is the ${stroke} one leaves`,
  ],
  [/\bat --at\b/g, "at a crank angle"],
  [/--(?=[a-z])/g, ""],
  [
    /require slow_stroke = "(\w+)"(?: among the constraints)?/g,
    (_, stroke) => `choose “${stroke}” as the slow stroke, under Motion`,
  ],
  [/ \((?:opposes|helps)\)/g, ""],
  [/^cancelled: /, ""],
  [/^claimed by \S+$/, "a worker took it"],
  [/\b(\w+_\w+) (?:max|min)\b/g, (_, name) => `the ${name.replaceAll("_", " ")} limit`],
  [/\bmin must not exceed max\b/g, "the least value must not exceed the greatest"],
];

/** Bounds in words. @type {Record<string, string>} */
export const WORDS = {
  min: "at least",
  max: "at most",
  equals: "exactly",
  target: "to come near to",
  step: "by",
};

/** Return a sentence of the service in the words and units of the page. @param {string} sentence */
export function inWords(sentence) {
  return inDisplayUnits(
    SAID.reduce(
      (text, [found, said]) => text.replace(found, /** @type {string} */ (said)),
      sentence,
    ),
  );
}

/** Return a sentence with an initial capital. @param {string} sentence */
export function capitalised(sentence) {
  return sentence.charAt(0).toUpperCase() + sentence.slice(1);
}
