"""Curves of one design over a swing, forward and return stroke, and the kinds of their values."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from ...model.arrays import Array
from ...model.errors import InputError
from ...model.linkage.linkage import Linkage
from ...model.machine.mechanism import Mechanism
from ...model.swing.forces import SwingCurves, swing_curves
from ...model.swing.swing import Swing, require_swing, swing_between_crank_angles
from ..kinds import (
    ACCELERATION,
    ANGLE,
    ANGULAR_ACCELERATION,
    ANGULAR_SPEED,
    FORCE,
    LENGTH,
    POWER,
    SPEED,
    TORQUE,
    Kind,
)
from .cycle_curves import LEAST, MOST

if TYPE_CHECKING:
    import pandas as pd

POINTS = 181
"""Points per stroke, in curves and figures."""


@dataclass(frozen=True)
class SwingCurve:
    """A curve over a swing.

    name: key without unit. attribute: name in `SwingCurves`. timed: whether it needs a duration.
    """

    name: str
    attribute: str
    title: str
    kind: Kind
    timed: bool = False

    @property
    def field(self) -> str:
        """Key of the curve in metric tables and JSON."""
        return self.name + self.kind.metric.suffix

    def values_in(self, curves: SwingCurves) -> Array:
        """Return the values, metric."""
        return np.asarray(self.kind.metric.factor * getattr(curves, self.attribute))


def motion_and_drive_curves(swing: Swing) -> tuple[SwingCurve, ...]:
    """Return the curves of a swing except the joint forces; without a duration, only curves that do not need it."""
    drive = "force on the slider" if swing.driver == "slider" else "torque on the crank"
    angle_title = "transmission angle" if swing.driver == "crank" else "angle between rod and crank"
    error = "slider position error" if swing.driver == "crank" else "crank angle error"
    every = (
        SwingCurve("crank_angle", "crank_angle", "crank angle", ANGLE),
        SwingCurve("crank_speed", "crank_speed", "crank speed", ANGULAR_SPEED, timed=True),
        SwingCurve("crank_acceleration", "crank_acceleration", "crank acceleration", ANGULAR_ACCELERATION, timed=True),
        SwingCurve("slider_position", "slider_position", "slider position", LENGTH),
        SwingCurve("slider_velocity", "slider_velocity", "slider velocity", SPEED, timed=True),
        SwingCurve("slider_acceleration", "slider_acceleration", "slider acceleration", ACCELERATION, timed=True),
        SwingCurve("drive", "drive", drive, kind_of_drive_effort(swing)),
        SwingCurve("power", "power", "power of the drive", POWER, timed=True),
        SwingCurve("load", "load", "load on the slider", FORCE),
        SwingCurve("transmission_angle", "driven_angle", angle_title, ANGLE),
        SwingCurve(
            f"{driven_side_name(swing)}_position_error", "driven_error", error, kind_of_driven_side_error(swing)
        ),
    )
    return tuple(curve for curve in every if not curve.timed or swing.duration is not None)


def force_components() -> tuple[SwingCurve, ...]:
    """Return the curves of the joint forces along x and y, and of the guide force."""
    titles = {"pivot": "crank pivot force", "crank_pin": "crank pin force", "slider_pin": "slider pin force"}
    components = (
        SwingCurve(f"{name}_{axis}", f"{name}_{axis}", f"{title}, {axis}", FORCE)
        for name, title in titles.items()
        for axis in ("x", "y")
    )
    return (*components, SwingCurve("guide", "guide", "guide force", FORCE))


def force_magnitudes() -> tuple[SwingCurve, ...]:
    """Return the curves of the joint force magnitudes, and of the signed guide force."""
    return (
        SwingCurve("pivot", "pivot", "crank pivot force", FORCE),
        SwingCurve("crank_pin", "crank_pin", "crank pin force", FORCE),
        SwingCurve("slider_pin", "slider_pin", "slider pin force", FORCE),
        SwingCurve("guide", "guide", "guide force", FORCE),
    )


def kind_of_drive_effort(swing: Swing) -> Kind:
    """Return the kind of the drive effort: a torque or a force."""
    return TORQUE if swing.driver == "crank" else FORCE


def kind_of_driven_side_error(swing: Swing) -> Kind:
    """Return the kind of the error at the driven side: in slider position or in crank angle."""
    return LENGTH if swing.driver == "crank" else ANGLE


def driven_side_name(swing: Swing) -> str:
    """Return the driven side."""
    return "slider" if swing.driver == "crank" else "crank"


def curves_of_both_strokes(mechanism: Mechanism, linkage: Linkage, swing: Swing) -> tuple[SwingCurves, SwingCurves]:
    """Return the curves for the forward and the return stroke, at evenly spaced times."""
    checked, share = require_swing(mechanism, linkage, swing), np.linspace(0.0, 1.0, POINTS)
    swing = swing_between_crank_angles(mechanism, checked, swing)
    return (
        swing_curves(mechanism, checked, swing, share),
        swing_curves(mechanism, checked, swing, share, back=True),
    )


def curves_at_even_times(
    mechanism: Mechanism, linkage: Linkage, swing: Swing, count: int
) -> tuple[SwingCurves, SwingCurves]:
    """Return the curves at evenly spaced times in a swing, for the forward and the return stroke.

    swing: swing between two crank angles that the linkage can make. count: even number of times. The first time is the
    start of the swing; the middle one is its end, which belongs to the forward stroke.
    """
    place: Array = np.arange(count, dtype=np.float64) * (2.0 / count)
    return (
        swing_curves(mechanism, linkage, swing, place[place <= 1.0]),
        swing_curves(mechanism, linkage, swing, place[place > 1.0] - 1.0, back=True),
    )


def has_position_error(mechanism: Mechanism, swing: Swing) -> bool:
    """Return whether an error is defined for the driven side."""
    return mechanism.tolerances.are_stated or swing.actuator_tolerance > 0.0


def defined_curves(mechanism: Mechanism, swing: Swing) -> list[SwingCurve]:
    """Return the curves of a swing that a machine defines: an error needs tolerances."""
    every = (*motion_and_drive_curves(swing), *force_components())
    return [one for one in every if one.attribute != "driven_error" or has_position_error(mechanism, swing)]


def swing_table(mechanism: Mechanism, linkage: Linkage, swing: Swing, points: int | ArrayLike = 360) -> pd.DataFrame:
    """Return the curves of both strokes as a table in SI, one row for each of the evenly spaced times.

    The first row is the start of the swing, the middle one its end. Columns: way, "forth" or "back", time_s unless the
    swing is slow, and the names of the curves with their unit. Raises `InputError` for an odd number of points, too few
    or too many, and `AssemblyError` for a linkage that cannot make the swing.
    """
    count, checked = require_even_point_count(points, MOST), require_swing(mechanism, linkage, swing)
    swing = swing_between_crank_angles(mechanism, checked, swing)
    ways = curves_at_even_times(mechanism, checked, swing, count)
    shares = np.concatenate([ways[0].share, 1.0 + ways[1].share])
    columns: dict[str, Any] = {"way": np.where(shares <= 1.0, "forth", "back")}
    if swing.duration is not None:
        columns["time_s"] = swing.duration * shares
    for curve in defined_curves(mechanism, swing):
        values = np.concatenate([getattr(way, curve.attribute) for way in ways])
        columns[curve.name + curve.kind.si_display_unit.suffix] = values
    import pandas as pd

    return pd.DataFrame(columns)


def require_even_point_count(count: object, limit: int) -> int:
    """Return a valid number of points for both strokes together.

    Raises `InputError` unless it is even and between `LEAST` and a limit.
    """
    if isinstance(count, int | np.integer) and LEAST <= count <= limit and not count % 2:
        return int(count)
    raise InputError(
        f"curves of a swing must have {LEAST} to {limit} points, the same number in both strokes; got {count!r:.60}; "
        "ask for an even number"
    )
