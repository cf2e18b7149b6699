"""Curves of a motor over the cycle: torque, power and energy drawn, with a lossy gear.

In the direction of rotation, let T be the crank torque, J_f the flywheel inertia, J_m the rotor inertia, i the gear
ratio, and w and a the crank's speed and acceleration:

    T_g = T + J_f a,        T_m = i J_m a + max(T_g / eta, eta_b T_g) / i.

The efficiency acts on the torque through the gear, not on the rotor's own torque. The supply delivers T_m i + c T_m^2 /
w per crank angle, where c is the copper loss divided by the square of the torque; it recovers a fraction of the
returned energy. Where T_g or the supply power changes sign, the curves have kinks, which are breakpoints.
"""

from dataclasses import dataclass
from enum import IntEnum, auto
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array, IntArray
from ..errors import InputError
from ..kernel.arithmetic import STEP
from ..kernel.batches import require_full_rotation, run_in_chunks
from ..machine.cylinders_and_turns import cylinder_count
from ..machine.drive import Drive
from ..machine.mechanism import Mechanism
from ..machine.memoise import memoise_by_batch
from ..machine.raw_machine_vector import Raw, load_knot_count
from ..machine.raw_numbers_of_designs import DRIVE, raw_number_at_slot
from .peaks import Peaks
from .shaft import Shaft
from .shaft_averages import MEAN, SQUARE_OVER_TIME, shaft_means, shaft_peaks
from .shaft_segments import GEAR, SUPPLY, Breaks, join_breaks
from .signals import Signal

_CHUNK = 128  # designs
_Stepped = NDArray[np.complexfloating[Any, Any]]


class MotorCurve(IntEnum):
    """A curve of the motor in the direction of rotation.

    Torque, N m; power at its shaft, W; energy drawn from the supply per crank angle, J, net of the recovered energy.
    The last two curves are those with the kinks: torque at the crank through the gear, N m, and energy per crank angle
    in either direction.
    """

    TORQUE = auto()
    POWER = auto()
    DRAWN = auto()
    THROUGH_GEAR = auto()
    SUPPLIED = auto()


_EFFICIENCIES = {"drive.gear_efficiency", "drive.braking_efficiency"}
_KINKS = {GEAR: MotorCurve.THROUGH_GEAR, SUPPLY: MotorCurve.SUPPLIED}


class _Numbers(NamedTuple):
    """Drive train numbers, (n, 1 + v): complex, stepped in the place and each design number."""

    speed: _Stepped
    acceleration: _Stepped
    flywheel: _Stepped
    motor_inertia: _Stepped
    gear_ratio: _Stepped
    gear_efficiency: _Stepped
    braking_efficiency: _Stepped
    recovery: _Stepped
    resistance: _Stepped


