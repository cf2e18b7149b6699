"""Motion law compared with constant speed: numbers, text, cam table and figure."""

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Annotated, Any, cast

import numpy as np

from ....model.linkage.linkage import Linkage
from ....model.machine.mechanism import Mechanism
from ....model.motion_law.motion_law import cam_table_of_turn
from ....model.transient.crank_equation import TURN
from ....model.transient.speed_profile_cycle import speed_profile_curves, speed_profile_cycle
from ....objectives.kinds import ANGULAR_SPEED, SPEED, TORQUE, Kind, System
from ....optimise.motion_law.input_words import LawObjective, Timing
from ....optimise.motion_law.law_limits import LawRequest
from ....optimise.motion_law.optimal_law import OptimalLaw, optimal_law
from ....optimise.problem.problem import Problem
from ...designs.display_units import convert_rows, row_without_noise
from ...figures.panel_figure import DASHED, Line, Panel, PanelFigure, crank_angle_panel, sampled_crank_angles
from ...render.blocks import Block, NamedNumber, joined, named_number, note, number_list, remark_with_value, sentence
from ...render.numerals import format_number
from ...runs.result import Row
from ..record_types import Note, Record

_RPM = ANGULAR_SPEED.metric.factor


class LawNumbers(Record):
    """Motion law, and constant speed with the same cycle time. Torques are at the crank, rotor included."""

    objective: LawObjective
    timing: Timing
    cycle_time_s: float
    peak_torque_Nm: float
    peak_torque_angle_deg: float
    rms_torque_Nm: float
    """Over time."""
    least_speed_rpm: float
    greatest_speed_rpm: float
    peak_crank_acceleration_rad_s2: float
    peak_slider_speed_m_s: float
    peak_power_W: float
    work_J: float
    """Work of the drive per revolution."""
    peak_torque_at_constant_speed_Nm: float
    rms_torque_at_constant_speed_Nm: float
    peak_power_at_constant_speed_W: float
    peak_slider_speed_at_constant_speed_m_s: float
    gap: Annotated[float, Note("upper bound on the fraction by which the law is worse than the best possible one")]
    proven: bool
    """Whether the gap is at most a thousandth."""
    relaxed: Annotated[bool, Note("whether the bound comes from a relaxation, which even the best law may not reach")]


def compute_shared_options(
    mechanism: Mechanism,
    linkage: Linkage,
    *,
    cancelled: Callable[[], bool],
    words: Mapping[str, str] | None = None,
    problem: Problem | None = None,
    optimum: OptimalLaw | None = None,
    **inputs: Any,
) -> dict[str, Any]:
    """Return the law that numbers, cam table and figure share. inputs: fields of `LawRequest`."""
    found = optimum or optimal_law(mechanism, linkage, LawRequest(**inputs), names=words, cancelled=cancelled)
    return {"optimum": found}


def numbers(_: Mechanism, linkage: Linkage, *, optimum: OptimalLaw, **options: Any) -> LawNumbers:
    """Return a law ready for JSON, evaluated like any speed profile."""
    law, request = optimum.law, optimum.limits.request
    judged = speed_profile_cycle(law.turn.machine, linkage, law.crank_motion)
    even = speed_profile_cycle(_at_constant_speed(optimum), linkage)
    record: Row = {
        "objective": request.objective,
        "timing": request.timing,
        "cycle_time_s": judged.period,
        "peak_torque_Nm": judged.peaks["torque"].value,
        "peak_torque_angle_deg": math.degrees(judged.peaks["torque"].angle),
        "rms_torque_Nm": judged.rms_torque,
        "least_speed_rpm": _RPM * min(abs(judged.least_speed.value), abs(judged.greatest_speed.value)),
        "greatest_speed_rpm": _RPM * max(abs(judged.least_speed.value), abs(judged.greatest_speed.value)),
        "peak_crank_acceleration_rad_s2": judged.acceleration.value,
        "peak_slider_speed_m_s": judged.peaks["slider_speed"].value,
        "peak_power_W": judged.peaks["power"].value,
        "work_J": judged.work,
        "peak_torque_at_constant_speed_Nm": even.peaks["torque"].value,
        "rms_torque_at_constant_speed_Nm": even.rms_torque,
        "peak_power_at_constant_speed_W": even.peaks["power"].value,
        "peak_slider_speed_at_constant_speed_m_s": even.peaks["slider_speed"].value,
        "gap": optimum.gap,
        "proven": optimum.proven,
        "relaxed": optimum.relaxed,
    }
    return cast(LawNumbers, row_without_noise(record))


