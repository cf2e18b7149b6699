"""Designs with round numbers near a front's design: the best ones that meet every requirement, or the nearest.

Numbers are not rounded one by one: every combination of multiples of a step around the design is judged exactly.
Combinations that meet all requirements, ranges and full rotation are ranked by their greatest loss in an objective,
relative to its range over the front. Dominated ones are omitted.
"""

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from ...model.arrays import Array
from ...model.checks import is_integer, is_number
from ...model.errors import InputError, number_in_si_and_usual_unit
from ...model.linkage.dimensions import DIMENSIONS
from ...objectives.kinds import LENGTH, SMALL_LENGTH
from ...objectives.quantity import Quantity
from ...objectives.units import quote, to_si
from ..problem.constraint_violation import FEASIBLE, constraints_with_floors
from ..problem.problem import Problem
from ..problem.requirements import Constraint, Range
from .rounded_design import Rounded
from .rounding_search import RoundingSearch, Steps, design_number_text
from .saved_front import column_ranges

_SMALLEST = 1e-9  # relative to the greatest number in a range: a smaller step is rounding
_LARGE = 0.1  # relative to a bound: a greater miss without a unit was probably meant in another unit
_PERCENT = re.compile(r"\s*(\d+(?:\.\d*)?|\.\d+)\s*%\s*")


def round_design(
    part: Problem,
    given: Array,
    span: Array,
    to: float | Mapping[str, float],
    *,
    count: int = 5,
    allow: Mapping[str, float | str] | None = None,
    notes: Sequence[str],
) -> Steps[Rounded]:
    """Return the best designs with round numbers near a given one; if none meets all requirements, the nearest.

    If the best loses more than 1 % of a range and fewer than `count` meet all requirements, further designs follow.
    They miss a requirement by at most 1 % of its bound and lose at least a quarter less.

    If none does, the first is the design whose greatest relative deviation is least. A deviation is a value's
    distance beyond a bound plus the allowed deviation, divided by the bound. Among equal deviations, the least loss
    comes first, then the least distance in steps from the given design. Next come those that miss more but lose at
    least a quarter less than the previous one, until nothing is lost.

    part: a problem without choices. given: (3 + v,), its design. span: (m,), unit of each objective's loss. to: one
    step for crank, rod and offset, m, or steps by name, SI, also for extra variables; numbers that are fixed or have no
    step stay unchanged. allow: allowed deviations of requirements, by quantity: a number in SI, or "0.1 mm". notes:
    notes to add to those of the answer. Yields a `Stage` several times a second; closing it ends the search.

    Raises `InputError` for a step that is not positive or has no multiple within the range, an unknown name, a
    deviation that cannot be allowed, or a count below one.
    """
    if not is_integer(count) or count < 1:
        raise InputError(f"count must be a whole number of 1 or more; got {count!r}")
    allowed = _allowed_misses(part, allow or {})
    moved, remarks = _steps_of_movable_numbers(part, given, _rounding_steps(to, part))
    search = RoundingSearch(part, given, span, moved, allowed)
    best = yield from search.best_designs(int(count))
    return Rounded(
        problem=part,
        design=given,
        steps=moved,
        allowed=allowed,
        dimensions=best,
        design_objectives=search.objectives_of_designs(given[None])[0],
        values=search.objectives_of_designs(best),
        losses=search.losses_of_objectives(search.objectives_of_designs(best)),
        constraint_values=search.constrained_values(best, search.constraints),
        constraints=search.constraints,
        steps_tried=search.window,
        judged=search.judged,
        feasible_count=search.feasible_count,
        notes=(*notes, *remarks),
    )


def _steps_of_movable_numbers(
    part: Problem, given: Array, steps: Mapping[str, float]
) -> tuple[dict[str, float], list[str]]:
    """Return the steps for numbers that vary over a range, and reasons why others stay unchanged.

    Raises `InputError` if all of them stay unchanged.
    """
    ranges = part.ranges
    moved = {name: step for name, step in steps.items() if not ranges[name].fixed}
    discrete_rules = {item.name: item.rule for item in part.discrete if item.name in moved}
    moved = {name: step for name, step in moved.items() if name not in discrete_rules}
    if not moved:
        raise InputError(
            f"a step may only be given for a number that varies over a range; got {', '.join(steps)}, fixed or with "
            "discrete values in this job; name another"
        )
    return moved, [
        *_unchanged_numbers_text(given, ranges, steps),
        *(
            f"{name} has discrete values in the job, {rule}, and stays unchanged"
            for name, rule in discrete_rules.items()
        ),
    ]


def ranges_or_sizes(values: Array, reference: Array, sizes: Sequence[float]) -> Array:
    """Return the ranges (m,) of objectives over a front (n, m); for a constant objective, its scale.

    reference: (m,), a design's objectives, which set the scale. sizes: (m,), targets, which replace it if greater.
    """
    span = column_ranges(values, size=sizes)
    sizes_of_reference = np.maximum(np.where(np.isfinite(reference), np.abs(reference), 0.0), sizes)
    return np.where(span > 0.0, span, np.where(sizes_of_reference > 0.0, sizes_of_reference, 1.0))


