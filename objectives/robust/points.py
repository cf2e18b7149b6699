"""A quantity at points of the tolerance box around designs, with its pieces kept separate."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np

from ...model.arrays import IntArray, Mask
from ...model.errors import InputError
from ...model.machine.mechanism import Mechanism
from ..quantity import Array, Quantity

_SAME = 0.3  # labels (rad) farther apart are not the same peak; as the polish has it


@dataclass(frozen=True)
class PointValues:
    """A quantity at q points around each of n designs.

    values: (n, q, p), values of its pieces, -inf where absent; +inf in the first where the linkage does not rotate
    fully. gradients: (n, q, p, 3 + k), by the design, not by the point: a tolerance may grow with its dimension.
    local: (n, q, p, 3), by the point. labels: (n, q, p). turns: (n, q), whether the linkage rotates fully.
    """

    values: Array
    gradients: Array
    local: Array
    labels: Array
    turns: Mask

    def highest(self, slopes: Array) -> tuple[Array, Array]:
        """Return the values (n, q) of the highest piece at each point, and its slopes."""
        first = np.argmax(self.values, axis=2)[:, :, None]
        values = np.take_along_axis(self.values, first, axis=2)[:, :, 0]
        return values, np.take_along_axis(slopes, first[:, :, :, None], axis=2)[:, :, 0]


def limits_of(mechanism: Mechanism, dimensions: Array) -> Array:
    """Return the tolerances of crank, rod and offset of designs (n, 3 + k), (n, 3), m.

    The tolerance of the crank angle is left out: no quantity of a whole cycle depends on the start of the cycle. So are
    clearances: pins and guide are ideal except in position errors. Raises `InputError` for tolerances that vary.
    """
    for item in mechanism.varying:
        if any(path.startswith("tolerances.") for path in item.paths):
            raise InputError(
                f"robust quantities need tolerances that are given; got {item.name} that varies; fix it, or leave "
                "out robust"
            )
    absolute, fraction = _nominal_and_tolerances(mechanism)
    limits: Array = absolute + fraction * np.abs(dimensions[:, :3])
    return limits


def uncertain(mechanism: Mechanism) -> list[int]:
    """Return which of crank, rod and offset (0, 1, 2) have a tolerance."""
    absolute, fraction = _nominal_and_tolerances(mechanism)
    return np.flatnonzero((absolute > 0.0) | (fraction > 0.0)).tolist()


def corners(columns: list[int]) -> Array:
    """Return the corners of the box, (2^d, 3), in units of the limits; opposite corners are mirrored rows."""
    points = np.zeros((2 ** len(columns), 3))
    points[:, columns] = list(itertools.product((-1.0, 1.0), repeat=len(columns)))
    return points


def in_line(columns: list[int], dimensions: Array, limits: Array) -> tuple[IntArray, Array]:
    """Return the designs (m,) whose offset may be zero within the limits, and their points (m, q, 3) there.

    The points are the corners of the other dimensions' box, in units of the limits.
    """
    if 2 not in columns:
        return np.zeros(0, np.int64), np.zeros((0, 0, 3))
    rows = np.flatnonzero((np.abs(dimensions[:, 2]) < limits[:, 2]) & (limits[:, 2] > 0.0))
    ends = corners([column for column in columns if column != 2])
    points = np.repeat(ends[None], len(rows), axis=0)
    points[:, :, 2] = -(dimensions[rows, 2] / limits[rows, 2])[:, None]
    return rows, points


def star(columns: list[int]) -> Array:
    """Return the points (q, 3) that fit a full quadratic, in units of the limits. Here q = 1 + 2 d + d (d - 1).

    The centre, both ends along each axis, and two opposite corners in each plane: cubic terms then cancel in the mixed
    second derivatives as they do in the pure ones.
    """
    rows = [np.zeros(3)]
    for column in columns:
        rows += [sign * np.eye(3)[column] for sign in (1.0, -1.0)]
    for a, b in itertools.combinations(columns, 2):
        rows += [sign * (np.eye(3)[a] + np.eye(3)[b]) for sign in (1.0, -1.0)]
    return np.array(rows)


def evaluate_points(quantity: Quantity, mechanism: Mechanism, dimensions: Array, points: Array) -> PointValues:
    """Return a quantity at points (q, 3) around designs (n, 3 + k), in units of the limits.

    points: points of all designs, or (n, q, 3) for each.
    """
    absolute, fraction = _nominal_and_tolerances(mechanism)
    n, q, width = len(dimensions), points.shape[-2], dimensions.shape[1]
    moved = np.repeat(dimensions[:, None, :], q, axis=1)
    moved[:, :, :3] += points * (absolute + fraction * np.abs(dimensions[:, None, :3]))
    turns = (moved[:, :, 0] > 0.0) & (moved[:, :, 1] > moved[:, :, 0] + np.abs(moved[:, :, 2]))
    moved = np.where(turns[:, :, None], moved, dimensions[:, None, :])
    pieces = quantity.pieces(mechanism, np.ascontiguousarray(moved.reshape(n * q, width)))
    values = pieces.values.reshape(n, q, pieces.values.shape[1]).copy()
    gradients = pieces.gradients.reshape(*values.shape, width).copy()
    local = gradients[:, :, :, :3].copy()
    gradients[:, :, :, :3] *= (1.0 + points * fraction * np.sign(dimensions[:, None, :3]))[:, :, None, :]
    values[~turns] = -np.inf
    values[~turns, 0] = np.inf
    gradients[~turns] = local[~turns] = 0.0
    return PointValues(values, gradients, local, pieces.labels.reshape(values.shape), turns)


def match_pieces(point_values: PointValues) -> tuple[Array, Array, Mask]:
    """Return the pieces of the first point (the centre) at all points: values (n, q, p), gradients, and a mask.

    A piece is found at a point if a piece there has nearly the same label; the mask tells where.
    """
    distance = np.abs(
        point_values.labels[:, :, None, :] - point_values.labels[:, :1, :, None]
    )  # (n, q, p of the centre, p)
    distance = np.minimum(distance, np.abs(distance - 2.0 * np.pi))
    distance = np.where(np.isfinite(point_values.values)[:, :, None, :], distance, np.inf)
    twin = np.argmin(distance, axis=3)
    has_twin = np.take_along_axis(distance, twin[:, :, :, None], axis=3)[:, :, :, 0] < _SAME
    has_twin &= np.isfinite(point_values.values[:, :1, :])
    values = np.take_along_axis(point_values.values, twin, axis=2)
    gradients = np.take_along_axis(point_values.gradients, twin[:, :, :, None], axis=2)
    return values, gradients, has_twin


def _nominal_and_tolerances(mechanism: Mechanism) -> tuple[Array, Array]:
    t = mechanism.tolerances
    tolerances = [(float(each.absolute), float(each.fraction)) for each in (t.crank, t.rod, t.offset)]
    absolute, fraction = np.array(tolerances).T
    return absolute, fraction
