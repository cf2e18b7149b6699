"""Masses of the crank, the rod and all moving parts; inertia ratio of a motor: driven over rotor inertia."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np

from ..model.machine.design import link_properties
from ..model.machine.mechanism import Mechanism
from ..model.machine.raw_machine_vector import Raw
from ..model.machine.raw_numbers_of_designs import DRIVE, LEVER, LEVER_MASSES, evaluate_formula_of_raw_numbers
from ..model.signals.averages import signal_averages
from ..model.signals.peaks import find_peaks
from ..model.signals.signals import Signal
from .closed_form import GreatestOfFormulas
from .kinds import MASS, RATIO
from .machine_needs import CRANK_MASS as CRANK_WEIGHS
from .machine_needs import DRIVE_TRAIN, MASSES, ROTOR
from .machine_needs import ROD_MASS as ROD_WEIGHS
from .quantity import Array, Formula, Group, Number, Pieces, Quantity, Values, undefined_values


@dataclass(frozen=True, kw_only=True)
class Mass(GreatestOfFormulas):
    """A mass in closed form. closed_form: its function of a machine's raw numbers."""

    closed_form: Formula = field(repr=False)

    def formulas(self, mechanism: Mechanism) -> Sequence[Formula]:
        """Return the formula; see `Quantity`."""
        return [self.closed_form]


def _crank_mass(number: Number) -> Any:
    return _link_mass(number, number(Raw.CRANK), Raw.CRANK_WIDTH)


def _rod_mass(number: Number) -> Any:
    return _link_mass(number, number(Raw.ROD), Raw.ROD_WIDTH)


def _link_mass(number: Number, length: Any, first: int) -> Any:
    return link_properties(length, *(number(first + slot) for slot in range(9)))[0]


_mass = partial(
    Mass, kind=MASS, group=Group.STRENGTH, section="22. Strength of crank and rod", plain=True, turning=False
)
CRANK_MASS = _mass(
    name="crank_mass",
    closed_form=_crank_mass,
    place=430,
    sentence=(
        "The mass of the crank without its counterweight. If the crank is given by its section, it follows from the "
        "dimensions."
    ),
    formula="rho d (w r + pi w^2 / 4) for a bar",
    picture="crank",
    needs=(CRANK_WEIGHS,),
)
ROD_MASS = _mass(
    name="rod_mass",
    closed_form=_rod_mass,
    place=432,
    sentence="The mass of the connecting rod. If the rod is given by its section, it follows from the dimensions.",
    formula="rho d (w l + pi w^2 / 4) for a bar",
    picture="rod",
    needs=(ROD_WEIGHS,),
)


def _moving_mass(number: Number) -> Any:
    bars = _crank_mass(number) + _rod_mass(number) + number(Raw.COUNTERWEIGHT_MASS) + number(Raw.SLIDER_MASS)
    return bars + sum(number(LEVER[name]) for name in LEVER_MASSES)


MOVING_MASS = _mass(
    name="moving_mass",
    closed_form=_moving_mass,
    place=434,
    sentence="The mass of all moving links: crank, counterweight, rod, slider; cylinder, arm and ram of a lever.",
    advice="With variable sections it trades off against their safety; it also affects forces and torque.",
    formula="m_crank + m_counterweight + m_rod + m_slider",
    picture="inertia",
    needs=(MASSES,),
)


def _inverse_of_reflected_rotor_inertia(number: Number) -> Any:
    return 1.0 / (number(DRIVE["gear_ratio"]) ** 2 * number(DRIVE["motor_inertia"]))


def _flywheel_inertia_ratio(number: Number) -> Any:
    return number(DRIVE["flywheel"]) * _inverse_of_reflected_rotor_inertia(number)


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
            return self._ratio_from_inertia(mechanism, dimensions, averages.mean, averages.mean_gradients)
        peaks = find_peaks(mechanism, Signal.REFLECTED_INERTIA, dimensions, gradients=gradients, limit=1)
        slopes = None if peaks.gradients is None else peaks.gradients[:, 0]
        return self._ratio_from_inertia(mechanism, dimensions, peaks.values[:, 0], slopes)

    def pieces(self, mechanism: Mechanism, dimensions: Array) -> Pieces:
        """Return the ratios for the highest local peaks of the inertia; see `Quantity`."""
        if self.mean or self.unmet_need(mechanism, "undefined"):
            return super().pieces(mechanism, dimensions)
        peaks = find_peaks(mechanism, Signal.REFLECTED_INERTIA, dimensions, gradients=True)
        assert peaks.gradients is not None
        values, slopes = np.full_like(peaks.values, -np.inf), np.zeros_like(peaks.gradients)
        for place in range(values.shape[1]):
            rows = np.flatnonzero(np.isfinite(peaks.values[:, place]))
            ratio = self._ratio_from_inertia(
                mechanism, dimensions[rows], peaks.values[rows, place], peaks.gradients[rows, place]
            )
            assert ratio.gradients is not None
            values[rows, place], slopes[rows, place] = ratio.values, ratio.gradients
        return Pieces(values, slopes, peaks.angles)

    def _ratio_from_inertia(self, mechanism: Mechanism, designs: Array, inertia: Array, slopes: Array | None) -> Values:
        scale, flywheel = (
            Values(*evaluate_formula_of_raw_numbers(mechanism, designs, formula, gradients=slopes is not None))
            for formula in (_inverse_of_reflected_rotor_inertia, _flywheel_inertia_ratio)
        )
        linkage = Values(inertia, slopes).multiplied_by(scale)
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
