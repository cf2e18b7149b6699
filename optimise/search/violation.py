"""Designs that come nearest to all requirements: the greatest violation made as small as possible."""

from __future__ import annotations

import numpy as np

from ...model.arrays import Array, Mask
from .candidates import Polished
from .evaluation import Evaluator
from .pieces import Rows
from .recorded import polished
from .sampling import apart


class _Violations:
    """Presents all constraint rows as the pieces of one objective, to be made as small as possible."""

    def __init__(self, evaluator: Evaluator) -> None:
        self.inner = evaluator

    def valid(self, u: Array) -> Mask:
        return self.inner.valid(u)

    def exact(self, u: Array) -> tuple[Rows, Rows]:
        _, limits = self.inner.exact(u, goals=False)
        goals = Rows(limits.values, limits.gradients, limits.labels, np.zeros(len(limits.owner), np.int64))
        return goals, Rows.none(*u.shape)


def least_violation(evaluator: Evaluator, u: Array, *, ranked: int, starts: int) -> Polished:
    """Return designs of locally least violation, their only value, from points (n, k) of a sheet; none if none turns.

    ranked: how many of the points are looked at, evenly spread. starts: how many of them lead down, the best first.
    """
    u = u[evaluator.valid(u)]
    u = u[:: max(1, len(u) // ranked)]
    best = u[apart(_greatest(evaluator, u), u, np.zeros(len(u), np.int64), starts)] if len(u) else u
    return polished(evaluator, best, np.ones(1), shown=_Violations(evaluator))


def _greatest(evaluator: Evaluator, u: Array) -> Array:
    """Return the greatest relative violation (n,) of points."""

    def greatest() -> tuple[Array]:
        return (evaluator.exact(u, goals=False)[1].values.max(axis=1, initial=0.0),)

    return evaluator.step("violation", (u,), greatest)[0]
