"""The flywheel that a machine needs, in numbers."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from ...model.errors import InputError
from .start_up import steady_numbers

if TYPE_CHECKING:
    from rich.console import Console

    from ...model.linkage.linkage import Linkage
    from ...model.machine.mechanism import Mechanism

FLUCTUATION = 0.02
"""Wanted unless asked otherwise: pumps and machine tools (1/30 to 1/50 in textbooks)."""
_RPM = 30.0 / math.pi
_TRIED = (0.2, 0.1, 0.05, 0.02, 0.01, 0.005)


def numbers(mechanism: Mechanism, linkage: Linkage, *, fluctuation: float = FLUCTUATION) -> dict[str, Any]:
    """Return the flywheel for a coefficient of speed fluctuation, and those for others, ready for JSON."""
    from ...model.transient.flywheel import design_flywheel

    found = design_flywheel(mechanism, linkage, fluctuation)
    table = [design_flywheel(mechanism, linkage, wanted) for wanted in _TRIED]
    bare = _without(mechanism, linkage)
    return {
        "motor": "constant torque" if mechanism.drive is None else type(mechanism.drive.motor).__name__,
        "wanted_fluctuation": fluctuation,
        "flywheel_kgm2": found.inertia,
        "classical_estimate_kgm2": found.estimate,
        "fluctuation_without_flywheel": None if bare is None else bare[0],
        "least_speed_without_flywheel_rpm": None if bare is None else _RPM * bare[1],
        "steady": steady_numbers(found.running),
        "fluctuations": list(_TRIED),
        "flywheels_kgm2": [design.inertia for design in table],
        "classical_estimates_kgm2": [design.estimate for design in table],
    }


def _without(mechanism: Mechanism, linkage: Linkage) -> tuple[float, float] | None:
    """Return fluctuation and least speed, rad/s, of the machine without a flywheel; None if no running is found."""
    from dataclasses import replace

    from ...model.transient.steady import Runner

    runner, drive = Runner(mechanism, linkage), mechanism.drive
    try:
        if drive is None:
            least, greatest = runner.speeds(0.0)
            return (greatest - least) / runner.speed, least
        running = runner.under(replace(drive, flywheel=0.0))
        return running.fluctuation, float(abs(running.speed).min())
    except InputError:
        return None


def show(console: Console, numbers: dict[str, Any]) -> None:
    """Write the numbers as a sentence and a short table."""
    from rich.table import Table

    wanted, inertia = numbers["wanted_fluctuation"], numbers["flywheel_kgm2"]
    bare, steady = numbers["fluctuation_without_flywheel"], numbers["steady"]
    slowest = numbers["least_speed_without_flywheel_rpm"]
    if bare is None:
        without = "no steady running was found"
    elif slowest:
        without = f"it is {bare:.4g} (least speed {slowest:.4g} rpm)"
    else:
        without = f"it is {bare:.4g}: the crank all but stops, below a millionth of its greatest speed"
    console.print(
        f"Flywheel on the crank shaft for a speed fluctuation of {wanted:g}: {inertia:.5g} kg m² "
        f"(classical estimate {numbers['classical_estimate_kgm2']:.5g}); without one {without}."
        if inertia
        else f"No flywheel is needed for a speed fluctuation of {wanted:g}: without one {without}.",
        soft_wrap=True,
    )
    console.print(
        "Fluctuation: (greatest - least speed) / mean speed; mean speed: a turn over its time.", soft_wrap=True
    )
    console.print(
        f"{'With it' if inertia else 'So'}: mean speed {steady['mean_speed_rpm']:.5g} rpm, motor torque up to "
        f"{steady['peak_motor_torque_Nm']:.4g} N m on the crank, mean power {steady['mean_power_W']:.4g} W.",
        soft_wrap=True,
    )
    table = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0))
    for title in ("fluctuation", "flywheel, kg m²", "classical, kg m²"):
        table.add_column(title, justify="right")
    for row in zip(
        numbers["fluctuations"], numbers["flywheels_kgm2"], numbers["classical_estimates_kgm2"], strict=True
    ):
        table.add_row(*(f"{value:.4g}" for value in row))
    console.print(table)
