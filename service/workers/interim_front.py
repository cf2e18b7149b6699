"""The front that a search has by now, as its job shows it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ...optimise.front.stationarity import Array
    from ...optimise.problem.problem import Problem

MOST = 64
"""Designs that are shown: enough for the shape of a front, and some kB at most."""


def front_so_far(problem: Problem, values: Array) -> dict[str, Any]:
    """Return at most `MOST` designs of a front, evenly spread along its first objective, as JSON has them.

    values: objectives (n, m), SI, as they are minimised. columns: those of the objectives in tables of designs; points:
    in their units, of an objective with a target the distance from that.
    """
    import numpy as np

    quantities = [problem.quantity(objective.quantity) for objective in problem.objectives]
    factors = [
        of.unit.factor * (-1.0 if objective.sense == "maximise" else 1.0)
        for of, objective in zip(quantities, problem.objectives, strict=True)
    ]
    ordered = values[np.argsort(values[:, 0], kind="stable")]
    rows = np.linspace(0, len(ordered) - 1, min(len(ordered), MOST)).round().astype(int)
    return {"columns": [of.field for of in quantities], "points": (ordered[rows] * factors).tolist()}
