"""Textbook formulas for slider acceleration and inertia torque: approximations, not exact values.

With k the crank, c the rod, w the constant crank speed, t the crank angle and m3 the mass that moves with the slider,
as printed by M. Obaseki and P. B. Alfred, "Modeling and Investigating the Effect of Offset Distance on Slider-Crank
Mechanism" (2020), for the open branch:

    Eq. 52    a = -k w^2 (cos t + (k / c) cos 2t)
    Eq. 53    T = m3 k^2 w^2 (k sin t / (4 c) - sin 2t / 2 - 3 k sin 3t / (4 c))
    Eq. 48    T = k F_i tan(alpha),    F_i = -(m2 w^2 k cos t + m3 a_s)  (Eq. 46b)

Eqs. 52 and 53 keep only the first power of k / c and ignore the offset. alpha is the rod angle in the mirror image,
-phi. Eq. 48 is not the torque that follows from F_i: the lever arm of a force along the slider line is k sin t, and
that of the rod force is k sin(t + alpha) / cos(alpha). It is included because the figures in the paper use it.

Eq. 46b allows two readings of a_s. Differentiating s = k + c - x twice (Eqs. 9 to 14), a_s = -x_tt. The paper's Eq. 20,
with its exponents 3/2 and 5/2 corrected to 1/2 and 3/2, is +x_tt; the sign was lost between Eqs. 13 and 17.

T is the inertia torque on the crank; the drive supplies -T, which the functions here return.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..linkage.linkage import Linkage


def series_acceleration(linkage: Linkage, crank_angle: ArrayLike, *, speed: ArrayLike) -> Any:
    """Return the slider acceleration from Eq. 52, m/s^2, at crank angles, rad, for a crank speed, rad/s.

    On the crossed branch, the mirror image, k / c changes sign. All arguments broadcast.
    """
    t, w = np.asarray(crank_angle, dtype=np.float64), np.asarray(speed, dtype=np.float64)
    ratio = linkage.sign * linkage.crank / linkage.rod
    return -linkage.crank * w * w * (np.cos(t) + ratio * np.cos(2.0 * t))


def series_torque(linkage: Linkage, crank_angle: ArrayLike, *, speed: ArrayLike, reciprocating_mass: ArrayLike) -> Any:
    """Return the drive torque from Eq. 53, N m, with reversed sign, for a reciprocating mass, kg."""
    t, w = np.asarray(crank_angle, dtype=np.float64), np.asarray(speed, dtype=np.float64)
    ratio = linkage.sign * linkage.crank / linkage.rod
    shape = 0.25 * ratio * np.sin(t) - 0.5 * np.sin(2.0 * t) - 0.75 * ratio * np.sin(3.0 * t)
    return -np.asarray(reciprocating_mass) * (linkage.crank * w) ** 2 * shape


def drive_torque_equation_48(
    linkage: Linkage,
    crank_angle: ArrayLike,
    *,
    speed: ArrayLike,
    rotating_mass: ArrayLike,
    reciprocating_mass: ArrayLike,
    as_equation_20: bool = False,
) -> Any:
    """Return the drive torque from Eq. 48, N m, with reversed sign, for a rotating and a reciprocating mass, kg.

    as_equation_20: whether a_s comes from the corrected Eq. 20 rather than from the second derivative of s. Raises
    `AssemblyError` where the linkage cannot be assembled.
    """
    at = linkage.at(crank_angle, speed=speed)
    w = np.asarray(speed, dtype=np.float64)
    # The mirror image about the y axis turns the crossed branch into the open one: both x_tt and cos(t) change sign.
    pin = linkage.sign * linkage.crank * w * w * np.cos(at.crank_angle)
    slider = linkage.sign * at.slider_acceleration * (1.0 if as_equation_20 else -1.0)
    force = -(np.asarray(rotating_mass) * pin + np.asarray(reciprocating_mass) * slider)
    return linkage.sign * linkage.crank * force * np.tan(linkage.sign * at.rod_angle)
