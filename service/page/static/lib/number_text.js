/**
 * Numbers as people type them: with a decimal comma, a unit, or as a sum, for example "150,5", "6 in", "2*75", "1/2 in" and
 * "3 in + 5 mm"; and ranges such as "180 mm +- 0.5 mm".
 */

/**
 * @typedef {object} Field What a field takes.
 * @property {string} unit the one that it shows; a number without one is in it
 * @property {Record<string, number>} factors what one of each unit is in the first; those that no number changes into are left out
 * @property {Record<string, string>} [spoken] other words for units, each with the unit that it means here
 * @property {boolean} [percent] whether a share may stand for a value
 * @property {boolean} [range] whether a range may stand for a value
 *
 * @typedef {{ value: number, unit: string | null }} Part A number, with its unit once it has one.
 * @typedef {{ number?: undefined, ends?: undefined, wrong?: undefined, empty?: true }} Nothing nothing was typed, or what only the service can read
 * @typedef {{ number: string, unit: string, said: string | null, ends?: undefined, wrong?: undefined, empty?: undefined }} Read
 * @typedef {{ ends: [string, string], unit: string, said: string, number?: undefined, wrong?: undefined, empty?: undefined }} Ends
 * @typedef {{ wrong: string, number?: undefined, ends?: undefined, empty?: undefined }} Wrong
 */

const PLAIN = /^[+-]?(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d{1,3})?$/i;
const MIXED = /^(\d+)\s+(\d+)\s*\/\s*(\d+)(?![\d.,])/; // one and a half, as on an inch rule: 1 1/2
const SPACED = /^\d{1,3}(?:[ \u00a0\u202f]\d{3})+(?![\d])(?:[.,]\d+)?/;
const DIGITS = /^(?:\d|[.,](?=\d))[\d.,]*(?:e[+-]?\d{1,3})?/i;
/** Other spellings of units. @type {Record<string, string>} */
const SPELLINGS = {
  '"': "in",
  "″": "in",
  inch: "in",
  "'": "foot",
  "′": "foot",
  ft: "foot",
  feet: "foot",
  um: "µm",
  μm: "µm",
  "°": "deg",
};
const SPREAD = /^(?:\+\/?-|±)/; // between the middle of a range and half its width
const SIGN = /^(?!\+\/?-)[+-]/;
const WORD = /^[^\d\s.,+\-*/×·÷()±]/;

/** Error for an unreadable number; its message is a sentence. */
class Unreadable extends Error {}

/** Error for a word that is not a unit of the field: a formula, or a unit that only the service knows. */
class Unknown extends Error {}

/**
 * Return the parsed text of a field: {number, unit, said} with the number as text in the unit of the field and an explanation unless it
 * is obvious; {ends, unit, said} for a range; {wrong} with a sentence; {empty}; or {} if only the service can read it. A comma before
 * exactly three digits is read as a thousands separator, which is reported.
 * @param {string} typed @param {Field} field @returns {Nothing | Read | Ends | Wrong}
 */
export function parseNumber(typed, field) {
  const text = typed.trim().replaceAll("−", "-").replace(/^=\s*/, "");
  if (text === "") return { empty: true };
  if (PLAIN.test(text)) return { number: text, unit: field.unit, said: null };
  try {
    const parser = new Parser(text, field);
    const { value, unit, half } = parser.whole();
    if (!Number.isFinite(value + (half ?? 0)))
      return { wrong: `${quoted(typed)} has no finite value.` };
    const same =
      unit === null ||
      unit === field.unit ||
      !(unit in field.factors) ||
      !(field.unit in field.factors);
    /** @param {number} of */
    const converted = (of) =>
      tidy(same ? of : (of * field.factors[unit]) / field.factors[field.unit]);
    const number = converted(value);
    const into = same ? (unit ?? field.unit) : field.unit;
    /** @type {[string, string] | null} */
    const ends = half === null ? null : [converted(value - half), converted(value + half)];
    const result = `${ends ? ends.join(" to ") : number}${into ? ` ${into}` : ""}`;
    const said = parser.doubtful
      ? `${quoted(typed)} is read as ${result}; write ${parser.doubtful} if you mean that.`
      : result === text
        ? null
        : `${quoted(typed)} = ${result}`;
    return ends ? { ends, unit: into, said: said ?? result } : { number, unit: into, said };
  } catch (problem) {
    if (problem instanceof Unreadable) return { wrong: problem.message };
    if (problem instanceof Unknown) return {};
    throw problem;
  }
}

