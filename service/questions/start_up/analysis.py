"""Start of a machine from rest under its motor to steady running."""

from collections.abc import Callable
from typing import Annotated, Any

import numpy as np

from ....model.errors import InputError
from ....model.linkage.linkage import Linkage
from ....model.machine.mechanism import Mechanism
from ....model.transient.forward_dynamics import State, simulate
from ....model.transient.simulated_motion import Transient, Verdict
from ....model.transient.steady_running import SteadyRunning, steady_running
from ....objectives.kinds import ANGULAR_SPEED, TIME, TORQUE
from ...figures.panel_figure import FAINT, Line, Panel, PanelFigure, crank_angle_panel
from ...render.blocks import Block, Table, Unit, column, sentence, value_from_record
from ...render.numerals import format_number
from ..record_types import Note, Record


class SteadyNumbers(Record):
    """Steady running, with identical cycles; means are over time."""

    mean_speed_rpm: float
    least_speed_rpm: float
    greatest_speed_rpm: float
    fluctuation: float
    """Maximum minus minimum speed, relative to the mean."""
    period_s: float
    peak_motor_torque_Nm: float
    """On the crank."""
    peak_torque_Nm: float
    """Into the mechanism."""
    mean_power_W: float


class Start(Record):
    """Start from rest at the inner dead centre, and the steady running that it reaches."""

    verdict: Verdict
    message: str
    time_s: float
    turns: float
    final_speed_rpm: float
    peak_motor_torque_Nm: float
    """On the crank."""
    peak_torque_Nm: float
    """Into the mechanism."""
    peak_power_W: float
    turned_back_s: list[float]
    """Times at which the crank reversed."""
    motor_work_J: float
    load_work_J: float
    friction_work_J: float
    kinetic_energy_gained_J: float
    potential_energy_gained_J: float
    energy_imbalance: float
    """Relative error of the energy balance."""
    steady: Annotated[SteadyNumbers | None, Note("null where there is no steady running")]
    why_not_steady: Annotated[str | None, Note("null where there is steady running")]


LONGEST = 60.0
"""s; a longer start is simulated to its end only on request"""
TURNS = 300
STEADY = 1e-4
"""Relative change in speed from one revolution to the next that still counts as steady."""
RPM = ANGULAR_SPEED.metric.factor


def simulate_start(
    mechanism: Mechanism, linkage: Linkage, **options: Any
) -> tuple[Transient, SteadyRunning | None, str]:
    """Return the start from rest at the inner dead centre, and steady running or the reason why there is none.

    options: those of `simulate`. Raises `InputError` if the mechanism has no drive.
    """
    angle = float(Linkage(linkage.crank, linkage.rod, linkage.offset, mechanism.branch).dead_centre_angles[0])
    usual: dict[str, Any] = {"duration": LONGEST, "turns": TURNS, "steady": STEADY, "tolerance": 1e-10}
    run = simulate(mechanism, linkage, **(usual | {"start": State(angle=angle)} | options))
    try:
        return run, steady_running(mechanism, linkage), ""
    except InputError as error:
        return run, None, str(error)


def compute_shared_options(
    mechanism: Mechanism, linkage: Linkage, cancelled: Callable[[], bool], **_: Any
) -> dict[str, Any]:
    """Return the option that cancels a simulation."""
    return {"cancelled": cancelled}


def numbers(mechanism: Mechanism, linkage: Linkage, **options: Any) -> Start:
    """Return the start from rest and the steady running, ready for JSON. options: options of `simulate`."""
    run, running, reason = simulate_start(mechanism, linkage, **options)
    return {
        "verdict": run.verdict,
        "message": run.message,
        "time_s": float(run.time[-1]),
        "turns": run.turns,
        "final_speed_rpm": RPM * float(run.speed[-1]),
        "peak_motor_torque_Nm": float(abs(run.motor_torque).max()),
        "peak_torque_Nm": float(abs(run.torque).max()),
        "peak_power_W": float(abs(run.power).max()),
        "turned_back_s": list(run.turned_back),
        "motor_work_J": float(run.motor_work[-1]),
        "load_work_J": float(run.load_work[-1]),
        "friction_work_J": float(run.friction_work[-1]),
        "kinetic_energy_gained_J": float(run.kinetic[-1] - run.kinetic[0]),
        "potential_energy_gained_J": float(run.potential[-1] - run.potential[0]),
        "energy_imbalance": run.energy_balance_error,
        "steady": None if running is None else steady_numbers(running),
        "why_not_steady": reason or None,
    }


