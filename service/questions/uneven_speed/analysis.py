"""Machine with the speed profile of its job, compared with constant speed."""

import math
from dataclasses import replace
from typing import Annotated, Any

import numpy as np

from ....model.cycle.crank_speed import speed_knots
from ....model.cycle.cycle import breakpoints
from ....model.errors import InputError
from ....model.linkage.linkage import Linkage
from ....model.machine.cylinders_and_turns import cycle_turns
from ....model.machine.mechanism import Mechanism
from ....model.transient.speed_profile_cycle import speed_profile_curves, speed_profile_cycle
from ....objectives.kinds import ACCELERATION, ANGULAR_SPEED, FORCE, POWER, SPEED, TIME, TORQUE, Kind
from ...figures.panel_figure import DASHED, Line, Panel, PanelFigure, crank_angle_panel, sampled_crank_angles
from ...render.blocks import Block, Value, joined, named_number, number_list, remark_with_value
from ..record_types import Keys, Note, NullIfLocked, PeakAngle

_RPM = 30.0 / math.pi
_KINDS = {
    "torque": TORQUE,
    "power": POWER,
    "pivot_force": FORCE,
    "crank_pin_force": FORCE,
    "slider_pin_force": FORCE,
    "guide_force": FORCE,
    "slider_speed": SPEED,
    "slider_acceleration": ACCELERATION,
    "shaking_force": FORCE,
    "shaking_moment": TORQUE,
}


UnevenSpeed = Annotated[
    dict[str, Any],
    Keys(
        "UnevenSpeed",
        "Speeds, torque and peaks with the speed profile, and at constant speed (its mean over the crank angle).",
        {
            "least_speed_rpm": float,
            "least_speed_angle_deg": float,
            "greatest_speed_rpm": float,
            "greatest_speed_angle_deg": float,
            "mean_speed_over_time_rpm": float,
            "speed_fluctuation": Annotated[float, Note("(greatest - least speed) / mean speed over time")],
            "period_s": float,
            "peak_crank_acceleration_rad_s2": float,
            "mean_torque_Nm": Annotated[NullIfLocked, Note("over the crank angle; null where friction locks")],
            "rms_torque_Nm": NullIfLocked,
            "rms_torque_at_constant_speed_Nm": NullIfLocked,
            "mean_power_W": NullIfLocked,
            **{f"peak_{name}{kind.metric.suffix}": NullIfLocked for name, kind in _KINDS.items()},
            **{f"peak_{name}_angle_deg": PeakAngle for name in _KINDS},
            **{f"peak_{name}_at_constant_speed{kind.metric.suffix}": NullIfLocked for name, kind in _KINDS.items()},
        },
    ),
]


def _require_profile(mechanism: Mechanism) -> None:
    if mechanism.speed_profile is None:
        raise InputError(
            "an uneven speed needs a speed profile; the speed of this job is constant; for example, add to the job "
            "[mechanism] speed_profile = { cosines = [0.0, 0.05] }"
        )


def numbers(mechanism: Mechanism, linkage: Linkage) -> UnevenSpeed:
    """Return speeds, period and peaks with the profile, and the peaks at constant speed.

    Raises `InputError` if the machine has no profile.
    """
    _require_profile(mechanism)
    profile, even = (
        speed_profile_cycle(machine, linkage) for machine in (mechanism, replace(mechanism, speed_profile=None))
    )
    record: dict[str, Any] = {
        "least_speed_rpm": _RPM * profile.least_speed.value,
        "least_speed_angle_deg": math.degrees(profile.least_speed.angle),
        "greatest_speed_rpm": _RPM * profile.greatest_speed.value,
        "greatest_speed_angle_deg": math.degrees(profile.greatest_speed.angle),
        "mean_speed_over_time_rpm": _RPM * profile.mean_speed,
        "speed_fluctuation": abs(profile.fluctuation),
        "period_s": profile.period,
        "peak_crank_acceleration_rad_s2": profile.acceleration.value,
        "mean_torque_Nm": profile.mean_torque,
        "rms_torque_Nm": profile.rms_torque,
        "rms_torque_at_constant_speed_Nm": even.rms_torque,
        "mean_power_W": profile.mean_power,
    }
    for name, kind in _KINDS.items():
        suffix = kind.metric.suffix
        record[f"peak_{name}{suffix}"] = profile.peaks[name].value
        record[f"peak_{name}_angle_deg"] = math.degrees(profile.peaks[name].angle)
        record[f"peak_{name}_at_constant_speed{suffix}"] = even.peaks[name].value
    return record


def blocks(numbers: dict[str, Any]) -> list[Block]:
    """Return the answer in human-readable form."""
    even = "at constant speed"
    rms = joined(["over time", remark_with_value(numbers, "rms_torque_at_constant_speed_Nm", even)])
    lines = [
        *(named_number(numbers, key) for key in ("least_speed_rpm", "greatest_speed_rpm", "mean_speed_over_time_rpm")),
        named_number(numbers, "speed_fluctuation", "(greatest - least) / mean over time"),
        ("period", Value(numbers["period_s"], TIME), "of a turn"),
        named_number(numbers, "peak_crank_acceleration_rad_s2"),
        named_number(numbers, "mean_torque_Nm", "over the crank angle"),
        named_number(numbers, "rms_torque_Nm", rms),
        named_number(numbers, "mean_power_W", "over time"),
    ]
    for name, kind in _KINDS.items():
        suffix = kind.metric.suffix
        remark = remark_with_value(numbers, f"peak_{name}_at_constant_speed{suffix}", even)
        lines.append(named_number(numbers, f"peak_{name}{suffix}", remark))
    return number_list("With the speed profile (constant speed: the mean over the crank angle)", lines)


def figure(mechanism: Mechanism, linkage: Linkage) -> PanelFigure:
    """Return speed, torque and shaking force over a revolution, with the profile and at constant speed."""
    _require_profile(mechanism)
    knots = np.mod(speed_knots(mechanism), 2.0 * np.pi)
    theta = sampled_crank_angles(breakpoints(mechanism, linkage), knots, turns=cycle_turns(mechanism))
    degrees = np.degrees(theta)
    now, even = (
        speed_profile_curves(machine, linkage, theta) for machine in (mechanism, replace(mechanism, speed_profile=None))
    )

    def comparison_panel(title: str, kind: Kind, first: Any, second: Any) -> Panel:
        lines = Line("profile", degrees, first), Line("constant speed", degrees, second, DASHED)
        return crank_angle_panel(title, *lines, kind=kind)

    panels = (
        comparison_panel("crank speed", ANGULAR_SPEED, now.speed, even.speed),
        comparison_panel("drive torque", TORQUE, now.curves.torque, even.curves.torque),
        comparison_panel(
            "slider acceleration", ACCELERATION, now.curves.slider_acceleration, even.curves.slider_acceleration
        ),
        comparison_panel("shaking force", FORCE, now.named_curves["shaking_force"], even.named_curves["shaking_force"]),
    )
    return PanelFigure("Uneven crank speed", "", panels, width=6.4, height=2.25, stacked=True)
