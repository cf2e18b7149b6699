"""A machine that starts from rest: speed and torque over time, and over a turn of steady running."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from ....model.linkage.linkage import Linkage
from ....model.machine.mechanism import Mechanism
from ...figures.style import (
    BLUE,
    FRAME,
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
from .numbers import start

Array = NDArray[np.float64]
_RPM = 30.0 / np.pi


@dataclass(frozen=True)
class StartUp:
    """Data of the start-up figure: times, s; crank angles, deg; speeds, rpm; torques on the crank, N m.

    motor: of the motor. taken: into the mechanism. The turn's arrays are empty without steady running.
    """

    time: Array
    speed: Array
    motor: Array
    taken: Array
    turn_angle: Array
    turn_speed: Array
    turn_motor: Array
    turn_taken: Array
    message: str
    fluctuation: float | None


def start_up_data(mechanism: Mechanism, linkage: Linkage, **options: Any) -> StartUp:
    """Return the data of the figure. options: those of `simulate`."""
    run, running, reason = start(mechanism, linkage, **options)
    angle, speed, motor, taken = (np.zeros(0) for _ in range(4))
    if running is not None:
        angle = np.degrees(running.crank_angle) % 360.0
        order = np.argsort(angle, kind="stable")
        columns = (angle, _RPM * running.speed, running.motor_torque, running.torque)
        angle, speed, motor, taken = (column[order] for column in columns)
    return StartUp(
        time=run.time,
        speed=_RPM * run.speed,
        motor=run.motor_torque,
        taken=run.torque,
        turn_angle=angle,
        turn_speed=speed,
        turn_motor=motor,
        turn_taken=taken,
        message=run.message if not reason else f"{run.message}; no steady running",
        fluctuation=None if running is None else running.fluctuation,
    )


def draw_start_up(mechanism: Mechanism, linkage: Linkage, path: Path, **options: Any) -> Path:
    """Write the figure as PNG; return the file. Raises `InputError` if the mechanism has no drive."""
    data = start_up_data(mechanism, linkage, **options)
    figure = new_figure(9.6, 5.6)
    write(figure, 0.25, 5.25, "Start from rest", fontsize=TITLE, fontweight="bold")
    write(figure, 0.25, 5.03, data.message, color=MUTED)
    steady = len(data.turn_angle) > 0
    width = 5.0 if steady else 8.7
    speed, torque = place(figure, 0.65, 2.85, width, 1.75), place(figure, 0.65, 0.55, width, 1.75)
    _curves(speed, data.time, [(data.speed, "")], "crank speed, rpm")
    _curves(
        torque, data.time, [(data.motor, "motor"), (data.taken, "mechanism")], "torque on the crank, N m", legend=True
    )
    torque.set_xlabel("time, s", fontsize=TEXT)
    if steady:
        left, size = 6.4, 2.95
        speed, torque = place(figure, left, 2.85, size, 1.75), place(figure, left, 0.55, size, 1.75)
        assert data.fluctuation is not None
        _curves(speed, data.turn_angle, [(data.turn_speed, "")], "speed in steady running, rpm")
        speed.set_title(
            f"fluctuation {shown(data.fluctuation, 3)}", loc="right", fontsize=SMALL, color=VERMILION, pad=3
        )
        pair = [(data.turn_motor, "motor"), (data.turn_taken, "mechanism")]
        _curves(torque, data.turn_angle, pair, "torque in steady running, N m")
        torque.set_xlabel("crank angle, deg", fontsize=TEXT)
        for axes in (speed, torque):
            axes.set_xlim(0, 360)
            axes.set_xticks(range(0, 361, 90))
    save(figure, path)
    return path


def _curves(axes: Axes, x: Array, curves: list[tuple[Array, str]], title: str, *, legend: bool = False) -> None:
    dress(axes, across=6)
    values = np.concatenate([y for y, _ in curves])
    low, high = float(values.min()), float(values.max())
    if low < 0.0 < high:
        axes.axhline(0.0, color=FRAME, linewidth=0.8, zorder=1)
    # The mechanism's torque swings within the motor's: thin and grey behind it.
    looks = [{"color": BLUE, "linewidth": 1.7, "zorder": 3}, {"color": MUTED, "linewidth": 0.8, "zorder": 2}]
    for (y, label), look in zip(curves, looks, strict=False):
        axes.plot(x, y, label=label, linestyle="--" if label == "mechanism" else "-", **look)  # type: ignore[arg-type]
    if x[-1] > x[0]:
        axes.set_xlim(float(x[0]), float(x[-1]))
    axes.set_ylim(limits(low, high))
    axes.set_title(title, loc="left", fontsize=SMALL, color=INK, pad=3)
    if legend:
        axes.legend(
            loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=2, frameon=False, fontsize=SMALL, borderaxespad=0.0
        )
