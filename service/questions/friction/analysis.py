"""Friction of one design: self-locking, effect on torque and forces, energy balance of a cycle."""

import math
from dataclasses import replace
from typing import Annotated, Literal

import numpy as np

from ....model.cycle.cycle import breakpoints, cycle, cycle_energies
from ....model.cycle.locked_angles import locking_verdict
from ....model.linkage.linkage import Linkage
from ....model.machine.cylinders_and_turns import cycle_turns, has_cylinders_or_speed_profile, single_cylinder_machine
from ....model.machine.links_and_joints import Friction
from ....model.machine.mechanism import Mechanism
from ....model.signals.averages import torque_averages
from ....model.signals.signals import Signal
from ....objectives.kinds import ANGLE, FORCE, PERCENT, TORQUE, Kind
from ...figures.panel_figure import CRANK_ANGLE, Line, Panel, PanelFigure, crank_angle_panel, sampled_crank_angles
from ...render.blocks import (
    Block,
    NamedNumber,
    Value,
    joined,
    named_number,
    number_list,
    remark_with_value,
    value_from_record,
    words,
)
from ...text.tables import finite_or_none
from ..peaks import lengths_row, peak
from ..record_types import Note, NullIfLocked, Record

Smooth = Annotated[float | None, Note("null where it is not determined")]
Verdict = Literal["drives", "locks", "locks or may jam", "may jam"]


class FrictionNumbers(Record):
    """Self-locking, torque and guide force with and without friction, and the energies of a cycle."""

    one_cylinder_at_constant_speed: bool
    """True for a machine with several cylinders or a speed profile: the numbers are for one cylinder at constant
    speed."""
    verdict: Verdict
    self_locking_margin_deg: Annotated[
        float | None, Note("least transmission angle minus the friction angles; null where there is none")
    ]
    least_transmission_angle_deg: float
    guide_friction_angle_deg: float
    pin_friction_angle_deg: Annotated[float | None, Note("null where the pins are too thick for such an angle")]
    locked_angles_deg: list[list[float]]
    """Start and end of each range of crank angles in which it locks."""
    peak_torque_Nm: NullIfLocked
    peak_torque_without_friction_Nm: Smooth
    mean_torque_Nm: NullIfLocked
    mean_torque_without_friction_Nm: Smooth
    peak_guide_force_N: NullIfLocked
    peak_guide_force_without_friction_N: Smooth
    input_work_J: NullIfLocked
    useful_work_J: Annotated[float | None, Note("negative where the load drives; null where friction locks")]
    friction_heat_J: NullIfLocked
    guide_heat_J: NullIfLocked
    crank_pivot_heat_J: NullIfLocked
    crank_pin_heat_J: NullIfLocked
    slider_pin_heat_J: NullIfLocked
    efficiency: Annotated[float | None, Note("null where friction locks, and where the load does no net work")]


_WORDS = {
    "drives": "drives at every crank angle, for any load",
    "locks": "LOCKS: no crank torque drives the slider",
    "locks or may jam": "LOCKS at some crank angles, may jam at others",
    "may jam": "MAY JAM: the forces are undefined",
}
_OVER = "over the crank angle"


def numbers(mechanism: Mechanism, linkage: Linkage) -> FrictionNumbers:
    """Return verdict, torque with and without friction, energies of a cycle and efficiency of one linkage.

    Undefined values are None: torques and energies of a linkage that locks, and the efficiency if the load does no net
    work.
    """
    has_several, mechanism = has_cylinders_or_speed_profile(mechanism), single_cylinder_machine(mechanism)
    friction, locking = mechanism.friction, locking_verdict(mechanism, linkage)
    smooth = replace(mechanism, friction=Friction())
    pins = (friction.crank_pin.friction_circle_radius + friction.slider_pin.friction_circle_radius) / float(linkage.rod)
    torque, smooth_torque = (
        finite_or_none(peak(machine, Signal.TORQUE, linkage).value) for machine in (mechanism, smooth)
    )
    mean, smooth_mean = (
        finite_or_none(torque_averages(machine, lengths_row(linkage)).mean[0]) for machine in (mechanism, smooth)
    )
    guide, smooth_guide = (
        finite_or_none(peak(machine, Signal.GUIDE_FORCE, linkage).value) for machine in (mechanism, smooth)
    )
    work = None if locking.locks else cycle_energies(mechanism, linkage)
    return {
        "one_cylinder_at_constant_speed": has_several,
        "verdict": "drives" if locking.holds is None and not locking.locks else _locking_verdict(locking.holds),
        "self_locking_margin_deg": finite_or_none(math.degrees(locking.margin)),
        "least_transmission_angle_deg": math.degrees(float(linkage.least_transmission_angle)),
        "guide_friction_angle_deg": math.degrees(math.atan(friction.guide)),
        "pin_friction_angle_deg": math.degrees(math.asin(pins)) if pins < 1.0 else None,
        "locked_angles_deg": [[math.degrees(a) % 360.0, math.degrees(b) % 360.0] for a, b in locking.locked],
        "peak_torque_Nm": torque,
        "peak_torque_without_friction_Nm": smooth_torque,
        "mean_torque_Nm": mean,
        "mean_torque_without_friction_Nm": smooth_mean,
        "peak_guide_force_N": guide,
        "peak_guide_force_without_friction_N": smooth_guide,
        "input_work_J": None if work is None else work.input,
        "useful_work_J": None if work is None else work.useful,
        "friction_heat_J": None if work is None else work.heat,
        "guide_heat_J": None if work is None else work.guide_heat,
        "crank_pivot_heat_J": None if work is None else work.crank_pivot_heat,
        "crank_pin_heat_J": None if work is None else work.crank_pin_heat,
        "slider_pin_heat_J": None if work is None else work.slider_pin_heat,
        "efficiency": None if work is None else work.efficiency,
    }


