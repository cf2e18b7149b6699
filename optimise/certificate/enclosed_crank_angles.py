"""Crank angles that depend on the design, enclosed over boxes: for a slider position, and at a dead centre."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ...model.arrays import Array, Mask
from ...model.kinematics.geometry import inner_crank_angle, outer_crank_angle
from ...model.kinematics.position import motion
from ...model.machine.design import Design
from ...model.machine.two_turn_machine import TURN
from .enclosure import Enclosure, enclosure_of_ends, select_by_mask

_ON_END = 1e-7  # fraction of the stroke; a point closer than this to a dead centre is on it
_AT_REST = 1e-6  # relative to the crank: |x'| below it means a dead centre


def crank_pin_coefficients(d: Design, x: Any, side: Any) -> tuple[Any, Any]:
    """Return q and h for a slider position x; the crank pin is at q B + h B'.

    B is the slider pin, B' is B turned by 90 degrees, q = (r^2 + B^2 - l^2) / (2 B^2) and h^2 = r^2 / B^2 - q^2. side:
    the sign of h, 1 if the crank pin is left of the line from crank pivot to slider pin.
    """
    square = x * x + d.e * d.e
    q = (d.r * d.r + square - d.l * d.l) / (square * 2.0)
    return q, np.sqrt(d.r * d.r / square - q * q) * side


def crank_sine_and_cosine(d: Design, x: Any, side: Any) -> tuple[Any, Any]:
    """Return sine and cosine of the crank angle for the slider position x, see `crank_pin_coefficients`."""
    q, h = crank_pin_coefficients(d, x, side)
    return (q * d.e + h * x) / d.r, (q * x - h * d.e) / d.r


def angle_near(d: Design, x: Enclosure, sine: Any, cosine: Any, side: Array, near: Array | None = None) -> Enclosure:
    """Return the crank angle, rad, from its sine and cosine: theta = atan2(e, x) + side acos(...).

    near: angles (n, p) less than half a turn away, to which whole turns are added. NaN where the angle ranges over half
    a turn or more.
    """
    r, l, e, at = (number.centre for number in (d.r, d.l, d.e, x))
    size = np.hypot(at, e)
    middle = np.arctan2(e, at) + side * np.arccos(np.clip((r * r + size * size - l * l) / (2.0 * r * size), -1.0, 1.0))
    if near is not None:
        middle = middle + TURN * np.round((near - middle) / TURN)
    c, s = np.cos(middle), np.sin(middle)
    off = np.arcsin(sine * c - cosine * s)
    is_sure = (cosine * c + sine * s).ends()[0] > 0.0
    return Enclosure(off.centre + middle, off.slopes, np.where(is_sure, off.rest, np.nan), off.empty)


def crank_at_stroke_fraction(
    d: Design, sine: Array, cosine: Array, middle: Array, start: float, end: float
) -> tuple[Enclosure, Enclosure]:
    """Return sine and cosine of the crank angle at the same fraction of the stroke as in the middle design."""
    r, l, e = (column[:, None] for column in middle[:, :3].T)
    at = motion(sine, cosine, r, l, e, d.branch)
    inner, outer = np.sqrt((l - r) ** 2 - e * e), np.sqrt((l + r) ** 2 - e * e)
    share = np.clip((at.x * d.branch - inner) / (outer - inner), start, end)
    side = np.where(at.x * r * sine >= e * r * cosine, 1.0, -1.0)
    x = (d.inner + (d.outer - d.inner) * np.clip(share, _ON_END, 1.0 - _ON_END)) * d.branch
    q, h = crank_pin_coefficients(d, x, side)
    on_inner, on_outer = share < _ON_END, share > 1.0 - _ON_END
    q = select_by_mask(on_inner, -d.r / (d.l - d.r), select_by_mask(on_outer, d.r / (d.l + d.r), q))
    h = select_by_mask(on_inner | on_outer, 0.0 * d.r, h)
    x = select_by_mask(on_inner, d.inner * d.branch, select_by_mask(on_outer, d.outer * d.branch, x))
    return (q * d.e + h * x) / d.r, (q * x - h * d.e) / d.r


def dead_centre_angle(d: Design, far: Mask) -> Enclosure:
    """Return the crank angle of the outer dead centre where `far`, otherwise of the inner one, rad."""
    outer, inner = outer_crank_angle(d.r, d.l, d.e), inner_crank_angle(d.r, d.l, d.e)
    angle = select_by_mask(far, outer, inner)
    return angle if d.branch > 0.0 else math.pi - angle


def track_dead_centre(
    d: Design, sine: Array, cosine: Array, angle: Array, middle: Array
) -> tuple[Mask, Enclosure, Enclosure, Any]:
    """Return a mask of middle designs at a dead centre, with sine, cosine and angle that follow the dead centre."""
    r, l, e = (column[:, None] for column in middle[:, :3].T)
    at = motion(sine, cosine, r, l, e, d.branch)
    on_dead_centre = np.abs(at.x_1) < _AT_REST * r
    far = at.x * d.branch > np.sqrt(l * l - e * e)  # sqrt(l^2 - e^2) lies between the dead centres
    q = select_by_mask(far, d.r / (d.l + d.r), -d.r / (d.l - d.r))
    x = select_by_mask(far, d.outer * d.branch, d.inner * d.branch)
    k = len(q.slopes)
    if not on_dead_centre.any():
        return on_dead_centre, enclosure_of_ends(sine, sine, k), enclosure_of_ends(cosine, cosine, k), angle
    followed = dead_centre_angle(d, far)
    followed = followed + TURN * np.round((angle - followed.centre) / TURN)
    return (
        on_dead_centre,
        select_by_mask(on_dead_centre, q * d.e / d.r, enclosure_of_ends(sine, sine, k)),
        select_by_mask(on_dead_centre, q * x / d.r, enclosure_of_ends(cosine, cosine, k)),
        select_by_mask(on_dead_centre, followed, enclosure_of_ends(angle, angle, k)),
    )
