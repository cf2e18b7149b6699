"""Worst points in the tolerance box besides its corners: at offset zero, or at an extreme of the quantity."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ...model.arrays import IntArray, Mask
from ...model.machine.mechanism import Mechanism
from ..quantity import Array, Quantity
from .tolerance_box_points import (
    PointValues,
    box_corners,
    evaluate_points,
    match_pieces,
    points_at_zero_offset,
    tolerance_limits,
)

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
    values, slopes = point_values.highest(point_values.local)
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