class MotorShaft(Shaft):
    """Designs (n, 3 + k) of a machine with a drive, and one curve of its motor along their cycles."""

    def __init__(self, mechanism: Mechanism, curve: MotorCurve, designs: Array, *, gradients: bool = False) -> None:
        members = tuple(range(cylinder_count(mechanism)))
        super().__init__(mechanism, int(Signal.TORQUE), designs, members=members, gradients=gradients)
        self.curve, self._direction = curve, mechanism.direction
        drive = _required_drive(mechanism)
        self._lossy = drive.has_gear_losses or any(_EFFICIENCIES & {*item.paths} for item in mechanism.varying)
        self._train = _drive_train_numbers(mechanism, drive, designs)

    def evaluate(
        self, row: IntArray, probe: Array, angle: Array, *, rate: Array | None = None, gradients: bool = False
    ) -> tuple[Array, Array]:
        """Return the curve (p, k, 2 + v) and its magnitudes (p, k), as `Shaft.evaluate` does."""
        return self._motor_curve(self.curve, row, probe, angle, rate, gradients)

    def breakpoint_gradients(self, cuts: IntArray, probe: Array) -> Array:
        """Return the derivatives (c, v) of breakpoint angles by the design.

        Probe: angles in segments that begin there.
        """
        out = super().breakpoint_gradients(cuts, probe)
        for code, curve in _KINKS.items():
            rows = np.flatnonzero(self.all_breakpoints.code[cuts] == code)
            row, angle = self.all_breakpoints.row[cuts[rows]], self.all_breakpoints.angle[cuts[rows], None]
            slopes = self._motor_curve(curve, row, probe[rows], angle, None, True)[0][:, 0]
            out[rows] = -slopes[:, 2:] / slopes[:, 1:2]
        return out

    def _cut_at_kinks(self, breaks: Breaks) -> Breaks:
        """Return breakpoints together with those of gear and supply."""
        breaks = super()._cut_at_kinks(breaks)
        codes = ([GEAR] if self._lossy else []) + ([SUPPLY] if self.curve is MotorCurve.DRAWN else [])
        for code in codes:
            breaks = join_breaks(
                [breaks, self.sign_change_breakpoints(breaks, partial(self._motor_curve_values, _KINKS[code]), code)]
            )
        return breaks

    def _motor_curve_values(self, curve: MotorCurve, row: IntArray, probe: Array, angle: Array) -> Array:
        return self._motor_curve(curve, row, probe, angle, None, False)[0][:, :, 0]

    def _motor_curve(
        self, curve: MotorCurve, row: IntArray, probe: Array, angle: Array, rate: Array | None, gradients: bool
    ) -> tuple[Array, Array]:
        """Return a curve and its magnitudes, as `evaluate` does; the probe says which sides of the kinks count."""
        angle = np.concatenate([angle, probe[:, None]], axis=1)
        torque, size = super().evaluate(row, probe, angle, rate=rate, gradients=gradients)
        steps: _Stepped = 1j * STEP * torque[:, :, 1:]
        train = _Numbers(*(part[row, None, : steps.shape[2]] for part in self._train))
        moves = np.ones((len(angle), steps.shape[2]))
        if gradients:
            moves[:, 1:] = 0.0 if rate is None else rate
        speed, acceleration = self._crank_speed_and_acceleration(train, angle, 1j * STEP * moves[:, None])
        through_gear = self._direction * (torque[:, :, :1] + steps) + train.flywheel * acceleration
        drives = through_gear[:, -1:, :1].real >= 0.0
        share = np.where(drives, 1.0 / train.gear_efficiency, train.braking_efficiency)
        at_motor = train.gear_ratio * train.motor_inertia * acceleration + share * through_gear / train.gear_ratio
        greatest = size[:, :, None] + np.abs(train.flywheel * acceleration)[:, :, :1]
        sizes = np.abs(share / train.gear_ratio)[:, :, :1] * greatest
        sizes = sizes + np.abs(train.gear_ratio * train.motor_inertia * acceleration)[:, :, :1]
        if curve is MotorCurve.THROUGH_GEAR:
            values, sizes = through_gear, greatest
        elif curve is MotorCurve.TORQUE:
            values = at_motor
        elif curve is MotorCurve.POWER:
            values, sizes = train.gear_ratio * speed * at_motor, np.abs(train.gear_ratio * speed)[:, :, :1] * sizes
        else:
            values = train.gear_ratio * at_motor + train.resistance * at_motor * at_motor / speed
            sizes = np.abs(train.gear_ratio)[:, :, :1] * sizes
            if curve is MotorCurve.DRAWN:
                values = values * np.where(values[:, -1:, :1].real >= 0.0, 1.0, train.recovery)
        out = np.concatenate([values[:, :-1, :1].real, values[:, :-1].imag / STEP], axis=2)
        return out, np.asarray(sizes[:, :-1, 0])

    def _crank_speed_and_acceleration(self, train: _Numbers, angle: Array, step: _Stepped) -> tuple[_Stepped, _Stepped]:
        """Return speed and acceleration of the crank in its direction of rotation, stepped, (p, k, c)."""
        speed = self._direction * train.speed
        if self.profile is None:
            ones = np.ones((*angle.shape, 1))
            return speed * ones, self._direction * train.acceleration * ones
        ratio, slope, bend = (
            derivative(angle)[:, :, None]
            for derivative in (
                self.profile.speed_ratio,
                self.profile.speed_ratio_slope,
                self.profile.speed_ratio_curvature,
            )
        )
        stepped_ratio, stepped_slope = ratio + step * slope, slope + step * bend
        return speed * stepped_ratio, self._direction * train.speed * train.speed * stepped_ratio * stepped_slope


def _required_drive(mechanism: Mechanism) -> Drive:
    if mechanism.drive is None:
        raise InputError("motor curves need a drive; got none; for example, add [drive] gear_ratio = 5")
    return mechanism.drive


