"""The curves of one design over a turn of the crank, as columns with units."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from ...model.errors import InputError

if TYPE_CHECKING:
    from ...model.cycle.cycle import Cycle
    from ...model.linkage.linkage import Linkage
    from ...model.machine.mechanism import Mechanism

LEAST, MOST = 4, 3600

_DEGREES = 57.29577951308232
_FORCES = ("pivot_x", "pivot_y", "crank_pin_x", "crank_pin_y", "slider_pin_x", "slider_pin_y")


@dataclass(frozen=True)
class CurveColumn:
    """A curve. key: as in JSON. values: over the crank angles; NaN where friction leaves it undetermined."""

    key: str
    title: str
    unit: str
    values: list[float]


def cycle_table(mechanism: Mechanism, linkage: Linkage, *, angles: int = 360) -> list[CurveColumn]:
    """Return the curves of one fully turning linkage at evenly spaced crank angles from 0 deg; the angle comes first.

    Without a crank speed, velocity and acceleration are those of one radian per second: per unit of crank speed.
    Forces are those of the frame on the crank (pivot), of the crank on the rod (crank pin), of the rod on the slider
    (slider pin), and of the guide on the slider along +y. Position errors are NaN without tolerances.
    Raises `InputError` for too few or too many angles.
    """
    import numpy as np

    from ...model.cycle.cycle import cycle

    if not LEAST <= angles <= MOST:
        raise InputError(f"curves have {LEAST} to {MOST} crank angles; got {angles}; ask for as many")
    theta = np.arange(angles) * (2.0 * np.pi / angles)
    acting = cycle(mechanism, linkage, theta)
    moving = acting if mechanism.speed else cycle(replace(mechanism, speed=1.0), linkage, theta)
    if not mechanism.tolerances.given:
        unknown = np.full(angles, np.nan)
        acting = replace(acting, position_error=unknown, position_error_rss=unknown)
    return [
        CurveColumn(key, title, unit, (factor * values(moving if of_motion else acting)).tolist())
        for key, title, unit, factor, values, of_motion in _columns(static=not mechanism.speed)
    ]


def _columns(*, static: bool) -> list[tuple[str, str, str, float, Callable[[Cycle], Any], bool]]:
    """Return key, title, unit, factor from SI, where it is, and whether it is of the motion, of every curve."""
    velocity, acceleration = ("_mm_per_rad", "mm/rad", 1e3), ("_mm_per_rad2", "mm/rad^2", 1e3)
    if not static:
        velocity, acceleration = ("_m_s", "m/s", 1.0), ("_m_s2", "m/s^2", 1.0)
    per = " per crank speed" if static else ""
    forces = [
        (f"{name}_N", f"{name[:-2].replace('_', ' ')} force along {name[-1]}", "N", 1.0, _field(name), False)
        for name in _FORCES
    ]
    return [
        ("crank_angle_deg", "crank angle", "deg", _DEGREES, _field("crank_angle"), True),
        ("slider_position_mm", "slider position", "mm", 1e3, _field("slider_position"), True),
        (f"slider_velocity{velocity[0]}", f"slider velocity{per}", *velocity[1:], _field("slider_velocity"), True),
        (
            f"slider_acceleration{acceleration[0]}",
            f"slider acceleration{per}",
            *acceleration[1:],
            _field("slider_acceleration"),
            True,
        ),
        ("transmission_angle_deg", "transmission angle", "deg", _DEGREES, _field("transmission_angle"), True),
        ("torque_Nm", "drive torque", "N m", 1.0, _field("torque"), False),
        ("load_N", "load on the slider", "N", 1.0, _field("load"), False),
        *forces,
        ("guide_N", "guide force", "N", 1.0, _field("guide"), False),
        ("position_error_mm", "position error, worst case", "mm", 1e3, _field("position_error"), False),
        ("position_error_rss_mm", "position error, root-sum-square", "mm", 1e3, _field("position_error_rss"), False),
    ]


def _field(name: str) -> Callable[[Cycle], Any]:
    return lambda curves: getattr(curves, name)
