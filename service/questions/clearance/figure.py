"""Figures of a loose joint: motion compared with the ideal, path of the journal, several speeds side by side."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from ....model.arrays import Array
from ....model.clearance.run import ClearanceRun, simulate
from ....model.clearance.statistics import ClearanceSummary, clearance_statistics
from ....model.errors import InputError
from ....model.linkage.linkage import Linkage
from ....model.machine.mechanism import Mechanism
from ....objectives.kinds import ACCELERATION, ANGULAR_SPEED, ENERGY, FORCE, LENGTH, PERCENT, RATIO, SPEED, Kind, System
from ...figures.panel_drawing import draw_panel
from ...figures.panel_figure import CRANK_ANGLE, DASHED, DOTS, SOLID, Line, Panel, PanelFigure
from ...figures.style import add_axes, new_figure, write_heading, write_text
from ...render.blocks import Text, Unit, Value, words
from ...render.formatting import format_text
from ...render.numerals import format_number

CASE_RPM = (30.0, 300.0, 400.0)
"""Speeds of the published case: ME748, "Offset-Slider Crank Mechanism", section 2.3, with the nominal speed in the
middle."""
_RPM = 2.0 * math.pi / 60.0
_TITLES = {LENGTH: "slider displacement", SPEED: "slider velocity", ACCELERATION: "slider acceleration"}


@dataclass(frozen=True)
class LooseCurves:
    """Curves of the last revolution of a run with a loose joint, in SI.

    angles: crank angles (n,), deg, from 0 to 360 in the direction of rotation. curves, ideal: kind -> (n,),
    displacement, velocity and acceleration of the slider. force: contact force. journal_x, journal_y: position of the
    journal, m. touching: contact flags (n,).
    """

    angles: Array
    curves: dict[Kind, Array]
    ideal: dict[Kind, Array]
    force: Array
    journal_x: Array
    journal_y: Array
    touching: NDArray[np.bool_]


def loose_joint_curves(run: ClearanceRun) -> LooseCurves:
    """Return the curves of the last revolution of a run. Raises `InputError` if there is no complete revolution."""
    if run.cycles < 1:
        raise InputError("a figure needs a complete turn of the crank; got none; simulate longer")
    start = (run.cycles - 1) * run.turn_time
    last = (run.times >= start * (1.0 - 1e-12)) & (run.times <= (start + run.turn_time) * (1.0 + 1e-12))
    loose = (run.slider_position, run.slider_velocity, run.slider_acceleration)
    ideal = (run.ideal_position, run.ideal_velocity, run.ideal_acceleration)
    return LooseCurves(
        360.0 * (run.times[last] - start) / run.turn_time,
        {kind: values[last] for kind, values in zip(_TITLES, loose, strict=True)},
        {kind: values[last] for kind, values in zip(_TITLES, ideal, strict=True)},
        run.contact_force[last],
        run.journal_x[last],
        run.journal_y[last],
        run.in_contact[last],
    )


def clearance_figure(run: ClearanceRun, system: System = "metric") -> Figure:
    """Return slider motion and contact force over the last revolution of a run, and the path of the journal."""
    curves = loose_joint_curves(run)
    figure = new_figure(12.4, 7.6)
    title = words("{clearance}, {speed}", clearance=_clearance_text(run), speed=_speed_value(run))
    subtitle = f"turn {run.cycles} of the crank; solid: loose joint, dashed: ideal joints"
    write_heading(figure, format_text(title, system, printed=True), subtitle)
    position, velocity, acceleration = (_motion_panel(curves, kind) for kind in _TITLES)
    loose, ideal = position.lines
    off = float(np.abs(loose.y - ideal.y).max())
    share = f"{format_number(100.0 * off / float(run.linkage.stroke), 2)} % of the stroke"
    note = words(f"largest deviation {{off}}, {share}", off=Value(off, LENGTH, 3))
    greatest = words("greatest {force}", force=Value(float(curves.force.max()), FORCE, 4))
    x_title, force = "crank angle in the direction of rotation, deg", Line("", curves.angles, curves.force, SOLID)
    contact = Panel("contact force", x_title, (force,), FORCE, turns=True, note=greatest)
    for row, panel in enumerate((contact, acceleration, velocity, replace(position, note=note))):
        draw_panel(add_axes(figure, 0.75, 0.55 + 1.62 * row, 6.7, 1.24), panel, system, has_x_title=row == 0)
    draw_panel(add_axes(figure, 8.3, 2.65, 3.75, 3.75), _journal_panel(curves, run.clearance.radius), system)
    if run.cycles > run.discard:
        for row, line in enumerate(_statistics_lines(clearance_statistics(run))):
            write_text(figure, 7.95, 1.8 - 0.2 * row, format_text(line, system, printed=True))
    return figure


def speeds_figure(runs: Sequence[ClearanceRun]) -> PanelFigure:
    """Return displacement, velocity and acceleration of the slider with a loose joint, one column per run."""
    columns = []
    for run in runs:
        curves = loose_joint_curves(run)
        first, *other_panels = (_motion_panel(curves, kind) for kind in _TITLES)
        columns.append([replace(first, note=(_speed_value(run),)), *other_panels])
    panels = tuple(panel for row in zip(*columns, strict=True) for panel in row)
    subtitle = "solid: loose joint, dashed: ideal joints"
    return PanelFigure(
        _clearance_text(runs[0]), subtitle, panels, columns=len(runs), width=4.05, height=1.82, stacked=True
    )


def speed_runs(mechanism: Mechanism, linkage: Linkage, rpm: Sequence[float] = CASE_RPM) -> list[ClearanceRun]:
    """Return a run of three revolutions at each speed, in the mechanism's direction of rotation."""
    if mechanism.clearance is None:
        raise InputError("a comparison of speeds needs a joint with clearance; all joints are ideal; give a clearance")
    way = math.copysign(_RPM, mechanism.speed)
    return [
        simulate(replace(mechanism, speed=way * speed), linkage, mechanism.clearance, cycles=3, discard=1)
        for speed in rpm
    ]


