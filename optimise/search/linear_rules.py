"""Rules that compute an unknown of a design from others, so that a requirement holds exactly.

Linear equalities between dimensions are solved for one of them, in exact fractions. Lengths that give a swing its exact
travel, or its exact crank angle, have a closed form. A pin at a rod's length from two points lies on their
perpendicular bisector. For the travel S between two crank angles, the slider pin at the start is as far from the crank
pin there as from the crank pin at the end, moved back by S. For the angle between two slider positions, the crank pin
at the start is as far from the slider pin there as from the slider pin at the end, rotated back by the angle.
"""

from __future__ import annotations

import itertools
import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import numpy as np

from ...model.swing.end_angles import swing_start_column
from ...objectives.force_transmission import TRANSMISSION_ANGLE
from ...objectives.formula.expression import SIZE, Linear, linear_form_of_unknown
from ...objectives.formula.quantity import FormulaQuantity, linear_equation_of
from ...objectives.lengths_and_time_ratio import ROD_TO_CRANK, ROD_TO_OFFSET
from ...objectives.quantity import Quantity
from ...objectives.swing_quantities import ACTUATOR_TRAVEL, SWING_ANGLE
from ..problem.problem import Problem


@dataclass(frozen=True)
class Rule(ABC):
    """A way to compute an unknown: `target` from `sources`. origin: its requirements, joined by "+".

    values: values of the requirements.
    """

    origin: str
    target: str
    sources: tuple[str, ...]
    values: tuple[float, ...]

    @abstractmethod
    def formula(self, *known: Any) -> Any:
        """Return the target computed from the sources."""

    @property
    def solutions(self) -> tuple[Rule, ...]:
        """Return one rule for each solution of its equation; each has a separate branch."""
        return (self,)


@dataclass(frozen=True)
class Block:
    """Equalities solved for some unknowns, the targets. origins: all equalities, including redundant ones.

    rows: for each target, a sum that is zero; the target's own factor is not zero, but those of the other targets are.
    """

    origins: tuple[str, ...]
    targets: tuple[str, ...] = ()
    rows: tuple[Linear, ...] = ()


NOTHING = Block(())


def linear_equations(required: Mapping[Quantity, float], sign: float) -> dict[str, Linear]:
    """Return the equalities that are linear in crank, rod, |offset| and extra variables, as sums that are zero.

    required: quantities with their values. sign: sign of the offset. Empty if none of them is a formula, because
    proportions alone have their own rules.
    """
    equations: dict[str, Linear] = {}
    for quantity, value in required.items():
        equation = linear_equation_of(quantity, value) if isinstance(quantity, FormulaQuantity) else None
        if equation is not None:
            equations[quantity.name] = in_terms_of_offset_magnitude(equation, sign)
    if not equations:
        return {}
    for quantity, value in required.items():
        proportion = _linear_proportion(quantity, value)
        if proportion is not None:
            equations[quantity.name] = proportion
    return equations


def in_terms_of_offset_magnitude(row: Linear, sign: float) -> Linear:
    """Return an equality in terms of |offset|, given the sign of the offset."""
    size = Linear((("offset", Fraction(1)),), Fraction(0))
    rewritten = Linear((), row.constant)
    for name, factor in row.factors:
        if name == "offset":
            rewritten = rewritten.plus_multiple_of(size, Fraction(int(sign)) * factor)
        else:
            rewritten = rewritten.plus_multiple_of(size if name == SIZE else linear_form_of_unknown(name), factor)
    return rewritten


def equation_blocks(equations: Mapping[str, Linear], loose: Sequence[str]) -> Iterator[Block]:
    """Yield every way to solve equalities for loose unknowns; one without targets if there is none.

    Equalities that contradict earlier ones are omitted everywhere, because the check of the problem reports them.
    """
    origins, rows, reduced = list[str](), list[Linear](), list[Linear]()
    for name, row in equations.items():
        left = row
        for reduced_row in reduced:
            left = _eliminate_name(left, reduced_row, next(n for n in reduced_row.names if n in loose))
        if any(n in loose for n in left.names):
            reduced = [
                _eliminate_name(reduced_row, left, next(n for n in left.names if n in loose)) for reduced_row in reduced
            ] + [left]
            rows.append(row)
        elif left.factors or left.constant:
            continue  # it has no loose unknown, or is a contradiction
        origins.append(name)
    if not rows:
        yield NOTHING
        return
    for targets in itertools.combinations(loose, len(rows)):
        solved = _solve_rows_for_targets(rows, targets)
        if solved is not None:
            yield Block(tuple(origins), targets, solved)