def _drive_train_numbers(mechanism: Mechanism, drive: Drive, designs: Array) -> _Numbers:
    """Return the drive-train values for designs (n, 3 + k)."""

    def stepped(slot: int, otherwise: float | None) -> _Stepped:
        values, slopes = raw_number_at_slot(mechanism, slot, designs, otherwise=0.0 if otherwise is None else otherwise)
        return np.concatenate([values[:, None] + 0j, values[:, None] + 1j * STEP * slopes], axis=1)

    numbers = {name: stepped(slot, getattr(drive, name)) for name, slot in DRIVE.items()}
    if drive.braking_efficiency is None:
        numbers["braking_efficiency"] = numbers["gear_efficiency"]
    rated = numbers["rated_torque"]
    resistance = 0.0 * rated if drive.copper_loss is None else numbers["copper_loss"] / (rated * rated)
    kept = {name: numbers[name] for name in _Numbers._fields if name in numbers}
    motion = stepped(Raw.SPEED, mechanism.speed), stepped(Raw.ACCELERATION, mechanism.acceleration)
    return _Numbers(*motion, **kept, resistance=resistance)


def motor_curve(mechanism: Mechanism, design: Array, crank_angle: Array, curve: MotorCurve) -> Array:
    """Return a motor curve of one design (1, 3 + k) at crank angles (n,), rad, along the rotation.

    NaN where friction locks the design. Raises `InputError` without a drive.
    """
    shaft = MotorShaft(mechanism, curve, require_full_rotation(design))
    if not shaft.unlocked_designs[0]:
        return np.full(len(crank_angle), np.nan)
    row = np.zeros(len(crank_angle), dtype=np.int64)
    return shaft.evaluate(row, crank_angle, crank_angle[:, None])[0][:, 0, 0]


@memoise_by_batch
def motor_peaks(mechanism: Mechanism, designs: Array, curve: MotorCurve, gradients: bool, limit: int) -> Peaks:
    """Return the highest local peaks of the magnitude of a motor's curve for designs (n, 3 + k); see `Peaks`."""
    designs = require_full_rotation(designs)
    values, angles = np.empty((len(designs), limit)), np.empty((len(designs), limit))
    slopes = np.empty((len(designs), limit, designs.shape[1])) if gradients else None

    def work(begin: int, end: int) -> None:
        peaks = shaft_peaks(MotorShaft(mechanism, curve, designs[begin:end], gradients=gradients), limit=limit)
        values[begin:end], angles[begin:end] = peaks[:2]
        if slopes is not None:
            slopes[begin:end] = peaks[2]

    run_in_chunks(len(designs), work, size=_CHUNK, knots=load_knot_count(mechanism))
    return Peaks(values, angles, slopes)


@dataclass(frozen=True)
class MotorAverages:
    """Averages of a motor's curve over the cycle, (n,), and their derivatives (n, 3 + k) or None.

    integral: over the crank angle. rms: root mean square over time. Both are infinite where friction locks the design.
    """

    integral: Array
    rms: Array
    integral_gradients: Array | None
    rms_gradients: Array | None


@memoise_by_batch
def motor_averages(mechanism: Mechanism, designs: Array, curve: MotorCurve, gradients: bool) -> MotorAverages:
    """Return the averages of a motor's curve for designs (n, 3 + k)."""
    designs = require_full_rotation(designs)
    values, slopes = np.empty((2, len(designs))), np.zeros((2, *designs.shape))

    def work(begin: int, end: int) -> None:
        shaft = MotorShaft(mechanism, curve, designs[begin:end], gradients=gradients)
        means = shaft_means(shaft, end - begin)
        integral, rms = shaft.period * means.values[MEAN], np.sqrt(means.values[SQUARE_OVER_TIME])
        values[:, begin:end] = np.where(
            means.nothing, 0.0, np.where(shaft.unlocked_designs, np.stack([integral, rms]), np.inf)
        )
        if means.gradients is not None:
            positive = (rms > 0.0) & ~means.nothing & shaft.unlocked_designs
            half = np.where(positive, 0.5 / np.where(positive, rms, 1.0), 0.0)
            slopes[0, begin:end] = np.where(
                (means.nothing | ~shaft.unlocked_designs)[:, None], 0.0, shaft.period * means.gradients[MEAN]
            )
            slopes[1, begin:end] = half[:, None] * means.gradients[SQUARE_OVER_TIME]

    run_in_chunks(len(designs), work, size=_CHUNK, knots=load_knot_count(mechanism))
    return MotorAverages(values[0], values[1], slopes[0] if gradients else None, slopes[1] if gradients else None)