def _locking_verdict(holds: float | None) -> Verdict:
    if holds is None:  # a single angle, if the margin is exactly zero
        return "may jam"
    return "locks" if holds == 1.0 else "may jam" if holds == 0.0 else "locks or may jam"


def blocks(numbers: FrictionNumbers) -> list[Block]:
    """Return the answer in human-readable form."""
    locked_ranges = ", ".join(f"{a:.2f} to {b:.2f} deg" for a, b in numbers["locked_angles_deg"])
    heats = {
        "guide": numbers["guide_heat_J"],
        "crank pivot": numbers["crank_pivot_heat_J"],
        "crank pin": numbers["crank_pin_heat_J"],
        "slider pin": numbers["slider_pin_heat_J"],
    }
    heat, drives = numbers["friction_heat_J"], (numbers["useful_work_J"] or 0.0) < 0.0
    shares = ", ".join(f"{name} {100.0 * part / heat:.3g} %" for name, part in heats.items() if heat and part)
    least = words(
        "least transmission angle {angle} minus the friction angles",
        angle=value_from_record(numbers, "least_transmission_angle_deg", digits=4),
    )
    lines: list[NamedNumber] = [
        ("self-locking margin", value_from_record(numbers, "self_locking_margin_deg"), least),
        ("friction angle, guide", value_from_record(numbers, "guide_friction_angle_deg"), ""),
        ("friction angle, pins", value_from_record(numbers, "pin_friction_angle_deg"), ""),
    ]
    for key, smooth, averaging in (
        ("peak_torque_Nm", "peak_torque_without_friction_Nm", ""),
        ("mean_torque_Nm", "mean_torque_without_friction_Nm", _OVER),
        ("peak_guide_force_N", "peak_guide_force_without_friction_N", ""),
    ):
        lines.append(
            named_number(numbers, key, joined([averaging, remark_with_value(numbers, smooth, "without friction")]))
        )
    why = "the load does no net work" if heat is not None else "all values are undefined"
    delivered = "of the load's work is delivered at the crank" if drives else ""
    efficiency = numbers["efficiency"]
    side = "negative: the load drives the machine" if drives else "against the load"
    lines += [
        ("input work per cycle", value_from_record(numbers, "input_work_J"), ""),
        ("useful work per cycle", value_from_record(numbers, "useful_work_J"), side),
        ("friction heat per cycle", value_from_record(numbers, "friction_heat_J"), shares),
        ("efficiency", Value(efficiency, PERCENT), why if efficiency is None else delivered),
    ]
    scope = " of one cylinder at constant speed" if numbers["one_cylinder_at_constant_speed"] else ""
    return number_list(
        f"Friction{scope}: {_WORDS[numbers['verdict']]}{f' ({locked_ranges})' if locked_ranges else ''}", lines
    )


def figure(mechanism: Mechanism, linkage: Linkage) -> PanelFigure:
    """Return torque, guide force and transmission angle with and without friction, over the cycle.

    Torque and force are missing at angles where friction locks the linkage.
    """
    mechanism = single_cylinder_machine(mechanism)
    smooth = replace(mechanism, friction=Friction())
    locking = locking_verdict(mechanism, linkage)
    ends = [end for span in locking.locked for end in span]
    turns = cycle_turns(mechanism)
    theta = sampled_crank_angles(breakpoints(smooth if locking.locks else mechanism, linkage), ends, turns=turns)
    degrees = np.degrees(theta)
    with_it, frictionless = (cycle(machine, linkage, theta) for machine in (mechanism, smooth))
    margin, least = float(locking.margin), float(linkage.least_transmission_angle)
    level = ("locks below (worst side)", least - margin) if np.isfinite(margin) else None

    def comparison_panel(title: str, kind: Kind, name: str) -> Panel:
        lines = (("with friction", with_it), ("without", frictionless))
        curves = (
            Line(label, degrees, getattr(curves_of_case, name), n) for n, (label, curves_of_case) in enumerate(lines)
        )
        return crank_angle_panel(title, *curves, kind=kind)

    angle = Line("transmission angle", degrees, with_it.transmission_angle)
    panels = (
        comparison_panel("drive torque", TORQUE, "torque"),
        comparison_panel("guide force on the slider", FORCE, "guide"),
        crank_angle_panel("transmission angle", angle, kind=ANGLE, level=level),
    )
    locked = tuple((float(np.degrees(a)), float(np.degrees(b))) for a, b in locking.locked)
    x_title = joined([CRANK_ANGLE, "(shaded: locks or may jam)" if locked else ""], " ")
    shaded = tuple(replace(panel, x_title=x_title, shaded=locked) for panel in panels)
    return PanelFigure("Friction over the cycle", "", shaded, width=6.4, height=2.25, stacked=True)
