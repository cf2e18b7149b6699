"""A quantity at points in the tolerance boxes around designs, with its pieces kept separate."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np

from ...model.arrays import IntArray, Mask
from ...model.errors import InputError
from ...model.machine.mechanism import Mechanism
from ..quantity import Array, Quantity

_SAME = 0.3  # labels (rad) farther apart belong to different peaks; the polish uses the same value


@dataclass(frozen=True)
class PointValues:
    """A quantity at q points around each of n designs.

    values: (n, q, p), values of its pieces, -inf where absent; +inf in the first piece where the linkage does not
    rotate fully. gradients: (n, q, p, 3 + k), with respect to the design rather than the point: a tolerance may grow
    with its dimension. local: (n, q, p, 3), with respect to the point. labels: (n, q, p). turns: (n, q), whether the
    linkage rotates fully.
    """

    values: Array
    gradients: Array
    local: Array
    labels: Array
    turns: Mask

    def highest(self, slopes: Array) -> tuple[Array, Array]:
        """Return the value (n, q) of the highest piece at each point, with its gradients."""
        first = np.argmax(self.values, axis=2)[:, :, None]
        values = np.take_along_axis(self.values, first, axis=2)[:, :, 0]
        return values, np.take_along_axis(slopes, first[:, :, :, None], axis=2)[:, :, 0]


def tolerance_limits(mechanism: Mechanism, dimensions: Array) -> Array:
    """Return the tolerances of crank, rod and offset for designs (n, 3 + k), (n, 3), m.

    The tolerance of the crank angle is excluded: no quantity over a whole cycle depends on where the cycle starts.
    Clearances are excluded, too: pins and guide are ideal except in position errors. Raises `InputError` if tolerances
    are variables.
    """
    for item in mechanism.varying:
        if any(path.startswith("tolerances.") for path in item.paths):
            raise InputError(
                f"robust quantities need fixed tolerances; got {item.name} as a variable; fix it, or leave out robust"
            )
    absolute, fraction = _nominal_and_tolerances(mechanism)
    limits: Array = absolute + fraction * np.abs(dimensions[:, :3])
    return limits


def toleranced_columns(mechanism: Mechanism) -> list[int]:
    """Return the indices among crank, rod and offset (0, 1, 2) that have a tolerance."""
    absolute, fraction = _nominal_and_tolerances(mechanism)
    return np.flatnonzero((absolute > 0.0) | (fraction > 0.0)).tolist()


def box_corners(columns: list[int]) -> Array:
    """Return the corners of the box, (2^d, 3), in units of the limits; opposite corners are in mirrored rows."""
    points = np.zeros((2 ** len(columns), 3))
    points[:, columns] = list(itertools.product((-1.0, 1.0), repeat=len(columns)))
    return points


def points_at_zero_offset(columns: list[int], dimensions: Array, limits: Array) -> tuple[IntArray, Array]:
    """Return the designs (m,) whose offset may be zero within the limits, and their points (m, q, 3) there.

    The points are the corners of the box in the other dimensions, in units of the limits.
    """
    if 2 not in columns:
        return np.zeros(0, np.int64), np.zeros((0, 0, 3))
    rows = np.flatnonzero((np.abs(dimensions[:, 2]) < limits[:, 2]) & (limits[:, 2] > 0.0))
    ends = box_corners([column for column in columns if column != 2])
    points = np.repeat(ends[None], len(rows), axis=0)
    points[:, :, 2] = -(dimensions[rows, 2] / limits[rows, 2])[:, None]
    return rows, points


def quadratic_fit_points(columns: list[int]) -> Array:
    """Return the points (q, 3) for fitting a full quadratic, in units of the limits. Here q = 1 + 2 d + d (d - 1).

    The centre, both ends of each axis, and two opposite corners in each plane. Cubic terms then cancel in the mixed
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

    points: common to all designs, or (n, q, 3) for each.
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
    """Return the centre's pieces at all points: values (n, q, p), gradients, and a mask.

    The centre is the first point. The mask marks where a piece with nearly the same label exists.
    """
    distance = np.abs(
        point_values.labels[:, :, None, :] - point_values.labels[:, :1, :, None]
    )  # (n, q, p at the centre, p)
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
