"""Designs of round numbers near a design of a front: the best ones that keep every requirement of the problem.

Each number is not rounded on its own: of every combination of the multiples of a step around the design, each is judged
exactly. Those that keep all requirements, ranges and full rotation are ranked by what they lose at most in an
objective, in units of its range over the front; those that another one dominates are left out.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from decimal import Decimal
from numbers import Integral, Real

import numpy as np

from ...model.arrays import Array, Whole
from ...model.errors import InputError
from ...model.linkage.values import DIMENSIONS
from ...objectives.tables.evaluate import running
from ...objectives.tables.varying_column import columns_of_numbers
from ..problem.problem import Problem
from ..problem.requirements import Constraint, Range
from ..problem.robust import asks_robust
from ..problem.violation import FEASIBLE, all_minimised, clearly_turning, constraints_of, costly, greatest_violation
from .constant import spread
from .dominance import nondominated
from .rounded import Rounded

REACHES = (16, 32)
"""Multiples of a step on either side of the design that are looked at, the next ones where none before met all."""
_MOST, _MOST_ROBUST = 1 << 18, 1 << 13  # combinations judged at once
_NEAREST = 4096  # designs of least violation that are looked at for those that lose less
_CLEARLY = 0.75  # of the loss before: what is worth to miss more for
_SMALLEST = 1e-9  # of the greatest number of a range: a step below is rounding
_TIE = 9  # decimals of a share of a range: nearer together is rounding


def rounded(
    part: Problem, given: Array, span: Array, to: float | Mapping[str, float], *, count: int = 5, notes: Sequence[str]
) -> Rounded:
    """Return the best designs of round numbers near a given one; where none keeps all requirements, the nearest.

    part: a problem without choices. given: (3 + v,), its design. span: (m,), what the loss of each objective is counted
    in. to: a step for crank, rod and offset, m, or steps by name, of varying numbers too, SI; what has no step, or is
    fixed, stays as it is. notes: to add to those of the answer.

    Raises `InputError` for a step that is not above zero, one without a multiple in the range, an unknown name, and a
    count below one.
    """
    if isinstance(count, bool) or not isinstance(count, Integral) or count < 1:
        raise InputError(f"count must be a whole number of 1 or more; got {count!r}")
    ranges = part.ranges
    steps = _steps(to, ranges)
    moved = {name: step for name, step in steps.items() if not ranges[name].fixed}
    told = [*notes, *_stays(given, ranges, steps)]
    own = {item.name: item.rule for item in part.discrete if item.name in moved}
    moved = {name: step for name, step in moved.items() if name not in own}
    told += [f"{name} has values of the job, {rule}, and stays" for name, rule in own.items()]
    if not moved:
        raise InputError(
            f"a step is for a number that varies; got {', '.join(steps)}, fixed in this job or with values of its own; "
            "name another"
        )
    search = _Search(part, given, span, moved, ranges)
    best = search.best()[:count]
    return Rounded(
        problem=part,
        given=given,
        steps=moved,
        dimensions=best,
        before=search.values(given[None])[0],
        values=search.values(best),
        losses=search.losses(search.values(best)),
        held=search.held(best, search.constraints),
        constraints=search.constraints,
        reach=search.reach,
        judged=search.judged,
        kept=search.kept,
        notes=tuple(told),
    )


def ranges_or_sizes(values: Array, of: Array, sizes: Sequence[float]) -> Array:
    """Return the ranges (m,) of objectives over a front (n, m); of a constant one the size.

    of: (m,), the objectives of a design, whose size it then is. sizes: (m,), the targets, where they are greater.
    """
    span = spread(values, size=sizes)
    own = np.maximum(np.where(np.isfinite(of), np.abs(of), 0.0), sizes)
    return np.where(span > 0.0, span, np.where(own > 0.0, own, 1.0))


class _Search:
    """Search among the combinations of round numbers around a design."""

    def __init__(
        self,
        part: Problem,
        given: Array,
        span: Array,
        steps: Mapping[str, float],
        ranges: Mapping[str, Range],
    ) -> None:
        self.part, self.given, self.span, self.steps, self.ranges = part, given, span, steps, ranges
        self.constraints = constraints_of(part)
        self.quick = [item for item in self.constraints if not costly(part.quantity(item.quantity))]
        self.slow = [item for item in self.constraints if item not in self.quick]
        self.most = _MOST_ROBUST if asks_robust(part) else _MOST
        self.before = all_minimised(part, self.values(given[None]))[0]
        self.reach, self.judged, self.kept = 0, 0, 0
        self._ladders(1)  # refuses steps without a multiple

    def best(self) -> Array:
        """Return the best designs (n, 3 + v) of the least window where some keep all; else the nearest."""
        for reach in self._reaches():
            designs, self.reach = self._window(reach), reach
            short = greatest_violation(self.part, designs, self.quick)
            kept = designs[short <= FEASIBLE]
            kept = kept[greatest_violation(self.part, kept, self.slow) <= FEASIBLE]
            values = self.values(kept)
            had = ~np.isnan(values).any(axis=1)
            if had.any():
                break
        self.judged, self.kept = len(designs), int(had.sum())
        return self._ranked(kept[had], values[had]) if had.any() else self._nearest(designs, short)

    def values(self, designs: Array) -> Array:
        """Return the objectives (n, m) of designs, SI."""
        return self.part.evaluate(designs) if len(designs) else np.zeros((0, len(self.part.objectives)))

    def losses(self, values: Array) -> Array:
        """Return by how much objectives (n, m) are worse than the design's, in units of `span`."""
        now = all_minimised(self.part, values)
        with np.errstate(invalid="ignore"):
            lost = np.where(now == self.before, 0.0, now - self.before) / self.span
        return np.asarray(np.where(np.isnan(lost), np.inf, lost))

    def held(self, designs: Array, constraints: Sequence[Constraint]) -> Array:
        """Return the values (n, c) of what is constrained."""
        if not (len(designs) and len(constraints)):
            return np.zeros((len(designs), len(constraints)))
        return self.part.evaluate(designs, [constraint.quantity for constraint in constraints])

    def _ladders(self, reach: int) -> list[list[float]]:
        """Return for each number of a design the values that it may take."""
        ladders = [[float(value)] for value in self.given]
        for place, name in enumerate(self.ranges):
            if name in self.steps:
                ladders[place] = self._multiples(name, float(self.given[place]), reach)
        return ladders

    def _multiples(self, name: str, value: float, reach: int) -> list[float]:
        step, lower, upper = self.steps[name], self.ranges[name].lower, self.ranges[name].upper
        place = value / step
        on = abs(place - round(place)) <= FEASIBLE * max(1.0, abs(place))
        low, high = (round(place), round(place)) if on else (math.floor(place), math.ceil(place))
        room = FEASIBLE * max(abs(lower), abs(upper))
        exact, side = Decimal(repr(step)), self.part.slow_side() if name == "offset" else None
        # A multiple as it is written: the step's decimals times a whole number, rounded once.
        every = [float(exact * k) for k in range(low - reach + 1, high + reach)]
        found = [x for x in every if lower - room <= x <= upper + room and (side is None or side * x > 0.0)]
        if not found and reach == 1:
            raise InputError(
                f"the step of {name} must have a multiple within its range, {self._told(name, lower)} to "
                f"{self._told(name, upper)}{'' if side is None else ', on the side that slow_stroke asks for'}; got "
                f"{self._told(name, step)}; give a smaller one, or none, so that it stays"
            )
        return found

    def _told(self, name: str, value: float) -> str:
        """Return a number of a design in its shown unit."""
        unit = columns_of_numbers(self.part.mechanism.varying)[name][1]
        return f"{value * unit.factor:.6g} {unit.symbol}".rstrip()

    def _reaches(self) -> list[int]:
        """Return the widths of the windows, each wider; fewer than usual where there are very many numbers."""
        fitting = [reach for reach in (*range(1, REACHES[0]), *REACHES) if self._size(reach) <= self.most]
        if not fitting:
            raise InputError(
                f"at most {int(math.log2(self.most))} numbers are rounded together; got {len(self.steps)}; leave some "
                "without a step"
            )
        return [reach for reach in fitting if reach >= REACHES[0]] or fitting[-1:]

    def _size(self, reach: int) -> int:
        return math.prod(len(ladder) for ladder in self._ladders(reach))

    def _window(self, reach: int) -> Array:
        """Return the combinations (n, 3 + v) of the multiples around the design that turn fully or make the swing."""
        grid = np.meshgrid(*self._ladders(reach), indexing="ij")
        designs = np.stack([values.ravel() for values in grid], axis=1)
        if self.part.motion is not None:
            return np.asarray(designs[running(self.part.mechanism, self.part.motion, designs)])
        return np.asarray(designs[clearly_turning(designs)])

    def _order(self, designs: Array, losses: Array) -> Whole:
        """Return designs in order of their greatest loss, then of the sum of losses, then of the way in steps."""
        steps = np.array([self.steps.get(name, np.inf) for name in self.ranges])
        way = np.abs((designs - self.given) / steps).max(axis=1)
        total = np.clip(losses, 0.0, None).sum(axis=1)
        return np.lexsort((way, np.round(total, _TIE), np.round(losses.max(axis=1), _TIE)))

    def _ranked(self, designs: Array, values: Array) -> Array:
        losses = self.losses(values)
        order = self._order(designs, losses)
        if losses.shape[1] == 1:  # one dominates all others: the next best are worth to be known
            return designs[order]
        free = nondominated(all_minimised(self.part, values)[order])
        return np.asarray(designs[order[free]])

    def _nearest(self, designs: Array, short: Array) -> Array:
        """Return the design that misses least, then those that miss more but lose clearly less."""
        order = np.argsort(short, kind="stable")
        taken, missed = np.zeros(0, dtype=np.int64), np.zeros(0)
        for begin in range(0, len(order), _NEAREST):
            rows = order[begin : begin + _NEAREST]
            if len(missed) == _NEAREST and missed[-1] <= short[rows[0]]:
                break  # what closed forms tell is less than all
            worst = np.maximum(short[rows], greatest_violation(self.part, designs[rows], self.slow))
            taken, missed = np.concatenate([taken, rows]), np.concatenate([missed, worst])
            best = np.argsort(missed, kind="stable")[:_NEAREST]
            taken, missed = taken[best], missed[best]
        taken, missed = taken[np.isfinite(missed)], missed[np.isfinite(missed)]
        losses = self.losses(self.values(designs[taken])).max(axis=1)
        order = np.lexsort((losses, np.round(missed, _TIE)))
        found: list[int] = []
        least = np.inf
        for row, loss in zip(taken[order].tolist(), losses[order].tolist(), strict=True):
            if not found or loss <= _CLEARLY * least:
                found.append(row)
                least = loss
            if least <= 0.0:
                break  # nothing is lost: there is no reason to miss more
        return np.asarray(designs[found])


