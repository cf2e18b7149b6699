"""Closing of many linkages over a swing, and the transmission angle of the driven side, with derivatives.

Where the crank drives, the linkage opens as |e - r sin(theta)| reaches l; the transmission angle is that between the
rod and the normal of the slider line, cos(mu) = |e - r sin(theta)| / l. It is least at an end of the swing or where
the crank is normal to the slider line. Where the slider drives, it is the angle between rod and crank, sin(mu) =
sin(theta - phi) with the sign that it has in the middle of the swing: below zero beyond a dead point. It is least at an
end, or where the rod turns as fast as the crank, x = 0.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import Array, Mask
from ..kernel.arithmetic import STEP
from ..kinematics.position import motion
from .push import bend
from .swing import Swing, extreme_angles

_FLAT = 1e-12


@dataclass(frozen=True)
class DrivenAngles:
    """Angles at the places where the least one may be, rad. values: (n, k), inf where absent. slopes: (n, k, 3)."""

    values: Array
    slopes: Array


def closes(swing: Swing, designs: Array) -> Mask:
    """Return which designs (n, 3 + k) close over the whole swing, without a dead point where the slider drives."""
    r, l, e = designs[:, 0], designs[:, 1], designs[:, 2]
    with np.errstate(invalid="ignore"):
        reach = np.max([np.abs(e - r * np.sin(angle)) for angle in extreme_angles(swing)], axis=0)
        found = (r > 0.0) & (reach < l) & np.isfinite(designs).all(axis=1)
    return np.asarray(found)


def passes(swing: Swing, sign: float, designs: Array) -> Mask:
    """Return which designs (n, 3 + k) close and pass no dead point where the slider drives.

    sign: +1 on the open branch, -1 on the crossed one.
    """
    found = closes(swing, designs)
    if swing.driver == "slider" and found.any():
        found &= ~_dead(swing, sign, designs)
        found[found] = driven_angles(swing, sign, designs[found]).values.min(axis=1) > 0.0
    return found


def _dead(swing: Swing, sign: float, designs: Array) -> Mask:
    """Return which designs have a dead point in the swing: beyond two of them the angle is above zero again."""
    r, l, e = designs[:, 0], designs[:, 1], designs[:, 2]
    found = np.zeros(len(designs), np.bool_)
    for reach, side in ((r + l, sign), (r - l, -sign)):
        with np.errstate(divide="ignore", invalid="ignore"):
            angle = np.arcsin(e / reach)
        found |= np.isfinite(within(swing, angle if side > 0.0 else np.pi - angle))
    return found


def driven_angles(swing: Swing, sign: float, designs: Array) -> DrivenAngles:
    """Return the transmission angles of designs (n, 3 + k) that close, see `closes`."""
    sizes = designs[:, :3].astype(np.complex128)
    stepped = [sizes + 1j * STEP * np.eye(3)[v] for v in range(3)]
    angles = [np.full(len(designs), angle) for angle in _candidates(swing)]
    if swing.driver == "slider":
        angles += _rod_as_fast(swing, sign, designs)
    values, slopes = [], []
    for theta in angles:
        there = np.isfinite(theta)
        at = np.where(there, theta, swing.start)
        own = [_measure(swing, sign, at, dims) for dims in (sizes, *stepped)]
        size = own[0].real
        slope = np.stack([each.imag / STEP for each in own[1:]], axis=1)
        steep = np.sqrt(np.maximum(1.0 - size * size, _FLAT))[:, None]
        if swing.driver == "crank":  # cos(mu)
            value, slope = np.arccos(np.minimum(size, 1.0)), -slope / steep
        else:
            value, slope = np.arcsin(np.clip(size, -1.0, 1.0)), slope / steep
        values.append(np.where(there, value, np.inf))
        slopes.append(np.where(there[:, None], slope, 0.0))
    return DrivenAngles(np.stack(values, axis=1), np.stack(slopes, axis=1))


def _candidates(swing: Swing) -> list[float]:
    return extreme_angles(swing) if swing.driver == "crank" else [swing.start, swing.end]


def _measure(swing: Swing, sign: float, theta: Array, sizes: Any) -> Any:
    """Return cos(mu) where the crank drives, else sin(mu)."""
    r, l, e = sizes[:, 0], sizes[:, 1], sizes[:, 2]
    across = e - r * np.sin(theta)
    if swing.driver == "crank":
        return np.where(across.real < 0.0, -across, across) / l
    half = np.array(0.5 * (swing.start + swing.end))
    middle = _bend(half, r.real, l.real, e.real, sign)
    with np.errstate(invalid="ignore"):
        return np.where(middle < 0.0, -1.0, 1.0) * _bend(theta, r, l, e, sign) / l


def _bend(theta: Array, r: Any, l: Any, e: Any, sign: float) -> Any:
    sine, cosine = np.sin(theta), np.cos(theta)
    return bend(sine, cosine, motion(sine, cosine, r, l, e, sign))


def _rod_as_fast(swing: Swing, sign: float, designs: Array) -> list[Array]:
    """Return the crank angles (n,) at which the slider is at the pivot; NaN where the swing has none."""
    r, l, e = designs[:, 0], designs[:, 1], designs[:, 2]
    size = np.abs(e)
    with np.errstate(divide="ignore", invalid="ignore"):
        half = np.arccos((r * r + size * size - l * l) / (2.0 * r * size))
        found = []
        for way in (-1.0, 1.0):
            theta = within(swing, np.where(e < 0.0, -0.5, 0.5) * np.pi + way * half)
            off = np.abs(motion(np.sin(theta), np.cos(theta), r, l, e, sign).x)
            found.append(np.where(off < 1e-6 * r, theta, np.nan))
    return found


def within(swing: Swing, angle: Array) -> Array:
    """Return crank angles (n,) turned by whole turns into the swing; NaN where it does not reach them."""
    low, high = sorted((swing.start, swing.end))
    with np.errstate(invalid="ignore"):
        first = angle + 2.0 * np.pi * np.ceil((low - angle) / (2.0 * np.pi))
        return np.where(first <= high, first, np.nan)


def travels(swing: Swing, sign: float, designs: Array) -> tuple[Array, Array]:
    """Return the way (n,) of the slider from one end to the other, m, and its slopes (n, 3)."""
    sizes = designs[:, :3].astype(np.complex128)
    stepped = [sizes] + [sizes + 1j * STEP * np.eye(3)[v] for v in range(3)]
    ways = []
    for dims in stepped:
        at = [_position(angle, sign, dims) for angle in (swing.start, swing.end)]
        ways.append(at[1] - at[0])
    side = np.where(ways[0].real < 0.0, -1.0, 1.0)
    slopes = np.stack([each.imag / STEP for each in ways[1:]], axis=1)
    return side * ways[0].real, side[:, None] * slopes


def _position(angle: float, sign: float, sizes: Any) -> Any:
    sine, cosine = np.sin(angle), np.cos(angle)
    return motion(sine, cosine, sizes[:, 0], sizes[:, 1], sizes[:, 2], sign).x
