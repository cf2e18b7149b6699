"""Answer to wishes: the design, and the desired and reached value of each objective in words."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import cast

import numpy as np

from ...objectives.kinds import System, metric_unit_in
from ...objectives.quantity import Quantity
from ..front.front import ParetoFront
from ..problem.requirements import Objective
from .wishes import Kind, Wish

_ROUNDING = 1e-9
"""Relative to an objective's range: smaller differences do not count."""


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """One objective of the design that answers a wish.

    objective: the objective. quantity: its quantity. kind: kind of the wish. wished, reached, before: desired or
    allowed value, value reached by the new design, and value of the design to which classes refer, SI; None if there is
    none.
    short: shortfall from the desired or allowed value, in the objective as minimised, SI; negative if the design is
    better; None if there is no such value. changed: the same difference from the value before. range_: range of the
    objective over the front.
    """

    objective: Objective
    quantity: Quantity
    kind: Kind
    wished: float | None
    reached: float
    before: float | None
    short: float | None
    changed: float | None
    range_: float

    @property
    def is_met(self) -> bool:
        """Whether the new design reaches the desired value, or stays within the allowed one."""
        return self.short is None or self.short <= _ROUNDING * self.range_

    @property
    def gained(self) -> bool:
        """Whether the new design is better than the previous one."""
        return self.changed is not None and self.changed < -_ROUNDING * self.range_

    def text(self, system: System = "metric") -> str:
        """Describe wish and outcome: "peak torque 109.2 N m instead of the desired 110 N m"."""
        reached = f"{self.quantity.title} {self._value_text(self.reached, system)}"
        if self.kind == "value":
            return reached + self._wish_comparison_text(system)
        if self.kind == "limit":
            worst = {"minimise": "most", "maximise": "least", "target": "worst"}[self.objective.sense]
            return f"{reached}, at {worst} {self._value_text(cast(float, self.wished), system)} allowed"
        if self.kind == "free" and self.changed is None:
            return f"{reached}, free"
        free = ", free" if self.kind == "free" else ""
        changed = cast(float, self.changed)
        if abs(changed) <= _ROUNDING * self.range_:
            return f"{reached}, as before{free}"
        direction = "worse" if changed > 0.0 else "better"
        return f"{reached}, {self._difference_text(changed, system)} {direction} than before{free}"

    def _wish_comparison_text(self, system: System) -> str:
        short, wished = cast(float, self.short), self._value_text(cast(float, self.wished), system)
        if abs(short) <= _ROUNDING * self.range_:
            is_target = self.objective.sense == "target"
            return f", as near to its target as the desired {wished}" if is_target else ", as desired"
        amount = self._difference_text(short, system)
        if self.objective.sense == "target":
            target = self._value_text(cast(float, self.objective.target), system)
            far = f"{amount} {'farther from' if short > 0.0 else 'nearer to'} its target of {target} than"
            return f", {far} the desired {wished}"
        if short < 0.0:
            return f", {amount} better than the desired {wished}"
        return f" instead of the desired {wished}: it must give way by {amount}"

    def _value_text(self, value: float, system: System) -> str:
        unit, factor = metric_unit_in(self.quantity.unit.symbol, system)
        return f"{value * self.quantity.unit.factor * factor:.4g} {unit}".rstrip()

    def _difference_text(self, value: float, system: System) -> str:
        unit, factor = metric_unit_in(self.quantity.unit.symbol, system)
        return f"{abs(value) * self.quantity.unit.factor * factor:.3g} {unit}".rstrip()


@dataclass(frozen=True, kw_only=True)
class Wished:
    """The answer to wishes for the objectives of a front.

    found: the design, as a separate front with all columns of a front's table, its stationarity residual and trade-off
    rates; empty if no design stays within the allowed values. row: row of the design to which classes refer. wishes:
    wish for each objective. value: the achievement function at the design, as `wish` defines it; NaN if there is no
    design. outcomes: outcome of each objective; empty if there is no design. message: reason for a missing design, or
    empty.
    """

    found: ParetoFront
    row: int | None
    wishes: tuple[Wish, ...]
    value: float
    outcomes: tuple[Outcome, ...]
    message: str = ""

    def __len__(self) -> int:
        return len(self.found)

    def __repr__(self) -> str:
        return f"Wished({self.found.problem.name!r}: {'; '.join(self.sentences())})"

    @property
    def possible(self) -> bool:
        """Whether the design fulfils every wish."""
        return bool(self.outcomes) and all(outcome.is_met for outcome in self.outcomes)

    def sentences(self, system: System = "metric") -> list[str]:
        """Say whether the wishes can be met, then describe wish and outcome for each objective."""
        if not self.outcomes:
            return [self.message]
        return [self._first_sentence(), *(outcome.text(system) for outcome in self.outcomes)]

    def _first_sentence(self) -> str:
        wished = [outcome for outcome in self.outcomes if outcome.kind == "value"]
        if not wished:
            if any(outcome.kind == "improve" and outcome.gained for outcome in self.outcomes):
                return "the objectives to improve do so as far as the others allow"
            return "nothing improves while the other objectives stay as required"
        if not self.possible:
            verdict = (
                "no design reaches the desired value" if len(wished) == 1 else "no design reaches all desired values"
            )
            return f"{verdict}; this one is nearest"
        if all(cast(float, outcome.short) < -_ROUNDING * outcome.range_ for outcome in wished):
            return "the wish can be met and exceeded" + (" in every objective" if len(wished) > 1 else "")
        return "the wish can be met"


def outcomes_of(
    front: ParetoFront, wishes: Sequence[Wish], aims: Sequence[float | None], row: int | None, found: ParetoFront
) -> tuple[Outcome, ...]:
    """Return the outcome for each objective.

    aims: desired values as minimised, SI. found: the design, as a separate front.
    """
    return tuple(
        Outcome(
            objective=objective,
            quantity=(of := front.problem.quantity(objective.quantity)),
            kind=wishes[column].kind,
            wished=wishes[column].value,
            reached=float(found.columns[of.field][0]) / of.unit.factor,
            before=None if row is None else float(front.columns[of.field][row]) / of.unit.factor,
            short=None if (aim := aims[column]) is None else float(found.values[0, column] - aim),
            changed=None if row is None else float(found.values[0, column] - front.values[row, column]),
            range_=float(np.ptp(front.values[:, column])) or float(abs(found.values[0, column])),
        )
        for column, objective in enumerate(front.objectives)
    )
