"""Velocity and acceleration from positions alone, by Cauchy's integral over a circle in complex time."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

_POINTS = 48


def motion_in_time(
    position: Callable[[Any], Any], theta: Any, *, speed: float, acceleration: float, reach: float
) -> tuple[Any, Any, Any]:
    """Return value, first and second time derivative of `position` where the crank angle is `theta`.

    The crank turns by theta + speed t + acceleration t^2 / 2. `position` is analytic within `reach` (rad) of every
    theta; the circle stays within 0.35 of it, so that the trapezoidal rule is off by 0.35^48 = 1e-22, and rounding
    by about 1e-16 / (0.35 reach)^2.
    """
    ahead = 0.35 * reach
    radius = 2.0 * ahead / (abs(speed) + math.sqrt(speed**2 + 2.0 * abs(acceleration) * ahead))
    unit = np.exp(2j * math.pi * np.arange(_POINTS) / _POINTS)
    t = radius * unit
    turn = speed * t + 0.5 * acceleration * t**2
    f = position(np.asarray(theta)[..., None] + turn)
    return (
        np.mean(f, axis=-1).real,
        np.mean(f / unit, axis=-1).real / radius,
        2.0 * np.mean(f / unit**2, axis=-1).real / radius**2,
    )


def distance_to_locking(crank: float, rod: float, offset: float) -> float:
    """Return how far in imaginary crank angle the linkage locks: cosh(w) = (rod - |offset|) / crank."""
    return math.acosh((rod - abs(offset)) / crank)
