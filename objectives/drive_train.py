"""Loads on the motor of a drive train, upstream of its gear: torque, speed, power, energy and heating."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from ..model.machine.mechanism import Mechanism
from ..model.machine.raw_machine_vector import Raw
from ..model.machine.raw_numbers_of_designs import DRIVE, evaluate_formula_of_raw_numbers
from ..model.signals.motor_curves import MotorCurve, motor_averages, motor_peaks
from ..model.signals.peaks import STORED_PEAKS
from ..model.signals.shaft_statistics import greatest_speed_ratio
from .closed_form import GreatestOfFormulas
from .kinds import ANGULAR_SPEED, ENERGY, POWER, RATIO, TORQUE
from .machine_needs import DRIVE_TRAIN, MOTOR_LOADED, SPEED, need_of_motor_limit
from .quantity import Array, Formula, Group, Number, Pieces, Quantity, Values, display_only_field, undefined_values


@dataclass(frozen=True, kw_only=True)
class MotorQuantity(Quantity):
    """A load on the motor.

    limit: key of its limit in [drive]. share: whether the quantity is the load divided by the limit.
    """

    group: Group = display_only_field(Group.DRIVE)
    section: str = display_only_field("10. Motor and balance")
    limit: str = ""
    share: bool = False

    def allowable_value(self, mechanism: Mechanism) -> float:
        """Return the limit stated for the drive, SI; infinite if there is none."""
        limit = None if mechanism.drive is None else getattr(mechanism.drive, self.limit)
        return math.inf if limit is None else float(limit)

    def load_factor_and_gradients(
        self, mechanism: Mechanism, dimensions: Array, *, gradients: bool
    ) -> tuple[Array, Array | None]:
        """Return the factor (n,) that converts the load to the quantity, and its derivatives (n, 3 + k)."""
        return evaluate_formula_of_raw_numbers(mechanism, dimensions, self.load_factor, gradients=gradients)

    def load_factor(self, number: Number) -> float:
        """Return the factor that converts the load to the quantity: real, complex, or an enclosure."""
        scale: float = 1.0 / number(DRIVE[self.limit]) if self.share else 1.0
        return scale


@dataclass(frozen=True, kw_only=True)
class MotorPeak(MotorQuantity):
    """Maximum magnitude of one of the motor's curves over the cycle."""

    curve: MotorCurve

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); see `Quantity`."""
        if self.unmet_need(mechanism, "undefined"):
            return undefined_values(dimensions, gradients)
        values, slopes, _ = self._highest_peaks(mechanism, dimensions, 1, gradients)
        return Values(values[:, 0], None if slopes is None else slopes[:, 0])

    def pieces(self, mechanism: Mechanism, dimensions: Array) -> Pieces:
        """Return the highest local peaks; see `Quantity`."""
        if self.unmet_need(mechanism, "undefined"):
            return super().pieces(mechanism, dimensions)
        values, slopes, angles = self._highest_peaks(mechanism, dimensions, STORED_PEAKS, True)
        assert slopes is not None
        return Pieces(values, slopes, angles)

    def _highest_peaks(
        self, mechanism: Mechanism, dimensions: Array, count: int, gradients: bool
    ) -> tuple[Array, Array | None, Array]:
        """Return values, derivatives and crank angles for the highest local peaks."""
        peaks = motor_peaks(mechanism, dimensions, self.curve, gradients, count)
        scale, by_scale = self.load_factor_and_gradients(mechanism, dimensions, gradients=gradients)
        slopes = None
        if peaks.gradients is not None and by_scale is not None:
            finite = np.where(np.isfinite(peaks.values), peaks.values, 0.0)
            slopes = peaks.gradients * scale[:, None, None] + finite[:, :, None] * by_scale[:, None]
        return peaks.values * scale[:, None], slopes, peaks.angles


@dataclass(frozen=True, kw_only=True)
class MotorRms(MotorQuantity):
    """Root mean square of the motor torque over time; infinite where friction locks the linkage."""

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); see `Quantity`."""
        if self.unmet_need(mechanism, "undefined"):
            return undefined_values(dimensions, gradients)
        averages = motor_averages(mechanism, dimensions, MotorCurve.TORQUE, gradients)
        scale, by_scale = self.load_factor_and_gradients(mechanism, dimensions, gradients=gradients)
        slopes = None
        if averages.rms_gradients is not None and by_scale is not None:
            finite = np.where(np.isfinite(averages.rms), averages.rms, 0.0)
            slopes = averages.rms_gradients * scale[:, None] + finite[:, None] * by_scale
        return Values(averages.rms * scale, slopes)


@dataclass(frozen=True, kw_only=True)
class MotorSpeed(MotorQuantity, GreatestOfFormulas):
    """Maximum motor speed over the cycle."""

    def formulas(self, mechanism: Mechanism) -> Sequence[Formula]:
        """Return the gear ratio times the crank speed, at the maximum of the speed profile."""
        greatest = mechanism.direction * greatest_speed_ratio(mechanism)
        return (lambda number: greatest * number(DRIVE["gear_ratio"]) * number(Raw.SPEED) * self.load_factor(number),)


