"""Drive of the crank: a motor with its torque-speed curve and limits, a gear, and inertias that turn with it.

Motor speed and motor torque are positive in the motor's intended direction. A `Drive` converts these to the crank's
direction, which is that of the mechanism's speed.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array
from ..checks import require_all_finite, require_numbers, store_as_tuples
from ..errors import InputError


@dataclass(frozen=True, kw_only=True)
class ConstantTorque:
    """A constant motor torque, N m. It does not limit the speed; zero lets the machine coast."""

    torque: float

    def __post_init__(self) -> None:
        require_numbers(self, "torque")

    def torque_at(self, speed: ArrayLike) -> Any:
        """Return the torque, N m, at motor speeds, rad/s."""
        return np.full(np.shape(speed), self.torque)[()]

    def torque_slope(self, speed: ArrayLike) -> Any:
        """Return the torque's derivative with respect to speed, N m s."""
        return np.zeros(np.shape(speed))[()]


@dataclass(frozen=True, kw_only=True)
class LinearMotor:
    """A motor whose torque falls linearly with speed: torque = stall_torque (1 - speed / no_load_speed).

    A direct-current motor, or an induction motor near its synchronous speed (see `through`). The line continues beyond
    both ends: above the no-load speed the motor brakes; driven backwards it resists with more than the stall torque.

    stall_torque: N m. no_load_speed: rad/s.
    """

    stall_torque: float
    no_load_speed: float

    def __post_init__(self) -> None:
        require_numbers(self, "stall_torque", "no_load_speed", above=0.0)

    @classmethod
    def from_rated_point(cls, *, torque: float, speed: float, no_load_speed: float) -> LinearMotor:
        """Return the line through a rated point (torque, N m, at speed, rad/s) and the no-load speed, rad/s."""
        if not (0.0 <= speed < no_load_speed < math.inf and 0.0 < torque < math.inf):
            raise InputError(
                f"a rated point needs a positive torque and a speed below the no-load speed; got {torque:g} N m at "
                f"{speed:g} rad/s, no-load speed {no_load_speed:g} rad/s; give the no-load (synchronous) speed and "
                "the lower speed under the rated load"
            )
        return cls(stall_torque=torque * no_load_speed / (no_load_speed - speed), no_load_speed=no_load_speed)

    def torque_at(self, speed: ArrayLike) -> Any:
        """Return the torque, N m, at motor speeds, rad/s."""
        return self.stall_torque * (1.0 - np.asarray(speed) / self.no_load_speed)[()]

    def torque_slope(self, speed: ArrayLike) -> Any:
        """Return the torque's derivative with respect to speed, N m s."""
        return np.full(np.shape(speed), -self.stall_torque / self.no_load_speed)[()]


@dataclass(frozen=True, kw_only=True)
class TorqueTable:
    """A motor torque tabulated over speed, interpolated by a monotone cubic (Fritsch and Carlson, 1980).

    The curve has no kinks and no overshoot. Beyond the table it is undefined (NaN), and a simulation that gets there
    stops with a message. speeds: increasing, rad/s, the first zero or negative. torques: N m.
    """

    speeds: tuple[float, ...]
    torques: tuple[float, ...]

    def __post_init__(self) -> None:
        store_as_tuples(self, "speeds", "torques")
        if len(self.speeds) != len(self.torques) or len(self.speeds) < 2:
            raise InputError(
                f"a torque table needs as many torques as speeds, at least two; got {len(self.speeds)} speeds and "
                f"{len(self.torques)} torques"
            )
        require_all_finite("a torque table", (*self.speeds, *self.torques), "throughout")
        for before, after in pairwise(self.speeds):
            if after <= before:
                raise InputError(
                    f"speeds of a torque table must increase; got {after:g} after {before:g}; sort the table and "
                    "remove repeated points"
                )
        if self.speeds[0] > 0.0:
            raise InputError(
                f"the first speed in a torque table must be zero or negative; got {self.speeds[0]:g} rad/s; add "
                "the torque at speed 0"
            )

    @cached_property
    def _torque_spline(self) -> Any:
        from scipy.interpolate import PchipInterpolator

        return PchipInterpolator(self.speeds, self.torques, extrapolate=False)

    def torque_at(self, speed: ArrayLike) -> Any:
        """Return the torque, N m, at motor speeds, rad/s; NaN beyond the table."""
        return self._torque_spline(speed)[()]

    def torque_slope(self, speed: ArrayLike) -> Any:
        """Return the torque's derivative with respect to speed, N m s; NaN beyond the table."""
        return self._torque_spline(speed, 1)[()]


Motor = ConstantTorque | LinearMotor | TorqueTable