def readings_of_unitless_misses(part: Problem, allow: Mapping[str, float | str]) -> list[str]:
    """Return both readings of allowed deviations without a unit that are large compared with the required value."""
    plain_misses, doubts = (
        {name: value for name, value in _require_misses_by_quantity(allow).items() if not isinstance(value, str)},
        [],
    )
    bounds = {item.quantity: max(abs(bound) for _, bound in item.sides) for item in constraints_with_floors(part)}
    for name, value in _allowed_misses(part, plain_misses).items():
        quantity = part.quantity(name)
        if quantity.unit.symbol != quantity.kind.unit and value > _LARGE * bounds[name]:
            doubts.append(
                number_in_si_and_usual_unit(name, value, quantity.kind.unit, quantity.unit.symbol, quantity.unit.factor)
            )
    return doubts


def _allowed_misses(part: Problem, misses: Mapping[str, float | str]) -> dict[str, float]:
    """Return the allowed deviations of requirements, SI, by quantity. A required slow stroke cannot be missed."""
    constraints = {item.quantity: item for item in constraints_with_floors(replace(part, slow_stroke=None))}
    quantities = {name: part.quantity(name) for name in constraints}
    names = {
        alias: name for name, quantity in quantities.items() for alias in (quantity.field, quantity.column_stem, name)
    }
    allowed: dict[str, float] = {}
    for name, value in _require_misses_by_quantity(misses).items():
        if name not in names:
            raise InputError(
                f"only requirements of this job may be missed: {', '.join(constraints) or 'it has none'}; got "
                f"{quote(name)}; name one of them"
            )
        if names[name] in allowed:
            raise InputError(
                f"a requirement may have only one allowed deviation; got two for {names[name]}; leave out one"
            )
        try:
            allowed[names[name]] = _allowed_miss(value, quantities[names[name]], constraints[names[name]])
        except InputError as error:
            raise InputError(f"the allowed deviation of {name} {error}") from None
    return allowed


def _require_misses_by_quantity(misses: Mapping[str, float | str]) -> Mapping[str, float | str]:
    """Return allowed deviations. Raises `InputError` unless they are given by quantity."""
    if not isinstance(misses, Mapping):
        raise InputError(
            f'allowed deviations must be a dict by quantity; got {misses!r}; write it like {{"stroke": "0.1 mm"}}'
        )
    return misses


def _allowed_miss(value: float | str, quantity: Quantity, constraint: Constraint) -> float:
    """Return the allowed deviation of a requirement, SI.

    Raises `InputError`; for a percentage, it names the amount that was meant.
    """
    percent = _PERCENT.fullmatch(value) if isinstance(value, str) else None
    if percent is not None and quantity.kind.unit:
        bound = max(abs(bound) for _, bound in constraint.sides) * quantity.unit.factor
        amount = f"{0.01 * float(percent[1]) * bound:.4g} {quantity.unit.symbol}"
        raise InputError(f"must be {quantity.kind.name}, not a percentage; got {quote(value)}; write {quote(amount)}")
    kind = SMALL_LENGTH if quantity.kind is LENGTH else quantity.kind
    return to_si(value, kind, sign="positive", plain=not isinstance(value, str))


def _rounding_steps(to: float | Mapping[str, float], part: Problem) -> dict[str, float]:
    """Return the step of each number to round."""
    ranges = part.ranges
    steps = dict(to) if isinstance(to, Mapping) else dict.fromkeys(DIMENSIONS, to)
    if not steps:
        raise InputError("rounding needs a step for all lengths, or steps by name; got none; give one")
    for name, step in steps.items():
        if name not in ranges:
            raise InputError(f"a step must be for one of {', '.join(ranges)}; got {name!r}; name one of them")
        if not is_number(step) or not (math.isfinite(step) and step > 0.0):
            raise InputError(f"the step of {name} must be above zero and finite; got {step!r}")
        size = max(abs(ranges[name].lower), abs(ranges[name].upper))
        if step < _SMALLEST * size:
            step_text, least, greatest = (
                design_number_text(part, name, value) for value in (step, _SMALLEST * size, size)
            )
            raise InputError(
                f"the step of {name} must be at least {least}, {_SMALLEST:g} of {greatest}, the greatest in its "
                f"range; got {step_text}; use a larger step"
            )
    return {name: float(steps[name]) for name in ranges if name in steps}


def _unchanged_numbers_text(given: Array, ranges: Mapping[str, Range], steps: Mapping[str, float]) -> list[str]:
    """Describe the numbers that stay unchanged although they are not multiples of a step."""
    notes = []
    for value, (name, ends) in zip(given.tolist(), ranges.items(), strict=True):
        if name not in steps:
            notes.append(f"{name} has no step and stays unchanged")
        elif ends.fixed:
            place = value / steps[name]
            if abs(place - round(place)) > FEASIBLE * max(1.0, abs(place)):
                notes.append(
                    f"{name} is fixed in this job and stays unchanged, although it is not a multiple of the step"
                )
    return notes
