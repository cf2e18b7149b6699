"""Case 1: Mechanism in row c of Norton's table, as analysed by Boyle and Liu, with lengths taken as metres."""

import math

from ...model.classical.loop_equations import Polygons, motion_polygons
from ...model.linkage.inverse_kinematics import crank_motion
from ...model.linkage.linkage import Linkage
from ...model.machine.mechanism import Branch
from .printed_values import Numbers

ANGLE, SPEED, ACCELERATION = math.radians(-30.0), -15.0, -10.0
BRANCHES: tuple[Branch, ...] = ("open", "crossed")


def case_linkage(branch: Branch = "open") -> Linkage:
    """Return the mechanism."""
    return Linkage(3.0, 8.0, 2.0, branch)


def computed_values() -> Numbers:
    """Return the exact values by key."""
    exact: dict[str, float] = {}
    for branch in BRANCHES:
        at = case_linkage(branch).at(ANGLE, speed=SPEED, acceleration=ACCELERATION)
        exact |= {
            f"{branch}_position": float(at.slider_position),
            f"{branch}_velocity": float(at.slider_velocity),
            f"{branch}_rod_velocity": float(at.rod_velocity),
            f"{branch}_acceleration": float(at.slider_acceleration),
            f"{branch}_rod_acceleration": float(at.rod_acceleration),
        }
    back = crank_motion(
        case_linkage(),
        exact["open_position"],
        velocity=exact["open_velocity"],
        acceleration=exact["open_acceleration"],
        solution="outward",
    )
    pin = motion_polygons(case_linkage(), ANGLE).position[1]
    vertices = len(Polygons.POSITION) + len(Polygons.VELOCITY) + len(Polygons.ACCELERATION)
    given_coordinates = 9  # origin and slider line of each polygon
    return Numbers(
        exact
        | {
            "backsolved_angle": math.degrees(math.remainder(float(back.crank_angle), 2.0 * math.pi)),
            "backsolved_speed": float(back.speed),
            "backsolved_acceleration": float(back.acceleration),
            "below_horizontal": -math.degrees(math.atan2(pin[1], pin[0])),
            "given_coordinates": given_coordinates,
            "found_coordinates": 2 * vertices - given_coordinates,
        }
    )
