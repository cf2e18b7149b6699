"""Figures of a loose joint: motion against the ideal one, path of the journal, several speeds side by side."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from ....model.clearance.run import ClearanceRun, simulate
from ....model.clearance.statistics import ClearanceSummary, summarise
from ....model.errors import InputError
from ....model.linkage.linkage import Linkage
from ....model.machine.mechanism import Mechanism
from ...figures.panels import draw_panel, draw_sheet
from ...figures.sheets import CRANK_ANGLE, DASHED, DOTS, THIN, Line, Panel, Sheet
from ...figures.style import heading, new_figure, place, write
from ...render.numerals import shown

Array = NDArray[np.float64]

CASE_RPM = (30.0, 300.0, 400.0)
"""Speeds of the published case: ME748, "Offset-Slider Crank Mechanism", section 2.3, with the nominal one between."""
_RPM = 2.0 * math.pi / 60.0


@dataclass(frozen=True)
class LooseCurves:
    """Curves of the last turn of a run with a loose joint.

    angles: (n,), deg, from 0 to 360 in the direction of rotation. curves, ideal: title with unit -> (n,), displacement,
    velocity and acceleration of the slider. force: contact force, kN. journal_x, journal_y: mm. touching: (n,).
    """

    angles: Array
    curves: dict[str, Array]
    ideal: dict[str, Array]
    force: Array
    journal_x: Array
    journal_y: Array
    touching: NDArray[np.bool_]


def loose_curves(run: ClearanceRun) -> LooseCurves:
    """Return the curves of the last turn of a run. Raises `InputError` if it has no complete turn."""
    if run.cycles < 1:
        raise InputError("a figure needs a complete turn of the crank; got none; let the simulation run longer")
    start = (run.cycles - 1) * run.period
    last = (run.times >= start * (1.0 - 1e-12)) & (run.times <= (start + run.period) * (1.0 + 1e-12))
    titles = ("slider displacement, mm", "slider velocity, m/s", "slider acceleration, m/s²")
    loose = (1e3 * run.slider_position, run.slider_velocity, run.slider_acceleration)
    ideal = (1e3 * run.ideal_position, run.ideal_velocity, run.ideal_acceleration)
    return LooseCurves(
        360.0 * (run.times[last] - start) / run.period,
        {title: values[last] for title, values in zip(titles, loose, strict=True)},
        {title: values[last] for title, values in zip(titles, ideal, strict=True)},
        1e-3 * run.contact_force[last],
        1e3 * run.journal_x[last],
        1e3 * run.journal_y[last],
        run.in_contact[last],
    )


def clearance_figure(run: ClearanceRun) -> Figure:
    """Return slider motion and contact force over the last turn of a run, and the path of the journal."""
    curves = loose_curves(run)
    figure = new_figure(12.4, 7.6)
    joint, radial = run.clearance.joint, 1e3 * run.clearance.radius
    heading(
        figure,
        f"{shown(radial)} mm of radial clearance at the {joint}, {shown(run.mechanism.speed / _RPM)} rpm",
        f"turn {run.cycles} of the crank; solid: loose joint, dashed: ideal joints",
    )
    position, velocity, acceleration = (_panel(curves, title) for title in curves.curves)
    loose, ideal = position.lines
    off = np.abs(loose.y - ideal.y).max()
    share = 100.0 * off / (1e3 * float(run.linkage.stroke))
    note = f"off by {shown(float(off), 3)} mm at most, {shown(float(share), 2)} % of the stroke"
    greatest = f"greatest {shown(float(curves.force.max()))}"
    across, force = "crank angle in the direction of rotation, deg", Line("", curves.angles, curves.force, THIN)
    contact = Panel("contact force, kN", across, (force,), turns=True, note=greatest)
    for row, panel in enumerate((contact, acceleration, velocity, replace(position, note=note))):
        draw_panel(place(figure, 0.75, 0.55 + 1.62 * row, 6.7, 1.24), panel, across=row == 0)
    draw_panel(place(figure, 8.3, 2.65, 3.75, 3.75), _journal(curves, radial))
    if run.cycles > run.discard:
        for row, line in enumerate(_notes(summarise(run))):
            write(figure, 7.95, 1.8 - 0.2 * row, line)
    return figure


def speeds_figure(runs: Sequence[ClearanceRun]) -> Figure:
    """Return displacement, velocity and acceleration of the slider with a loose joint, a column for each run."""
    columns = []
    for run in runs:
        curves = loose_curves(run)
        first, *others = (_panel(curves, title) for title in curves.curves)
        columns.append([replace(first, note=f"{shown(run.mechanism.speed / _RPM)} rpm"), *others])
    clearance = runs[0].clearance
    title = f"{shown(1e3 * clearance.radius)} mm of radial clearance at the {clearance.joint}"
    panels = tuple(panel for row in zip(*columns, strict=True) for panel in row)
    subtitle = "solid: loose joint, dashed: ideal joints"
    return draw_sheet(Sheet(title, subtitle, panels, columns=len(runs), width=4.05, height=1.82, stacked=True))


def speed_runs(mechanism: Mechanism, linkage: Linkage, rpm: Sequence[float] = CASE_RPM) -> list[ClearanceRun]:
    """Return a run of three turns at each speed, in the direction in which the mechanism turns."""
    if mechanism.clearance is None:
        raise InputError("a comparison of speeds needs a loose joint; got ideal joints only; give a clearance")
    way = math.copysign(_RPM, mechanism.speed)
    return [
        simulate(replace(mechanism, speed=way * speed), linkage, mechanism.clearance, cycles=3, discard=1)
        for speed in rpm
    ]


def _panel(curves: LooseCurves, title: str) -> Panel:
    loose, ideal = curves.curves[title], curves.ideal[title]
    note = ""
    if "acceleration" in title:
        note = f"greatest {shown(float(np.abs(loose).max()), 3)}, ideal {shown(float(np.abs(ideal).max()), 3)}"
    lines = (Line("", curves.angles, loose, THIN), Line("", curves.angles, ideal, DASHED))
    return Panel(title, CRANK_ANGLE, lines, turns=True, note=note)


def _journal(curves: LooseCurves, radius: float) -> Panel:
    """Return the path of the journal's centre, dots where it touches the bearing, and the circle of free play."""
    turn, touching = np.linspace(0.0, 2.0 * math.pi, 361), curves.touching
    lines = (
        Line("", radius * np.cos(turn), radius * np.sin(turn), DASHED),
        Line("", curves.journal_x, curves.journal_y, THIN),
        Line("", curves.journal_x[touching], curves.journal_y[touching], DOTS),
    )
    across = "journal in its bearing, along the slider line, mm; upward: across it"
    return Panel("path of the journal's centre; dots: in contact", across, lines, equal=True)


def _notes(summary: ClearanceSummary) -> list[str]:
    """Return the summary in lines."""
    lines = [f"means over {summary.turns} turns, ± 99 % confidence:"]
    for title, estimate, factor, unit in (
        ("peak acceleration over the ideal one", summary.acceleration_ratio, 1.0, ""),
        ("impacts per turn", summary.impacts, 1.0, ""),
        ("time in contact", summary.contact_share, 100.0, " %"),
        ("peak contact force", summary.peak_contact_force, 1e-3, " kN"),
        ("lost in the joint per turn", summary.dissipated, 1.0, " J"),
    ):
        certain = "" if estimate.uncertainty is None else f" ± {shown(factor * estimate.uncertainty, 2)}"
        lines.append(f"{title}: {shown(factor * estimate.value, 3)}{certain}{unit}")
    return lines