def steady_numbers(running: SteadyRunning) -> SteadyNumbers:
    """Return the numbers of steady running: speeds, fluctuation, period, torques and mean power."""
    return {
        "mean_speed_rpm": RPM * running.mean_speed,
        "least_speed_rpm": RPM * float(abs(running.speed).min()),
        "greatest_speed_rpm": RPM * float(abs(running.speed).max()),
        "fluctuation": running.fluctuation,
        "period_s": running.period,
        "peak_motor_torque_Nm": float(abs(running.motor_torque).max()),
        "peak_torque_Nm": float(abs(running.torque).max()),
        "mean_power_W": running.work / running.period,
    }


def blocks(numbers: Start) -> list[Block]:
    """Return the answer in human-readable form."""
    titles = {
        "final_speed_rpm": "speed reached",
        "peak_motor_torque_Nm": "peak motor torque at the crank",
        "peak_torque_Nm": "peak torque into the mechanism",
        "peak_power_W": "peak motor power",
        "motor_work_J": "work of the motor",
        "load_work_J": "work done on the loads",
        "friction_work_J": "friction heat",
        "kinetic_energy_gained_J": "kinetic energy gained",
        "energy_imbalance": "energy balance error",
    }
    steady_titles = {
        "mean_speed_rpm": "steady running: time-averaged speed",
        "fluctuation": "coefficient of speed fluctuation",
        "peak_motor_torque_Nm": "peak motor torque",
        "mean_power_W": "mean motor power over time",
    }
    steady = numbers["steady"]
    lines = [
        (title, value_from_record(numbers, key, digits=4))
        for key, title in titles.items()
        if key != "friction_work_J" or numbers["friction_work_J"]
    ]
    if steady is not None:
        lines += [(title, value_from_record(steady, key, digits=4)) for key, title in steady_titles.items()]
    rows = tuple((title, value, Unit(value.kind)) for title, value in lines)
    result_blocks: list[Block] = [
        sentence("Start from rest: {message}.", message=numbers["message"]),
        Table((column(left=True), column(), column(left=True)), rows),
    ]
    if steady is None:
        result_blocks.append(sentence("No steady running: {reason}.", reason=numbers["why_not_steady"] or ""))
    return result_blocks


def figure(mechanism: Mechanism, linkage: Linkage, **options: Any) -> PanelFigure:
    """Return plots of speed and torque against time, and over a cycle of steady running if there is any.

    options: those of `simulate`. Raises `InputError` if the mechanism has no drive.
    """
    run, running, reason = simulate_start(mechanism, linkage, **options)
    message = run.message if not reason else f"{run.message}; no steady running"
    speed = Panel("crank speed", "time", (Line("", run.time, run.speed),), kind=ANGULAR_SPEED, x_kind=TIME)
    torques = (Line("motor", run.time, run.motor_torque), Line("mechanism", run.time, run.torque, FAINT))
    torque = Panel("torque on the crank", "time", torques, kind=TORQUE, x_kind=TIME)
    if running is None:
        return PanelFigure("Start from rest", message, (speed, torque), width=9.6, height=2.3, stacked=True)
    angle, (speeds, motor, mechanism_torque) = sort_by_crank_angle(
        running, running.speed, running.motor_torque, running.torque
    )
    note = f"fluctuation {format_number(running.fluctuation, 3)}"
    turning = crank_angle_panel("speed in steady running", Line("", angle, speeds), kind=ANGULAR_SPEED, note=note)
    pair = (Line("", angle, motor), Line("", angle, mechanism_torque, FAINT))
    panels = (speed, turning, torque, crank_angle_panel("torque in steady running", *pair, kind=TORQUE))
    return PanelFigure("Start from rest", message, panels, columns=2, width=(5.9, 3.9), height=2.3, stacked=True)


def sort_by_crank_angle(running: SteadyRunning, *columns: np.ndarray) -> tuple[np.ndarray, list[np.ndarray]]:
    """Return the crank angles of steady running, deg, from 0 to 360 or 720, and its columns in order."""
    angle = np.degrees(running.crank_angle) % (360.0 * running.turns)
    order = np.argsort(angle, kind="stable")
    return angle[order], [column[order] for column in columns]
