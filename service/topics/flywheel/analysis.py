"""The flywheel that a machine needs for a speed fluctuation, exact and by the classical estimate."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from rich.console import Console

from ....model.errors import InputError
from ....model.linkage.linkage import Linkage
from ....model.machine.mechanism import Mechanism
from ....model.transient.flywheel import design_flywheel
from ....model.transient.steady import Runner, SteadyRunning
from ...figures.numerals import shown
from ...figures.sheets import FAINT, Line, Panel, Sheet, over_turn
from ...text.tables import table
from ..start_up.analysis import RPM, in_order, steady_numbers

FLUCTUATION = 0.02
"""Wanted unless asked otherwise: pumps and machine tools (1/30 to 1/50 in textbooks)."""
_TRIED = (0.2, 0.1, 0.05, 0.02, 0.01, 0.005)
_SIZES = np.geomspace(0.25, 4.0, 33)


def numbers(mechanism: Mechanism, linkage: Linkage, *, fluctuation: float = FLUCTUATION) -> dict[str, Any]:
    """Return the flywheel for a coefficient of speed fluctuation, and those for others, ready for JSON."""
    found = design_flywheel(mechanism, linkage, fluctuation)
    tried = [found if wanted == fluctuation else design_flywheel(mechanism, linkage, wanted) for wanted in _TRIED]
    bare, reason = _without(mechanism, linkage)
    return {
        "motor": "constant torque" if mechanism.drive is None else type(mechanism.drive.motor).__name__,
        "wanted_fluctuation": fluctuation,
        "flywheel_kgm2": found.inertia,
        "classical_estimate_kgm2": found.estimate,
        "fluctuation_without_flywheel": None if bare is None else bare[0],
        "least_speed_without_flywheel_rpm": None if bare is None else RPM * bare[1],
        "reason_without_flywheel": reason,
        "steady": steady_numbers(found.running),
        "fluctuations": list(_TRIED),
        "flywheels_kgm2": [design.inertia for design in tried],
        "classical_estimates_kgm2": [design.estimate for design in tried],
    }


def _without(mechanism: Mechanism, linkage: Linkage) -> tuple[tuple[float, float] | None, str | None]:
    """Return fluctuation and least speed, rad/s, without a flywheel, or the reason why there are none."""
    runner, drive = Runner(mechanism, linkage), mechanism.drive
    try:
        if drive is None:
            least, greatest = runner.speeds(0.0)
            return ((greatest - least) / runner.speed, least), None
        running = runner.under(replace(drive, flywheel=0.0))
        return (running.fluctuation, float(abs(running.speed).min())), None
    except InputError as error:
        return None, str(error)


def show(console: Console, numbers: dict[str, Any]) -> None:
    """Write the numbers as a sentence and a short table."""
    wanted, inertia = numbers["wanted_fluctuation"], numbers["flywheel_kgm2"]
    bare, steady = numbers["fluctuation_without_flywheel"], numbers["steady"]
    slowest = numbers["least_speed_without_flywheel_rpm"]
    if bare is None:
        without = f"no steady running was found: {numbers['reason_without_flywheel']}"
    elif slowest:
        without = f"it is {bare:.4g} (least speed {slowest:.4g} rpm)"
    else:
        without = f"it is {bare:.4g}: the crank all but stops, below a millionth of its greatest speed"
    for sentence in (
        f"Flywheel on the crank shaft for a speed fluctuation of {wanted:g}: {inertia:.5g} kg m² "
        f"(classical estimate {numbers['classical_estimate_kgm2']:.5g} kg m²); without one {without}."
        if inertia
        else f"No flywheel is needed for a speed fluctuation of {wanted:g}: without one {without}.",
        "Fluctuation: (greatest - least speed) / mean speed; mean speed: a turn over its time.",
        f"{'With it' if inertia else 'So'}: mean speed {steady['mean_speed_rpm']:.5g} rpm, motor torque up to "
        f"{steady['peak_motor_torque_Nm']:.4g} N m on the crank, mean power {steady['mean_power_W']:.4g} W.",
    ):
        console.print(sentence, soft_wrap=True)
    rows = table(">fluctuation", ">flywheel, kg m²", ">classical, kg m²")
    keys = ("fluctuations", "flywheels_kgm2", "classical_estimates_kgm2")
    for row in zip(*(numbers[key] for key in keys), strict=True):
        rows.add_row(*(f"{value:.4g}" for value in row))
    console.print(rows)


def figure(mechanism: Mechanism, linkage: Linkage, *, fluctuation: float = FLUCTUATION) -> Sheet:
    """Return the fluctuation over the flywheel, exact and classical, and the speed over a turn with two flywheels.

    Where a flywheel is too small for the machine to come through a turn, there is no point.
    """
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
    lines = [Line("exact", flywheels, fluctuations)]
    lines.append(Line("classical", flywheels, found.estimate * fluctuation / flywheels, FAINT))
    if found.inertia:
        chosen = np.array([found.inertia]), np.array([found.running.fluctuation])
        lines.append(Line("", *chosen, points=True))
    turns = [("with flywheel" if found.needed else "without flywheel", found.running, 0)]
    small = run(0.5 * found.inertia) if found.needed else None
    if small is not None:
        turns.append(("with half of it", small, FAINT))
    speeds = []
    for name, running, style in turns:
        angle, (speed,) = in_order(running, RPM * running.speed)
        speeds.append(Line(name, angle, speed, style))
    reached = shown(found.running.fluctuation)
    said = f"{shown(found.inertia)} kg m² for {reached}" if found.inertia else f"none needed for {shown(fluctuation)}"
    motor = "constant motor torque" if mechanism.drive is None else "the motor's own torque curve"
    panels = (
        Panel("coefficient of speed fluctuation", "flywheel on the crank shaft, kg m²", tuple(lines)),
        over_turn("crank speed over a turn, rpm", *speeds),
    )
    title = "Flywheel and speed fluctuation"
    return Sheet(title, f"{said}; {motor}", panels, columns=2, width=4.9, height=3.2)
