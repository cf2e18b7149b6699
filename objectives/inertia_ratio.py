"""Inertia ratio of a motor: driven inertia divided by rotor inertia."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from ..model.machine.mechanism import Mechanism
from ..model.machine.raw_numbers_of_designs import DRIVE, evaluate_formula_of_raw_numbers
from ..model.signals.averages import signal_averages
from ..model.signals.peaks import find_peaks
from ..model.signals.signals import Signal
from .kinds import RATIO
from .machine_needs import DRIVE_TRAIN, ROTOR
from .quantity import Array, Group, Number, Pieces, Quantity, Values, undefined_values


def _per_rotor_inertia(number: Number) -> Any:
    return 1.0 / (number(DRIVE["gear_ratio"]) ** 2 * number(DRIVE["motor_inertia"]))


def _flywheel_inertia_ratio(number: Number) -> Any:
    return number(DRIVE["flywheel"]) * _per_rotor_inertia(number)


@dataclass(frozen=True, kw_only=True)
class InertiaRatio(Quantity):
    """(J + J_f) / (i^2 J_m), with the maximum or mean inertia J of the linkage at the crank.

    mean: whether J is the mean over the crank angle.
    """

    mean: bool

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); see `Quantity`."""
        if self.unmet_need(mechanism, "undefined"):
            return undefined_values(dimensions, gradients)
        if self.mean:
            averages = signal_averages(mechanism, Signal.REFLECTED_INERTIA, dimensions, gradients=gradients)
            return self._ratio(mechanism, dimensions, averages.mean, averages.mean_gradients)
        peaks = find_peaks(mechanism, Signal.REFLECTED_INERTIA, dimensions, gradients=gradients, limit=1)
        slopes = None if peaks.gradients is None else peaks.gradients[:, 0]
        return self._ratio(mechanism, dimensions, peaks.values[:, 0], slopes)

    def pieces(self, mechanism: Mechanism, dimensions: Array) -> Pieces:
        """Return the ratios for the highest local peaks of the inertia; see `Quantity`."""
        if self.mean or self.unmet_need(mechanism, "undefined"):
            return super().pieces(mechanism, dimensions)
        peaks = find_peaks(mechanism, Signal.REFLECTED_INERTIA, dimensions, gradients=True)
        assert peaks.gradients is not None
        values, slopes = np.full_like(peaks.values, -np.inf), np.zeros_like(peaks.gradients)
        for place in range(values.shape[1]):
            rows = np.flatnonzero(np.isfinite(peaks.values[:, place]))
            ratio = self._ratio(mechanism, dimensions[rows], peaks.values[rows, place], peaks.gradients[rows, place])
            assert ratio.gradients is not None
            values[rows, place], slopes[rows, place] = ratio.values, ratio.gradients
        return Pieces(values, slopes, peaks.angles)

    def _ratio(self, mechanism: Mechanism, designs: Array, inertia: Array, slopes: Array | None) -> Values:
        scale, flywheel = (
            Values(*evaluate_formula_of_raw_numbers(mechanism, designs, formula, gradients=slopes is not None))
            for formula in (_per_rotor_inertia, _flywheel_inertia_ratio)
        )
        linkage = Values(inertia, slopes).times(scale)
        if linkage.gradients is None or flywheel.gradients is None:
            return Values(linkage.values + flywheel.values, None)
        return Values(linkage.values + flywheel.values, linkage.gradients + flywheel.gradients)


_ratio = partial(
    InertiaRatio,
    kind=RATIO,
    group=Group.DRIVE,
    section="10. Motor and balance",
    picture="inertia",
    example=5.0,
    needs=(DRIVE_TRAIN, ROTOR),
)
INERTIA_RATIO = _ratio(
    name="inertia_ratio",
    title="greatest inertia ratio",
    short="inertia ratio",
    mean=False,
    place=239,
    sentence=(
        "The greatest inertia of linkage and flywheel within a turn, reflected to the motor, divided by the rotor "
        "inertia."
    ),
    advice="Servo motor makers recommend at most 3 to 10; beyond that, the speed loop becomes soft.",
    formula="max (J + J_f) / (i^2 J_m)",
)
MEAN_INERTIA_RATIO = _ratio(
    name="mean_inertia_ratio",
    title="mean inertia ratio over the crank angle",
    short="mean inertia ratio",
    mean=True,
    place=240,
    sentence=(
        "The mean inertia of linkage and flywheel over the crank angle, reflected to the motor, divided by the "
        "rotor inertia."
    ),
    formula="(mean of J over the crank angle + J_f) / (i^2 J_m)",
)
