"""Flywheel required for a speed fluctuation, exact and by the classical estimate."""

from dataclasses import replace
from typing import Annotated

import numpy as np

from ....model.errors import InputError
from ....model.linkage.linkage import Linkage
from ....model.machine.mechanism import Mechanism
from ....model.transient.flywheel import design_flywheel
from ....model.transient.steady_running import Runner, SteadyRunning
from ....objectives.kinds import ANGULAR_SPEED, INERTIA
from ...figures.panel_figure import FAINT, Line, Panel, PanelFigure, crank_angle_panel
from ...render.blocks import Block, Table, Text, Value, column, sentence, value_from_record, words
from ...render.numerals import format_number
from ..record_types import Note, Record
from ..start_up.analysis import RPM, SteadyNumbers, sort_by_crank_angle, steady_numbers
from . import FLUCTUATION

Bare = Annotated[float | None, Note("null where no steady running was found without a flywheel")]


class Flywheel(Record):
    """Flywheel for one coefficient of speed fluctuation, exact and by the classical estimate, and for others."""

    motor: str
    """Type of drive, or "constant torque" for a job without a drive."""
    wanted_fluctuation: float
    flywheel_kgm2: float
    classical_estimate_kgm2: float
    fluctuation_without_flywheel: Bare
    least_speed_without_flywheel_rpm: Bare
    reason_without_flywheel: Annotated[str | None, Note("null where steady running was found without it")]
    steady: SteadyNumbers
    """With the flywheel."""
    fluctuations: list[float]
    flywheels_kgm2: list[float]
    """Values for each coefficient of fluctuation."""
    classical_estimates_kgm2: list[float]


_TRIED = (0.2, 0.1, 0.05, 0.02, 0.01, 0.005)
_SIZES = np.geomspace(0.25, 4.0, 33)


def numbers(mechanism: Mechanism, linkage: Linkage, *, fluctuation: float = FLUCTUATION.default) -> Flywheel:
    """Return the flywheels for one coefficient of speed fluctuation and for others, ready for JSON."""
    chosen = design_flywheel(mechanism, linkage, fluctuation)
    tried = [chosen if limit == fluctuation else design_flywheel(mechanism, linkage, limit) for limit in _TRIED]
    bare, reason = _fluctuation_without_flywheel(mechanism, linkage)
    return {
        "motor": "constant torque" if mechanism.drive is None else type(mechanism.drive.motor).__name__,
        "wanted_fluctuation": fluctuation,
        "flywheel_kgm2": chosen.inertia,
        "classical_estimate_kgm2": chosen.estimate,
        "fluctuation_without_flywheel": None if bare is None else bare[0],
        "least_speed_without_flywheel_rpm": None if bare is None else RPM * bare[1],
        "reason_without_flywheel": reason,
        "steady": steady_numbers(chosen.running),
        "fluctuations": list(_TRIED),
        "flywheels_kgm2": [design.inertia for design in tried],
        "classical_estimates_kgm2": [design.estimate for design in tried],
    }


def _fluctuation_without_flywheel(
    mechanism: Mechanism, linkage: Linkage
) -> tuple[tuple[float, float] | None, str | None]:
    """Return fluctuation and minimum speed, rad/s, without a flywheel, or the reason why they are undefined."""
    runner, drive = Runner(mechanism, linkage), mechanism.drive
    try:
        if drive is None:
            least, greatest = runner.least_and_greatest_speed(0.0)
            return ((greatest - least) / runner.speed, least), None
        running = runner.run_under_drive(replace(drive, flywheel=0.0))
        return (running.fluctuation, float(abs(running.speed).min())), None
    except InputError as error:
        return None, str(error)


