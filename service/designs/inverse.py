"""Crank angles that put the slider of a design at a position: the record of JSON, in metric units.

Of a crank that swings they are those of its swing: it has no others.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

from ...model.errors import AssemblyError
from ...model.linkage.from_slider import CrankSolution
from ...model.linkage.linkage import Linkage
from ...model.machine.mechanism import Mechanism
from ...model.swing.swing import Swing, dead_points, placed, require_swing
from ...objectives.kinds import ANGLE, ANGULAR_SPEED

_NEAR = 1e-9  # rad, beyond an end of a swing: rounding
UNDEFINED = "at a dead centre a slider at rest goes with any crank speed: crank speed and acceleration are undefined"
"""Reason why there is no crank speed where a slider velocity is given."""


@dataclass(frozen=True)
class SliderMotion:
    """Slider position, m, velocity, m/s, and acceleration, m/s^2, along +x; the latter two None where not given."""

    position: float
    velocity: float | None = None
    acceleration: float | None = None


def inverse_record(mechanism: Mechanism, linkage: Linkage, swing: Swing | None, motion: SliderMotion) -> dict[str, Any]:
    """Return dimensions, slider motion and every solution with keys that carry their units, and a note.

    swing: of the crank, whose angles alone count; None of one that turns, or of a linkage by itself. null: what is not
    asked for, and what a dead centre leaves undefined; the note then says so. Raises what `Linkage.from_slider` and
    `require_swing` raise, and `AssemblyError` for a position outside of the swing.
    """
    every = linkage.from_slider(motion.position, velocity=motion.velocity, acceleration=motion.acceleration)
    found, notes = every, []
    if swing is not None:
        own = require_swing(mechanism, linkage, swing)
        swing = placed(mechanism, own, swing)
        found = _within(every, swing)
        ends = f"from {_degrees(swing.start)} to {_degrees(swing.end)} deg"
        if not found:
            places = sorted(1e3 * float(own.at(angle).slider_position) for angle in _turning_angles(own, swing))
            raise AssemblyError(
                f"the slider stays between {places[0]:.9g} and {places[-1]:.9g} mm while the crank swings {ends}; got "
                f"{1e3 * motion.position:.9g} mm; take a position between"
            )
        if len(found) < len(every):
            other = "one other crank angle that gives it lies" if len(every) - len(found) == 1 else "others lie"
            notes.append(f"{other} outside of the swing {ends}")
    if motion.velocity is not None and any(each.speed is None for each in found):
        notes.append(UNDEFINED)
    return {
        **{f"{name}_mm": 1e3 * float(getattr(linkage, name)) for name in ("crank", "rod", "offset")},
        "branch": linkage.branch,
        "slider_position_mm": 1e3 * motion.position,
        "slider_velocity_m_s": motion.velocity,
        "slider_acceleration_m_s2": motion.acceleration,
        "solutions": [_solution(each) for each in found],
        "note": "; ".join(notes),
    }


def _within(found: tuple[CrankSolution, ...], swing: Swing) -> tuple[CrankSolution, ...]:
    """Return the solutions of a swing between crank angles, their angles as it has them."""
    kept = []
    for each in found:
        angles = [at for near in (0.0, _NEAR, -_NEAR) for at in swing.inside(each.crank_angle + near)]
        kept += [replace(each, crank_angle=angles[0])] if angles else []
    return tuple(sorted(kept, key=lambda each: each.crank_angle))


def _turning_angles(own: Linkage, swing: Swing) -> list[float]:
    """Return the ends of a swing, and where the slider turns back within."""
    return [swing.start, swing.end, *(angle for dead in dead_points(own) for angle in swing.inside(dead))]


def _degrees(angle: float) -> str:
    return f"{math.degrees(angle):.6g}"


def _solution(found: CrankSolution) -> dict[str, Any]:
    return {
        "crank_angle_deg": ANGLE.metric.factor * found.crank_angle,
        "stroke": found.stroke,
        "crank_speed_rpm": None if found.speed is None else ANGULAR_SPEED.metric.factor * found.speed,
        "crank_acceleration_rad_s2": found.acceleration,
    }
