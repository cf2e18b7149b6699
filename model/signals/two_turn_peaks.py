"""Peaks and averages over a two-turn cycle, from those of its two halves."""

from typing import Protocol

import numpy as np

from ..arrays import Array, IntArray
from ..kinematics import geometry
from ..machine.cylinders_and_turns import shift_angles_into_half
from ..machine.mechanism import Mechanism


class _Peaks(Protocol):
    @property
    def values(self) -> Array: ...
    @property
    def angles(self) -> Array: ...
    @property
    def gradients(self) -> Array | None: ...


class _Averages(Protocol):
    @property
    def values(self) -> Array: ...
    @property
    def gradients(self) -> Array | None: ...


def highest_peaks_of_both_turns(
    mechanism: Mechanism, designs: Array, first: _Peaks, second: _Peaks
) -> tuple[Array, Array, Array | None]:
    """Return values, angles and gradients for the highest peaks of both turns, as many as each turn has."""
    limit = first.values.shape[1]
    values = np.concatenate([first.values, second.values], axis=1)
    order = np.argsort(-values, axis=1, kind="stable")[:, :limit]
    angles = np.concatenate(
        [angles_within_both_turns(mechanism, designs, part.angles, half) for half, part in enumerate((first, second))],
        axis=1,
    )
    gradients = None
    if first.gradients is not None and second.gradients is not None:
        all_gradients = np.concatenate([first.gradients, second.gradients], axis=1)
        gradients = np.take_along_axis(all_gradients, order[:, :, None], axis=1)
    return np.take_along_axis(values, order, axis=1), np.take_along_axis(angles, order, axis=1), gradients


def averages_of_both_turns(first: _Averages, second: _Averages) -> tuple[Array, Array | None]:
    """Return `Averages` (3, n) and their gradients over both turns, for a crank at constant speed."""
    mean, square = 0.5 * (first.values[:1] + second.values[:1]), 0.5 * (first.values[1:] ** 2 + second.values[1:] ** 2)
    rms = np.sqrt(square)
    values = np.concatenate([mean, rms])
    if first.gradients is None or second.gradients is None:
        return values, None
    first_part, second_part = (part.values[1:, :, None] * np.asarray(part.gradients)[1:] for part in (first, second))
    with np.errstate(invalid="ignore", divide="ignore"):
        moved = 0.5 * (first_part + second_part) / rms[:, :, None]
    moved = np.where(rms[:, :, None] > 0.0, moved, 0.0)
    return values, np.concatenate([0.5 * (first.gradients[:1] + second.gradients[:1]), moved])


def angles_within_both_turns(mechanism: Mechanism, designs: Array, angles: Array, half: int | IntArray) -> Array:
    """Return crank angles within both turns for peaks (n, k) of given halves, rad; NaN stays."""
    dimensions = designs[:, :3].T[:, :, None]
    inner, outer = geometry.inner_crank_angle(*dimensions), geometry.outer_crank_angle(*dimensions)
    if mechanism.branch == "crossed":
        inner, outer = np.pi - inner, np.pi - outer
    is_finite = np.isfinite(angles)
    return np.where(
        is_finite, shift_angles_into_half(mechanism, inner, outer, np.where(is_finite, angles, 0.0), half), angles
    )
