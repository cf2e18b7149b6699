"""Figures of a swing or a lever: the machine to scale, and its curves against the angle, both strokes."""

from dataclasses import replace

import numpy as np
from matplotlib.figure import Figure

from ...model.linkage.linkage import Linkage
from ...model.machine.lever_cylinder import Cylinder
from ...model.machine.mechanism import Mechanism
from ...model.swing.forces import SwingCurves
from ...model.swing.swing import Swing
from ...model.turning_cylinder.cylinder_and_pin_forces import LeverMachine, LeverSwing, lever_curves
from ...model.turning_cylinder.lever_of_design import lever_machine, lever_swing, state_at_crank_angles
from ...objectives.kinds import ANGLE, FORCE, LENGTH, RATIO, SPEED, TORQUE, System
from ...objectives.tables.swing_curves import (
    POINTS,
    SwingCurve,
    curves_of_both_strokes,
    has_position_error,
    motion_and_drive_curves,
)
from ..drawings.lever_parts import lever_extent, lever_shapes, usual_angle
from ..drawings.shapes import Shape
from ..drawings.swing_parts import fixed_swing_shapes, moving_swing_shapes, swing_sizes
from ..render.blocks import Value, dimensions_text, joined, words
from .mechanism_drawing import draw_scale_bar
from .panel_drawing import draw_panel_figure
from .panel_figure import CRANK_ANGLE, DASHED, Line, Panel, PanelFigure
from .shape_painting import paint_shapes, set_axes_to_rectangle
from .style import add_axes

_TALLEST = 3.2  # inches, for the drawing
_ASIDE, _BELOW = 0.4, 0.3
_DRAWN = ("drive", "slider_position", "driven_angle", "power", "driven_error")
"""Curves of the panels, by their names in `SwingCurves`."""


def swing_figure(
    mechanism: Mechanism,
    linkage: Linkage,
    swing: Swing,
    system: System = "metric",
    *,
    title: str = "",
    subtitle: str = "",
) -> Figure:
    """Return the machine at mid-swing with both ends dashed, above the curves of both strokes.

    title: title instead of the type of drive. subtitle: text before its dimensions.
    """
    panel_figure = swing_panels(mechanism, linkage, swing)
    if title:
        panel_figure = replace(panel_figure, title=title, subtitle=joined([subtitle, panel_figure.subtitle], "; "))
    drawn = swing_sizes(mechanism, linkage, swing)
    shapes = [*fixed_swing_shapes(drawn), *moving_swing_shapes(drawn, 0.5 * (drawn.swing.start + drawn.swing.end))]
    return figure_below_machine(panel_figure, shapes, drawn.extent, system)


