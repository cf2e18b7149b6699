"""Comparison of the approximate models with the exact one, over the crank angle and over the offset."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array
from ..cycle.cycle import cycle
from ..errors import InputError
from ..linkage.linkage import Linkage
from ..linkage.require_single_linkage import require_single_rotating_linkage
from ..machine.friction import Friction
from ..machine.mechanism import Mechanism
from .lumped import mechanism_with_lumped_rod, rotating_and_reciprocating_masses
from .series import drive_torque_equation_48, series_acceleration, series_torque

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