class EnergyDrawn(MotorQuantity):
    """Energy drawn from the supply over a cycle, less the recovered energy.

    Infinite where friction locks the linkage.
    """

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); see `Quantity`."""
        if self.unmet_need(mechanism, "undefined"):
            return undefined_values(dimensions, gradients)
        averages = motor_averages(mechanism, dimensions, MotorCurve.DRAWN, gradients)
        return Values(averages.integral, averages.integral_gradients)


_NEEDS = (DRIVE_TRAIN, MOTOR_LOADED)
_TORQUE = "T_m = i J_m alpha + max(T_g / eta, eta_b T_g) / i, T_g = T + J_f alpha"
_peak = partial(MotorPeak, curve=MotorCurve.TORQUE, limit="greatest_torque", picture="torque")
_rms = partial(MotorRms, limit="rated_torque", picture="torque")
_speed = partial(MotorSpeed, limit="greatest_speed", picture="power")

MOTOR_PEAK_TORQUE = _peak(
    name="motor_peak_torque",
    title="peak motor torque",
    kind=TORQUE,
    place=231,
    sentence=(
        "The greatest motor torque within a cycle, driving or braking, including gear losses. Flywheel and rotor "
        "inertia matter where the speed changes."
    ),
    advice="Compare it with the greatest torque that the motor can deliver briefly.",
    formula=f"max |T_m|, {_TORQUE}",
    allowed_by="greatest torque of the motor",
    needs=_NEEDS,
)
MOTOR_RMS_TORQUE = _rms(
    name="motor_rms_torque",
    title="RMS motor torque over time",
    short="RMS motor torque",
    kind=TORQUE,
    place=232,
    sentence=(
        "The root mean square of the motor's torque over the time of a cycle, which determines the heating of the "
        "motor."
    ),
    advice="Compare it with the rated torque of the motor.",
    formula=f"sqrt(mean of T_m^2 over time), {_TORQUE}",
    allowed_by="rated torque of the motor",
    needs=_NEEDS,
)
MOTOR_SPEED = _speed(
    name="motor_speed",
    kind=ANGULAR_SPEED,
    place=233,
    sentence="The greatest speed of the motor within a turn: the crank speed times the gear ratio.",
    formula="i max |omega|",
    example="3000 rpm",
    allowed_by="greatest speed of the motor",
    needs=(DRIVE_TRAIN, SPEED),
)
MOTOR_POWER = MotorPeak(
    name="motor_power",
    title="peak motor power",
    kind=POWER,
    curve=MotorCurve.POWER,
    place=234,
    sentence="The greatest power at the shaft of the motor within a cycle, driving or braking.",
    formula=f"max |T_m i omega|, {_TORQUE}",
    picture="power",
    needs=(*_NEEDS, SPEED),
)
ENERGY_DRAWN = EnergyDrawn(
    name="energy_drawn",
    title="energy drawn per cycle",
    short="energy drawn",
    kind=ENERGY,
    place=235,
    sentence=(
        "The energy from the supply over a cycle: work of the motor and copper loss P_c (T_m / T_r)^2. The supply "
        "takes back a fraction of braking energy, the recovery; the rest becomes heat."
    ),
    formula="integral of max(P, 0) + recovery min(P, 0) over time, P = T_m i omega + P_c (T_m / T_r)^2",
    picture="power",
    signed=True,
    needs=(*_NEEDS, SPEED),
)
THERMAL_USE = _rms(
    name="thermal_use",
    title="thermal use of the motor over time",
    short="thermal use",
    kind=RATIO,
    share=True,
    place=236,
    sentence="The RMS torque of the motor over time, as a fraction of its rated torque.",
    advice="Up to 1 the motor does not overheat; 0.8 leaves a margin.",
    formula="sqrt(mean of T_m^2 over time) / T_r",
    example=0.8,
    needs=(need_of_motor_limit("rated_torque", "5 N m"), MOTOR_LOADED),
)
MOTOR_TORQUE_USE = _peak(
    name="motor_torque_use",
    kind=RATIO,
    share=True,
    place=237,
    sentence="The peak motor torque, as a fraction of the greatest torque that the motor can deliver.",
    formula="max |T_m| over the greatest torque of the motor",
    example=0.8,
    needs=(need_of_motor_limit("greatest_torque", "15 N m"), MOTOR_LOADED),
)
MOTOR_SPEED_USE = _speed(
    name="motor_speed_use",
    kind=RATIO,
    share=True,
    place=238,
    sentence="The greatest motor speed within a turn, as a fraction of the speed that the motor can reach.",
    formula="i max |omega| over the greatest speed of the motor",
    example=0.8,
    needs=(need_of_motor_limit("greatest_speed", "4000 rpm"), SPEED),
)