/** Whether a text states a range by its middle and half its width, whatever the two are. @param {string} text */
export function isRange(text) {
  return /\+\/?-|±/.test(text.replaceAll("−", "-"));
}

/** Parser of sums; a unit belongs to the product before it, so that 1/2 in is half an inch. */
class Parser {
  /** @param {string} text @param {Field} field */
  constructor(text, field) {
    this.text = text;
    this.rest = text;
    this.field = field;
    this.doubtful = ""; // the other reading of an ambiguous number
    /** @type {[string, string][]} */
    this.spellings = spellingsOf(field);
  }

  /** @returns {Part & { half: number | null }} half: half the width of a range, in the unit of its middle */
  whole() {
    const { value, unit } = this.sum();
    const by = this.taken(SPREAD) ? this.sum() : null;
    if (by && !this.field.range)
      throw new Unreadable(`${quoted(this.text)} is a range; write a single value here.`);
    if (this.rest)
      throw new Unreadable(
        this.rest[0] === ")"
          ? `${quoted(this.text)} closes a bracket that was never opened.`
          : `An operator such as + or * is missing before ${quoted(this.rest)}.`,
      );
    if (!by) return { value, unit, half: null };
    const half = Math.abs(
      unit === null || by.unit === null || by.unit === unit
        ? by.value
        : (by.value * this.factor(by.unit)) / this.factor(unit),
    );
    return { value, unit: unit ?? by.unit, half };
  }

  /** @returns {Part} */
  sum() {
    const terms = [this.term()];
    const signs = [1];
    for (let sign = this.taken(SIGN); sign; sign = this.taken(SIGN)) {
      signs.push(sign === "-" ? -1 : 1);
      terms.push(this.term());
    }
    const last = terms[terms.length - 1].unit;
    const bare = terms.slice(0, -1).every(({ unit }) => unit === null); // 100 + 5 mm: the unit applies to all terms
    const missing = terms.find(({ unit }) => unit === null);
    if (!bare && missing)
      throw new Unreadable(
        `A part of ${quoted(this.text)} has no unit; write one after each part, or only at the end.`,
      );
    if (bare)
      return { value: terms.reduce((all, { value }, n) => all + signs[n] * value, 0), unit: last };
    const { unit } = terms[0];
    const value = terms.reduce(
      (all, one, n) =>
        all +
        signs[n] *
          (one.unit === unit ? one.value : (one.value * this.factor(one.unit)) / this.factor(unit)),
      0,
    );
    return { value, unit };
  }

  /** @param {string | null} unit */
  factor(unit) {
    const factor = this.field.factors[unit ?? ""];
    if (factor === undefined)
      throw new Unreadable(`A percentage and a value cannot be added, as in ${quoted(this.text)}.`);
    return factor;
  }

  /** @returns {Part} */
  term() {
    let product = this.withUnit(this.operand());
    for (let sign = this.taken(/^[*/×·÷]/); sign; sign = this.taken(/^[*/×·÷]/)) {
      const other = this.operand();
      const by = sign === "/" || sign === "÷";
      if (other.unit !== null && (product.unit !== null || by))
        throw new Unreadable(
          `Only one factor of a product may have a unit, and a divisor may not; got ${quoted(this.text)}.`,
        );
      if (by && other.value === 0) throw new Unreadable(`${quoted(this.text)} divides by zero.`);
      product = this.withUnit({
        value: by ? product.value / other.value : product.value * other.value,
        unit: product.unit ?? other.unit,
      });
    }
    return product;
  }

  /** Return a part with the unit after it, if any. @param {Part} part @returns {Part} */
  withUnit(part) {
    const match = this.spellings.find(
      ([spelling]) =>
        this.rest.startsWith(spelling) &&
        !(/\w$/.test(spelling) && /^[\w^]/.test(this.rest.slice(spelling.length))),
    );
    if (!match) {
      if (WORD.test(this.rest)) throw new Unknown();
      return part;
    }
    this.rest = this.rest.slice(match[0].length).trimStart();
    if (part.unit !== null)
      throw new Unreadable(`${quoted(this.text)} has two units in one product.`);
    return { value: part.value, unit: match[1] };
  }