def solve_for_target(row: Linear, target: str) -> tuple[tuple[str, ...], tuple[float, ...]]:
    """Return a target's sources, and the numbers for `evaluate_linear_rule`: factors, constant and divisor."""
    factors = dict(row.factors)
    divisor = factors.pop(target)
    numbers = [*(-factor for factor in factors.values()), -row.constant, divisor]
    return tuple(factors), tuple(float(number) for number in numbers)


def evaluate_linear_rule(*numbers: Any) -> Any:
    """Return a target from the numbers of `solve_for_target`, followed by its sources."""
    count = (len(numbers) - 2) // 2
    *factors, constant, divisor = numbers[: count + 2]
    total: Any = 0.0
    for place, (factor, source) in enumerate(zip(factors, numbers[count + 2 :], strict=True)):
        total = factor * source if not place else total + factor * source
    return (total + constant if constant or not factors else total) / divisor


def _linear_proportion(quantity: Quantity, value: float) -> Linear | None:
    """Return a proportion as a linear equality; None for any other quantity."""
    rod, crank, offset = (
        linear_form_of_unknown("rod"),
        linear_form_of_unknown("crank"),
        linear_form_of_unknown("offset"),
    )
    if quantity.name == ROD_TO_OFFSET.name:
        return rod.plus_multiple_of(offset, -Fraction(value))
    if quantity.name == ROD_TO_CRANK.name:
        return rod.plus_multiple_of(crank, -Fraction(value))
    if quantity.name == TRANSMISSION_ANGLE.name:
        return crank.plus_multiple_of(offset).plus_multiple_of(rod, -Fraction(math.cos(value)))
    return None


def _eliminate_name(row: Linear, pivot: Linear, name: str) -> Linear:
    """Return an equality minus the multiple of another one that eliminates a name."""
    factor = dict(row.factors).get(name)
    return row if factor is None else row.plus_multiple_of(pivot, -factor / dict(pivot.factors)[name])


def _solve_rows_for_targets(rows: Sequence[Linear], targets: Sequence[str]) -> tuple[Linear, ...] | None:
    """Return the equalities with one target in each; None if they do not determine the targets."""
    left, solved = list(rows), list[Linear]()
    for target in targets:
        place = next((n for n, row in enumerate(left) if target in row.names), None)
        if place is None:
            return None
        pivot = left.pop(place)
        left = [_eliminate_name(row, pivot, target) for row in left]
        solved = [_eliminate_name(row, pivot, target) for row in solved] + [pivot]
    return tuple(solved)


@dataclass(frozen=True)
class SwingRule(Rule):
    """A rule of a swing. solve: its formula. root: index of its solution among `roots`."""

    solve: Callable[..., Any]
    roots: int
    root: int = 0

    def formula(self, *known: Any) -> Any:
        """Return the target computed from the sources."""
        return self.solve(self.root, *self.values, *known)

    @property
    def solutions(self) -> tuple[Rule, ...]:
        """Return the rule for each of its roots."""
        return tuple(replace(self, root=root) for root in range(self.roots))