def _clearance_text(run: ClearanceRun) -> Text:
    clearance = run.clearance
    at = f"radial clearance {{radius}} at the {clearance.joint}"
    return words(at, radius=Value(float(clearance.radius), LENGTH, 4))


def _speed_value(run: ClearanceRun) -> Value:
    return Value(float(run.mechanism.speed), ANGULAR_SPEED, 4)


def _motion_panel(curves: LooseCurves, kind: Kind) -> Panel:
    loose, ideal = curves.curves[kind], curves.ideal[kind]
    note: Text = ""
    if kind is ACCELERATION:
        peaks = (Value(float(np.abs(values).max()), kind, 3) for values in (loose, ideal))
        note = words("greatest {loose}, ideal {ideal}", **dict(zip(("loose", "ideal"), peaks, strict=True)))
    lines = (Line("", curves.angles, loose, SOLID), Line("", curves.angles, ideal, DASHED))
    return Panel(_TITLES[kind], CRANK_ANGLE, lines, kind, turns=True, note=note)


def _journal_panel(curves: LooseCurves, radius: float) -> Panel:
    """Return the path of the journal's centre, with dots where it touches the bearing, and the clearance circle."""
    turn, touching = np.linspace(0.0, 2.0 * math.pi, 361), curves.touching
    lines = (
        Line("", radius * np.cos(turn), radius * np.sin(turn), DASHED),
        Line("", curves.journal_x, curves.journal_y, SOLID),
        Line("", curves.journal_x[touching], curves.journal_y[touching], DOTS),
    )
    title, x_title = (
        "path of the journal's centre (dots: in contact)",
        "horizontal: along the slider line; vertical: across it",
    )
    return Panel(title, x_title, lines, LENGTH, LENGTH, equal=True)


def _statistics_lines(summary: ClearanceSummary) -> list[Text]:
    """Return the summary in lines."""
    lines: list[Text] = [f"means over {summary.turns} turns, ± 99 % confidence:"]
    for title, estimate, kind in (
        ("peak acceleration divided by the ideal one", summary.acceleration_ratio, RATIO),
        ("impacts per turn", summary.impacts, RATIO),
        ("time in contact", summary.contact_share, PERCENT),
        ("peak contact force", summary.peak_contact_force, FORCE),
        ("energy lost in the joint per turn", summary.dissipated, ENERGY),
    ):
        spread = estimate.uncertainty
        certain = "" if spread is None else words(" ± {spread}", spread=Value(spread, kind, 2, bare=True))
        value = Value(estimate.value, kind, 3, bare=True)
        lines.append(words(f"{title}: {{value}}{{certain}} {{unit}}", value=value, certain=certain, unit=Unit(kind)))
    return lines