  /** @returns {Part} */
  operand() {
    const sign = this.taken(SIGN);
    if (sign) {
      const { value, unit } = this.operand();
      return { value: sign === "-" ? -value : value, unit };
    }
    if (this.taken(/^\(/)) {
      const inner = this.sum();
      if (SPREAD.test(this.rest))
        throw new Unreadable(
          `A range such as 180 mm +- 0.5 mm must not be in brackets; got ${quoted(this.text)}.`,
        );
      if (!this.taken(/^\)/))
        throw new Unreadable(`A bracket in ${quoted(this.text)} is not closed.`);
      return inner;
    }
    const mixed = this.matched(MIXED);
    if (mixed) {
      const [, whole, over, under] = mixed.map(Number);
      if (under === 0) throw new Unreadable(`${quoted(this.text)} divides by zero.`);
      return { value: whole + over / under, unit: null };
    }
    const digits = this.taken(SPACED) || this.taken(DIGITS);
    if (digits) return { value: this.number(digits.replace(/[\s\u00a0\u202f]/g, "")), unit: null };
    if (WORD.test(this.rest)) throw new Unknown();
    throw new Unreadable(
      this.rest
        ? `A number is missing before ${quoted(this.rest)}.`
        : `A number is missing at the end of ${quoted(this.text)}.`,
    );
  }

  /** Return the number for digits with points and commas. @param {string} digits */
  number(digits) {
    const [mantissa, power = "0"] = digits.split(/e/i);
    const [commas, points] = [mantissa.split(",").length - 1, mantissa.split(".").length - 1];
    const grouped = /^[1-9]\d{0,2}(?:,\d{3})+(?:\.\d*)?$/.test(mantissa)
      ? ","
      : /^[1-9]\d{0,2}(?:\.\d{3})+(?:,\d*)?$/.test(mantissa)
        ? "."
        : "";
    let plain = mantissa;
    if (grouped === "," && (commas > 1 || points || !digits.match(/e/i))) {
      if (commas === 1 && !points) this.doubtful = mantissa.replace(",", ".");
      plain = mantissa.replaceAll(",", "");
    } else if (grouped === "." && (points > 1 || commas))
      plain = mantissa.replaceAll(".", "").replace(",", ".");
    else if (commas + points <= 1) plain = mantissa.replace(",", ".");
    else
      throw new Unreadable(
        `${quoted(mantissa)} is not a number: it has points or commas in more than one place.`,
      );
    return Number(`${plain}e${power}`);
  }

  /** Consume a pattern at the beginning of the remaining text, and the space after it. @param {RegExp} pattern */
  matched(pattern) {
    const match = pattern.exec(this.rest);
    if (match) this.rest = this.rest.slice(match[0].length).trimStart();
    return match;
  }

  /** @param {RegExp} pattern */
  taken(pattern) {
    return this.matched(pattern)?.[0] ?? "";
  }
}

/** Return the spellings of a field's units, each with its unit, longest first. @param {Field} field @returns {[string, string][]} */
function spellingsOf({ factors, spoken, percent }) {
  const units = Object.keys(factors);
  /** @type {[string, string][]} */
  const spellings = units.flatMap((unit) =>
    [
      unit,
      unit.replaceAll(" ", ""),
      unit.replaceAll(" ", "·"),
      unit.replace("^2", "²").replace("^3", "³"),
    ].map((one) => /** @type {[string, string]} */ ([one, unit])),
  );
  for (const [spelling, unit] of Object.entries({ ...SPELLINGS, ...spoken }))
    if (unit in factors) spellings.push([spelling, unit]);
  if (percent) spellings.push(["%", "%"]);
  return spellings.sort(([one], [other]) => other.length - one.length);
}

/** Return a number as text without rounding noise. @param {number} value */
function tidy(value) {
  return String(Number(value.toPrecision(12)));
}

/** Return typed text quoted for a sentence. @param {string} text */
function quoted(text) {
  return `"${text.trim()}"`;
}