def swing_rules(problem: Problem, required: Mapping[str, float], sign: float) -> Iterator[Rule]:
    """Yield the rules for the equalities of a swing. required: their values. sign: sign of the offset."""
    motion = problem.motion
    if motion is None:
        return
    column = swing_start_column(problem.mechanism)
    free = () if column is None else (problem.mechanism.varying[column - 3].name,)
    swing_values = (sign, motion.start, motion.end, float(motion.follows))
    travel, angle = ACTUATOR_TRAVEL.name, SWING_ANGLE.name
    if motion.stated_for == "crank" and travel in required:
        numbers = (required[travel], *swing_values)
        yield SwingRule(travel, "rod", ("crank", "offset", *free), numbers, _rod_from_travel, 2)
        yield SwingRule(travel, "offset", ("crank", "rod", *free), numbers, _offset_from_travel, 4)
    if motion.stated_for == "slider" and angle in required:
        numbers = (required[angle], *swing_values)
        yield SwingRule(angle, "crank", ("rod", "offset", *free), numbers, _crank_from_swing_angle, 4)
        yield SwingRule(angle, "rod", ("crank", "offset", *free), numbers, _rod_from_swing_angle, 4)


def _swing_ends(start: float, end: float, follows: float, free: tuple[Any, ...]) -> tuple[Any, Any]:
    first = free[0] if free else start
    return first, first + (end - start) if follows else end


def _root_signs(root: int) -> tuple[float, float]:
    """Return the two signs that a root stands for: of the direction, and of the solution."""
    return (1.0, -1.0)[root % 2], (1.0, -1.0)[root // 2]


def _crank_pins_less_travel(root: int, travel: float, ends: tuple[Any, Any], r: Any) -> tuple[Any, Any, Any, Any]:
    """Return the crank pin at the start, and at the end moved back by the travel."""
    first, last = ends
    way = _root_signs(root)[0]
    return r * np.cos(first), r * np.sin(first), r * np.cos(last) - way * travel, r * np.sin(last)


def _rod_from_travel(
    root: int, travel: float, sign: float, start: float, end: float, follows: float, r: Any, a: Any, *free: Any
) -> Any:
    x_0, y_0, x_1, y_1 = _crank_pins_less_travel(root, travel, _swing_ends(start, end, follows, free), r)
    e = sign * a
    x = 0.5 * (x_1 + x_0) + 0.5 * (y_1 - y_0) * (y_1 + y_0 - 2.0 * e) / (x_1 - x_0)
    return np.sqrt((x_0 - x) ** 2 + (y_0 - e) ** 2)


def _offset_from_travel(
    root: int, travel: float, sign: float, start: float, end: float, follows: float, r: Any, l: Any, *free: Any
) -> Any:
    x_0, y_0, x_1, y_1 = _crank_pins_less_travel(root, travel, _swing_ends(start, end, follows, free), r)
    square = (x_1 - x_0) ** 2 + (y_1 - y_0) ** 2
    away = _root_signs(root)[1] * np.sqrt(l * l / square - 0.25)
    return sign * (0.5 * (y_0 + y_1) + away * (x_1 - x_0))


def _bisector_of_slider_pins(root: int, angle: float, ends: tuple[Any, Any], e: Any) -> tuple[Any, Any, Any, Any]:
    """Return a point and the direction of the bisector between the slider pin's start and its turned-back end."""
    first, last = ends
    turn = _root_signs(root)[0] * angle
    cosine, sine = np.cos(turn), np.sin(turn)
    x_1, y_1 = cosine * last + sine * e, cosine * e - sine * last
    return 0.5 * (first + x_1), 0.5 * (e + y_1), e - y_1, x_1 - first


def _crank_from_swing_angle(
    root: int, angle: float, sign: float, start: float, end: float, follows: float, l: Any, a: Any, *free: Any
) -> Any:
    x, y, u, v = _bisector_of_slider_pins(root, angle, _swing_ends(start, end, follows, free), sign * a)
    away = _root_signs(root)[1] * np.sqrt(l * l / (u * u + v * v) - 0.25)
    return np.sqrt((x + away * u) ** 2 + (y + away * v) ** 2)


def _rod_from_swing_angle(
    root: int, angle: float, sign: float, start: float, end: float, follows: float, r: Any, a: Any, *free: Any
) -> Any:
    x, y, u, v = _bisector_of_slider_pins(root, angle, _swing_ends(start, end, follows, free), sign * a)
    square = u * u + v * v
    projection = (x * u + y * v) / square
    away = -projection + _root_signs(root)[1] * np.sqrt(projection * projection + (r * r - x * x - y * y) / square)
    return np.sqrt(square * (away * away + 0.25))
