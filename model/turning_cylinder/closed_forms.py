"""Closed forms of a lever's swing, for real numbers and complex steps. c: numbers of levers, see `states`."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..kernel.arithmetic import magnitude
from .lever import pin_distance
from .states import LeverNumbers, lift


def transmission_angle(c: LeverNumbers, lever_angle: Any) -> Any:
    """Return the angle, rad, between AB and the lever OB: sin(mu) = f |sin(psi)| / AB.

    Between dead points its sine has at most a maximum, so that the angle is least at an end of a swing.
    """
    psi = lever_angle + c.pin_angle - c.frame_angle
    return np.arcsin(c.frame * magnitude(np.sin(psi)) / pin_distance(c.crank, c.frame, psi))


def dead_point_margin(c: LeverNumbers, lever_angle: Any) -> Any:
    """Return the angle, rad, by which the lever is off the nearest dead point."""
    psi = lever_angle + c.pin_angle - c.frame_angle
    return magnitude(psi - np.pi * np.round(np.real(psi) / np.pi))


def travel(c: LeverNumbers) -> Any:
    """Return the travel of the cylinder, m."""
    first, last = c.ends
    return magnitude(last - first)


def extension_ratio(c: LeverNumbers) -> Any:
    """Return the greatest length of the cylinder over its least."""
    first, last = c.ends
    return np.where(np.real(last - first) > 0.0, last / first, first / last)


def work_out(c: LeverNumbers) -> Any:
    """Return the work of the slow cylinder from start to end, J: against gravity and the friction of the seal."""
    return lift(c) + c.rub * travel(c)


def greatest_speed(c: LeverNumbers, fastest: float) -> Any:
    """Return the greatest speed of the cylinder, m/s. fastest: greatest ds/dt of the law."""
    return fastest * travel(c) * c.rate
