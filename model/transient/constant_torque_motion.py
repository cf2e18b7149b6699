"""Motion under a constant torque by the energy integral: exact if no load depends on the speed.

With K = (J + J_drive) w^2 / 2 the speed disappears from the equation of motion, dK / d(theta) = T - C. The torque for a
periodic turn is the mean of C. With W, the integral of T - C counted from its minimum,

    K(theta) = K_least + W(theta),        period = integral of sqrt((J + J_drive) / 2 K) d(theta).

One unknown is left for the mean speed: K_least > 0. No load jumps over the crank angle, so W rises smoothly from its
minimum, and the period grows without bound as K_least falls to 0. Every mean speed therefore has a solution, however
close the crank comes to stopping.

Loads D w and E w^2, and friction, are evaluated along the latest motion, starting at constant speed; the result is then
a first guess.

The search for steady running starts at the constant speed at which motor and loads balance over a turn.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..arrays import Array
from ..errors import InputError
from ..machine.drive import ConstantTorque, Drive, LinearMotor, speed_range
from ..quadrature import WEIGHTS
from .steady_cycle import PeriodicTurn, Torque

if TYPE_CHECKING:
    from .steady_cycle import Guess, PeriodicTurn


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

    law = drive.motor_torque_law
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


_STOPS = 1e-12
"""Smallest fraction of the energies involved that differs from zero: a millionth of the maximum speed."""
_NEAR = 1e-2
"""Fraction of the range of W within which each of several minima may bring the crank close to stopping."""
_ROUNDS, _CONVERGED = 60, 1e-6
"""Number of re-evaluations of viscous loads and friction, and the relative change in speed that ends them."""
_GRADES = 10
"""Panels on either side of a minimum, each a quarter of the previous one: down to a millionth of a radian."""


@dataclass(frozen=True)
class Coasting:
    """A turn found by the energy integral.

    load: C, viscous loads and friction at the nodes, N m. guess: start of Newton's method; None if the loads do not
    settle. stops: whether the crank is slower than can be resolved, even with the minimum K_least, which guess then
    has.
    """

    load: Array
    guess: Guess | None
    stops: bool


def periodic_motion_by_energy_integral(turn: PeriodicTurn, inertia: float, speed: float) -> Coasting:
    """Return the periodic turn found by the energy integral.

    inertia: that of the drive, kg m^2. speed: magnitude of the mean, rad/s.

    Between nodes the energy must not fall below zero: see `cut_at_energy_minima`.
    """
    pace, rise = np.full(turn.angle.shape, speed), np.zeros(turn.angle.shape)
    for _ in range(_ROUNDS):
        load = turn.terms.static + (turn.way * turn.terms.drag + turn.terms.square * pace) * pace
        if turn.equation.rubs:
            load = load + turn.friction_torque(turn.way * pace, rise)
        guess, stops = _motion_under_load(turn, load, inertia, speed)
        if stops or not turn.depends_on_speed:
            return Coasting(load, guess, stops)
        rise = (guess[2] - load - 2.0 * turn.terms.spin * guess[0]) / (turn.terms.inertia + inertia)
        change = np.sqrt(2.0 * guess[0]) - pace
        pace = pace + 0.5 * change  # a full step overshoots if the drag is strong
        if np.abs(change).max() <= _CONVERGED * pace.max():
            return Coasting(load, guess, stops)
    return Coasting(load, None, stops)


def cut_at_energy_minima(turn: PeriodicTurn, load: Array) -> PeriodicTurn:
    """Return the turn with panels that end at the minimum of W; load: values at the nodes, N m."""
    surplus = turn.way * (turn.mean(load) - load)
    least = [turn.low[p] + place * turn.width[p] for p, place, rises in turn.zero_crossings(surplus) if rises]
    return turn.cut_at_angles(np.array(least))


def refine_at_energy_minima(turn: PeriodicTurn, load: Array) -> PeriodicTurn:
    """Return the turn with ever finer panels on both sides of the minima of W.

    turn: from `cut_at_energy_minima`. load: values at the nodes, N m.
    """
    starts, _ = turn.running_integral(turn.mean(load) - load)
    least = turn.low[starts - starts.min() <= _NEAR * np.ptp(starts)]
    away = np.abs(turn.width).max() * 4.0 ** -np.arange(_GRADES)
    return turn.cut_at_angles((least[:, None] + np.concatenate([-away, away])).ravel())


def _motion_under_load(turn: PeriodicTurn, load: Array, inertia: float, speed: float) -> tuple[Guess, bool]:
    """Return the motion under a load, N m at the nodes, and whether its crank stops."""
    from scipy.optimize import brentq

    starts, nodes = turn.running_integral(turn.mean(load) - load)
    least = min(float(starts.min()), float(nodes.min()))
    starts, nodes, total = starts - least, nodes - least, turn.terms.inertia + inertia
    weights = np.abs(turn.width)[:, None] * WEIGHTS

    def late(log: float) -> float:
        period = float(np.sum(weights * np.sqrt(0.5 * total / (math.exp(log) + nodes))))
        return period * speed / turn.equation.period - 1.0

    size = float(nodes.max()) + 0.5 * speed**2 * float(total.max())
    low, high = math.log(_STOPS * size), math.log(2.0 * size)
    stops = not late(low) > 0.0
    energy_sum = math.exp(low if stops else brentq(late, low, high, xtol=1e-15, rtol=1e-14))
    at_starts = turn.equation.moving_inertia(turn.low) + inertia
    return ((energy_sum + nodes) / total, (energy_sum + starts) / at_starts, turn.mean(load)), stops