def figure_below_machine(
    panel_figure: PanelFigure, shapes: list[Shape], extent: tuple[float, float, float, float], system: System
) -> Figure:
    """Return panels below a machine drawn to scale. extent: left, bottom, right and top of the machine, mm."""
    left, low, right, high = extent
    size = max(right - left, high - low)
    low -= 0.11 * size
    wide = panel_figure.columns * float(np.max(panel_figure.width)) - 2.0 * _ASIDE
    tall = min(_TALLEST, wide * (high - low) / (right - left))
    figure = draw_panel_figure(panel_figure, system, space_above=tall + _BELOW)
    foot = -(-len(panel_figure.panels) // panel_figure.columns) * panel_figure.height + _BELOW
    axes = add_axes(figure, _ASIDE, foot, wide, tall)
    paint_shapes(axes, shapes)
    draw_scale_bar(axes, left, low + 0.03 * size, size, system)
    set_axes_to_rectangle(axes, left, low, right, high)
    return figure


def swing_panels(mechanism: Mechanism, linkage: Linkage, swing: Swing) -> PanelFigure:
    """Return the curves of both strokes over the crank angle; the return stroke is drawn only if it differs."""
    ways = curves_of_both_strokes(mechanism, linkage, swing)
    curves = {curve.attribute: curve for curve in motion_and_drive_curves(swing)}
    if not has_position_error(mechanism, swing):
        del curves["driven_error"]
    panels = [
        _panel_of_curve(curves[name], ways if name in ("drive", "power") else ways[:1])
        for name in _DRAWN
        if name in curves
    ]
    return PanelFigure(
        f"Swing driven at the {swing.driver}",
        dimensions_text(linkage),
        tuple(panels),
        columns=2 if len(panels) > 3 else 1,
        width=5.2,
    )


def _panel_of_curve(curve: SwingCurve, ways: tuple[SwingCurves, ...]) -> Panel:
    values = [getattr(way, curve.attribute) for way in ways]
    differ = len(ways) > 1 and not np.allclose(values[0], values[1][::-1], equal_nan=True)
    lines = tuple(
        Line(label if differ else "", np.degrees(way.crank_angle), heights, style)
        for style, (label, way, heights) in enumerate(zip(("forth", "back"), ways, values, strict=False))
        if differ or not style
    )
    return Panel(curve.title, CRANK_ANGLE, lines, curve.kind)


_X = "lever angle, deg"


def lever_datasheet(
    mechanism: Mechanism, linkage: Linkage, swing: Swing, system: System = "metric", *, title: str, subtitle: str
) -> Figure:
    """Return the lever at mid-swing with both ends dashed, above its curves."""
    assert mechanism.lever is not None
    machine, _ = lever_machine(mechanism, linkage, swing)
    cylinder, placed = mechanism.lever.cylinder, lever_swing(mechanism, linkage, swing)
    if placed.of_full_turn:
        panels = _panels_of_turn(mechanism, linkage)
        return _figure_of_lever(machine, placed, panels, system, title=title, subtitle=subtitle)
    return lever_figure(machine, placed, cylinder, system, title=title, subtitle=subtitle)


def lever_figure(
    machine: LeverMachine,
    swing: LeverSwing,
    cylinder: Cylinder,
    system: System = "metric",
    *,
    title: str = "Lever moved by a cylinder that turns",
    subtitle: str = "",
) -> Figure:
    """Return the lever half-way between both ends, which are dashed, above its curves."""
    found = lever_curves(machine, swing, np.linspace(0.0, 1.0, POINTS))
    degrees, rub = np.degrees(found.lever_angle), cylinder.seal_friction
    forces = [Line("extending", degrees, found.push + rub), Line("retracting", degrees, found.push - rub, DASHED)]
    panels = [
        Panel("push of the cylinder", _X, tuple(forces if rub else [replace(forces[0], label="")]), FORCE),
        Panel("length of the cylinder", _X, (Line("", degrees, found.length),), LENGTH),
        Panel("transmission angle", _X, (Line("", degrees, found.transmission),), ANGLE),
    ]
    if swing.duration is not None:
        panels.append(Panel("speed of the cylinder", _X, (Line("", degrees, found.speed),), SPEED))
    return _figure_of_lever(machine, swing, panels, system, title=title, subtitle=subtitle)


def _panels_of_turn(mechanism: Mechanism, linkage: Linkage) -> list[Panel]:
    """Return crank torque, arm speed and acceleration, and the length along the arm over a crank turn."""
    angles = np.linspace(0.0, 2.0 * np.pi, 2 * POINTS + 1)
    found, degrees = state_at_crank_angles(mechanism, linkage, angles), np.degrees(angles)
    curves = (
        *(("torque on the crank", found.torque, TORQUE), ("length along the arm", found.length, LENGTH)),
        *(("speed of the arm divided by the speed of the crank", found.turn_1, RATIO),),
        *(("acceleration of the arm over the crank's squared speed", found.turn_2, RATIO),),
    )
    return [Panel(name, CRANK_ANGLE, (Line("", degrees, curve),), kind, turns=True) for name, curve, kind in curves]


def _figure_of_lever(
    machine: LeverMachine, swing: LeverSwing, panels: list[Panel], system: System, *, title: str, subtitle: str
) -> Figure:
    sizes = machine.sizes
    dimensions = words(
        "crank {crank}, frame {frame} at {angle}, offset {offset}",
        crank=Value(sizes.crank, LENGTH),
        frame=Value(sizes.frame, LENGTH),
        angle=Value(sizes.frame_angle, ANGLE),
        offset=Value(sizes.offset, LENGTH),
    )
    figure = PanelFigure(
        title,
        joined([subtitle, dimensions], "; ") if subtitle else dimensions,
        tuple(panels),
        columns=2 if len(panels) > 3 else 1,
        width=5.2,
    )
    shapes = lever_shapes(machine, swing, usual_angle(swing))
    return figure_below_machine(figure, shapes, lever_extent(machine, swing), system)
