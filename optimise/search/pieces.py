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


def partner(here: Rows, there: Rows, index: int) -> int | None:
    """Return the row of another design that is the same piece, matched by its label: peaks may swap their order."""
    same = np.flatnonzero((here.owner == here.owner[index]) & np.isfinite(there.values))
    apart = np.abs(there.labels[same] - here.labels[index])
    apart = np.minimum(apart, np.abs(apart - 2.0 * np.pi))
    near = apart < _SAME
    same, apart = same[near], apart[near]
    # Rows of one owner with equal labels (lower and upper bound) keep their place.
    return int(same[np.lexsort((np.abs(same - index), np.round(apart, 3)))[0]]) if len(same) else None


def difference(here: Rows, there: Rows, weight: Array) -> Array:
    """Return the weighted change of gradients."""
    total = np.zeros(here.gradients.shape[1])
    for index in np.flatnonzero(weight > 0.0).tolist():
        twin = partner(here, there, index)
        if twin is not None:
            total = total + weight[index] * (there.gradients[twin] - here.gradients[index])
    return total


def bent(here: Rows, there: Rows, step: Array) -> Array:
    """Return the values of rows whose linearisation meets their values at the end of a step."""
    values = here.values.copy()
    for index in np.flatnonzero(np.isfinite(values)).tolist():
        twin = partner(here, there, index)
        if twin is not None:
            values[index] = there.values[twin] - here.gradients[index] @ step
    return values
