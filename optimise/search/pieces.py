"""Rows of smooth pieces: which are active, and which of two designs' rows are the same piece."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...model.arrays import Array, Mask, Whole

ACTIVE = 1e-8
"""Constraint rows nearer to zero than this, and objective pieces nearer to their greatest (scaled), are active."""
_SAME = 0.3  # labels farther apart (rad) are not the same peak


@dataclass(frozen=True)
class Rows:
    """Smooth rows of n designs in the free unknowns: `value <= 0` for constraints, "greatest of" for objectives.

    values: (n, r), -inf for absent rows. gradients: (n, r, k). labels: (n, r). owner: (r,), the constraint or
    objective that a row belongs to. constant: owners that are the same for every design, of which nothing can be told
    by slopes; none if all are.
    """

    values: Array
    gradients: Array
    labels: Array
    owner: Whole
    constant: tuple[int, ...] = ()

    @classmethod
    def absent(cls, n: int, k: int) -> Rows:
        """Return no rows of n designs in k unknowns."""
        return cls(np.zeros((n, 0)), np.zeros((n, 0, k)), np.zeros((n, 0)), np.zeros(0, np.int64))

    def overwrite(self, row: int, other: Rows, source: int) -> None:
        """Overwrite a design's rows with those of a design of `other`."""
        self.values[row] = other.values[source]
        self.gradients[row] = other.gradients[source]
        self.labels[row] = other.labels[source]


def greatest(rows: Rows, count: int) -> Array:
    """Return the greatest piece of each owner, (..., count)."""
    return np.stack([rows.values[..., rows.owner == owner].max(axis=-1) for owner in range(count)], axis=-1)


def alone(rows: Rows, row: int | slice) -> Rows:
    """Return the rows of one design, or of some."""
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


def partners(here: Rows, there: Rows, of: Whole) -> tuple[Whole, Mask]:
    """Return for rows (p,) of one design the same rows of others (..., p), and whether these have them.

    Matched by labels, since peaks may swap their order. Rows of one owner with equal labels (lower and upper bound)
    keep their place.
    """
    same = (here.owner[of, None] == here.owner) & np.isfinite(there.values)[..., None, :]
    apart = np.abs(there.labels[..., None, :] - here.labels[of, None])
    apart = np.minimum(apart, np.abs(apart - 2.0 * np.pi))
    near = same & (apart < _SAME)
    count = len(there.owner)
    steps = np.abs(np.arange(count) - of[:, None])
    rank = np.where(near, np.rint(1e3 * np.where(near, apart, 0.0)) * (count + 1.0) + steps, np.inf)
    return rank.argmin(axis=-1), near.any(axis=-1)


def difference(here: Rows, there: Rows, weight: Array) -> Array:
    """Return the weighted change of gradients (n, k) from one design to n others."""
    n = len(there.values)
    total, of = np.zeros((n, here.gradients.shape[1])), np.flatnonzero(weight > 0.0)
    if not len(of):
        return total
    twins, had = partners(here, there, of)
    changes = weight[of, None] * (there.gradients[np.arange(n)[:, None], twins] - here.gradients[of])
    if not had.all():
        changes = np.where(had[..., None], changes, 0.0)
    for place in range(len(of)):  # in order, as sums of pairs round otherwise
        total = total + changes[:, place]
    return total


def bent(here: Rows, there: Rows, step: Array) -> Array:
    """Return the values of rows whose linearisation meets their values at the end of a step."""
    values = here.values.copy()
    of = np.flatnonzero(np.isfinite(values))
    if len(of):
        for index, twin, had in zip(of.tolist(), *(found.tolist() for found in partners(here, there, of)), strict=True):
            if had:
                values[index] = there.values[twin] - here.gradients[index] @ step
    return values
