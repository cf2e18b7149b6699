"""Refusal of objectives that are zero for every design: rounding would rank the designs."""

from __future__ import annotations

from ..model.errors import InputError
from ..objectives.cycle_average import CycleAverage
from .problem import Problem


def require_ranking(problem: Problem) -> None:
    """Raise `InputError` for an objective that is zero whatever the design, robust or not, in all variants."""
    for objective in problem.objectives:
        quantity = problem.quantity(objective.quantity)
        quantity = getattr(quantity, "inner", quantity)
        if isinstance(quantity, CycleAverage) and all(quantity.zero_for(part.mechanism) for part in problem.parts()):
            other = "peak_power" if quantity.times_speed else "peak_torque or rms_torque"
            raise InputError(
                f"objectives.{objective.quantity}: a machine that takes no work over a turn has none, whatever its "
                "dimensions; got no friction, no viscous load and no load that differs between the strokes; "
                f"use {other}, or add what the machine works against"
            )
