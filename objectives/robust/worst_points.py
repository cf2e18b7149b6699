"""A quantity at points in the tolerance boxes around designs, and its worst points besides the corners.

These are at offset zero, or at an extreme of the quantity. Pieces are kept separate.
"""

import itertools
from dataclasses import dataclass
from typing import Any

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
    rotate fully, or a lever cannot make its swing. gradients: (n, q, p, 3 + k), with respect to the design rather than
    the point: a tolerance may grow with its dimension. local: (n, q, p, 3), with respect to the point. labels:
    (n, q, p). turns: (n, q), whether the linkage can move.
    """

    values: Array
    gradients: Array
    local: Array
    labels: Array
    turns: Mask

    def highest_pieces(self, slopes: Array) -> tuple[Array, Array]:
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
    is_slider_crank = mechanism.lever is None
    shortest_rod = (moved[:, :, 0] + np.abs(moved[:, :, 2])) * is_slider_crank
    turns = (moved[:, :, 0] > 0.0) & (moved[:, :, 1] > shortest_rod)
    moved = np.where(turns[:, :, None], moved, dimensions[:, None, :])
    pieces = quantity.pieces(mechanism, np.ascontiguousarray(moved.reshape(n * q, width)))
    values = pieces.values.reshape(n, q, pieces.values.shape[1]).copy()
    gradients = pieces.gradients.reshape(*values.shape, width).copy()
    turns &= is_slider_crank | ~np.isnan(values).any(axis=2)  # NaN: a lever that cannot make its swing
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


_SIDE_STEP = (
    1e-6  # in units of the limits: distance from offset zero that distinguishes a kink there from a nearby extreme
)
_LOST = 1e-13  # relative: margin by which a point must be worse than another
_FLAT = 1e-9  # of a value, over the limits: smaller slopes do not show where a curve has its extreme
_STEPS = 60
_EXACT = 1e-15


@dataclass(frozen=True)
class InnerPoints:
    """Points (m, q, 3) besides the corners, in units of the limits, for the designs `rows` (m,) that have any."""

    rows: IntArray
    points: Array


def worst_inner_points(
    quantity: Quantity,
    mechanism: Mechanism,
    dimensions: Array,
    columns: list[int],
    at_corners: PointValues,
    *,
    low: bool,
) -> InnerPoints:
    """Return points inside the boxes of designs (n, 3 + k) that may be worse than all their corners.

    at_corners: the quantity at the corners. low: whether the minimum is the worst value, else the maximum. 1.
    Quantities that depend on |offset| have an extreme at zero; those points are included if the limits span it. 2. At
    the worst of all these points, the quantity must improve in every direction into the box, to first order.
       Otherwise it has an extreme inside, and sequential quadratic programming finds the worst value from there.
    """
    limits = tolerance_limits(mechanism, dimensions)
    spanning, points = points_at_zero_offset(columns, dimensions, limits)
    ends = box_corners(columns)
    worst, slopes, turns = _signed_as_losses(at_corners, low)
    start = ends[np.argmax(worst, axis=1)]
    inward = (start * _slopes_at_worst(worst, slopes)) * limits
    best = worst.max(axis=1)
    doubtful = (inward[:, columns] < -_FLAT * np.abs(best)[:, None]).any(axis=1)
    if len(spanning):
        at_zero, zero_slopes, _ = _signed_as_losses(
            evaluate_points(quantity, mechanism, dimensions[spanning], points), low
        )
        beaten = at_zero.max(axis=1) >= best[spanning]
        rows, zero_points = spanning[beaten], points[beaten]
        place = np.argmax(at_zero[beaten], axis=1)
        start[rows], best[rows] = zero_points[np.arange(len(rows)), place], at_zero[beaten].max(axis=1)
        inward = start[rows] * _slopes_at_worst(at_zero[beaten], zero_slopes[beaten]) * limits[rows]
        other_columns = [column for column in columns if column != 2]
        doubtful[rows] = (inward[:, other_columns] < -_FLAT * np.abs(best[rows])[:, None]).any(axis=1)
        next_to_zero = start[rows][:, None, :] + _SIDE_STEP * np.array(
            [[[0.0, 0.0, 1.0]], [[0.0, 0.0, -1.0]]]
        ).transpose(1, 0, 2)
        near, _, _ = _signed_as_losses(evaluate_points(quantity, mechanism, dimensions[rows], next_to_zero), low)
        doubtful[rows] |= near.max(axis=1, initial=-np.inf) > best[rows] + _LOST * np.abs(best[rows])
    doubtful &= turns.all(axis=1) & np.isfinite(best)
    sought = {
        int(row): _search_worst_point(quantity, mechanism, dimensions[row], columns, start[row], low)
        for row in np.flatnonzero(doubtful)
    }
    rows = np.union1d(spanning, np.flatnonzero(doubtful)).astype(np.int64)
    count = len(ends) // 2 if len(spanning) else 0
    inner_points = np.repeat(
        start[rows][:, None], count + 1, axis=1
    )  # designs without an inner point repeat their worst point
    if len(spanning):
        inner_points[np.searchsorted(rows, spanning), :count] = points
    for index, row in enumerate(rows.tolist()):
        inner_points[index, count] = sought.get(row, start[row])
    return InnerPoints(rows, inner_points)


def _signed_as_losses(point_values: PointValues, low: bool) -> tuple[Array, Array, Mask]:
    """Return a quantity as a loss at points (n, q), slopes (n, q, 3), and where the linkage rotates fully."""
    values, slopes = point_values.highest_pieces(point_values.local)
    sign = -1.0 if low else 1.0
    return np.where(point_values.turns, sign * values, np.inf), sign * slopes, point_values.turns


def _slopes_at_worst(worst: Array, slopes: Array) -> Array:
    """Return the slopes (n, 3) at the worst point of each design."""
    return np.take_along_axis(slopes, np.argmax(worst, axis=1)[:, None, None], axis=1)[:, 0]


def _search_worst_point(
    quantity: Quantity, mechanism: Mechanism, design: Array, columns: list[int], start: Array, low: bool
) -> Array:
    """Return the worst point (3,) near a start.

    If the worst value is the minimum of a maximum, peaks may tie there (minimax).
    """
    from scipy.optimize import minimize

    search: Any = minimize  # its stubs do not match SLSQP's signature
    at_start = evaluate_points(quantity, mechanism, design[None], start[None])
    many = (
        np.isfinite(at_start.values[0, 0])
        if low
        else np.argmax(at_start.values[0, 0]) == np.arange(at_start.values.shape[2])
    )
    size = abs(float(at_start.values[0, 0].max())) or 1.0
    tolerances = tolerance_limits(mechanism, design[None])[0]

    def pieces(point: Array) -> tuple[Array, Array]:
        at = start.copy()
        at[columns] = point
        point_values = evaluate_points(quantity, mechanism, design[None], np.stack([start, at]))
        values, _, has_twin = match_pieces(point_values)
        _, local, _ = match_pieces(
            PointValues(
                point_values.values, point_values.local, point_values.local, point_values.labels, point_values.turns
            )
        )
        counted_pieces = many & has_twin[0, 1]
        return np.where(counted_pieces, values[0, 1], -np.inf)[many] / size, local[0, 1][many] * tolerances / size

    # Unknowns: the point and, for a minimax, the bound that no piece exceeds.
    begin = start[columns]
    bounds: Any = [(-1.0, 1.0)] * len(columns)
    limits_met: Any = ()
    value, slope = (lambda z: -float(pieces(z)[0][0])), (lambda z: -pieces(z)[1][0, columns])
    if low:

        def slack(z: Array) -> Array:
            values = pieces(z[:-1])[0]
            return np.where(np.isfinite(values), z[-1] - values, 1.0)

        def slack_slopes(z: Array) -> Array:
            values, slopes = pieces(z[:-1])
            is_finite = np.isfinite(values)[:, None]
            return np.concatenate(
                [np.where(is_finite, -slopes[:, columns], 0.0), np.where(is_finite, 1.0, 0.0)], axis=1
            )

        limits_met = [{"type": "ineq", "fun": slack, "jac": slack_slopes}]
        begin, bounds = np.append(begin, float(pieces(begin)[0].max())), [*bounds, (None, None)]
        value, slope = (lambda z: float(z[-1])), (lambda _: np.append(np.zeros(len(columns)), 1.0))
    options: Any = {"maxiter": _STEPS, "ftol": _EXACT}
    result = search(value, begin, jac=slope, bounds=bounds, constraints=limits_met, method="SLSQP", options=options)
    worst_point = start.copy()
    if np.isfinite(result.x).all():
        worst_point[columns] = np.clip(result.x[: len(columns)], -1.0, 1.0)
    return worst_point
