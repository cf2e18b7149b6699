"""Figure of a swing: drive, slider, transmission angle and error over the crank angle, both ways."""

from __future__ import annotations

import numpy as np

from ...model.linkage.linkage import Linkage
from ...model.machine.mechanism import Mechanism
from ...model.swing.forces import SwingCurves
from ...model.swing.swing import Swing
from ...objectives.kinds import ANGLE, LENGTH, POWER, Face
from ..figures.numerals import with_unit
from ..figures.sheets import CRANK_ANGLE, Line, Panel, Sheet, lengths
from .record import both_ways, drive_kind, error_kind


def swing_sheet(mechanism: Mechanism, linkage: Linkage, swing: Swing) -> Sheet:
    """Return the curves of both ways over the crank angle; the way back is drawn where it differs."""
    ways = both_ways(mechanism, linkage, swing)
    drive = "force on the slider" if swing.driver == "slider" else "torque on the crank"
    driven = "slider position error" if swing.driver == "crank" else "crank angle error"
    between = "transmission angle" if swing.driver == "crank" else "angle between rod and crank"
    panels = [
        _panel(drive, "drive", drive_kind(swing).metric, ways),
        _panel("slider position", "slider_position", LENGTH.metric, ways[:1]),
        _panel(between, "driven_angle", ANGLE.metric, ways[:1]),
    ]
    if swing.duration is not None:
        panels.append(_panel("power of the drive", "power", POWER.metric, ways))
    if mechanism.tolerances.given or swing.actuator_tolerance:
        panels.append(_panel(driven, "driven_error", error_kind(swing).metric, ways[:1]))
    title = f"Swing driven at the {swing.driver}"
    return Sheet(title, lengths(linkage), tuple(panels), columns=2 if len(panels) > 3 else 1, width=5.2)


def _panel(title: str, name: str, face: Face, ways: tuple[SwingCurves, ...]) -> Panel:
    lines = []
    differ = len(ways) > 1 and not np.allclose(getattr(ways[0], name), getattr(ways[1], name)[::-1], equal_nan=True)
    for style, (label, curves) in enumerate(zip(("forth", "back"), ways if differ else ways[:1], strict=False)):
        x, y = np.degrees(curves.crank_angle), face.factor * getattr(curves, name)
        lines.append(Line(label if differ else "", x, y, style))
    return Panel(with_unit(title, face.symbol), CRANK_ANGLE, tuple(lines))
