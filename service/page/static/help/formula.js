/** Typeset formulas: converts plain text from the help, such as "cos(mu_min) = (r + |e|) / l", to MathML. */

import { h, mathml } from "../lib/dom.js";

/**
 * Part of a formula: a MathML element with text or parts. prose: words between symbols, which cannot be part of a fraction.
 * @typedef {{ tag: string, text?: string, parts?: Part[], prose?: boolean }} Part
 */

const GREEK = new Map(
  Object.entries({
    alpha: "α",
    eta: "η",
    mu: "μ",
    omega: "ω",
    phi: "φ",
    pi: "π",
    psi: "ψ",
    rho: "ρ",
    sigma: "σ",
    theta: "θ",
    dtheta: "dθ",
  }),
);
const FUNCTIONS = new Set([
  "sqrt",
  "sin",
  "cos",
  "asin",
  "acos",
  "arcsin",
  "arctan",
  "max",
  "min",
  "sgn",
]);
const SIGNS = new Map(Object.entries({ "+-": "±", "-": "−", deg: "°" }));
const TOKEN = /\s*(\+-|\d+(?:\.\d+)?|[A-Za-z]+(?:_[A-Za-z]+)?(?:'s\b|'+)?|[^\sA-Za-z\d])/y;

const SYMBOL_ON_LEFT = /^(?:cos\()?([A-Z]|mu_\w+)\)? = /;
/** @type {Record<string, [string, string | null]>} */
const SYMBOLS = {
  r: ["crank", "crank"],
  l: ["rod", "rod"],
  e: ["offset", "offset"],
  T: ["drive torque", null],
  T_m: ["motor torque", null],
  T_g: ["torque through the gear, at the crank", null],
  T_r: ["rated torque of the motor", null],
  J_f: ["inertia of the flywheel", null],
  J_m: ["inertia of the rotor", null],
  i: ["gear ratio", null],
  eta: ["efficiency of the gear", null],
  eta_b: ["efficiency of the gear while the motor brakes", null],
  theta: ["crank angle", null],
  phi: ["angle of the rod", null],
  omega: ["crank speed", null],
  alpha: ["crank acceleration", null],
  "x'": ["derivative of the slider position with respect to the crank angle", null],
  x_out: ["slider position at the outer dead centre", null],
};

/** Return a formula with typeset symbols and with words as text, which may wrap. @param {string} text */
export function formula(text) {
  /** @type {(string | Part[])[]} */
  const pieces = [];
  for (const part of parsed(text)) {
    const last = pieces.at(-1);
    if (part.prose || /^[,:;]$/.test(part.text ?? "")) pieces.push(part.text ?? "");
    else if (Array.isArray(last)) last.push(part);
    else pieces.push([part]);
  }
  return h(
    "span",
    { class: "formula" },
    pieces.map((piece, place) => [
      place && !(typeof piece === "string" && /^[,:;]$/.test(piece)) ? " " : "",
      typeof piece === "string" ? piece : drawn({ tag: "math", parts: piece }),
    ]),
  );
}

/**
 * Return the standard symbols in a formula: [symbol, meaning, quantity].
 * @param {string} text @param {readonly { name: string, title: string, formula: string }[]} quantities @returns {[MathMLElement, string, string | null][]}
 */
