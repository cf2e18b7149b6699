"""Figure of a lever with its pivoting cylinder: scale drawing above force, length and angle against lever angle."""

from dataclasses import replace

import numpy as np
from matplotlib.figure import Figure

from ...model.linkage.linkage import Linkage
from ...model.machine.lever_cylinder import Cylinder
from ...model.machine.mechanism import Mechanism
from ...model.swing.swing import Swing
from ...model.turning_cylinder.forces import LeverMachine, LeverSwing, lever_curves
from ...model.turning_cylinder.machine import crank_turn, lever_machine, lever_swing
from ...objectives.kinds import ANGLE, FORCE, LENGTH, RATIO, SPEED, TORQUE, System
from ...objectives.tables.swing_curves import POINTS
from ..drawings.lever_parts import lever_extent, lever_shapes
from ..render.blocks import Value, joined, words
from .panel_figure import CRANK_ANGLE, DASHED, Line, Panel, PanelFigure
from .swing_figure import figure_below_machine

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
    found, degrees = crank_turn(mechanism, linkage, angles), np.degrees(angles)
    curves = (
        *(("torque on the crank", found.torque, TORQUE), ("length along the arm", found.length, LENGTH)),
        *(("speed of the arm over that of the crank", found.turn_1, RATIO),),
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
    shapes = lever_shapes(machine, swing, 0.5 * (swing.start + swing.end))
    return figure_below_machine(figure, shapes, lever_extent(machine, swing), system)
