"""Figures of a loose joint: motion against the ideal one, path of the journal, several speeds side by side."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle
from numpy.typing import NDArray

from ....model.clearance.run import ClearanceRun, simulate
from ....model.clearance.statistics import ClearanceSummary, summarise
from ....model.errors import InputError
from ....model.linkage.linkage import Linkage
from ....model.machine.mechanism import Mechanism
from ...figures.style import (
    BLUE,
    INK,
    MUTED,
    SMALL,
    TEXT,
    TITLE,
    VERMILION,
    dress,
    limits,
    new_figure,
    place,
    save,
    shown,
    write,
)
from .numbers import simulated

Array = NDArray[np.float64]

CASE_RPM = (30.0, 300.0, 400.0)
"""Speeds of the published case: ME748, "Offset-Slider Crank Mechanism", section 2.3, with the nominal one between."""
_RPM = 2.0 * math.pi / 60.0
_LOOSE: dict[str, Any] = {"color": BLUE, "linewidth": 1.0, "zorder": 2}
_IDEAL: dict[str, Any] = {"color": INK, "linewidth": 1.1, "linestyle": (0, (4, 2)), "zorder": 3}


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


def draw_clearance(mechanism: Mechanism, linkage: Linkage, path: Path, *, run: ClearanceRun | None = None) -> Path:
    """Write the last turn of a simulation as PNG: slider and contact force over crank angle, path of the journal.

    run: one that was done before; else it is done now. Raises as `numbers.simulated` does.
    """
    run = run or simulated(mechanism, linkage)
    curves = loose_curves(run)
    figure = new_figure(12.4, 7.6)
    joint, radial = run.clearance.joint, shown(1e3 * run.clearance.radius)
    rpm = shown(run.mechanism.speed / _RPM)
    write(figure, 0.3, 7.3, f"{radial} mm of radial clearance at the {joint}, {rpm} rpm", fontsize=TITLE, weight="bold")
    text = f"turn {run.cycles} of the crank; solid: loose joint, dashed: ideal joints"
    write(figure, 0.3, 7.08, text, color=MUTED)
    panels = [place(figure, 0.75, 0.55 + 1.62 * row, 6.7, 1.24) for row in (3, 2, 1, 0)]
    for axes, title in zip(panels[:3], curves.curves, strict=True):
        _curve(axes, curves, title)
    panels[3].plot(curves.angles, curves.force, **_LOOSE)
    _head(panels[3], "contact force, kN", f"greatest {shown(float(curves.force.max()))}")
    panels[3].set_ylim(limits(0.0, float(curves.force.max())))
    for axes in panels:
        _over_angle(axes)
        axes.tick_params(labelbottom=axes is panels[-1])
    panels[-1].set_xlabel("crank angle in the direction of rotation, deg", fontsize=TEXT)
    off = np.abs(curves.curves["slider displacement, mm"] - curves.ideal["slider displacement, mm"]).max()
    share = 100.0 * off / (1e3 * float(run.linkage.stroke))
    _head(panels[0], "", f"off by {shown(float(off), 3)} mm at most, {shown(float(share), 2)} % of the stroke")
    _journal(place(figure, 8.3, 2.65, 3.75, 3.75), curves, 1e3 * run.clearance.radius)
    if run.cycles > run.discard:
        for row, line in enumerate(_notes(summarise(run))):
            write(figure, 7.95, 1.8 - 0.2 * row, line, color=INK)
    save(figure, path)
    return path


def draw_clearance_speeds(
    mechanism: Mechanism,
    linkage: Linkage,
    path: Path,
    *,
    rpm: Sequence[float] = CASE_RPM,
    runs: Sequence[ClearanceRun] | None = None,
) -> Path:
    """Write displacement, velocity and acceleration of the slider with a loose joint at several speeds as PNG.

    runs: one for each speed, done before; else three turns each are done now, of which the last is drawn.
    """
    runs = speed_runs(mechanism, linkage, rpm) if runs is None else runs
    width = 4.05
    figure = new_figure(0.35 + width * len(runs), 6.6)
    clearance = runs[0].clearance
    title = f"{shown(1e3 * clearance.radius)} mm of radial clearance at the {clearance.joint}"
    write(figure, 0.3, 6.3, title, fontsize=TITLE, weight="bold")
    write(figure, 0.3, 6.08, "solid: loose joint, dashed: ideal joints", color=MUTED)
    for column, run in enumerate(runs):
        curves = loose_curves(run)
        left = 0.75 + width * column
        write(figure, left, 5.72, f"{shown(run.mechanism.speed / _RPM)} rpm", weight="bold")
        for row, name in enumerate(curves.curves):
            axes = place(figure, left, 4.2 - 1.82 * row, width - 0.7, 1.25)
            _curve(axes, curves, name)
            _over_angle(axes)
            axes.tick_params(labelbottom=row == 2)
        axes.set_xlabel("crank angle, deg", fontsize=TEXT)
    save(figure, path)
    return path


def speed_runs(mechanism: Mechanism, linkage: Linkage, rpm: Sequence[float] = CASE_RPM) -> list[ClearanceRun]:
    """Return a run of three turns at each speed, in the direction in which the mechanism turns."""
    if mechanism.clearance is None:
        raise InputError("a comparison of speeds needs a loose joint; got ideal joints only; give a clearance")
    way = math.copysign(_RPM, mechanism.speed)
    return [
        simulate(replace(mechanism, speed=way * speed), linkage, mechanism.clearance, cycles=3, discard=1)
        for speed in rpm
    ]


def _curve(axes: Axes, curves: LooseCurves, title: str) -> None:
    loose, ideal = curves.curves[title], curves.ideal[title]
    axes.plot(curves.angles, loose, **_LOOSE)
    axes.plot(curves.angles, ideal, **_IDEAL)
    axes.set_ylim(limits(float(min(loose.min(), ideal.min())), float(max(loose.max(), ideal.max()))))
    note = ""
    if "acceleration" in title:
        note = f"greatest {shown(float(np.abs(loose).max()), 3)}, ideal {shown(float(np.abs(ideal).max()), 3)}"
    _head(axes, title, note)


def _over_angle(axes: Axes) -> None:
    dress(axes, up=5)
    axes.set_xlim(0.0, 360.0)
    axes.set_xticks(range(0, 361, 90))


def _head(axes: Axes, title: str, note: str = "") -> None:
    style: dict[str, Any] = {"transform": axes.transAxes, "va": "bottom", "fontsize": SMALL}
    axes.text(0.0, 1.03, title, ha="left", color=INK, **style)
    axes.text(1.0, 1.03, note, ha="right", color=MUTED, **style)


def _journal(axes: Axes, curves: LooseCurves, radius: float) -> None:
    """Draw the path of the journal's centre, dots where it touches the bearing, and the circle of free play."""
    dress(axes)
    axes.add_patch(Circle((0.0, 0.0), radius, fill=False, **(_IDEAL | {"zorder": 1})))
    axes.plot(curves.journal_x, curves.journal_y, color=BLUE, linewidth=0.7, zorder=2)
    touching = curves.touching
    axes.plot(
        curves.journal_x[touching],
        curves.journal_y[touching],
        linestyle="none",
        marker="o",
        markersize=2.2,
        color=VERMILION,
        zorder=3,
    )
    axes.set_aspect("equal")
    axes.set_xlim(-1.15 * radius, 1.15 * radius)
    axes.set_ylim(-1.15 * radius, 1.15 * radius)
    axes.set_xlabel("journal in its bearing, along the slider line, mm", fontsize=TEXT)
    axes.set_ylabel("across it, mm", fontsize=TEXT)
    _head(axes, "path of the journal's centre; dots: in contact")


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