@dataclass(frozen=True, kw_only=True)
class Drive:
    """A motor, a gear, and the parts that turn with them.

    motor: torque against speed; None if only the loads on the motor matter. flywheel: inertia on the crankshaft, kg
    m^2. motor_inertia: inertia of the rotor and all parts at motor speed, kg m^2. gear_ratio: motor turns per crank
    turn; at the crank the motor torque is multiplied by the ratio, its inertia by the square of the ratio.

    gear_efficiency: output power of the gear divided by input power while the motor drives. braking_efficiency: the
    same while the crank drives the motor; None if both are equal. greatest_torque, rated_torque: torque that the motor
    can supply briefly and continuously, N m. greatest_speed: maximum speed of the motor, rad/s. copper_loss: heat in
    the winding at the rated torque, W. recovery: fraction of the braking energy that the supply recovers.
    """

    motor: Motor | None = None
    flywheel: float = 0.0
    motor_inertia: float = 0.0
    gear_ratio: float = 1.0
    gear_efficiency: float = 1.0
    braking_efficiency: float | None = None
    greatest_torque: float | None = None
    rated_torque: float | None = None
    greatest_speed: float | None = None
    copper_loss: float | None = None
    recovery: float = 0.0

    def __post_init__(self) -> None:
        if not isinstance(self.motor, Motor | None):
            raise InputError(f"motor must be a ConstantTorque, LinearMotor or TorqueTable; got {self.motor!r}")
        require_numbers(self, "flywheel", "motor_inertia", "copper_loss", "recovery", least=0.0)
        positive = ("gear_ratio", "gear_efficiency", "braking_efficiency", "greatest_torque", "rated_torque")
        require_numbers(self, *positive, "greatest_speed", above=0.0)
        for name in ("gear_efficiency", "braking_efficiency", "recovery"):
            value = getattr(self, name)
            if value is not None and value > 1.0:
                raise InputError(f"{name} of a Drive must be at most 1; got {value:g}; no drive train can return more")
        if self.copper_loss is not None and self.rated_torque is None:
            raise InputError(
                "copper_loss is the heat at the rated torque of the motor; got no rated_torque; add it, or leave out "
                "copper_loss"
            )

    @property
    def inertia(self) -> float:
        """Inertia of flywheel and motor, reflected to the crank: flywheel + ratio^2 motor, kg m^2."""
        return self.flywheel + self.gear_ratio**2 * self.motor_inertia

    @property
    def has_gear_losses(self) -> bool:
        """Whether the gear loses part of the power, in either direction."""
        return self.gear_efficiency < 1.0 or (self.braking_efficiency or 1.0) < 1.0

    @property
    def motor_torque_law(self) -> Motor:
        """The motor's torque against its speed. Raises `InputError` if there is no motor, or if the gear has losses."""
        if self.motor is None:
            raise InputError(
                "a machine driven by its motor needs a motor torque; got a drive without one; for example, add "
                '[drive] motor = { stall_torque = "60 N m", no_load_speed = "400 rpm" }'
            )
        if self.has_gear_losses:
            raise InputError(
                "a machine driven by its motor needs a gear without losses; got a gear efficiency below 1; leave "
                "it out, and reduce the torque of the motor instead"
            )
        return self.motor

    @property
    def text(self) -> str:
        """Gear, inertias and limits of the motor, as far as stated."""
        braking = self.gear_efficiency if self.braking_efficiency is None else self.braking_efficiency
        parts = [f"gear ratio {self.gear_ratio:.6g}"]
        if self.has_gear_losses:
            parts.append(f"efficiency {self.gear_efficiency:.6g} driving, {braking:.6g} braking")
        if self.motor_inertia:
            parts.append(f"rotor {self.motor_inertia:.6g} kg m^2")
        if self.flywheel:
            parts.append(f"flywheel {self.flywheel:.6g} kg m^2")
        if self.greatest_torque is not None:
            parts.append(f"greatest torque {self.greatest_torque:.6g} N m")
        if self.rated_torque is not None:
            parts.append(f"rated torque {self.rated_torque:.6g} N m")
        if self.greatest_speed is not None:
            parts.append(f"greatest speed {self.greatest_speed * 30.0 / math.pi:.6g} rpm")
        if self.copper_loss is not None:
            parts.append(f"copper loss {self.copper_loss:.6g} W")
        if self.recovery:
            parts.append(f"recovery {self.recovery:.6g}")
        return ", ".join(parts)

    def torque_on_crank(self, crank_speed: ArrayLike, direction: float) -> Array:
        """Return the torque on the crank, N m, counter-clockwise, at crank speeds, rad/s.

        direction: +1 or -1, direction in which the motor is intended to turn the crank.
        """
        speed = direction * self.gear_ratio * np.asarray(crank_speed)
        return np.asarray(direction * self.gear_ratio * self.motor_torque_law.torque_at(speed))


def speed_range(drive: Drive) -> tuple[float, float]:
    """Return the minimum and maximum crank speed, rad/s in the motor's direction, at which its torque is known."""
    law = drive.motor_torque_law
    if not isinstance(law, TorqueTable):
        return -math.inf, math.inf
    return law.speeds[0] / drive.gear_ratio, law.speeds[-1] / drive.gear_ratio