export function symbolsOf(text, quantities) {
  /** @type {typeof SYMBOLS} */
  const symbols = { ...SYMBOLS };
  for (const { name, title, formula: own } of quantities) {
    const symbol = SYMBOL_ON_LEFT.exec(own)?.[1];
    if (symbol) symbols[symbol] ??= [title, name];
  }
  const names = [
    ...new Set(
      tokensOf(text).map((token) =>
        token in symbols
          ? token
          : token.replace(/'+$/, (primes) => (token.startsWith("x") && primes ? "'" : "")),
      ),
    ),
  ];
  return names
    .filter((name) => name in symbols)
    .map((name) => [drawn({ tag: "math", parts: parsed(name) }), ...symbols[name]]);
}

/** Return the parts of a formula. @param {string} text @returns {Part[]} */
export function parsed(text) {
  const tokens = tokensOf(text);
  let place = 0;
  const next = () => tokens[place];
  /** @param {string} closing @returns {Part[]} */
  const sum = (closing) => {
    /** @type {Part[]} */
    const parts = [];
    while (place < tokens.length && next() !== closing) {
      const token = next();
      if (token === "/") {
        place += 1;
        parts.push(...fraction(parts, closing));
      } else if (/^[-+=,:;)]$|^\+-$/.test(token)) {
        place += 1;
        parts.push({ tag: "mo", text: SIGNS.get(token) ?? token });
      } else parts.push(factor());
    }
    return parts;
  };
  /** Parse a factor and its exponent. @returns {Part} */
  const factor = () => {
    const base = single();
    if (next() !== "^") return base;
    place += 1;
    const over = single();
    return {
      tag: "msup",
      parts: [
        base,
        over.tag === "mrow" && over.parts?.[0]?.text === "(" ? row(over.parts.slice(1, -1)) : over,
      ],
    };
  };
  /** @returns {Part} */
  const single = () => {
    const token = tokens[place++] ?? "";
    if (token === "(" || token === "|") return bracketed(token);
    if (/^\d/.test(token)) return { tag: "mn", text: token };
    if (SIGNS.has(token)) return { tag: "mo", text: SIGNS.get(token) };
    if (FUNCTIONS.has(token)) return applied(token);
    return symbol(token);
  };
  /** @param {string} opening */
  const bracketed = (opening) => {
    const closing = opening === "(" ? ")" : "|";
    const inner = sum(closing);
    place += 1;
    return row([{ tag: "mo", text: opening }, ...inner, { tag: "mo", text: closing }]);
  };
  /** @param {string} name @returns {Part} */
  const applied = (name) => {
    const opening = next();
    if (opening !== "(" && opening !== "|") return { tag: "mi", text: name, prose: true };
    place += 1;
    const inner = bracketed(opening);
    return name === "sqrt"
      ? { tag: "msqrt", parts: inner.parts?.slice(1, -1) }
      : row([{ tag: "mi", text: name }, inner]);
  };
  /**
   * Make a fraction of the part before a slash and the part after it: only symbols, no words.
   * @param {Part[]} before @param {string} closing @returns {Part[]}
   */
  const fraction = (before, closing) => {
    let from = before.length;
    while (from > 0 && before[from - 1].tag !== "mo" && !before[from - 1].prose) from -= 1;
    /** @type {Part} */
    const stroke = { tag: "mo", text: "/" };
    if (place >= tokens.length || next() === closing) return [stroke];
    const below = factor();
    if (below.prose || from === before.length) return [stroke, below];
    return [{ tag: "mfrac", parts: [row(before.splice(from)), below].map(bare) }];
  };
  return sum("");
}

/** @param {string} text @returns {string[]} */
function tokensOf(text) {
  /** @type {string[]} */
  const tokens = [];
  TOKEN.lastIndex = 0;
  for (let match = TOKEN.exec(text); match; match = TOKEN.exec(text)) tokens.push(match[1]);
  return tokens;
}

/** Return a name: a symbol with its index and its primes, or a word. @param {string} token @returns {Part} */
function symbol(token) {
  const [, name, index, primes = ""] = /^([A-Za-z]+)(?:_([A-Za-z]+))?('+)?$/.exec(token) ?? [];
  const letterName =
    name &&
    (GREEK.get(name) ?? (index || name.length === 1 || /^d[a-zA-Z]$/.test(name) ? name : null));
  if (!letterName || (letterName === "a" && !index))
    return { tag: "mtext", text: token, prose: true };
  /** @type {Part} */
  const letter = { tag: "mi", text: letterName };
  /** @type {Part[]} */
  const primed = primes ? [{ tag: "mo", text: "′".repeat(primes.length) }] : []; // which is raised anyway
  if (!index) return row([letter, ...primed]);
  /** @type {Part} */
  const below =
    GREEK.has(index) || index.length === 1
      ? { tag: "mi", text: GREEK.get(index) ?? index }
      : { tag: "mtext", text: index };
  return row([{ tag: "msub", parts: [letter, below] }, ...primed]);
}

/** @param {Part[]} parts @returns {Part} */
function row(parts) {
  return parts.length === 1 ? parts[0] : { tag: "mrow", parts };
}

/** Return a part without outer brackets, which a fraction makes redundant. @param {Part} part */
function bare(part) {
  return part.tag === "mrow" && part.parts?.[0]?.text === "(" ? row(part.parts.slice(1, -1)) : part;
}

/** @param {Part} part @returns {MathMLElement} */
function drawn({ tag, text, parts = [] }) {
  return mathml(
    tag,
    {},
    text ?? parts.map((part, place) => drawn(spacedPart(part, parts[place - 1], parts[place + 1]))),
  );
}

/**
 * Return a part with the space that words need beside symbols.
 * @param {Part} part @param {Part | undefined} before @param {Part | undefined} after
 */
function spacedPart(part, before, after) {
  if (!part.prose) return part;
  const [left, right] = [
    before && before.text !== "(" && before.text !== "|",
    after && !/^[,:;)|]$/.test(after.text ?? ""),
  ];
  return {
    ...part,
    tag: "mtext",
    text: `${left && !before?.prose ? "\u00a0" : ""}${part.text}${right ? "\u00a0" : ""}`,
  };
}
