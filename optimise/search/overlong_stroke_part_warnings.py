"""Warning about a force over part of a stroke where that part is longer than the stroke."""

from __future__ import annotations

import numpy as np

from ...model.machine.loads.load import Load
from ...model.machine.loads.position_table import PositionTable
from ...objectives.proportions import STROKE
from ..problem.problem import Problem
from .designs_for_warnings import sampled_designs

_ROUNDING = 1e-9
"""Relative: a part that is longer by less is the whole stroke, as intended."""


def overlong_part_warnings(problem: Problem) -> list[str]:
    """Return a warning for each force whose part of the stroke is longer than every sampled stroke.

    Does not apply to a swing, which need not have dead centres.
    """
    if problem.motion is not None or not any(
        _part_length(load) for part in problem.parts() for load in part.mechanism.loads
    ):
        return []
    machines, longest = [], 0.0
    for part, designs in sampled_designs(problem):
        strokes = STROKE.evaluate(part.mechanism, designs).values
        machines.append(part.mechanism)
        longest = max([longest, *strokes[np.isfinite(strokes)].tolist()])
    warnings = []
    for k, load in enumerate(problem.mechanism.loads):
        least = min(_part_length(machine.loads[k]) for machine in machines)
        if isinstance(load, PositionTable) and least > longest * (1.0 + _ROUNDING) > 0.0:
            place = "last" if (load.datum, load.during) in _LAST else "first"
            warnings.append(
                f"load #{k + 1} acts over the {place} {1e3 * least:.6g} mm of the {load.during}, but the longest "
                f"stroke of the sampled designs is {1e3 * longest:.4g} mm, so it acts over the whole stroke; shorten "
                "this part, or leave it out"
            )
    return warnings


_LAST = {("outer dead centre", "outward stroke"), ("inner dead centre", "inward stroke")}


def _part_length(load: Load) -> float:
    """Return the length, m, over which a constant force acts in a stroke; 0 for any other load."""
    if not isinstance(load, PositionTable) or load.during == "cycle" or load.datum == "crank pivot":
        return 0.0
    first, *others = load.positions
    is_constant = len(others) == 2 and first == 0.0 and load.forces[0] == load.forces[1] and load.forces[2] == 0.0
    return others[0] if is_constant and others[0] == others[1] else 0.0
