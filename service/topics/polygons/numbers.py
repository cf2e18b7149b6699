"""Vertices of the kinematic polygons of one design at one crank angle, both branches."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ....model.linkage.linkage import Linkage
    from ....model.machine.mechanism import Mechanism


def numbers(mechanism: Mechanism, linkage: Linkage, *, crank_angle: float = math.radians(30.0)) -> dict[str, Any]:
    """Return the vertices at one crank angle, rad, by branch and polygon; without a crank speed for 1 rad/s."""
    from ....model.classical.polygons import Polygons, polygons
    from ....model.linkage.linkage import Linkage
    from ....model.machine.mechanism import Branch

    branches: tuple[Branch, ...] = ("open", "crossed")
    speed = mechanism.speed or 1.0
    record: dict[str, Any] = {
        "crank_angle_deg": math.degrees(crank_angle),
        "speed_rad_s": speed,
        "acceleration_rad_s2": mechanism.acceleration,
    }
    for branch in branches:
        one = Linkage(linkage.crank, linkage.rod, linkage.offset, branch)
        found = polygons(one, crank_angle, speed=speed, acceleration=mechanism.acceleration)
        record[branch] = {
            "position_mm": dict(zip(Polygons.POSITION, (1e3 * found.position).tolist(), strict=True)),
            "velocity_m_s": dict(zip(Polygons.VELOCITY, found.velocity.tolist(), strict=True)),
            "acceleration_m_s2": dict(zip(Polygons.ACCELERATION, found.acceleration.tolist(), strict=True)),
            "rod_velocity_rad_s": float(found.rod_velocity),
            "rod_acceleration_rad_s2": float(found.rod_acceleration),
        }
    return record
