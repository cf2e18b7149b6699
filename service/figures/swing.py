"""Figure of a swing: the machine to scale, and drive, slider, angles and error over the crank angle, both ways."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from matplotlib.figure import Figure

from ...model.linkage.linkage import Linkage
from ...model.machine.mechanism import Mechanism
from ...model.swing.forces import SwingCurves
from ...model.swing.swing import Swing
from ...objectives.kinds import ANGLE, LENGTH, POWER, Kind, System
from ..designs.swing_curves import both_ways, drive_kind, error_kind
from ..drawings.swing_parts import swing_look, swing_moving, swing_scenery
from ..render.blocks import dimensions, joined
from .drawing import scale_bar
from .painting import paint, show_rectangle
from .panels import draw_sheet
from .sheets import CRANK_ANGLE, Line, Panel, Sheet
from .style import place

_TALLEST = 3.2  # inches, of the drawing
_ASIDE, _BELOW = 0.4, 0.3


def swing_figure(
    mechanism: Mechanism,
    linkage: Linkage,
    swing: Swing,
    system: System = "metric",
    *,
    title: str = "",
    subtitle: str = "",
) -> Figure:
    """Return the machine half-way between both ends of its swing, which are dashed, above the curves of both strokes.

    title: instead of how it is driven. subtitle: before its dimensions.
    """
    sheet = swing_sheet(mechanism, linkage, swing)
    if title:
        sheet = replace(sheet, title=title, subtitle=joined([subtitle, sheet.subtitle], "; "))
    of = swing_look(mechanism, linkage, swing)
    (left, low, right, high), size = of.extent, of.look.size
    low -= 0.11 * size
    wide = sheet.columns * float(np.max(sheet.width)) - 2.0 * _ASIDE
    tall = min(_TALLEST, wide * (high - low) / (right - left))
    figure = draw_sheet(sheet, system, above=tall + _BELOW)
    foot = -(-len(sheet.panels) // sheet.columns) * sheet.height + _BELOW
    axes = place(figure, _ASIDE, foot, wide, tall)
    paint(axes, [*swing_scenery(of), *swing_moving(of, 0.5 * (of.swing.start + of.swing.end))])
    scale_bar(axes, left, low + 0.03 * size, size, system)
    show_rectangle(axes, left, low, right, high)
    return figure


def swing_sheet(mechanism: Mechanism, linkage: Linkage, swing: Swing) -> Sheet:
    """Return the curves of both strokes over the crank angle; the way back is drawn where it differs."""
    ways = both_ways(mechanism, linkage, swing)
    drive = "force on the slider" if swing.driver == "slider" else "torque on the crank"
    driven = "slider position error" if swing.driver == "crank" else "crank angle error"
    between = "transmission angle" if swing.driver == "crank" else "angle between rod and crank"
    panels = [
        _panel(drive, "drive", drive_kind(swing), ways),
        _panel("slider position", "slider_position", LENGTH, ways[:1]),
        _panel(between, "driven_angle", ANGLE, ways[:1]),
    ]
    if swing.duration is not None:
        panels.append(_panel("power of the drive", "power", POWER, ways))
    if mechanism.tolerances.given or swing.actuator_tolerance:
        panels.append(_panel(driven, "driven_error", error_kind(swing), ways[:1]))
    return Sheet(
        f"Swing driven at the {swing.driver}",
        dimensions(linkage),
        tuple(panels),
        columns=2 if len(panels) > 3 else 1,
        width=5.2,
    )


def _panel(title: str, name: str, kind: Kind, ways: tuple[SwingCurves, ...]) -> Panel:
    lines = []
    differ = len(ways) > 1 and not np.allclose(getattr(ways[0], name), getattr(ways[1], name)[::-1], equal_nan=True)
    for style, (label, curves) in enumerate(zip(("forth", "back"), ways if differ else ways[:1], strict=False)):
        lines.append(Line(label if differ else "", np.degrees(curves.crank_angle), getattr(curves, name), style))
    return Panel(title, CRANK_ANGLE, tuple(lines), kind)
