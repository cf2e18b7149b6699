import assert from "node:assert/strict";
import { test } from "node:test";

import { parsed } from "../../../../../service/page/static/help/formula.js";
import { draws } from "../draws.mjs";

/** Return parts in one line: a/b of fractions in square brackets, words in quotes. */
function line(parts) {
  const one = ({ tag, text, parts: inner = [], prose }) => {
    if (text !== undefined) return prose ? `"${text}"` : text;
    if (tag === "mrow") return inner.map(one).join(" ");
    return `${tag}[${inner.map(one).join(", ")}]`;
  };
  return parts.map(one).join(" ");
}

test("formulas of the help are set as they are meant", () => {
  const known = {
    "cos(mu_min) = (r + |e|) / l": "cos ( msub[μ, min] ) = mfrac[r + | e |, l]",
    "S = sqrt((l+r)^2 - e^2)": "S = msqrt[msup[( l + r ), 2], −, msup[e, 2]]",
    "mean of |P| |omega| / (2 b) over the angle":
      '"mean" "of" mfrac[| P | | ω |, 2 b] "over" "the" "angle"',
    "(p_h / p_l)^(1/n_e) - 1": "msup[( mfrac[msub[p, h], msub[p, l]] ), mfrac[1, msub[n, e]]] − 1",
    "x''' omega^3 + 3 x'' alpha": "x ′′′ msup[ω, 3] + 3 x ′′ α",
    "max |B_x| / max |B|": "mfrac[max | msub[B, x] |, max | B |]",
    "sum of V_c / sum of A S": '"sum" "of" msub[V, c] / "sum" "of" A S',
    "180 deg +- dx/di T_i": "180 ° ± mfrac[dx, di] msub[T, i]",
    "or Johnson's parabola": '"or" "Johnson\'s" "parabola"',
    "max F / (D d)": '"max" mfrac[F, D d]',
  };
  for (const [text, wanted] of Object.entries(known))
    assert.equal(line(parsed(text)), wanted, text);
});

test("no symbol of a formula is lost or changes its place", () => {
  const drawn = draws(17);
  const expression = (depth) => {
    if (depth === 0) return drawn.one(["r", "l_1", "2", "e", "x'", "T_i"]);
    const [one, other] = [expression(depth - 1), expression(depth - 1)];
    return drawn.one([
      `(${one} + ${other})`,
      `(${one} - ${other})`,
      `sqrt(${one})`,
      `sin(${one})`,
      `(${one}) / (${other})`,
      `${one} ${other}`,
      `(${one})^2`,
    ]);
  };
  const letters = (parts) =>
    parts.flatMap(({ text, parts: inner = [] }) =>
      text === undefined ? letters(inner) : /^[a-zA-Z0-9]+$/.test(text) ? [text] : [],
    );
  for (let n = 0; n < 300; n += 1) {
    const text = expression(drawn.whole(1, 4));
    const wanted = text.match(/[A-Za-z]+|\d/g).filter((token) => token !== "sqrt");
    assert.deepEqual(letters(parsed(text)), wanted, text);
  }
});

test("what is no formula is shown all the same", () => {
  for (const text of ["", "/", "1 /", "(", ")", "|", "^", "a / of b", "x ^"])
    assert.ok(Array.isArray(parsed(text)), text);
});
