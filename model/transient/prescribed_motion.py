"""A crank with prescribed motion: the drive required at every instant.

The motion is given over the crank angle, for a crank that always turns in one direction, or over time, for any motion.
Tables are interpolated by cubic splines, so that the acceleration is continuous; the splines are periodic over the
crank angle, not-a-knot over time.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array
from ..cycle.cycle import Cycle, cycle
from ..errors import InputError
from ..linkage.linkage import Linkage
from ..machine.mechanism import Mechanism
from ..quadrature import gauss_nodes_and_weights
from .crank_equation import TURN

Function = Callable[[Array], ArrayLike]

_CLOSE = 1e-4
"""Maximum difference between a stated derivative and its function's slope, as a fraction of the maximum slope: reveals
mistakes."""
_STEP = 1e-4
"""Step of the differences that check it, as a fraction of the distance between points."""


@dataclass(frozen=True, kw_only=True)
class PrescribedMotion:
    """The crank's motion at n instants and the drive that it needs, SI and radians.

    time: (n,), s. power: power of the drive torque, W. curves: slider motion, load, drive torque and reactions, (n,)
    each.
    """

    time: Array
    speed: Array
    acceleration: Array
    power: Array
    curves: Cycle


@dataclass(frozen=True)
class SpeedOverAngle:
    """Crank speed as a function of crank angle, periodic. speed: rad/s. slope: derivative over the angle, 1/s."""

    speed: Function
    slope: Function

    @classmethod
    def from_table(cls, angles: Sequence[float], speeds: Sequence[float]) -> SpeedOverAngle:
        """Return the periodic cubic spline through a table; angles: increasing, rad, spanning less than a turn."""
        at, values = _table_as_arrays("crank angles", angles, speeds)
        if at[-1] - at[0] >= TURN:
            raise InputError(
                "crank angles of a periodic table must span less than 360 deg; "
                f"got {math.degrees(at[-1] - at[0]):g} deg; leave out the last point, which repeats the first"
            )
        from scipy.interpolate import CubicSpline

        spline = CubicSpline(np.append(at, at[0] + TURN), np.append(values, values[0]), bc_type="periodic")
        return cls(spline, spline.derivative())


@dataclass(frozen=True)
class SpeedOverTime:
    """Crank speed, rad/s, as a function of time, s. acceleration: its derivative, rad/s^2.

    angle: the crank angle, rad; if None, it is integrated from the speed, starting with 0 at the first instant.
    """

    speed: Function
    acceleration: Function
    angle: Function | None = None

    @classmethod
    def from_table(cls, times: Sequence[float], speeds: Sequence[float], *, start: float = 0.0) -> SpeedOverTime:
        """Return the cubic spline through a table; times: increasing, s. start: crank angle at the first time, rad."""
        at, values = _table_as_arrays("times", times, speeds)
        from scipy.interpolate import CubicSpline

        spline = CubicSpline(at, values)
        turned = spline.antiderivative()
        return cls(_bounded_spline(spline, at), _bounded_spline(spline.derivative(), at), lambda t: start + turned(t))


def prescribed_over_angle(
    mechanism: Mechanism,
    linkage: Linkage,
    motion: SpeedOverAngle,
    *,
    turns: float = 1.0,
    start: float = 0.0,
    samples: int = 720,
) -> PrescribedMotion:
    """Return the motion over the crank angle, counting time from the angle `start`, rad.

    dt = d(theta) / w, acceleration = w dw/d(theta). The sign of the speed, which must not change, gives the direction.
    samples: points in each turn. Raises `InputError` for a speed that is not finite, is zero or changes its sign.
    """
    if not (0.0 < turns < math.inf and math.isfinite(start)):
        raise InputError(f"turns must be positive and the start angle finite; got {turns:g} turns from {start:g} rad")
    first = _function_values("speed", motion.speed, np.array([start]))[0]
    way = math.copysign(1.0, first)
    angle = start + way * TURN * np.linspace(0.0, turns, max(2, math.ceil(samples * turns)) + 1)
    nodes, weights = gauss_nodes_and_weights(4)
    step = np.diff(angle)[:, None]
    inner_speeds = _function_values("speed", motion.speed, (angle[:-1, None] + step * nodes).ravel())
    speed, slope = _function_values("speed", motion.speed, angle), _function_values("slope", motion.slope, angle)
    all_speeds = np.concatenate([speed, inner_speeds])
    if not np.all(all_speeds * way > 0.0):
        raise InputError(
            "a speed over crank angle must not be zero or change its sign, or the crank would stop; got "
            f"{all_speeds[np.argmin(all_speeds * way)]:.6g} rad/s; state the motion over time"
        )
    _require_slope(motion.speed, motion.slope, angle)
    time = np.concatenate([[0.0], np.cumsum(step[:, 0] * ((1.0 / inner_speeds).reshape(-1, 4) @ weights))])
    return _prescribed_motion(mechanism, linkage, time, angle, speed, speed * slope)


def prescribed_over_time(
    mechanism: Mechanism, linkage: Linkage, motion: SpeedOverTime, times: ArrayLike
) -> PrescribedMotion:
    """Return the motion at increasing times (n,), s.

    The loads follow the sign of the speed. If the speed is exactly zero, they follow the direction in which the crank
    starts, given by the sign of the acceleration. Raises `InputError` for values that are not finite, and for an
    acceleration that is not the slope of the speed.
    """
    time = np.atleast_1d(np.asarray(times, dtype=np.float64))
    if time.ndim != 1 or not np.all(np.isfinite(time)) or np.any(np.diff(time) <= 0.0):
        raise InputError(
            "times must be a list of finite, increasing values, in s; sort them and remove repeated points"
        )
    speed = _function_values("speed", motion.speed, time)
    acceleration = _function_values("acceleration", motion.acceleration, time)
    _require_slope(motion.speed, motion.acceleration, time)
    if motion.angle is None:
        angle = _angle_turned(motion.speed, time)
    else:
        angle = _function_values("angle", motion.angle, time)
        _require_slope(motion.angle, motion.speed, time)
    # Numerically zero, but with the sign that determines the direction of the loads.
    moving = np.where(speed == 0.0, np.copysign(1e-300, acceleration), speed)
    return _prescribed_motion(mechanism, linkage, time, angle, moving, acceleration)


def _prescribed_motion(
    mechanism: Mechanism, linkage: Linkage, time: Array, angle: Array, speed: Array, acceleration: Array
) -> PrescribedMotion:
    curves = cycle(mechanism, linkage, angle, speed=speed, acceleration=acceleration)
    return PrescribedMotion(
        time=time, speed=speed, acceleration=acceleration, power=curves.torque * speed, curves=curves
    )


def _angle_turned(speed: Function, time: Array) -> Array:
    from scipy.integrate import solve_ivp

    if len(time) == 1:
        return np.zeros(1)
    solution = solve_ivp(
        lambda t, _: _function_values("speed", speed, np.array([t])),
        (time[0], time[-1]),
        [0.0],
        method="DOP853",
        t_eval=time,
        rtol=1e-12,
        atol=1e-12,
        max_step=(time[-1] - time[0]) / 50.0,
    )
    return np.asarray(solution.y[0])


def _table_as_arrays(quantity: str, at: Sequence[float], speeds: Sequence[float]) -> tuple[Array, Array]:
    """Return a table as arrays. Raises `InputError` if it is not a valid table."""
    if len(at) != len(speeds) or len(at) < 4:
        raise InputError(
            f"a table of speeds needs as many speeds as {quantity}, at least four; got {len(at)} {quantity} and "
            f"{len(speeds)} speeds"
        )
    points, values = np.array(at, dtype=np.float64), np.array(speeds, dtype=np.float64)
    if not (np.all(np.isfinite(points)) and np.all(np.isfinite(values))):
        raise InputError(f"a table of {quantity} and speeds must be finite throughout")
    if np.any(np.diff(points) <= 0.0):
        raise InputError(f"{quantity} of a table must increase; sort the table and remove repeated points")
    return points, values


def _bounded_spline(spline: Any, at: Array) -> Function:
    """Return a spline that raises an error beyond its table."""

    def bounded(time: Array) -> Array:
        # Differences that check a slope extend beyond the ends by a millionth of the span.
        margin = 1e-5 * (at[-1] - at[0])
        if np.any(time < at[0] - margin) or np.any(time > at[-1] + margin):
            raise InputError(
                f"times must lie within the table, {at[0]:g} to {at[-1]:g} s; "
                f"got {np.min(time):g} to {np.max(time):g} s; extend the table"
            )
        return np.asarray(spline(time))

    return bounded


def _function_values(name: str, function: Function, at: Array) -> Array:
    values = np.array(np.broadcast_to(np.asarray(function(at), dtype=np.float64), at.shape))
    if not np.all(np.isfinite(values)):
        worst = np.flatnonzero(~np.isfinite(values))[0]
        raise InputError(f"{name} of a prescribed motion must be finite; got {name} {values[worst]} at {at[worst]:g}")
    return values


def _require_slope(function: Function, slope: Function, at: Array) -> None:
    """Raise `InputError` if a function's derivative differs from the stated slope."""
    step = _STEP * ((float(np.ptp(at)) or 1.0) / len(at))
    middle, slopes = _function_values("speed", function, at), _function_values("slope", slope, at)
    after = (_function_values("speed", function, at + step) - middle) / step
    before = (middle - _function_values("speed", function, at - step)) / step
    # At a kink, the slope of either side is accepted, and any value in between.
    off = np.maximum(slopes - np.maximum(before, after), np.minimum(before, after) - slopes)
    if float(off.max()) > _CLOSE * max(float(np.abs(slopes).max()), float(np.abs(after).max()), 1e-6):
        worst = int(np.argmax(off))
        raise InputError(
            "the derivative of a prescribed motion must be the slope of its function; "
            f"got {slopes[worst]:.6g} where the slope is {after[worst]:.6g}, at {at[worst]:.6g}; correct it"
        )
