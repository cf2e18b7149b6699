"""Deviation from a target motion (`target_motion`) as the maximum of smooth pieces, with exact gradients.

Derivatives are taken at fixed phase and shift (envelope theorem). The minimum over the phase lies where the highest
deviation has its turning point, or where a rising and a falling deviation cross. With values a_m and a_n and slopes b_m
< 0 < b_n, the expression

    lambda_m a_m + lambda_n a_n,    lambda_m = b_n / (b_n - b_m),    lambda_n = -b_m / (b_n - b_m),

is the value to first order for any change in the design. Locally, the deviation is therefore the maximum over such
pairs (duality of the linear programme in the phase).
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..kernel.arithmetic import STEP
from ..kernel.batches import require_full_rotation
from .position import motion
from .target_motion import Measure, TargetMotion, fit_target_motion

_PEAKS = 6  # local peaks over the points, of either sign, that make pieces
_OTHER_POINTS = 3  # the highest among the other points
_CROSSED = 8  # candidates that are paired if the phase is free
_PIECES = 10
_CONVERGED = 1e-6  # rad; if a deviation's turning point is this close to the phase, they coincide up to rounding
_MIX = 0.5 * (math.sqrt(5.0) - 1.0)  # any irrational: labels of different pairs hardly ever coincide


class FitPieces(NamedTuple):
    """The deviation as the maximum of smooth pieces, highest first: (n, k), gradients (n, k, 3), labels (n, k)."""

    values: Array
    gradients: Array
    labels: Array


def _motion_at_points(target: TargetMotion, branch: float, phase: Array, designs: NDArray[Any]) -> Any:
    """Return the `Motion` at the points, each array (n, points), for real or complex designs (n, 3)."""
    theta = np.array(target.crank_angles) + phase[:, None]
    r, l, e = (designs[:, v, None] for v in range(3))
    return motion(np.sin(theta), np.cos(theta), r, l, e, branch)


def _slider_position_slopes(target: TargetMotion, branch: float, phase: Array, designs: Array) -> Array:
    """Return the derivatives (n, points, 3) of the slider's distance at fixed phase, by complex steps."""
    slopes = np.empty((len(designs), len(target.positions), 3))
    for v in range(3):
        stepped = designs.astype(np.complex128)
        stepped[:, v] += STEP * 1j
        slopes[:, :, v] = branch * _motion_at_points(target, branch, phase, stepped).x.imag / STEP
    return slopes


def least_deviation_pieces(target: TargetMotion, branch: float, measure: Measure, designs: Array) -> FitPieces:
    """Return the minimum deviation for designs (n, 3) as the maximum of smooth pieces.

    The root mean square has one piece; its gradient is zero where it is only a rounding error.
    """
    designs = require_full_rotation(designs)
    fitted = fit_target_motion(target, branch, measure, designs)
    if measure == "rms":
        d = branch * _motion_at_points(target, branch, fitted.phase, designs).x - np.array(target.positions)
        d = d + fitted.shift[:, None]
        slopes = _slider_position_slopes(target, branch, fitted.phase, designs)
        # If the shift is free, the deviations have zero mean, so the means of the derivatives need not be subtracted.
        noise = fitted.values <= 1e-14 * (designs[:, 0] + designs[:, 1])
        per = np.where(noise, 0.0, 1.0 / np.where(noise, 1.0, fitted.values * d.shape[1]))
        gradients = np.einsum("ni,niv->nv", d, slopes) * per[:, None]
        return FitPieces(fitted.values[:, None], gradients[:, None], np.zeros((len(designs), 1)))
    phase = fitted.phase.copy()
    sides = _DeviationCandidates.from_points(target, branch, phase, designs)
    if target.phase == "free":
        # Golden-section search locates a smooth turning point only to the square root of rounding, so a Newton step
        # follows.
        step = sides.newton_step_at_turning_point()
        if np.any(step != 0.0):
            phase = phase + step
            sides = _DeviationCandidates.from_points(target, branch, phase, designs)
        sides = sides.crossing_pairs()
    return sides.highest(_PIECES)


