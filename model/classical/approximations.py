"""Textbook formulas for slider acceleration and inertia torque, and a rod as two point masses, against exact values.

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

Two-mass model of the rod: one point mass at the crank pin and one at the slider pin.

With the mass centre at distance a from the crank pin and b = l - a from the slider pin: m b / l at the crank pin, m a /
l at the slider pin. Mass and mass centre are preserved. The inertia about the mass centre becomes m a b, so the model
is exact for a rod whose inertia equals m a b. Any other split (half and half, as in Eqs. 31 to 36 of M. Obaseki and P.
B. Alfred, "Modeling and Investigating the Effect of Offset Distance on Slider-Crank Mechanism", 2020) also moves the
mass centre, unless it happens to match.

Comparison of the approximate models with the exact one, over the crank angle and over the offset.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array
from ..cycle.cycle import cycle
from ..errors import InputError
from ..linkage.linkage import Linkage
from ..linkage.require_single_linkage import require_single_rotating_linkage
from ..machine.links_and_joints import Bar, Friction, Link, RigidLink
from ..machine.mechanism import Mechanism


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


@dataclass(frozen=True)
class MassProperties:
    """Mass (kg), mass centre along and across the link (m) and inertia about the mass centre (kg m^2)."""

    mass: float
    centre: float
    centre_across: float
    inertia: float


def link_mass_properties(link: Link, length: float) -> MassProperties:
    """Return the mass properties of a link with a given length between pin centres, m."""
    if isinstance(link, Bar):
        return MassProperties(link.mass(length), 0.5 * length, 0.0, link.principal_inertias(length)[0])
    centre = 0.5 * length if link.centre is None else link.centre
    inertia = link.mass * length**2 / 12.0 if link.inertia is None else link.inertia
    return MassProperties(link.mass, centre, link.centre_across, inertia)


def rod_mass_share_at_crank_pin(mechanism: Mechanism, linkage: Linkage) -> float:
    """Return the fraction of the rod's mass lumped at the crank pin, b / l.

    Raises `InputError` for a mass centre that is not between the pins: one mass would be negative.
    """
    length = float(linkage.rod)
    share = 1.0 - link_mass_properties(mechanism.rod, length).centre / length
    if not 0.0 <= share <= 1.0:
        raise InputError(
            "the two-mass model needs the rod's mass centre between the pins; got "
            f"{1e3 * length * (1.0 - share):g} mm from the crank pin of a rod of {1e3 * length:g} mm; use the "
            "exact model"
        )
    return share


def mechanism_with_lumped_rod(
    mechanism: Mechanism, linkage: Linkage, *, crank_pin_share: float | None = None
) -> Mechanism:
    """Return one linkage's mechanism with a massless rod, its mass being lumped at the crank pin and the slider.

    crank_pin_share: fraction of the rod's mass lumped at the crank pin; b / l if None. The distance of the mass centre
    from the rod axis is lost.
    """
    share = rod_mass_share_at_crank_pin(mechanism, linkage) if crank_pin_share is None else crank_pin_share
    if not 0.0 <= share <= 1.0:
        raise InputError(f"the crank pin's share of the mass must be from 0 to 1; got {share:g}")
    radius = float(linkage.crank)
    rod = link_mass_properties(mechanism.rod, float(linkage.rod)).mass
    crank, added = link_mass_properties(mechanism.crank, radius), share * rod
    total = crank.mass + added
    centre = (crank.mass * crank.centre + added * radius) / total if total > 0.0 else 0.0
    centre_across = crank.mass * crank.centre_across / total if total > 0.0 else 0.0
    inertia = (
        crank.inertia
        + crank.mass * ((crank.centre - centre) ** 2 + (crank.centre_across - centre_across) ** 2)
        + added * ((radius - centre) ** 2 + centre_across**2)
    )
    return replace(
        mechanism,
        crank=RigidLink(mass=total, centre=centre, centre_across=centre_across, inertia=inertia),
        rod=RigidLink(mass=0.0, inertia=0.0),
        slider_mass=mechanism.slider_mass + (1.0 - share) * rod,
    )


def rotating_and_reciprocating_masses(
    mechanism: Mechanism, linkage: Linkage, *, crank_pin_share: float | None = None
) -> tuple[float, float]:
    """Return the rotating mass at the crank pin, crank included, and the reciprocating mass, kg.

    The crank contributes its first moment, m centre / r (Eq. 35 of the paper); its counterweight does not count.
    """
    length, radius = float(linkage.rod), float(linkage.crank)
    share = rod_mass_share_at_crank_pin(mechanism, linkage) if crank_pin_share is None else crank_pin_share
    rod = link_mass_properties(mechanism.rod, length).mass
    crank = link_mass_properties(mechanism.crank, radius)
    return crank.mass * crank.centre / radius + share * rod, mechanism.slider_mass + (1.0 - share) * rod


ACCELERATION = ("series",)
TORQUE = ("two masses by mass centre", "two masses, half and half", "series", "k F tan(alpha)")
"""The approximations in the order used in every table and figure."""
_ANGLES = 1440


@dataclass(frozen=True)
class Comparison:
    """Exact and approximate curves of one design at constant speed; each (n,), SI.

    accelerations: slider acceleration, by the names in `ACCELERATION`. torques: inertia torque that the drive supplies,
    by the names in `TORQUE`.
    """

    crank_angle: Array
    acceleration: Array
    accelerations: Mapping[str, Array]
    torque: Array
    torques: Mapping[str, Array]


def compare_approximations(mechanism: Mechanism, linkage: Linkage, crank_angle: ArrayLike) -> Comparison:
    """Return the curves of one fully rotating linkage at crank angles (n,), rad: inertia alone, at constant speed.

    Loads, gravity and the acceleration of the crank are left out. The formulas split the rod's mass at its mass centre.
    Raises `InputError` if the crank speed is zero, or if a mass centre is not between the pins.
    """
    linkage = require_single_rotating_linkage(mechanism, linkage)
    inert = _with_inertia_alone(mechanism)
    exact = cycle(inert, linkage, crank_angle)
    theta, speed = exact.crank_angle, mechanism.speed
    rotating, reciprocating = rotating_and_reciprocating_masses(inert, linkage)
    torques = (
        cycle(mechanism_with_lumped_rod(inert, linkage), linkage, theta).torque,
        cycle(mechanism_with_lumped_rod(inert, linkage, crank_pin_share=0.5), linkage, theta).torque,
        series_torque(linkage, theta, speed=speed, reciprocating_mass=reciprocating),
        drive_torque_equation_48(linkage, theta, speed=speed, rotating_mass=rotating, reciprocating_mass=reciprocating),
    )
    return Comparison(
        theta,
        exact.slider_acceleration,
        {ACCELERATION[0]: series_acceleration(linkage, theta, speed=speed)},
        exact.torque,
        dict(zip(TORQUE, torques, strict=True)),
    )


@dataclass(frozen=True)
class Errors:
    """Maximum error of each approximation over the cycle as a fraction of the exact peak; each (offsets,).

    peak_acceleration, peak_torque: exact, m/s^2 and N m. Errors of a torque that is zero throughout are `nan`.
    """

    offset: Array
    peak_acceleration: Array
    peak_torque: Array
    accelerations: Mapping[str, Array]
    torques: Mapping[str, Array]


def approximation_errors_over_offset(mechanism: Mechanism, linkage: Linkage, offsets: ArrayLike) -> Errors:
    """Return the errors for offsets (n,), m, with one linkage's crank and rod; 1440 crank angles each.

    Raises `AssemblyError` for an offset at which the linkage does not rotate fully.
    """
    values = np.atleast_1d(np.asarray(offsets, dtype=np.float64))
    theta = np.linspace(0.0, 2.0 * math.pi, _ANGLES, endpoint=False)
    rows = [
        compare_approximations(mechanism, Linkage(linkage.crank, linkage.rod, offset, linkage.branch), theta)
        for offset in values
    ]
    return Errors(
        values,
        np.array([np.abs(row.acceleration).max() for row in rows]),
        np.array([np.abs(row.torque).max() for row in rows]),
        {
            name: np.array([relative_error(row.accelerations[name], row.acceleration) for row in rows])
            for name in ACCELERATION
        },
        {name: np.array([relative_error(row.torques[name], row.torque) for row in rows]) for name in TORQUE},
    )


def relative_error(approximate: Array, exact: Array) -> float:
    """Return the maximum difference as a fraction of the maximum exact magnitude; `nan` if that is zero."""
    peak = float(np.abs(exact).max())
    return float(np.abs(approximate - exact).max()) / peak if peak > 0.0 else math.nan


def _with_inertia_alone(mechanism: Mechanism) -> Mechanism:
    if mechanism.speed == 0.0:
        raise InputError("approximate models need a crank speed; got none; add one")
    return replace(mechanism, loads=(), gravity=(0.0, 0.0), acceleration=0.0, friction=Friction())
