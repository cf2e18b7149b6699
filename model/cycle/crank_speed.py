"""Crank speed and acceleration over the crank angle: constant, or along the machine's speed profile."""

import math

import numpy as np

from ..arrays import Array
from ..machine.mechanism import Mechanism


def crank_speed_and_acceleration(mechanism: Mechanism, crank_angle: Array) -> tuple[Array, Array]:
    """Return crank speed, rad/s, and acceleration, rad/s^2, at crank angles (n,), rad."""
    profile, speed = mechanism.speed_profile, mechanism.speed
    if profile is None:
        return np.full(crank_angle.shape, speed), np.full(crank_angle.shape, mechanism.acceleration)
    ratio = profile.speed_ratio(crank_angle)
    return speed * ratio, speed**2 * ratio * profile.speed_ratio_slope(crank_angle)


def turn_time(mechanism: Mechanism) -> float:
    """Return the time of one turn, s, along the profile; infinite at rest. An accelerating crank has no turn time."""
    profile = mechanism.speed_profile
    over_time = mechanism.speed * (1.0 if profile is None else profile.time_mean_over_angle_mean)
    return 2.0 * math.pi / abs(over_time) if over_time else math.inf


def acceleration_slope_by_angle(mechanism: Mechanism, crank_angle: Array) -> Array:
    """Return the derivative of the acceleration with respect to the crank angle, rad/s^2, at crank angles (n,), rad."""
    profile = mechanism.speed_profile
    if profile is None:
        return np.zeros(crank_angle.shape)
    slope = profile.speed_ratio_slope(crank_angle)
    return np.asarray(
        mechanism.speed**2 * (slope**2 + profile.speed_ratio(crank_angle) * profile.speed_ratio_curvature(crank_angle))
    )


def speed_knots(mechanism: Mechanism) -> Array:
    """Return the crank angles (k,), rad, at which the speed is not analytic."""
    return np.array([] if mechanism.speed_profile is None else mechanism.speed_profile.knots, dtype=np.float64)
