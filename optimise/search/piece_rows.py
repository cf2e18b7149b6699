"""Rows of smooth pieces: which are active, and which rows of two designs are the same piece."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...model.arrays import Array, IntArray, Mask

ACTIVE = 1e-8
"""Constraint rows closer to zero than this, and scaled objective pieces closer to their greatest, are active."""
_SAME = 0.3  # labels farther apart (rad) belong to different peaks


@dataclass(frozen=True)
class Rows:
    """Smooth rows of n designs in the free unknowns: `value <= 0` for constraints, "greatest of" for objectives.

    values: (n, r), -inf for absent rows. gradients: (n, r, k). labels: (n, r). owner: (r,), the constraint or objective
    that a row belongs to. constant: owners with the same value for every design, whose slopes prove nothing; empty if
    all are constant.
    """

    values: Array
    gradients: Array
    labels: Array
    owner: IntArray
    constant: tuple[int, ...] = ()

    @classmethod
    def without_rows(cls, n: int, k: int) -> Rows:
        """Return an empty set of rows for n designs in k unknowns."""
        return cls(np.zeros((n, 0)), np.zeros((n, 0, k)), np.zeros((n, 0)), np.zeros(0, np.int64))

    def overwrite(self, row: int, replacement: Rows, source: int) -> None:
        """Overwrite a design's rows with those of a design of `replacement`."""
        self.values[row] = replacement.values[source]
        self.gradients[row] = replacement.gradients[source]
        self.labels[row] = replacement.labels[source]


def greatest_pieces(rows: Rows, count: int) -> Array:
    """Return the greatest piece of each owner, (..., count)."""
    return np.stack([rows.values[..., rows.owner == owner].max(axis=-1) for owner in range(count)], axis=-1)


def rows_of_designs(rows: Rows, row: int | slice) -> Rows:
    """Return the rows of one design, or of several."""
    return Rows(rows.values[row], rows.gradients[row], rows.labels[row], rows.owner)


def active_bound_normals(u: Array, *, tolerance: float = ACTIVE) -> Array:
    """Return the gradients of the box's active bounds."""
    edge = np.eye(len(u))
    return np.concatenate([-edge[u < tolerance], edge[u > 1.0 - tolerance]])


def active_pieces(goals: Rows, chosen: tuple[int, ...], *, tolerance: float = ACTIVE) -> IntArray:
    """Return the pieces that tie for the greatest of each chosen objective."""
    pieces = []
    for owner in chosen:
        columns = np.flatnonzero(goals.owner == owner)
        values = goals.values[columns]
        pieces.append(columns[values >= values.max() - tolerance])
    return np.concatenate(pieces)


def matching_rows(rows: Rows, others: Rows, columns: IntArray) -> tuple[IntArray, Mask]:
    """Return the rows of other designs (..., p) that match rows (p,) of one design, and whether they exist.

    Rows match by label, because peaks may swap their order. Rows of one owner with equal labels (lower and upper bound)
    keep their order.
    """
    same = (rows.owner[columns, None] == rows.owner) & np.isfinite(others.values)[..., None, :]
    distances = np.abs(others.labels[..., None, :] - rows.labels[columns, None])
    distances = np.minimum(distances, np.abs(distances - 2.0 * np.pi))
    near = same & (distances < _SAME)
    count = len(others.owner)
    steps = np.abs(np.arange(count) - columns[:, None])
    rank = np.where(near, np.rint(1e3 * np.where(near, distances, 0.0)) * (count + 1.0) + steps, np.inf)
    return rank.argmin(axis=-1), near.any(axis=-1)


def weighted_gradient_change(rows: Rows, others: Rows, weight: Array) -> Array:
    """Return the weighted change of gradients (n, k) from one design to n others."""
    n = len(others.values)
    total, columns = np.zeros((n, rows.gradients.shape[1])), np.flatnonzero(weight > 0.0)
    if not len(columns):
        return total
    twins, is_matched = matching_rows(rows, others, columns)
    changes = weight[columns, None] * (others.gradients[np.arange(n)[:, None], twins] - rows.gradients[columns])
    if not is_matched.all():
        changes = np.where(is_matched[..., None], changes, 0.0)
    for place in range(len(columns)):  # in this order, because pairwise sums round differently
        total = total + changes[:, place]
    return total


def values_corrected_for_curvature(rows: Rows, end_rows: Rows, step: Array) -> Array:
    """Return values such that the linearised rows agree with the true rows at the end of a step."""
    values = rows.values.copy()
    columns = np.flatnonzero(np.isfinite(values))
    if len(columns):
        for index, twin, is_matched in zip(
            columns.tolist(), *(array.tolist() for array in matching_rows(rows, end_rows, columns)), strict=True
        ):
            if is_matched:
                values[index] = end_rows.values[twin] - rows.gradients[index] @ step
    return values