def _steps(to: float | Mapping[str, float], ranges: Mapping[str, Range]) -> dict[str, float]:
    """Return the step of each number that is to be rounded."""
    steps = dict(to) if isinstance(to, Mapping) else dict.fromkeys(DIMENSIONS, to)
    if not steps:
        raise InputError("say what to round: a step for all lengths, or one by name")
    for name, step in steps.items():
        if name not in ranges:
            raise InputError(f"a step is for one of {', '.join(ranges)}; got {name!r}; name one of them")
        if isinstance(step, bool) or not isinstance(step, Real) or not (math.isfinite(step) and step > 0.0):
            raise InputError(f"the step of {name} must be above zero and finite; got {step!r}")
        size = max(abs(ranges[name].lower), abs(ranges[name].upper))
        if step < _SMALLEST * size:
            raise InputError(
                f"the step of {name} must be {_SMALLEST:g} of its range's greatest number or more; got {step:g} of "
                f"{size:g} (SI); give a greater one"
            )
    return {name: float(steps[name]) for name in ranges if name in steps}


def _stays(given: Array, ranges: Mapping[str, Range], steps: Mapping[str, float]) -> list[str]:
    """Return in words what stays as it is though it is no multiple of a step."""
    told = []
    for value, (name, ends) in zip(given.tolist(), ranges.items(), strict=True):
        if name not in steps:
            told.append(f"{name} has no step and stays as it is")
        elif ends.fixed:
            place = value / steps[name]
            if abs(place - round(place)) > FEASIBLE * max(1.0, abs(place)):
                told.append(f"{name} is fixed in this job and stays, though it is no multiple of the step")
    return told