class _DeviationCandidates(NamedTuple):
    """Candidates (n, m) for the maximum deviation at a phase, -inf where there are fewer.

    values, slope, bend: deviations and their first and second derivatives with respect to the phase. gradients: (n, m,
    3). labels: as in `FitPieces`.
    """

    values: Array
    slope: Array
    bend: Array
    gradients: Array
    labels: Array

    @classmethod
    def from_points(cls, target: TargetMotion, branch: float, phase: Array, designs: Array) -> _DeviationCandidates:
        """Return the local peaks of both signs over the points; if the shift is free, half-sums of pairs."""
        m = _motion_at_points(target, branch, phase, designs)
        d = branch * m.x - np.array(target.positions)
        slopes = _slider_position_slopes(target, branch, phase, designs)
        angles = np.broadcast_to(np.array(target.crank_angles), d.shape)
        curves = (branch * m.x_1, branch * m.x_2)
        positive, negative = (_highest_deviations(sign, d, *curves, slopes, angles) for sign in (1.0, -1.0))
        if target.shift == "fixed":
            return cls(*(np.concatenate(pair, axis=1) for pair in zip(positive, negative, strict=True)))
        n = len(d)
        values, slope, bend = (
            (0.5 * (getattr(positive, name)[:, :, None] + getattr(negative, name)[:, None, :])).reshape(n, -1)
            for name in ("values", "slope", "bend")
        )
        gradients = 0.5 * (positive.gradients[:, :, None] + negative.gradients[:, None, :])
        labels = positive.labels[:, :, None] + _MIX * negative.labels[:, None, :]
        return cls(values, slope, bend, gradients.reshape(n, -1, 3), labels.reshape(n, -1))

    def newton_step_at_turning_point(self) -> Array:
        """Return the Newton step (n,) in the phase where the highest deviation has its own turning point, else zero."""
        top = np.argmax(self.values, axis=1)[:, None]
        value, slope, bend = (
            np.take_along_axis(getattr(self, name), top, axis=1)[:, 0] for name in ("values", "slope", "bend")
        )
        turns_by_itself = np.abs(slope) < _CONVERGED * bend
        step = np.where(turns_by_itself, -slope / np.where(turns_by_itself, bend, 1.0), 0.0)
        with np.errstate(invalid="ignore"):
            after_step = np.where(np.isfinite(self.values), self.values + self.slope * step[:, None], -np.inf)
        np.put_along_axis(after_step, top, -np.inf, axis=1)
        return np.where(after_step.max(axis=1) < value, step, 0.0)

    def crossing_pairs(self) -> _DeviationCandidates:
        """Return pairs of a falling and a rising deviation, and the highest deviation where it has a turning point."""
        few = self._take_highest(_CROSSED)
        n, k = few.values.shape
        turning = (np.abs(few.slope) < _CONVERGED * few.bend) & (np.arange(k) == 0)
        falling, rising = (few.slope < 0.0) & ~turning, (few.slope > 0.0) & ~turning
        finite = np.isfinite(few.values)
        is_pair = (falling & finite)[:, :, None] & (rising & finite)[:, None, :]
        slope_difference = few.slope[:, None, :] - few.slope[:, :, None]
        share = np.where(
            is_pair, few.slope[:, None, :] / np.where(is_pair, slope_difference, 1.0), 0.0
        )  # for the falling one
        finite_values = np.where(finite, few.values, 0.0)
        values = np.where(
            is_pair, share * finite_values[:, :, None] + (1.0 - share) * finite_values[:, None, :], -np.inf
        ).reshape(n, -1)
        gradients = share[..., None] * few.gradients[:, :, None] + (1.0 - share[..., None]) * few.gradients[:, None, :]
        labels = few.labels[:, :, None] + 0.5 * _MIX * few.labels[:, None, :]
        by_itself = turning | (~is_pair.any(axis=(1, 2))[:, None] & (np.arange(k) == 0))
        zeros = np.zeros((n, k + k * k))
        return _DeviationCandidates(
            np.concatenate([np.where(by_itself, few.values, -np.inf), values], axis=1),
            zeros,
            zeros,
            np.concatenate([few.gradients, gradients.reshape(n, -1, 3)], axis=1),
            np.concatenate([few.labels, labels.reshape(n, -1)], axis=1),
        )

    def highest(self, count: int) -> FitPieces:
        """Return the highest candidates, highest first."""
        few = self._take_highest(count)
        return FitPieces(few.values, np.where(np.isfinite(few.values)[..., None], few.gradients, 0.0), few.labels)

    def _take_highest(self, count: int) -> _DeviationCandidates:
        order = np.argsort(-self.values, axis=1, kind="stable")[:, :count]
        values, slope, bend, labels = (
            np.take_along_axis(getattr(self, name), order, axis=1) for name in ("values", "slope", "bend", "labels")
        )
        return _DeviationCandidates(
            values, slope, bend, np.take_along_axis(self.gradients, order[..., None], axis=1), labels
        )


def _highest_deviations(
    sign: float, d: Array, slope: Array, bend: Array, slopes: Array, angles: Array
) -> _DeviationCandidates:
    """Return the highest deviations times a sign: local peaks over the points, and others that may tie with them."""
    values = sign * d
    padded = np.pad(values, ((0, 0), (1, 1)), constant_values=-np.inf)
    peaks = (values >= padded[:, :-2]) & (values >= padded[:, 2:])
    labels = angles + (0.0 if sign > 0.0 else 0.5 * math.pi)
    curves = sign * slope, sign * bend, sign * slopes, labels
    parts = (
        _DeviationCandidates(np.where(peaks, values, -np.inf), *curves)._take_highest(_PEAKS),
        _DeviationCandidates(np.where(peaks, -np.inf, values), *curves)._take_highest(_OTHER_POINTS),
    )
    return _DeviationCandidates(*(np.concatenate(pair, axis=1) for pair in zip(*parts, strict=True)))
