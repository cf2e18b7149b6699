"""Crank angles that put the slider of a design at a position: the record of JSON, in metric units."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ...model.linkage.from_slider import CrankSolution
from ...model.linkage.linkage import Linkage
from ...objectives.kinds import ANGLE, ANGULAR_SPEED

UNDEFINED = "at a dead centre a slider at rest goes with any crank speed: crank speed and acceleration are undefined"
"""Reason why there is no crank speed where a slider velocity is given."""


@dataclass(frozen=True)
class SliderMotion:
    """Slider position, m, velocity, m/s, and acceleration, m/s^2, along +x; the latter two None where not given."""

    position: float
    velocity: float | None = None
    acceleration: float | None = None


def inverse_record(linkage: Linkage, motion: SliderMotion) -> dict[str, Any]:
    """Return dimensions, slider motion and every solution with keys that carry their units, and a note.

    null: what is not asked for, and what a dead centre leaves undefined; the note then says so. Raises what
    `Linkage.from_slider` raises.
    """
    found = linkage.from_slider(motion.position, velocity=motion.velocity, acceleration=motion.acceleration)
    undefined = motion.velocity is not None and any(each.speed is None for each in found)
    return {
        **{f"{name}_mm": 1e3 * float(getattr(linkage, name)) for name in ("crank", "rod", "offset")},
        "branch": linkage.branch,
        "slider_position_mm": 1e3 * motion.position,
        "slider_velocity_m_s": motion.velocity,
        "slider_acceleration_m_s2": motion.acceleration,
        "solutions": [_solution(each) for each in found],
        "note": UNDEFINED if undefined else "",
    }


def _solution(found: CrankSolution) -> dict[str, Any]:
    return {
        "crank_angle_deg": ANGLE.metric.factor * found.crank_angle,
        "stroke": found.stroke,
        "crank_speed_rpm": None if found.speed is None else ANGULAR_SPEED.metric.factor * found.speed,
        "crank_acceleration_rad_s2": found.acceleration,
    }
