"""Linear equalities between dimensions, each solved for one of them, in exact fractions."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from ...objectives.formula.linear import SIZE, Linear, linear_unknown
from ...objectives.formula.quantity import FormulaQuantity, equation_of
from ...objectives.proportions import ROD_TO_CRANK, ROD_TO_OFFSET
from ...objectives.quantity import Quantity
from ...objectives.transmission_angle import TRANSMISSION_ANGLE


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
        equation = equation_of(quantity, value) if isinstance(quantity, FormulaQuantity) else None
        if equation is not None:
            equations[quantity.name] = with_offset_size(equation, sign)
    if not equations:
        return {}
    for quantity, value in required.items():
        proportion = _linear_proportion(quantity, value)
        if proportion is not None:
            equations[quantity.name] = proportion
    return equations


def with_offset_size(row: Linear, sign: float) -> Linear:
    """Return an equality in terms of |offset|, given the sign of the offset."""
    size = Linear((("offset", Fraction(1)),), Fraction(0))
    rewritten = Linear((), row.constant)
    for name, factor in row.factors:
        if name == "offset":
            rewritten = rewritten.plus(size, Fraction(int(sign)) * factor)
        else:
            rewritten = rewritten.plus(size if name == SIZE else linear_unknown(name), factor)
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
        solved = _solve_for(rows, targets)
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
    rod, crank, offset = linear_unknown("rod"), linear_unknown("crank"), linear_unknown("offset")
    if quantity.name == ROD_TO_OFFSET.name:
        return rod.plus(offset, -Fraction(value))
    if quantity.name == ROD_TO_CRANK.name:
        return rod.plus(crank, -Fraction(value))
    if quantity.name == TRANSMISSION_ANGLE.name:
        return crank.plus(offset).plus(rod, -Fraction(math.cos(value)))
    return None


def _eliminate_name(row: Linear, pivot: Linear, name: str) -> Linear:
    """Return an equality minus the multiple of another one that eliminates a name."""
    factor = dict(row.factors).get(name)
    return row if factor is None else row.plus(pivot, -factor / dict(pivot.factors)[name])


def _solve_for(rows: Sequence[Linear], targets: Sequence[str]) -> tuple[Linear, ...] | None:
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