def blocks(numbers: Flywheel) -> list[Block]:
    """Return the answer in human-readable form."""
    inertia, steady = numbers["flywheel_kgm2"], numbers["steady"]
    purpose = f"for a speed fluctuation of {numbers['wanted_fluctuation']:g}"
    needed = sentence(
        f"No flywheel is needed {purpose}: without one {{without}}.", without=_without_flywheel_text(numbers)
    )
    if inertia:
        needed = sentence(
            f"Flywheel on the crank shaft {purpose}: {{inertia}} (classical estimate {{estimate}}); "
            "without one {without}.",
            inertia=Value(inertia, INERTIA, 5),
            estimate=Value(numbers["classical_estimate_kgm2"], INERTIA, 5),
            without=_without_flywheel_text(numbers),
        )
    return [
        needed,
        sentence("Fluctuation: (greatest - least speed) / mean speed; mean speed: a turn over its time."),
        sentence(
            "{so}: mean speed {speed}, motor torque up to {torque} at the crank, mean power {power}.",
            so="With the flywheel" if inertia else "So",
            speed=value_from_record(steady, "mean_speed_rpm", digits=5),
            torque=value_from_record(steady, "peak_motor_torque_Nm", digits=4),
            power=value_from_record(steady, "mean_power_W", digits=4),
        ),
        Table(
            (column("fluctuation"), column("flywheel", INERTIA), column("classical", INERTIA)),
            tuple(
                (Value(tried, digits=4), Value(exact, INERTIA, 4), Value(classical, INERTIA, 4))
                for tried, exact, classical in zip(
                    numbers["fluctuations"],
                    numbers["flywheels_kgm2"],
                    numbers["classical_estimates_kgm2"],
                    strict=True,
                )
            ),
        ),
    ]


def _without_flywheel_text(numbers: Flywheel) -> Text:
    """Return a sentence on operation without a flywheel."""
    bare = numbers["fluctuation_without_flywheel"]
    if bare is None:
        return f"steady running was not reached: {numbers['reason_without_flywheel']}"
    slowest = value_from_record(numbers, "least_speed_without_flywheel_rpm", digits=4)
    if slowest.number:
        return words(f"it is {bare:.4g} (least speed {{slowest}})", slowest=slowest)
    return f"it is {bare:.4g}: the crank nearly stops, at less than a millionth of its maximum speed"


def figure(mechanism: Mechanism, linkage: Linkage, *, fluctuation: float = FLUCTUATION.default) -> PanelFigure:
    """Return the fluctuation over flywheel inertia, exact and classical, and the speed over a cycle with two flywheels.

    Curves have no points where the flywheel is too small for the machine to complete a revolution.
    """
    design, runner = design_flywheel(mechanism, linkage, fluctuation), Runner(mechanism, linkage)

    def run(flywheel: float) -> SteadyRunning | None:
        try:
            if mechanism.drive is None:
                return runner.run_under_constant_torque(flywheel)
            return runner.run_under_drive(replace(mechanism.drive, flywheel=flywheel))
        except InputError:
            return None

    sizes = _SIZES * (design.inertia or design.estimate)
    points = [(size, running.fluctuation) for size in sizes if (running := run(float(size)))]
    flywheels, fluctuations = np.array(points).reshape(-1, 2).T
    lines = [Line("exact", flywheels, fluctuations)]
    lines.append(Line("classical", flywheels, design.estimate * fluctuation / flywheels, FAINT))
    if design.inertia:
        chosen = np.array([design.inertia]), np.array([design.running.fluctuation])
        lines.append(Line("", *chosen, points=True))
    turns = [("with flywheel" if design.is_needed else "without flywheel", design.running, 0)]
    small = run(0.5 * design.inertia) if design.is_needed else None
    if small is not None:
        turns.append(("with half the inertia", small, FAINT))
    speeds = []
    for name, running, style in turns:
        angle, (speed,) = sort_by_crank_angle(running, running.speed)
        speeds.append(Line(name, angle, speed, style))
    reached = format_number(design.running.fluctuation)
    size: Text = f"none needed for {format_number(fluctuation)}"
    if design.inertia:
        size = words(f"{{inertia}} for {reached}", inertia=Value(design.inertia, INERTIA, 4))
    motor = "constant motor torque" if mechanism.drive is None else "the motor's own torque curve"
    panels = (
        Panel("coefficient of speed fluctuation", "flywheel on the crank shaft", tuple(lines), x_kind=INERTIA),
        crank_angle_panel("crank speed over a turn", *speeds, kind=ANGULAR_SPEED),
    )
    title = "Flywheel and speed fluctuation"
    return PanelFigure(
        title, words("{size}; {motor}", size=size, motor=motor), panels, columns=2, width=4.9, height=3.2
    )
