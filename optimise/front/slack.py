"""Slack of a constraint: distance of values from the nearer bound."""

from __future__ import annotations

import numpy as np

from ...model.arrays import Array
from ..problem.constraint_violation import closed_sides
from ..problem.requirements import Constraint
from .constant_numbers import is_constant


def slack_of(constraint: Constraint, values: Array) -> Array:
    """Return the distances (n,) of values from the nearer bound, SI: 0 on the bound, negative beyond it.

    Infinite for infinite values, NaN for missing ones.
    """
    slack = np.full(len(values), np.inf)
    if constraint.equality:
        slack = -_distances_from_bound(values, constraint.lower, np.abs(values - float(constraint.lower or 0.0)))
    else:
        for side, bound, _ in closed_sides(constraint):
            slack = np.minimum(slack, _distances_from_bound(values, bound, side * (bound - values)))
    return slack


def _distances_from_bound(values: Array, bound: float | None, slack: Array) -> Array:
    """Return distances from a bound, with 0 for values that differ from it only by rounding."""
    on_it = is_constant(np.stack([values, np.full(len(values), bound or 0.0)]), size=0.0 if bound else 1.0)
    return np.where(on_it & np.isfinite(values), 0.0, slack)
