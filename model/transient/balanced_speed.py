"""Constant speed at which motor and loads balance over a turn: the start of the search for steady running."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..arrays import Array
from ..errors import InputError
from ..machine.drive import ConstantTorque, Drive, LinearMotor, speed_range
from .steady_cycle import PeriodicTurn, Torque

_TRIED = 401
_KNOTS = 33
"""Speeds at which the mean torque of friction is found; between them it is interpolated."""
_DOUBLINGS = 40


def balanced_speed(turn: PeriodicTurn, drive: Drive, motor: Torque, near: float) -> float:
    """Return the magnitude of the speed, rad/s; see `Runner.balanced_speed`.

    motor: the drive's torque. near: magnitude of the mechanism's speed, rad/s.
    """
    from scipy.optimize import brentq

    way = turn.way
    static, drag = way * turn.mean(turn.terms.static), turn.mean(turn.terms.drag)
    square = way * turn.mean(turn.terms.square)

    def motor_surplus(speed: Array | float) -> Array:
        return way * motor(np.multiply(way, speed))[0] - static - (drag + square * speed) * speed

    law = drive.torque_law
    if isinstance(law, ConstantTorque) and drag <= 0.0 and square <= 0.0:
        top = _speed_where_friction_balances(turn, motor_surplus, near)
        if top is None:
            raise InputError(
                "steady running needs a motor torque or a load that changes with speed; got a constant motor "
                f"torque of {drive.gear_ratio * law.torque:g} N m on the crank against {static:.6g} N m on average "
                "at every speed; give the motor a no-load speed, or add a viscous load or drag"
            )
    elif isinstance(law, ConstantTorque | LinearMotor):  # a straight line or falling faster: beyond its zero
        top = max(1.0, 1.01 * float(motor_surplus(0.0) / (motor_surplus(0.0) - motor_surplus(1.0))))
    else:
        top = speed_range(drive)[1]
    friction = _mean_friction_by_speed(turn, top)

    def surplus(speed: Array | float) -> Array:
        return motor_surplus(speed) - friction(speed)

    speeds = np.linspace(0.0, top, _TRIED)
    values = surplus(speeds)
    falls = np.flatnonzero((values[:-1] > 0.0) & (values[1:] <= 0.0))
    if not len(falls):
        weak = values.max() <= 0.0
        loads, static_torque = (
            ("load and friction", static + float(friction(0.0))) if turn.equation.rubs else ("load", static)
        )
        raise InputError(
            "steady running needs a speed at which motor and loads balance; got a motor that is "
            + (
                f"weaker than the mean {loads} at every speed"
                if weak
                else "stronger than the loads where its table ends"
            )
            + f" ({static_torque:.6g} N m on the crank, without the loads that change with speed); "
            + ("choose a stronger motor or a higher gear ratio" if weak else "extend the torque table")
        )
    speeds_found = [float(brentq(lambda speed: float(surplus(speed)), speeds[i], speeds[i + 1])) for i in falls]
    return min(speeds_found, key=lambda speed: abs(speed - near)) if near else speeds_found[0]


def _mean_friction(turn: PeriodicTurn, speed: float) -> float:
    """Return the mean friction torque against the rotation, N m, at a constant speed of this magnitude, rad/s."""
    return turn.way * turn.mean(turn.friction_torque(np.array(turn.way * speed), 0.0))


def _mean_friction_by_speed(turn: PeriodicTurn, top: float) -> Callable[[Array | float], Array | float]:
    """Return the mean friction torque, N m, at speeds up to the maximum, rad/s."""
    if not turn.equation.rubs:
        return lambda speed: 0.0
    from scipy.interpolate import CubicSpline

    speeds = np.linspace(0.0, top, _KNOTS)
    spline = CubicSpline(speeds, [_mean_friction(turn, speed) for speed in speeds])
    return lambda speed: np.asarray(spline(speed))


def _speed_where_friction_balances(
    turn: PeriodicTurn, motor_surplus: Callable[[float], Array], near: float
) -> float | None:
    """Return a speed, rad/s, at which friction, growing with inertia forces, absorbs the motor's remaining torque."""
    top = max(1.0, near)
    for _ in range(_DOUBLINGS if turn.equation.rubs else 0):
        if motor_surplus(top) <= _mean_friction(turn, top):
            return top
        top *= 2.0
    return None
