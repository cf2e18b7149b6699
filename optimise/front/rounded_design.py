"""Designs with round numbers: their losses, their tightest requirement, and their deviations."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Literal

import numpy as np

from ...model.arrays import Array
from ...objectives.kinds import System, count_with_noun, metric_unit_in
from ...objectives.tables.design_input import columns_of_design_numbers
from ..problem.constraint_violation import FEASIBLE, relative_violation
from ..problem.problem import Problem
from ..problem.requirements import Constraint
from ..problem.table_columns import slack_field
from .rounding_search import REACHES
from .stationarity import slack_of

if TYPE_CHECKING:
    import pandas as pd

_SAME = 1e-12
"""Relative change in an objective that is only rounding, e.g. if the objective follows from a requirement."""


@dataclass(frozen=True, kw_only=True)
class Miss:
    """Distance by which a value misses a requirement's bound.

    quantity: its name in the job. kind: kind of the value, "length". amount: positive distance, in `unit`, the unit of
    the quantity's column. side: side of the bound on which the value lies. allowed: allowed amount, in `unit`.
    """

    quantity: str
    title: str
    kind: str
    amount: float
    unit: str
    side: Literal["above", "below"]
    allowed: float


@dataclass(frozen=True, kw_only=True)
class Rounded:
    """Designs with round numbers near a front's design, best first.

    Non-dominated designs that meet every requirement within the allowed deviations come first, least loss first; then
    designs that miss little but lose much less. If `is_met` is False, these are the nearest designs. The first has
    the least relative violation beyond the allowed deviations; those that follow miss more but lose much less. See
    `rounding.rounded`.

    problem: the problem that they solve, with its choices made. design: (3 + v,), the design to round. steps: steps of
    the rounded numbers, SI. allowed: allowed deviations of requirements, SI, by quantity. dimensions: (n, 3 + v).
    design_objectives: (m,), the design's objectives, SI. values: (n, m). losses: (n, m), loss of each objective as a
    fraction of its range over the front; negative for a gain. constraints: c constraints, including floors.
    constraint_values: (n, c). steps_tried: multiples of a step tried on either side. judged: number of movable
    combinations; all are judged. feasible_count: number of those that meet every requirement within the allowed
    deviations. notes: unchanged numbers, in words.
    """

    problem: Problem
    design: Array
    steps: Mapping[str, float]
    allowed: Mapping[str, float]
    dimensions: Array
    design_objectives: Array
    values: Array
    losses: Array
    constraint_values: Array
    constraints: tuple[Constraint, ...]
    steps_tried: int
    judged: int
    feasible_count: int
    notes: tuple[str, ...]

    def __len__(self) -> int:
        return len(self.dimensions)

    def __repr__(self) -> str:
        return f"Rounded({self.problem.name!r}: {self.message})"

    @property
    def is_met(self) -> bool:
        """Whether the designs meet every requirement within the allowed deviations."""
        return self.feasible_count > 0

    @property
    def message(self) -> str:
        """Result of the search, in words."""
        return self.message_in("metric")

    def message_in(self, system: System) -> str:
        """Return the result of the search in words. system: system of its units."""
        if not self.judged:
            steps = count_with_noun(self.steps_tried, "step")
            return f"no rounded design within {steps} rotates fully; give smaller steps"
        near = f"{count_with_noun(self.judged, 'rounded design')} within {count_with_noun(self.steps_tried, 'step')}"
        if self.steps_tried < REACHES[0]:
            near += f" (not {REACHES[0]}, because {len(self.steps)} numbers are rounded together)"
        if self.is_met:
            keep = "keeps" if self.feasible_count == 1 else "keep"
            tolerance = f" within {self._allowed_in_words(system)}" if self.allowed else ""
            missing = sum(bool(self._excessive_misses(row)) for row in range(len(self)))
            lose = "others lose much less but miss" if missing > 1 else "another one loses much less but misses"
            supplement = f"; {lose} little" if missing else ""
            return f"{self.feasible_count} of {near} {keep} every requirement{tolerance}{supplement}"
        subject = f"none of {near}"
        if not len(self):
            return f"{subject} has a value for every requirement; give smaller steps"
        titles = [self.problem.quantity(name).title for name in self._excessive_misses(0)]
        supplement = "a greater miss" if set(self._excessive_misses(0)) & set(self.allowed) else "a miss"
        return f"{subject} meets every requirement; these are the nearest; allow {supplement} of {' and '.join(titles)}"

    @cached_property
    def violations(self) -> Array:
        """Relative violation (n, c) of every constraint; zero or less if it is met."""
        columns = [
            relative_violation(constraint, self.constraint_values[:, j])
            for j, constraint in enumerate(self.constraints)
        ]
        return np.stack(columns, axis=1) if columns else np.zeros((len(self), 0))

    def tightest(self, row: int) -> str | None:
        """Return the quantity with the relatively tightest requirement, equalities first; None if there are none."""
        rest = [(item.equality, self.violations[row, j], item.quantity) for j, item in enumerate(self.constraints)]
        return max(rest)[2] if rest else None

    def misses(self, row: int) -> list[Miss]:
        """Return a design's deviations from all requirements that it violates, relatively worst first.

        Allowed deviations are included.
        """
        misses = []
        for place in np.argsort(-self.violations[row], kind="stable").tolist():
            if self.violations[row, place] <= FEASIBLE:
                break
            constraint, value = self.constraints[place], self.constraint_values[row, place]
            quantity = self.problem.quantity(constraint.quantity)
            slack = slack_of(constraint, self.constraint_values[row : row + 1, place])[0]
            misses.append(
                Miss(
                    quantity=constraint.quantity,
                    title=quantity.title,
                    kind=quantity.kind.name_without_article,
                    amount=float(-slack * quantity.unit.factor),
                    unit=quantity.unit.symbol,
                    side="below" if constraint.lower is not None and value < constraint.lower else "above",
                    allowed=drop_conversion_rounding(self.allowed.get(constraint.quantity, 0.0) * quantity.unit.factor),
                )
            )
        return misses

    def missed(self, row: int) -> list[str]:
        """Return the quantities whose requirements a design misses, worst first."""
        return [miss.quantity for miss in self.misses(row)]

    def _allowed_in_words(self, system: System) -> str:
        """Return the allowed deviations as text: "0.1 mm of stroke"."""
        texts = []
        for name, value in self.allowed.items():
            quantity = self.problem.quantity(name)
            unit, factor = metric_unit_in(quantity.unit.symbol, system)
            texts.append(f"{value * quantity.unit.factor * factor:.4g} {unit}".rstrip() + f" of {quantity.title}")
        return " and ".join(texts)

    def _excessive_misses(self, row: int) -> list[str]:
        """Return the quantities whose requirements a design misses by more than allowed."""
        return [miss.quantity for miss in self.misses(row) if miss.amount > miss.allowed * (1.0 + FEASIBLE)]

    @property
    def names(self) -> dict[str, tuple[str, float]]:
        """The column for each number of a design, with the factor from SI to its unit."""
        columns = columns_of_design_numbers(self.problem.mechanism.varying)
        return {name: (column, unit.factor) for name, (column, unit) in columns.items()}

    @cached_property
    def columns(self) -> dict[str, Array]:
        """The columns of the table of designs; see `designs`."""
        table: dict[str, Array] = {}
        for place, (name, (column, factor)) in enumerate(self.names.items()):
            values = self.dimensions[:, place] * factor
            table[column] = (
                np.array([drop_conversion_rounding(value) for value in values.tolist()])
                if name in self.steps
                else values
            )
        for place, objective in enumerate(self.problem.objectives):
            quantity = self.problem.quantity(objective.quantity)
            now, before = self.values[:, place], self.design_objectives[place]
            with np.errstate(invalid="ignore", divide="ignore"):
                is_same = (now == before) | (np.abs(now - before) <= _SAME * np.abs(before))
                change = np.where(is_same, 0.0, now - before)
                percent = np.where(change == 0.0, 0.0, 100.0 * change / abs(before))
            table[quantity.field] = now * quantity.unit.factor
            table[f"change_{quantity.field}"] = change * quantity.unit.factor
            table[f"change_{quantity.column_stem}_percent"] = percent
        table["loss_percent"] = 100.0 * self.losses.max(axis=1) if len(self) else np.zeros(0)
        for place, constraint in enumerate(self.constraints):
            quantity = self.problem.quantity(constraint.quantity)
            table[slack_field(quantity)] = (
                slack_of(constraint, self.constraint_values[:, place]) * quantity.unit.factor + 0.0
            )
        return table

    @cached_property
    def designs(self) -> pd.DataFrame:
        """The designs as a pandas DataFrame, one row per design.

        Columns: crank, rod, offset and extra variables; each objective, its change from the front's design,
        `change_...`, and that change in percent; `loss_percent`, the greatest loss in percent of an objective's range
        over the front; `slack_...` for every requirement, negative if it is missed; `tightest` requirement.
        """
        import pandas as pd

        return pd.DataFrame(self.columns | {"tightest": [self.tightest(row) for row in range(len(self))]})


def drop_conversion_rounding(value: float) -> float:
    """Return a round number without the rounding error from its conversion: 73.5, not 73.50000000000001."""
    return float(f"{value:.12g}")
