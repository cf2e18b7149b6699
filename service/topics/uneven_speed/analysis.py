"""A machine at the speed profile of its job, beside the same at constant speed."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
from rich.console import Console

from ....model.cycle.cycle import breakpoints
from ....model.cycle.pace import pace_knots
from ....model.errors import InputError
from ....model.linkage.linkage import Linkage
from ....model.machine.mechanism import Mechanism
from ....model.machine.two_turns import cycle_turns
from ....model.transient.uneven import uneven_curves, uneven_cycle
from ....objectives.kinds import face
from ...figures.sheets import DASHED, Line, Sheet, over_turn, turn
from ...text import tables as text

_RPM = 30.0 / math.pi
_UNITS = {
    "torque": "N m",
    "power": "W",
    "pivot_force": "N",
    "crank_pin_force": "N",
    "slider_pin_force": "N",
    "guide_force": "N",
    "slider_speed": "m/s",
    "slider_acceleration": "m/s^2",
    "shaking_force": "N",
    "shaking_moment": "N m",
}


def _require(mechanism: Mechanism) -> None:
    if mechanism.speed_profile is None:
        raise InputError(
            "an uneven speed needs a profile; got a constant speed; add to the job for example "
            "[mechanism] speed_profile = { cosines = [0.0, 0.05] }"
        )


def numbers(mechanism: Mechanism, linkage: Linkage) -> dict[str, Any]:
    """Return speeds, period and peaks at the profile, and the peaks at constant speed. Raises without a profile."""
    _require(mechanism)
    found, even = (uneven_cycle(each, linkage) for each in (mechanism, replace(mechanism, speed_profile=None)))
    record: dict[str, Any] = {
        "least_speed_rpm": _RPM * found.least_speed.value,
        "least_speed_angle_deg": math.degrees(found.least_speed.angle),
        "greatest_speed_rpm": _RPM * found.greatest_speed.value,
        "greatest_speed_angle_deg": math.degrees(found.greatest_speed.angle),
        "mean_speed_over_time_rpm": _RPM * found.mean_speed,
        "speed_fluctuation": abs(found.fluctuation),
        "period_s": found.period,
        "peak_crank_acceleration_rad_s2": found.acceleration.value,
        "mean_torque_Nm": found.mean_torque,
        "rms_torque_Nm": found.rms_torque,
        "rms_torque_at_constant_speed_Nm": even.rms_torque,
        "mean_power_W": found.mean_power,
    }
    for name, unit in _UNITS.items():
        suffix = face(unit).suffix
        record[f"peak_{name}{suffix}"] = found.peaks[name].value
        record[f"peak_{name}_angle_deg"] = math.degrees(found.peaks[name].angle)
        record[f"peak_{name}_at_constant_speed{suffix}"] = even.peaks[name].value
    return record


def show(console: Console, numbers: dict[str, Any]) -> None:
    """Write the numbers for people."""

    def told(key: str, remark: str = "") -> text.Line:
        return text.told(numbers, key, remark)

    even = "at constant speed"
    lines = [
        *(told(key) for key in ("least_speed_rpm", "greatest_speed_rpm", "mean_speed_over_time_rpm")),
        told("speed_fluctuation", "(greatest - least) / mean over time"),
        ("period", numbers["period_s"], "s", "of a turn"),
        told("peak_crank_acceleration_rad_s2"),
        told("mean_torque_Nm", "over the crank angle"),
        told("rms_torque_Nm", f"over time, {text.compared(numbers, 'rms_torque_at_constant_speed_Nm', even)}"),
        told("mean_power_W", "over time"),
    ]
    for name, unit in _UNITS.items():
        suffix = face(unit).suffix
        remark = text.compared(numbers, f"peak_{name}_at_constant_speed{suffix}", even)
        lines.append(told(f"peak_{name}{suffix}", remark))
    text.show_lines(console, "At the speed profile (constant speed: the mean over the crank angle)", lines)


def figure(mechanism: Mechanism, linkage: Linkage) -> Sheet:
    """Return speed, torque and shaking force over a turn, at the profile and at constant speed."""
    _require(mechanism)
    knots = np.mod(pace_knots(mechanism), 2.0 * np.pi)
    theta = turn(breakpoints(mechanism, linkage), knots, turns=cycle_turns(mechanism))
    degrees = np.degrees(theta)
    now, even = (uneven_curves(each, linkage, theta) for each in (mechanism, replace(mechanism, speed_profile=None)))

    def both(title: str, first: Any, second: Any) -> Any:
        return over_turn(title, Line("profile", degrees, first), Line("constant speed", degrees, second, DASHED))

    panels = (
        both("crank speed, rpm", _RPM * now.speed, _RPM * even.speed),
        both("drive torque, N m", now.curves.torque, even.curves.torque),
        both("slider acceleration, m/s²", now.curves.slider_acceleration, even.curves.slider_acceleration),
        both("shaking force, N", now.others["shaking_force"], even.others["shaking_force"]),
    )
    return Sheet("Uneven crank speed", "", panels, width=6.4, height=2.25, stacked=True)
