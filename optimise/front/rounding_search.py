"""Search among combinations of round numbers around a design, with progress reports and cancellation."""

import math
from collections.abc import Callable, Generator, Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from functools import partial
from typing import TypeVar

import numpy as np

from ...model.arrays import Array, IntArray
from ...model.errors import InputError
from ...objectives.tables.design_input import columns_of_design_numbers
from ...objectives.tables.evaluate_quantities import can_run_despite_friction
from ..problem.constraint_violation import (
    FEASIBLE,
    constraints_with_floors,
    greatest_violation,
    minimised_objectives,
    minimised_values,
    needs_computed_cycle,
    rotates_beyond_rounding,
)
from ..problem.problem import Problem
from ..problem.requirements import Constraint
from ..problem.robust_problem import has_robust_requirements
from .dominance import nondominated

REACHES = (16, 32)
"""Numbers of steps to try on either side of the design; each is tried only if none before gave a feasible design."""
_MOST, _MOST_ROBUST = 1 << 18, 1 << 13  # combinations to judge in one call
_NEAREST = 8192  # maximum number of designs to evaluate over the cycle for those that miss more but lose less
_BLOCK, _SLOW_BLOCK = 1 << 15, 1 << 8  # designs between two reports; fewer if a cycle is evaluated
_LITTLE = 0.01  # relative to a bound: greatest deviation of designs listed after the feasible ones
_ACCEPTED_LOSS = 0.01  # relative to a range: least loss that justifies looking for them
_CLEARLY = 0.75  # relative to the previous loss: greatest loss that justifies a larger miss
_TIE = 9  # decimals for fractions of a range: smaller differences are rounding


@dataclass(frozen=True)
class Stage:
    """Progress of the search. stage: current activity. step, steps: number of designs so far and in total."""

    stage: str
    step: int
    steps: int


T = TypeVar("T")
Steps = Generator[Stage, None, T]
"""A search that yields its progress and returns its result; closing it ends the search."""


def design_number_text(part: Problem, name: str, value: float) -> str:
    """Return the value, SI, of a number in a problem's designs as text in its display unit."""
    unit = columns_of_design_numbers(part.mechanism.varying)[name][1]
    return f"{value * unit.factor:.6g} {unit.symbol}".rstrip()


