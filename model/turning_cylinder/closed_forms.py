"""Closed forms of a lever's swing and of a crank's full turn, for real numbers and complex steps.

c: numbers of levers, see `states`.
"""

from typing import Any

import numpy as np

from ..kernel.arithmetic import magnitude
from .crank_turn_state import fast_stroke_ends
from .lever_geometry import pin_distance
from .lever_state import LeverNumbers, work_against_gravity_and_spring


def transmission_angle(c: LeverNumbers, lever_angle: Any) -> Any:
    """Return the angle, rad, between AB and the lever OB: sin(mu) = f |sin(psi)| / AB.

    Between dead points its sine has no interior minimum, so the angle is least at an end of a swing.
    """
    psi = lever_angle + c.pin_angle - c.frame_angle
    return np.arcsin(c.frame * magnitude(np.sin(psi)) / pin_distance(c.crank, c.frame, psi))


def dead_point_margin(c: LeverNumbers, lever_angle: Any) -> Any:
    """Return the angle, rad, between the lever and the nearest dead point."""
    psi = lever_angle + c.pin_angle - c.frame_angle
    return magnitude(psi - np.pi * np.round(np.real(psi) / np.pi))


def cylinder_travel(c: LeverNumbers) -> Any:
    """Return the travel of the cylinder, m."""
    first, last = c.cylinder_end_lengths
    return magnitude(last - first)


def spare_extension(c: LeverNumbers, length: Any) -> Any:
    """Return the length, m, by which a cylinder reaches beyond a length of the motion.

    For a cylinder whose stroke follows from the travel, only the distance from the closed length, because the open
    length always suffices.
    """
    known = ~np.isnan(np.real(c.stroke))
    return np.where(known, c.closed_length + c.stroke - length, length - c.closed_length)


def extension_ratio(c: LeverNumbers) -> Any:
    """Return the greatest length of the cylinder over its least."""
    first, last = c.cylinder_end_lengths
    return np.where(np.real(last - first) > 0.0, last / first, first / last)


def work_from_start_to_end(c: LeverNumbers) -> Any:
    """Return the work that a slow cylinder does from start to end, J, against gravity and seal friction."""
    return work_against_gravity_and_spring(c) + c.rub * cylinder_travel(c)


def greatest_cylinder_speed(c: LeverNumbers, greatest_law_slope: float) -> Any:
    """Return the greatest speed of the cylinder, m/s. greatest_law_slope: ds/dt."""
    return greatest_law_slope * cylinder_travel(c) * c.rate


def arm_swing_angle(c: LeverNumbers) -> Any:
    """Return the swing of the line, rad, while the crank rotates fully; 2 pi if the line rotates too.

    At a reversal the line is a tangent of the pin's circle: its angle to OA has the sine (r - e) / f or (r + e) / f.
    """
    r, f, e = (number + 0j for number in (c.crank, c.frame, c.offset))
    swings = np.real(r) < np.real(f)
    near, far = (np.where(swings, (r + side * e) / np.where(swings, f, 1.0), 0.0) for side in (-1.0, 1.0))
    return np.where(swings, np.arcsin(near) + np.arcsin(far), 2.0 * np.pi)


def arm_time_ratio_at_constant_crank_speed(c: LeverNumbers) -> Any:
    """Return the time of the slow stroke over that of the fast one at constant crank speed."""
    fast = sum(fast_stroke_ends(c))
    return (2.0 * np.pi - fast) / fast


def least_arm_transmission_angle(c: LeverNumbers) -> Any:
    """Return the least angle, rad, between AB and the normal of the line: the direction of the pin force."""
    return np.arccos(magnitude(c.offset) / magnitude(c.crank - c.frame))


def ram_stroke(c: LeverNumbers) -> Any:
    """Return the stroke of a ram, m.

    A swinging arm has R ((r - e) / f + (r + e) / f), a rotating one 2 R.
    """
    return 2.0 * c.ram * np.where(np.real(c.crank) < np.real(c.frame), c.crank / c.frame, 1.0)


def crank_work_per_turn(c: LeverNumbers) -> Any:
    """Return the work of the crank in a full turn, J, against arm torque, ram force and friction."""
    swing = arm_swing_angle(c)
    angle = np.where(np.real(c.crank) < np.real(c.frame), 2.0 * swing, swing)
    return c.arm_torque * angle + c.ram_force * ram_stroke(c) + 2.0 * c.rub * cylinder_travel(c)
