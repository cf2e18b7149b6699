"""Indicator diagram of a cylinder: pressure and volume over the crank angle, and the valve events."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array
from ..dynamics.gas import compression_end_position, expansion_end_position
from ..dynamics.segments import crank_angle_at
from ..linkage.linkage import Linkage
from ..linkage.require_single_linkage import require_single_rotating_linkage
from ..machine.loads.cylinder import Cylinder
from ..machine.loads.engine import LimitedPressure
from ..machine.mechanism import Mechanism
from ..machine.two_turn_machine import half_of_cycle_at, shift_angles_into_half

_BEFORE = 5e-10  # shift to an earlier crank angle, rad: less than the width at which figures mark jumps


@dataclass(frozen=True)
class Indicator:
    """Volume, m^3, and pressure, Pa, of the gas in a cylinder at crank angles, rad, each (n,)."""

    crank_angle: Array
    volume: Array
    pressure: Array


def indicator_diagram(mechanism: Mechanism, linkage: Linkage, load: Cylinder, crank_angle: ArrayLike) -> Indicator:
    """Return volume and pressure in one of a machine's cylinders; at a dead centre, the pressure just before it."""
    linkage = require_single_rotating_linkage(mechanism, linkage)
    theta = np.atleast_1d(np.asarray(crank_angle, dtype=np.float64))
    stroke, sign, top = _stroke_and_piston_top(linkage, load)
    z = np.clip(sign * (linkage.sign * linkage.at(theta).slider_position - top), 0.0, stroke)
    # The motion just before: at a dead centre, that of the stroke ending there.
    before = linkage.at(theta - _BEFORE * mechanism.direction, speed=mechanism.direction).slider_velocity
    away = sign * linkage.sign * before > 0.0
    pressure = _pressure_at(load, z, stroke, away)
    if load.cycle_turns > 1:
        turn = half_of_cycle_at(mechanism, *linkage.dead_centre_angles, theta - _BEFORE * mechanism.direction)
        parts = [load.load_on_turn(number) for number in (1, 2)]
        first, second = (_pressure_at(part, z, stroke, away) for part in parts if isinstance(part, Cylinder))
        pressure = np.where(turn == 0, first, second)
    return Indicator(theta, load.clearance * load.area * stroke + load.clearance_volume + load.area * z, pressure)


def _pressure_at(load: Cylinder, z: Array, stroke: float, away: Any) -> Array:
    return np.asarray(
        np.where(away, load.pressure(z, stroke, expanding=True), load.pressure(z, stroke, expanding=False))
    )


def valve_events(mechanism: Mechanism, linkage: Linkage, load: Cylinder) -> tuple[float | None, float | None]:
    """Return the crank angles, rad in [0, 2 pi), at which expansion and compression end.

    None if there is no such event.
    """
    linkage = require_single_rotating_linkage(mechanism, linkage)
    stroke = _stroke_and_piston_top(linkage, load)[0]
    if load.compression_exponent == 0.0 or isinstance(load, LimitedPressure):
        return None, None
    h, ratio = load.clearance * stroke + load.clearance_volume / load.area, load.high / load.low
    events = (
        expansion_end_position(h, ratio, load.expansion_exponent),
        compression_end_position(stroke, h, ratio, load.compression_exponent),
    )
    ends = [
        _crank_angle_at_piston_distance(mechanism, linkage, load, float(z), away=away)
        for z, away in zip(events, (True, False), strict=True)
    ]
    return ends[0], ends[1]


def burning_end_angle(mechanism: Mechanism, linkage: Linkage, load: Cylinder) -> float | None:
    """Return the crank angle at which burning at peak pressure ends, rad in [0, 4 pi).

    None if there is no such phase.
    """
    if not isinstance(load, LimitedPressure):
        return None
    linkage = require_single_rotating_linkage(mechanism, linkage)
    angle = _crank_angle_at_piston_distance(
        mechanism, linkage, load, load.burning_share * _stroke_and_piston_top(linkage, load)[0], away=True
    )
    if angle is None or load.cycle_turns == 1:
        return angle
    return float(shift_angles_into_half(mechanism, *linkage.dead_centre_angles, np.array(angle), 0))


def _crank_angle_at_piston_distance(
    mechanism: Mechanism, linkage: Linkage, load: Cylinder, z: float, *, away: bool
) -> float | None:
    """Return the crank angle at which the piston is z from its top position, rad in [0, 2 pi).

    away: whether the piston moves away from its top position. None if z is out of reach.
    """
    stroke, sign, top = _stroke_and_piston_top(linkage, load)
    outward = away == (sign > 0.0)
    second = outward == (mechanism.direction < 0.0)
    x = linkage.sign * (top + sign * z)
    angle = crank_angle_at(x, float(linkage.crank), float(linkage.rod), float(linkage.offset), second)
    return angle % (2.0 * math.pi) if 0.0 < z < stroke else None


def _stroke_and_piston_top(linkage: Linkage, load: Cylinder) -> tuple[float, float, float]:
    """Return the stroke, the direction in which the piston leaves its top, and the top's distance from the pivot.

    The direction is 1 for outward.
    """
    inner, outer = (linkage.sign * float(linkage.at(angle).slider_position) for angle in linkage.dead_centre_angles)
    return outer - inner, *((-1.0, outer) if load.head == "outer dead centre" else (1.0, inner))
