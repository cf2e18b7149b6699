"""The flywheel against the speed fluctuation, exact and classical, and the speed over a turn with and without it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ....model.errors import InputError
from ....model.linkage.linkage import Linkage
from ....model.machine.mechanism import Mechanism
from ....model.transient.flywheel import design_flywheel
from ....model.transient.steady import Runner, SteadyRunning
from ...figures.style import (
    BLUE,
    INK,
    MUTED,
    SMALL,
    TEXT,
    TITLE,
    VERMILION,
    dress,
    new_figure,
    place,
    save,
    shown,
    write,
)
from .numbers import FLUCTUATION

Array = NDArray[np.float64]
_RPM = 30.0 / np.pi
_SIZES = np.geomspace(0.25, 4.0, 33)


@dataclass(frozen=True)
class FlywheelCurves:
    """Data of the flywheel figure: flywheels, kg m^2, fluctuations, and speeds over a turn (crank angle, deg; rpm).

    Where a flywheel is too small for the machine to come through a turn, there is no point.
    """

    flywheel: Array
    fluctuation: Array
    classical: Array
    design: tuple[float, float]
    turns: tuple[tuple[str, Array, Array], ...]


def flywheel_data(mechanism: Mechanism, linkage: Linkage, *, fluctuation: float = FLUCTUATION) -> FlywheelCurves:
    """Return the data of the figure."""
    found, runner = design_flywheel(mechanism, linkage, fluctuation), Runner(mechanism, linkage)

    def run(flywheel: float) -> SteadyRunning | None:
        try:
            if mechanism.drive is None:
                return runner.constant(flywheel)
            return runner.under(replace(mechanism.drive, flywheel=flywheel))
        except InputError:
            return None

    sizes = _SIZES * (found.inertia or found.estimate)
    points = [(size, running.fluctuation) for size in sizes if (running := run(float(size)))]
    flywheels, fluctuations = np.array(points).reshape(-1, 2).T
    turns = [("with flywheel" if found.needed else "without flywheel", found.running)]
    small = run(0.5 * found.inertia) if found.needed else None
    if small is not None:
        turns.append(("with half of it", small))
    return FlywheelCurves(
        flywheels,
        fluctuations,
        found.estimate * fluctuation / flywheels,
        (found.inertia, found.running.fluctuation),
        tuple((name, *_over_angle(running)) for name, running in turns),
    )


def _over_angle(running: SteadyRunning) -> tuple[Array, Array]:
    angle = np.degrees(running.crank_angle) % 360.0
    order = np.argsort(angle, kind="stable")
    return angle[order], _RPM * running.speed[order]


def draw_flywheel(mechanism: Mechanism, linkage: Linkage, path: Path, *, fluctuation: float = FLUCTUATION) -> Path:
    """Write the figure as PNG; return the file."""
    data = flywheel_data(mechanism, linkage, fluctuation=fluctuation)
    figure = new_figure(9.6, 3.9)
    write(figure, 0.25, 3.58, "Flywheel and speed fluctuation", fontsize=TITLE, fontweight="bold")
    inertia, reached = data.design
    said = f"{shown(inertia)} kg m² for {shown(reached)}" if inertia else f"none needed for {shown(fluctuation)}"
    motor = "constant motor torque" if mechanism.drive is None else "the motor's own torque curve"
    write(figure, 0.25, 3.36, f"{said}; {motor}", color=MUTED)
    left, right = place(figure, 0.75, 0.6, 3.9, 2.35), place(figure, 5.45, 0.6, 3.9, 2.35)
    for axes in (left, right):
        dress(axes)
    left.plot(data.flywheel, data.fluctuation, color=BLUE, linewidth=1.7, label="exact", zorder=3)
    left.plot(data.flywheel, data.classical, color=MUTED, linewidth=1.1, linestyle="--", label="classical", zorder=2)
    if inertia:
        left.plot(inertia, reached, "o", markersize=6, markerfacecolor="white", markeredgecolor=VERMILION, zorder=4)
    left.set_xlim(0.0, float(data.flywheel.max()))
    left.set_ylim(0.0, 1.1 * float(data.fluctuation.max()))
    left.set_xlabel("flywheel on the crank shaft, kg m²", fontsize=TEXT)
    left.set_title("coefficient of speed fluctuation", loc="left", fontsize=SMALL, color=INK, pad=3)
    for (name, angle, speed), style in zip(data.turns, ("-", "--"), strict=False):
        right.plot(angle, speed, color=BLUE if style == "-" else MUTED, linestyle=style, linewidth=1.5, label=name)
    right.set_xlim(0, 360)
    right.set_xticks(range(0, 361, 45))
    right.set_xlabel("crank angle, deg", fontsize=TEXT)
    right.set_title("crank speed over a turn, rpm", loc="left", fontsize=SMALL, color=INK, pad=3)
    for axes in (left, right):
        axes.legend(
            loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=2, frameon=False, fontsize=SMALL, borderaxespad=0.0
        )
    save(figure, path)
    return path