def _at_constant_speed(optimum: OptimalLaw) -> Mechanism:
    """Return the machine at the constant speed with the same cycle time as the law."""
    machine = optimum.law.turn.machine
    return replace(machine, speed=machine.direction * TURN / optimum.law.period)


def notes(numbers: LawNumbers) -> list[str]:
    """Return a note if the optimum is not proven."""
    if numbers["proven"]:
        return []
    return [f"not proven to be the best: within {100.0 * numbers['gap']:.3g} % of a bound on all laws"]


def blocks(numbers: LawNumbers) -> list[Block]:
    """Return the answer in human-readable form."""
    even = "at constant speed"
    lines: list[NamedNumber] = [
        named_number(numbers, "peak_torque_Nm", remark_with_value(numbers, "peak_torque_at_constant_speed_Nm", even)),
        named_number(
            numbers,
            "rms_torque_Nm",
            joined(["over time", remark_with_value(numbers, "rms_torque_at_constant_speed_Nm", even)]),
        ),
        named_number(numbers, "peak_power_W", remark_with_value(numbers, "peak_power_at_constant_speed_W", even)),
        named_number(numbers, "cycle_time_s"),
        named_number(numbers, "least_speed_rpm"),
        named_number(numbers, "greatest_speed_rpm"),
        named_number(numbers, "peak_crank_acceleration_rad_s2"),
        named_number(
            numbers,
            "peak_slider_speed_m_s",
            remark_with_value(numbers, "peak_slider_speed_at_constant_speed_m_s", even),
        ),
        named_number(numbers, "work_J", "of the drive in a turn"),
    ]
    found: list[Block] = [
        *number_list(
            f"Motion law with the least {_objective_text(numbers['objective'])} (torques at the crank)", lines
        ),
        sentence(f"{_gain_text(numbers)}"),
    ]
    if numbers["proven"]:
        margin = f" by more than {100.0 * numbers['gap']:.2g} %" if numbers["gap"] else ""
        found.append(note(f"Proven: no law within these limits is better{margin}."))
    return found


def _gain_text(numbers: LawNumbers) -> str:
    """Return the gain over constant speed in a sentence."""
    changes = []
    for key, title in (("peak_torque", "peak torque"), ("rms_torque", "RMS torque")):
        even: float = numbers[f"{key}_at_constant_speed_Nm"]  # type: ignore[literal-required]
        change = numbers[f"{key}_Nm"] / even - 1.0 if even else 0.0  # type: ignore[literal-required]
        changes.append(f"{title} {format_number(abs(100.0 * change), 3)} % {'higher' if change > 0.0 else 'lower'}")
    return f"Compared with constant speed at the same cycle time: {' and '.join(changes)}."


def _objective_text(objective: LawObjective) -> str:
    return objective.replace("rms", "RMS")


def curves(_: Mechanism, __: Linkage, *, optimum: OptimalLaw, units: System, **options: Any) -> list[dict[str, Any]]:
    """Return the rows of the cam table."""
    table = cam_table_of_turn(optimum.law)
    rows = zip(table.time, table.crank_angle, table.speed, table.acceleration, strict=True)
    return convert_rows(
        [
            {
                "time_s": float(time),
                "crank_angle_deg": math.degrees(angle),
                "crank_speed_rad_s": float(speed),
                "crank_acceleration_rad_s2": float(acceleration),
            }
            for time, angle, speed, acceleration in rows
        ],
        units,
    )


def figure(_: Mechanism, linkage: Linkage, *, optimum: OptimalLaw, problem: Problem, **options: Any) -> PanelFigure:
    """Return plots of speed, torque and slider speed against crank angle, for the law and for constant speed."""
    law = optimum.law
    theta = sampled_crank_angles(law.turn.cell_start_angles)
    now = speed_profile_curves(law.turn.machine, linkage, theta, law.crank_motion)
    even = speed_profile_curves(_at_constant_speed(optimum), linkage, theta)
    degrees = np.degrees(theta)

    def panel(title: str, kind: Kind, first: Any, second: Any) -> Panel:
        lines = Line("law", degrees, first), Line("constant speed", degrees, second, DASHED)
        return crank_angle_panel(title, *lines, kind=kind)

    panels = (
        panel("crank speed", ANGULAR_SPEED, now.speed, even.speed),
        panel("drive torque at the crank", TORQUE, now.curves.torque, even.curves.torque),
        panel("slider speed", SPEED, now.curves.slider_velocity, even.curves.slider_velocity),
    )
    title = f"{problem.name}: motion law with the least {_objective_text(optimum.limits.request.objective)}"
    return PanelFigure(title, "", panels, width=6.4, height=2.25, stacked=True)
