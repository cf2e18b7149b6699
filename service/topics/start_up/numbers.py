"""Start of a machine: from rest under its motor to steady running, in numbers."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from ....model.errors import InputError

if TYPE_CHECKING:
    from ....model.linkage.linkage import Linkage
    from ....model.machine.mechanism import Mechanism
    from ....model.transient.record import Transient
    from ....model.transient.steady import SteadyRunning

LONGEST = 60.0
"""s; a start that takes longer is not followed to its end unless asked for."""
TURNS = 300
STEADY = 1e-4
"""Share by which the speed may still change from turn to turn."""
_RPM = 30.0 / math.pi


def start(mechanism: Mechanism, linkage: Linkage, **options: Any) -> tuple[Transient, SteadyRunning | None, str]:
    """Return the start from rest at the inner dead centre, steady running if there is any, and if not why.

    options: those of `simulate`. Raises `InputError` if the mechanism has no drive.
    """
    from ....model.linkage.linkage import Linkage as Own
    from ....model.transient.forward import State, simulate
    from ....model.transient.steady import steady_running

    angle = float(Own(linkage.crank, linkage.rod, linkage.offset, mechanism.branch).dead_centre_angles[0])
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
        "final_speed_rpm": _RPM * float(run.speed[-1]),
        "peak_motor_torque_Nm": float(abs(run.motor_torque).max()),
        "peak_torque_Nm": float(abs(run.torque).max()),
        "peak_power_W": float(abs(run.power).max()),
        "turned_back_s": list(run.turned_back),
        "motor_work_J": float(run.motor_work[-1]),
        "load_work_J": float(run.load_work[-1]),
        "kinetic_energy_gained_J": float(run.kinetic[-1] - run.kinetic[0]),
        "potential_energy_gained_J": float(run.potential[-1] - run.potential[0]),
        "energy_imbalance": run.imbalance,
        "steady": None if running is None else steady_numbers(running),
        "why_not_steady": reason or None,
    }


def steady_numbers(running: SteadyRunning) -> dict[str, Any]:
    """Return the numbers of steady running: speeds, fluctuation, period, torques and mean power."""
    return {
        "mean_speed_rpm": _RPM * running.mean_speed,
        "least_speed_rpm": _RPM * float(abs(running.speed).min()),
        "greatest_speed_rpm": _RPM * float(abs(running.speed).max()),
        "fluctuation": running.fluctuation,
        "period_s": running.period,
        "peak_motor_torque_Nm": float(abs(running.motor_torque).max()),
        "peak_torque_Nm": float(abs(running.torque).max()),
        "mean_power_W": running.work / running.period,
    }
