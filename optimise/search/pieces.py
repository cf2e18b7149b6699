"""Rows of smooth pieces: which are active, and which of two designs' rows are the same piece."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...model.arrays import Array, Whole

ACTIVE = 1e-8
"""Constraint rows nearer to zero than this, and objective pieces nearer to their greatest (scaled), are active."""
_SAME = 0.3  # labels farther apart (rad) are not the same peak


@dataclass(frozen=True)
class Rows:
    """Smooth rows of n designs in the free unknowns: `value <= 0` for constraints, "greatest of" for objectives.

    values: (n, r), -inf for absent rows. gradients: (n, r, k). labels: (n, r). owner: (r,), the constraint or
    objective that a row belongs to.
    """

    values: Array
    gradients: Array
    labels: Array
    owner: Whole

    @classmethod
    def none(cls, n: int, k: int) -> Rows:
        """Return no rows of n designs in k unknowns."""
        return cls(np.zeros((n, 0)), np.zeros((n, 0, k)), np.zeros((n, 0)), np.zeros(0, np.int64))

    def put(self, row: int, other: Rows, source: int) -> None:
        """Overwrite a design's rows with those of a design of `other`."""
        self.values[row] = other.values[source]
        self.gradients[row] = other.gradients[source]
        self.labels[row] = other.labels[source]


def greatest(rows: Rows, count: int) -> Array:
    """Return the greatest piece of each owner, (..., count)."""
    return np.stack([rows.values[..., rows.owner == owner].max(axis=-1) for owner in range(count)], axis=-1)


def alone(rows: Rows, row: int) -> Rows:
    """Return the rows of one design."""
    return Rows(rows.values[row], rows.gradients[row], rows.labels[row], rows.owner)


def box(u: Array, *, within: float = ACTIVE) -> Array:
    """Return the gradients of the box's active bounds."""
    edge = np.eye(len(u))
    return np.concatenate([-edge[u < within], edge[u > 1.0 - within]])


def active_pieces(goals: Rows, chosen: tuple[int, ...], *, within: float = ACTIVE) -> Whole:
    """Return the pieces that tie for the greatest of each chosen objective."""
    pieces = []
    for owner in chosen:
        columns = np.flatnonzero(goals.owner == owner)
        values = goals.values[columns]
        pieces.append(columns[values >= values.max() - within])
    return np.concatenate(pieces)


def partners(here: Rows, there: Rows, of: Whole) -> list[tuple[int, int]]:
    """Return rows (p,) of a design that another has too, each with its row there, matched by labels.

    Peaks may swap their order. Rows of one owner with equal labels (lower and upper bound) keep their place.
    """
    same = (here.owner[of, None] == here.owner) & np.isfinite(there.values)
    apart = np.abs(there.labels - here.labels[of, None])
    apart = np.minimum(apart, np.abs(apart - 2.0 * np.pi))
    near = same & (apart < _SAME)
    count = len(there.owner)
    steps = np.abs(np.arange(count) - of[:, None])
    rank = np.where(near, np.rint(1e3 * np.where(near, apart, 0.0)) * (count + 1.0) + steps, np.inf)
    rows = zip(of.tolist(), rank, near.any(axis=1), strict=True)
    return [(index, int(row.argmin())) for index, row, has in rows if has]


def difference(here: Rows, there: Rows, weight: Array) -> Array:
    """Return the weighted change of gradients."""
    total = np.zeros(here.gradients.shape[1])
    for index, twin in partners(here, there, np.flatnonzero(weight > 0.0)):
        total = total + weight[index] * (there.gradients[twin] - here.gradients[index])
    return total


def bent(here: Rows, there: Rows, step: Array) -> Array:
    """Return the values of rows whose linearisation meets their values at the end of a step."""
    values = here.values.copy()
    for index, twin in partners(here, there, np.flatnonzero(np.isfinite(values))):
        values[index] = there.values[twin] - here.gradients[index] @ step
    return values
