"""Start of a machine: from rest under its motor to steady running."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from rich.console import Console

from ....model.errors import InputError
from ....model.linkage.linkage import Linkage
from ....model.machine.mechanism import Mechanism
from ....model.transient.forward import State, simulate
from ....model.transient.record import Transient
from ....model.transient.steady import SteadyRunning, steady_running
from ...figures.numerals import shown
from ...figures.sheets import FAINT, Line, Panel, Sheet, over_turn
from ...text.tables import table

LONGEST = 60.0
"""s; a start that takes longer is not followed to its end unless asked for."""
TURNS = 300
STEADY = 1e-4
"""Share by which the speed may still change from turn to turn."""
RPM = 30.0 / math.pi


def start(mechanism: Mechanism, linkage: Linkage, **options: Any) -> tuple[Transient, SteadyRunning | None, str]:
    """Return the start from rest at the inner dead centre, steady running if there is any, and if not why.

    options: those of `simulate`. Raises `InputError` if the mechanism has no drive.
    """
    angle = float(Linkage(linkage.crank, linkage.rod, linkage.offset, mechanism.branch).dead_centre_angles[0])
    usual: dict[str, Any] = {"duration": LONGEST, "turns": TURNS, "steady": STEADY, "tolerance": 1e-10}
    run = simulate(mechanism, linkage, **(usual | {"start": State(angle=angle)} | options))
    try:
        return run, steady_running(mechanism, linkage), ""
    except InputError as error:
        return run, None, str(error)


def prepare(mechanism: Mechanism, linkage: Linkage, cancelled: Callable[[], bool]) -> dict[str, Any]:
    """Return the option that stops a simulation."""
    return {"cancelled": cancelled}


def numbers(mechanism: Mechanism, linkage: Linkage, **options: Any) -> dict[str, Any]:
    """Return the start from rest and the steady running, ready for JSON. options: those of `simulate`."""
    run, running, reason = start(mechanism, linkage, **options)
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
        "energy_imbalance": run.imbalance,
        "steady": None if running is None else steady_numbers(running),
        "why_not_steady": reason or None,
    }


def steady_numbers(running: SteadyRunning) -> dict[str, Any]:
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


def show(console: Console, numbers: dict[str, Any]) -> None:
    """Write the numbers as a short table."""
    rows = table("", ">", "")
    console.print(f"Start from rest: {numbers['message']}.", soft_wrap=True)
    told = [
        ("speed reached", "final_speed_rpm", "rpm"),
        ("peak motor torque, on the crank", "peak_motor_torque_Nm", "N m"),
        ("peak torque into the mechanism", "peak_torque_Nm", "N m"),
        ("peak motor power", "peak_power_W", "W"),
        ("work of the motor", "motor_work_J", "J"),
        ("work on the loads", "load_work_J", "J"),
        ("heat of friction", "friction_work_J", "J"),
        ("kinetic energy gained", "kinetic_energy_gained_J", "J"),
        ("error of the energy balance", "energy_imbalance", ""),
    ]
    then = [
        ("steady running: mean speed over time", "mean_speed_rpm", "rpm"),
        ("coefficient of speed fluctuation", "fluctuation", ""),
        ("peak motor torque", "peak_motor_torque_Nm", "N m"),
        ("mean motor power over time", "mean_power_W", "W"),
    ]
    steady = numbers["steady"]
    told = [line for line in told if line[1] != "friction_work_J" or numbers["friction_work_J"]]
    for found, lines in ((numbers, told), (steady, then if steady is not None else [])):
        for title, key, unit in lines:
            rows.add_row(title, f"{found[key]:.4g}", unit)
    console.print(rows)
    if steady is None:
        console.print(f"No steady running: {numbers['why_not_steady']}.", soft_wrap=True)


def figure(mechanism: Mechanism, linkage: Linkage, **options: Any) -> Sheet:
    """Return speed and torque over time, and over a turn of steady running if there is any.

    options: those of `simulate`. Raises `InputError` if the mechanism has no drive.
    """
    run, running, reason = start(mechanism, linkage, **options)
    message = run.message if not reason else f"{run.message}; no steady running"
    speed = Panel("crank speed, rpm", "time, s", (Line("", run.time, RPM * run.speed),))
    torques = (Line("motor", run.time, run.motor_torque), Line("mechanism", run.time, run.torque, FAINT))
    torque = Panel("torque on the crank, N m", "time, s", torques)
    if running is None:
        return Sheet("Start from rest", message, (speed, torque), width=9.6, height=2.3, stacked=True)
    angle, (speeds, motor, taken) = in_order(running, RPM * running.speed, running.motor_torque, running.torque)
    fluctuation = f"fluctuation {shown(running.fluctuation, 3)}"
    turning = over_turn("speed in steady running, rpm", Line("", angle, speeds), note=fluctuation)
    pair = (Line("", angle, motor), Line("", angle, taken, FAINT))
    panels = (speed, turning, torque, over_turn("torque in steady running, N m", *pair))
    return Sheet("Start from rest", message, panels, columns=2, width=(5.9, 3.9), height=2.3, stacked=True)


def in_order(running: SteadyRunning, *columns: np.ndarray) -> tuple[np.ndarray, list[np.ndarray]]:
    """Return the crank angles of steady running, deg, from 0 to 360 or 720, and columns of it by them."""
    angle = np.degrees(running.crank_angle) % (360.0 * running.turns)
    order = np.argsort(angle, kind="stable")
    return angle[order], [column[order] for column in columns]
