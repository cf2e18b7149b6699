"""Linear requirements on dimensions and extra variables that exclude each other within the ranges.

For either sign of the offset, a linear programme in crank, rod, |offset| and extra variables decides whether some point
meets them all. Full rotation, rod >= crank + |offset|, is one of its rows.

Options of choices are excluded if no design can have them.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from ...model.errors import InfeasibleError, InputError
from ...objectives.formula.expression import Call, Linear, linear_form_of_unknown
from ...objectives.formula.quantity import FormulaQuantity, linear_equation_of
from ..problem.problem import Problem
from ..search.elimination import offset_signs
from ..search.linear_rules import in_terms_of_offset_magnitude, linear_equations
from .mistake_messages import key_of_location
from .reachable_values import SLACK, Box

_UNIT = 1e3  # lengths in mm: the solver's tolerance is 1e-7 of its unit
_ANY: dict[str, tuple[float, float]] = {"crank": (1e-6, math.inf), "rod": (1e-6, math.inf), "offset": (0.0, math.inf)}
"""Ranges, m, that no job can exceed."""
_NONE = 2
"""Status of `linprog` if no point meets all rows."""


@dataclass(frozen=True)
class _Row:
    """A requirement as a sum that is zero (`exact`) or at most zero. name: its quantity."""

    name: str
    sum: Linear
    exact: bool


def require_compatible_linear_requirements(problem: Problem) -> None:
    """Raise InfeasibleError, naming the requirements, if no point within the ranges meets all linear ones."""
    is_possible: dict[tuple[object, ...], bool] = {}
    parts = problem.parts()
    for part in parts:
        sides = [(sign, *_linear_rows(part, sign)) for sign, _ in offset_signs(part)]
        if not sides or any(not rows for _, rows, _ in sides):
            return
        for sign, rows, ends in sides:
            key = (sign, tuple(rows), tuple(ends.items()))
            if key not in is_possible:
                is_possible[key] = _has_common_point(rows, ends, turning=problem.motion is None)
            if is_possible[key]:
                return
    raise InfeasibleError(_conflict_text(parts[0]))


def _conflict_text(part: Problem) -> str:
    """Describe a small set of requirements that exclude each other on either sign of the offset."""
    sides = [_linear_rows(part, sign) for sign, _ in offset_signs(part)]
    names = list(dict.fromkeys(row.name for rows, _ in sides for row in rows))
    for name in list(names):
        fewer = [rest for rest in names if rest != name]
        if fewer and not any(
            _has_common_point([row for row in rows if row.name in fewer], ends, turning=part.motion is None)
            for rows, ends in sides
        ):
            names = fewer
    first = f"constraints.{key_of_location([names[0]])}"
    constraints = {item.quantity: item for item in part.constraints}
    bounds = []
    for name in names:
        unit = part.quantity(name).unit
        bounds += [
            f"{name} {word} {bound * unit.factor:.6g} {unit.symbol}".rstrip() for word, bound in constraints[name].sides
        ]
    side = part.slow_side()
    side_text = (
        "" if side is None else f"; constraints.slow_stroke keeps the offset {'above' if side > 0.0 else 'below'} 0"
    )
    ever = any(
        _has_common_point([row for row in rows if row.name in names], ends | _ANY, turning=part.motion is None)
        for rows, ends in sides
    )
    if len(names) == 1:
        remedy = "widen the ranges" if ever else "no range can change that; leave it out"
        return f"{first}: no crank, rod and offset within the ranges meet it; got {bounds[0]}; {remedy}{side_text}"
    remedy = "leave out one of them, or widen the ranges" if ever else "no range can change that; leave out one of them"
    return (
        f"{first}: together the requirements must leave some crank, rod and offset within the ranges; got "
        f"{' and '.join(bounds)}, which exclude each other; {remedy}{side_text}"
    )


def _linear_rows(part: Problem, sign: float) -> tuple[list[_Row], dict[str, tuple[float, float]]]:
    """Return the linear requirements for one sign of the offset, and the ranges."""
    sizes = next(sizes for side, sizes in offset_signs(part) if side == sign)
    ends = {
        "crank": (part.crank.lower, part.crank.upper),
        "rod": (part.rod.lower, part.rod.upper),
        "offset": (sizes.lower, sizes.upper),
    } | {item.name: (item.lower, item.upper) for item in part.mechanism.varying}
    equalities = {
        part.quantity(item.quantity): float(item.lower)
        for item in part.constraints
        if item.equality and item.lower is not None
    }
    rows = [_Row(name, row, True) for name, row in linear_equations(equalities, sign).items()]
    return [*rows, *_formula_bounds(part, sign)], ends


def _formula_bounds(part: Problem, sign: float) -> Iterator[_Row]:
    """Yield the bounds on linear formulas; quotients would need the sign of their divisors."""
    for item in part.constraints:
        quantity = part.quantity(item.quantity)
        if item.equality or not isinstance(quantity, FormulaQuantity):
            continue
        if isinstance(quantity.expression, Call) and quantity.expression.function == "/":
            continue
        for word, bound in item.sides:
            row = linear_equation_of(quantity, bound)
            if row is not None:
                row = in_terms_of_offset_magnitude(row, sign)
                yield _Row(quantity.name, row if word == "max" else row.multiplied_by(Fraction(-1)), False)


def _has_common_point(rows: Sequence[_Row], ends: dict[str, tuple[float, float]], *, turning: bool) -> bool:
    """Return whether some point within the ranges meets all rows, as far as a linear programme can tell."""
    from scipy.optimize import linprog

    turned = (
        linear_form_of_unknown("crank")
        .plus_multiple_of(linear_form_of_unknown("offset"))
        .plus_multiple_of(linear_form_of_unknown("rod"), Fraction(-1))
    )
    every = [*rows, _Row("", turned, False)] if turning else list(rows)
    table = np.array([[float(dict(row.sum.factors).get(name, 0)) for name in ends] for row in every])
    size = np.maximum(np.abs(table).max(axis=1), 1e-300)
    table, right_sides = table / size[:, None], -_UNIT * np.array([float(row.sum.constant) for row in every]) / size
    exact = np.array([row.exact for row in every])
    solution = linprog(
        np.zeros(len(ends)),
        A_ub=table[~exact],
        b_ub=right_sides[~exact],
        A_eq=table[exact],
        b_eq=right_sides[exact],
        bounds=[(_UNIT * low, _UNIT * high) for low, high in ends.values()],
    )
    return bool(solution.status != _NONE)


_MOST = 5  # combinations to report one by one


def require_possible_option(problem: Problem) -> None:
    """Raise InfeasibleError if no combination of options can have a design."""
    impossible = impossible_options(problem)
    if problem.variants and len(impossible) == len(problem.variants):
        label, why = impossible[0]
        raise InfeasibleError(
            f"choice: at least one option must have a design within the ranges; none has: for {label} {why}; widen "
            "the ranges, relax the constraints, or add another option"
        )


def impossible_option_notes(problem: Problem) -> list[str]:
    """Describe which combinations of options no design can have, and why."""
    impossible = [*problem.left_out, *impossible_options(problem)]
    left_over = f", and {len(impossible) - _MOST} more" if len(impossible) > _MOST else ""
    reasons = "; ".join(f"{label}: {why}" for label, why in impossible[:_MOST])
    return [f"the front omits options without any design: {reasons}{left_over}"] if impossible else []


def impossible_options(problem: Problem) -> list[tuple[str, str]]:
    """Return labels of combinations of options that no design can have, each with the reason."""
    return [
        (", ".join(variant.labels) or f"combination {place + 1}", why)
        for place, variant in enumerate(problem.variants)
        if (why := next(_impossibility_reasons(problem, place), None))
    ]


def _impossibility_reasons(problem: Problem, variant: int) -> Iterator[str]:
    try:
        part = problem.part(variant)
    except InputError as error:  # requirements exclude each other
        yield str(error)
        return
    if part.motion is not None:
        return
    box = Box.from_problem(part)
    if not box.may_rotate_fully:
        yield "no rod in its range exceeds crank + |offset|"
        return
    for constraint in part.constraints:
        quantity = part.quantity(constraint.quantity)
        if part.common_bounds(quantity) is None or not quantity.depends_only_on_dimensions:
            continue
        least, greatest = box.bounds_on_quantity(quantity)
        rounding = SLACK * max(abs(least), abs(greatest))
        unit = quantity.unit
        for word, bound in constraint.sides:
            exceeds = word != "max" and bound > greatest + rounding, word != "min" and bound + rounding < least
            if any(exceeds):
                end = f"{(greatest if exceeds[0] else least) * unit.factor:.6g} {unit.symbol}".rstrip()
                bound_text = f"{bound * unit.factor:.6g} {unit.symbol}".rstrip()
                side = "at most" if exceeds[0] else "at least"
                yield f"{quantity.title} {word} {bound_text}, where {side} {end} is possible"