class RoundingSearch:
    """Search among the combinations of round numbers around a design."""

    def __init__(
        self,
        part: Problem,
        design: Array,
        span: Array,
        steps: Mapping[str, float],
        allowed: Mapping[str, float],
    ) -> None:
        """Prepare; see `rounding.rounding`. Raises `InputError` for a step without a multiple in range."""
        self.part, self.design, self.span, self.steps, self.ranges = part, design, span, steps, part.ranges
        self.allowed = allowed
        self.constraints = constraints_with_floors(part)
        self.quick = [item for item in self.constraints if not needs_computed_cycle(part.quantity(item.quantity))]
        self.slow = [item for item in self.constraints if item not in self.quick]
        self.most = _MOST_ROBUST if has_robust_requirements(part) else _MOST
        self.design_objectives = minimised_objectives(part, self.objectives_of_designs(design[None]))[0]
        self.window, self.judged, self.feasible_count = 0, 0, 0
        self._possible_values(1)

    def best_designs(self, count: int) -> Steps[Array]:
        """Return the best designs (n, 3 + v) from the smallest window with feasible ones; otherwise the nearest.

        Yields a `Stage` before every block of designs.
        """
        for window in self._window_widths():
            designs, self.window = self._designs_in_window(window), window
            misses = yield from self._in_blocks(
                "screening combinations", designs, self._violation_function(self.quick), _BLOCK
            )
            rows = np.flatnonzero(misses <= FEASIBLE)
            judged = yield from self._in_blocks(
                "judging combinations", designs[rows], self._violation_function(self.slow)
            )
            misses[rows] = np.maximum(misses[rows], judged)
            feasible_rows = rows[misses[rows] <= FEASIBLE]
            values = yield from self._in_blocks(
                "ranking combinations", designs[feasible_rows], self.objectives_of_designs
            )
            has_values = ~np.isnan(values).any(axis=1)
            if has_values.any():
                break
            misses[feasible_rows] = np.inf  # an objective has no value
        self.judged, self.feasible_count = len(designs), int(has_values.sum())
        if not has_values.any():
            return (yield from self._nearest_by_miss(designs, misses, rows, count))
        best = self._rank_designs(designs[feasible_rows[has_values]], values[has_values])[:count]
        loss = float(self.losses_of_objectives(self.objectives_of_designs(best[:1])).max())
        if len(best) == count or loss <= _ACCEPTED_LOSS:
            return best
        misses[feasible_rows] = np.inf
        near = misses <= _LITTLE
        place = np.flatnonzero(np.isin(np.flatnonzero(near), rows))
        missing = yield from self._nearest_by_miss(
            designs[near], misses[near], place, count - len(best), _CLEARLY * loss
        )
        return np.concatenate([best, missing])

    def objectives_of_designs(self, designs: Array) -> Array:
        """Return the objectives (n, m) of designs, SI."""
        return self.part.evaluate(designs) if len(designs) else np.zeros((0, len(self.part.objectives)))

    def losses_of_objectives(self, values: Array) -> Array:
        """Return the losses of objectives (n, m) compared with the design's, in units of `span`."""
        now = minimised_objectives(self.part, values)
        with np.errstate(invalid="ignore"):
            lost = np.where(now == self.design_objectives, 0.0, now - self.design_objectives) / self.span
        return np.asarray(np.where(np.isnan(lost), np.inf, lost))

    def constrained_values(self, designs: Array, constraints: Sequence[Constraint]) -> Array:
        """Return the constrained quantities' values (n, c)."""
        if not (len(designs) and len(constraints)):
            return np.zeros((len(designs), len(constraints)))
        return self.part.evaluate(designs, [constraint.quantity for constraint in constraints])

    def _violation_function(self, constraints: Sequence[Constraint]) -> Callable[[Array], Array]:
        """Return a function from designs to their greatest violation of the given constraints."""
        return partial(greatest_violation, self.part, constraints=constraints, allowed=self.allowed)

    def _in_blocks(
        self, stage: str, designs: Array, function: Callable[[Array], Array], size: int = _SLOW_BLOCK
    ) -> Steps[Array]:
        """Return the values of a function of designs, computed block by block."""
        blocks = []
        for begin in range(0, max(1, len(designs)), size):
            if len(designs):
                yield Stage(stage, begin, len(designs))
            blocks.append(function(designs[begin : begin + size]))
        return np.concatenate(blocks)

    def _possible_values(self, window: int) -> list[list[float]]:
        """Return the possible values of each number of a design."""
        ladders = [[float(value)] for value in self.design]
        for place, name in enumerate(self.ranges):
            if name in self.steps:
                ladders[place] = self._multiples_near_value(name, float(self.design[place]), window)
        return ladders

    def _multiples_near_value(self, name: str, value: float, window: int) -> list[float]:
        step, lower, upper = self.steps[name], self.ranges[name].lower, self.ranges[name].upper
        place = value / step
        is_multiple = abs(place - round(place)) <= FEASIBLE * max(1.0, abs(place))
        low, high = (round(place), round(place)) if is_multiple else (math.floor(place), math.ceil(place))
        slack = FEASIBLE * max(abs(lower), abs(upper))
        exact, side = Decimal(repr(step)), self.part.slow_side() if name == "offset" else None
        # A multiple as written: the step's decimals times a whole number, rounded once.
        every = [float(exact * k) for k in range(low - window + 1, high + window)]
        multiples = [x for x in every if lower - slack <= x <= upper + slack and (side is None or side * x > 0.0)]
        if not multiples and window == 1:
            raise InputError(
                f"the step of {name} must have a multiple within its range, "
                f"{design_number_text(self.part, name, lower)} "
                f"to {design_number_text(self.part, name, upper)}"
                f"{'' if side is None else ', on the side that slow_stroke asks for'}; "
                f"got {design_number_text(self.part, name, step)}; use a smaller step, or none, so that it stays "
                "unchanged"
            )
        return multiples

    def _window_widths(self) -> list[int]:
        """Return the increasing half-widths of the windows; fewer than usual for very many numbers."""
        every = (*range(1, REACHES[0]), *REACHES)
        fitting = [window for window in every if math.prod(map(len, self._possible_values(window))) <= self.most]
        if not fitting:
            raise InputError(
                f"at most {int(math.log2(self.most))} numbers may be rounded together; got {len(self.steps)}; leave "
                "some without a step"
            )
        return [window for window in fitting if window >= REACHES[0]] or fitting[-1:]

    def _designs_in_window(self, window: int) -> Array:
        """Return the combinations (n, 3 + v) of multiples near the design that rotate fully or make the swing."""
        grid = np.meshgrid(*self._possible_values(window), indexing="ij")
        designs = np.stack([values.ravel() for values in grid], axis=1)
        if self.part.motion is not None:
            return np.asarray(designs[can_run_despite_friction(self.part.mechanism, self.part.motion, designs)])
        return np.asarray(designs[rotates_beyond_rounding(designs)])

    def _steps_away(self, designs: Array) -> Array:
        """Return the greatest distance (n,) in any number from the given design, in steps."""
        steps = np.array([self.steps.get(name, np.inf) for name in self.ranges])
        return np.asarray((np.abs(designs - self.design) / steps).max(axis=1))

    def _rank_designs(self, designs: Array, values: Array) -> Array:
        """Return designs in order of greatest loss, then of total loss, then of distance in steps."""
        losses = self.losses_of_objectives(values)
        total = np.clip(losses, 0.0, None).sum(axis=1)
        order = np.lexsort((self._steps_away(designs), np.round(total, _TIE), np.round(losses.max(axis=1), _TIE)))
        if losses.shape[1] == 1:  # if one dominates all others, the next best are of interest
            return designs[order]
        free = nondominated(minimised_objectives(self.part, values)[order])
        return np.asarray(designs[order[free]])

    def _nearest_by_miss(
        self, designs: Array, misses: Array, exact: IntArray, count: int, max_loss: float = math.inf
    ) -> Steps[Array]:
        """Return the nearest designs, see `rounding.rounding`; only those that lose at most `max_loss`.

        misses: (n,), exact in the rows `exact`; elsewhere a lower bound from closed forms. Designs are judged in that
        order, and each gets its rank once every design that may miss as little is judged.
        """
        is_exact = np.zeros(len(designs), dtype=bool)
        is_exact[exact] = True
        least = yield from self._in_blocks("screening combinations", designs, self._least_losses, _BLOCK)
        losses, ranked = np.full(len(designs), np.nan), np.zeros(0, dtype=np.int64)
        ahead, judged = np.argsort(misses, kind="stable"), np.zeros(0, dtype=np.int64)
        ahead = ahead[least[ahead] <= max_loss]
        while len(ahead) and not ((len(ranked) or math.isfinite(max_loss)) and len(judged) >= _NEAREST):
            yield Stage("searching for the nearest", len(judged), max(_NEAREST, len(judged)))
            rows, ahead = ahead[:_SLOW_BLOCK], ahead[_SLOW_BLOCK:]
            judged = np.append(judged, rows)
            rows = rows[~is_exact[rows]]
            misses[rows] = np.maximum(misses[rows], self._violation_function(self.slow)(designs[rows]))
            bar = np.round(misses[ahead[0]], _TIE) if len(ahead) else np.inf
            placed = judged[np.isfinite(misses[judged]) & (np.round(misses[judged], _TIE) < bar)]
            fresh = placed[np.isnan(losses[placed])]
            losses[fresh] = self.losses_of_objectives(self.objectives_of_designs(designs[fresh])).max(axis=1)
            placed = placed[
                (losses[placed] <= max_loss) & (misses[placed] <= (_LITTLE if math.isfinite(max_loss) else np.inf))
            ]
            ranked = self._rows_with_falling_loss(designs, placed, misses[placed], losses[placed])[:count]
            if len(ranked) == count or (len(ranked) and losses[ranked[-1]] <= 0.0):
                break
            if len(ranked):
                ahead = ahead[least[ahead] <= _CLEARLY * losses[ranked[-1]]]
        return np.asarray(designs[ranked])

    def _least_losses(self, designs: Array) -> Array:
        """Return the greatest loss (n,) over the objectives with closed forms."""
        losses = np.full(len(designs), -np.inf)
        for place, objective in enumerate(self.part.objectives):
            if not needs_computed_cycle(self.part.quantity(objective.quantity)):
                now = minimised_values(objective, self.part.evaluate(designs, [objective.quantity])[:, 0])
                losses = np.fmax(losses, (now - self.design_objectives[place]) / self.span[place])
        return losses

    def _rows_with_falling_loss(self, designs: Array, rows: IntArray, misses: Array, losses: Array) -> IntArray:
        """Return the row with the least miss, then rows that miss more but lose much less."""
        order = np.lexsort((self._steps_away(designs[rows]), np.round(losses, _TIE), np.round(misses, _TIE)))
        ranked: list[int] = []
        least = np.inf
        for row, loss in zip(rows[order].tolist(), losses[order].tolist(), strict=True):
            if not ranked or loss <= _CLEARLY * least:
                ranked.append(row)
                least = loss
            if least <= 0.0:
                break  # nothing is lost, so there is no reason to miss more
        return np.array(ranked, dtype=np.int64)
