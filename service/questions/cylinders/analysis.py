"""Several cylinders on one crankshaft: total torque, shaking force, moment and rocking couple; peaks per cylinder."""

import math
from typing import Annotated

import numpy as np

from ....model.cycle.multi_cylinder import multi_cylinder_breakpoints, multi_cylinder_curves, multi_cylinder_cycle
from ....model.linkage.linkage import Linkage
from ....model.machine.cylinders_and_turns import (
    Member,
    cycle_turns,
    machines_of_arrangement,
    single_cylinder_machine,
)
from ....model.machine.mechanism import Mechanism
from ....model.signals.panel_polynomials import Extreme
from ....model.signals.signals import Signal
from ....objectives.kinds import ANGLE, FORCE, LENGTH, TORQUE
from ...figures.panel_figure import FAINT, Line, PanelFigure, crank_angle_panel, sampled_crank_angles
from ...render.blocks import Block, Table, Text, column, named_number, number_list, remark_with_value, value_from_record
from ..peaks import peak
from ..record_types import Note, NullIfLocked, PeakAngle, Record, ShakingNumbers


class Cylinder(Record):
    """Single cylinder."""

    phase_deg: float
    bank_deg: float
    place_mm: float
    peak_torque_Nm: NullIfLocked
    peak_crank_pin_force_N: NullIfLocked
    peak_slider_pin_force_N: NullIfLocked
    peak_guide_force_N: NullIfLocked


class Cylinders(ShakingNumbers):
    """Total torque and shaking of all cylinders."""

    cylinders: list[Cylinder]
    peak_torque_Nm: NullIfLocked
    peak_torque_angle_deg: PeakAngle
    least_torque_Nm: NullIfLocked
    least_torque_angle_deg: PeakAngle
    greatest_torque_Nm: NullIfLocked
    greatest_torque_angle_deg: PeakAngle
    mean_torque_Nm: NullIfLocked
    rms_torque_Nm: NullIfLocked
    torque_fluctuation_Nm: Annotated[float | None, Note("RMS deviation from the mean; null where friction locks")]
    energy_change_J: Annotated[float | None, Note("that a flywheel absorbs and returns; null where friction locks")]
    peak_rocking_couple_Nm: float
    peak_rocking_couple_angle_deg: PeakAngle
    peak_shaking_force_of_one_N: float
    peak_shaking_moment_of_one_Nm: float


def numbers(mechanism: Mechanism, linkage: Linkage) -> Cylinders:
    """Return total torque and shaking of all cylinders, and the peaks of each. None: the angle of a zero value.

    Raises `InputError` for a machine without cylinders in its job.
    """
    shaft = multi_cylinder_cycle(mechanism, linkage)
    return {
        "cylinders": [_single_cylinder(member, linkage) for member in machines_of_arrangement(mechanism)],
        "peak_torque_Nm": abs(shaft.peak.value),
        "peak_torque_angle_deg": _extreme_angle_deg(shaft.peak),
        "least_torque_Nm": shaft.least.value,
        "least_torque_angle_deg": _extreme_angle_deg(shaft.least),
        "greatest_torque_Nm": shaft.greatest.value,
        "greatest_torque_angle_deg": _extreme_angle_deg(shaft.greatest),
        "mean_torque_Nm": shaft.mean,
        "rms_torque_Nm": shaft.rms,
        "torque_fluctuation_Nm": shaft.fluctuation,
        "energy_change_J": shaft.energy_change,
        "peak_shaking_force_N": shaft.shaking_force.value,
        "peak_shaking_force_angle_deg": _extreme_angle_deg(shaft.shaking_force),
        "rms_shaking_force_N": shaft.rms_shaking_force,
        "peak_shaking_moment_Nm": shaft.shaking_moment.value,
        "peak_shaking_moment_angle_deg": _extreme_angle_deg(shaft.shaking_moment),
        "rms_shaking_moment_Nm": shaft.rms_shaking_moment,
        "peak_rocking_couple_Nm": shaft.couple.value,
        "peak_rocking_couple_angle_deg": _extreme_angle_deg(shaft.couple),
        "peak_shaking_force_of_one_N": peak(single_cylinder_machine(mechanism), Signal.SHAKING_FORCE, linkage).value,
        "peak_shaking_moment_of_one_Nm": peak(single_cylinder_machine(mechanism), Signal.SHAKING_MOMENT, linkage).value,
    }


def _single_cylinder(member: Member, linkage: Linkage) -> Cylinder:
    def greatest(signal: Signal) -> float:
        return peak(member.mechanism, signal, linkage).value

    return {
        "phase_deg": math.degrees(member.lead + member.bank),
        "bank_deg": math.degrees(member.bank),
        "place_mm": 1e3 * member.place,
        "peak_torque_Nm": greatest(Signal.TORQUE),
        "peak_crank_pin_force_N": greatest(Signal.CRANK_PIN_FORCE),
        "peak_slider_pin_force_N": greatest(Signal.SLIDER_PIN_FORCE),
        "peak_guide_force_N": greatest(Signal.GUIDE_FORCE),
    }


def _extreme_angle_deg(extreme: Extreme) -> float | None:
    return None if math.isnan(extreme.angle) else math.degrees(extreme.angle)


def blocks(numbers: Cylinders) -> list[Block]:
    """Return the answer in human-readable form."""
    remarks: dict[str, Text] = {
        "peak_torque_Nm": remark_with_value(numbers["cylinders"][0], "peak_torque_Nm", "of the first cylinder"),
        **dict.fromkeys(("least_torque_Nm", "greatest_torque_Nm"), ""),
        "mean_torque_Nm": "over the crank angle",
        "rms_torque_Nm": "over time; determines motor heating",
        "torque_fluctuation_Nm": "RMS deviation from the mean, over the crank angle",
        "energy_change_J": "range of the integral of torque minus mean; determines the flywheel",
        "peak_shaking_force_N": remark_with_value(numbers, "peak_shaking_force_of_one_N", "of one cylinder"),
        "rms_shaking_force_N": "over time",
        "peak_shaking_moment_Nm": remark_with_value(numbers, "peak_shaking_moment_of_one_Nm", "of one cylinder"),
        "rms_shaking_moment_Nm": "over time",
        "peak_rocking_couple_Nm": "about the origin of the shaft, from the axial positions of the cylinders",
    }
    together = [named_number(numbers, key, remark) for key, remark in remarks.items()]
    columns = (
        *(column(title, ANGLE) for title in ("phase", "bank")),
        column("place", LENGTH),
        column("peak torque", TORQUE),
        *(column(title, FORCE) for title in ("crank pin", "slider pin", "guide")),
    )
    rows = tuple(tuple(value_from_record(cylinder, key) for key in cylinder) for cylinder in numbers["cylinders"])
    title = f"{len(rows)} cylinders on one crankshaft, in total"
    return [*number_list(title, together), Table(columns, rows)]


def figure(mechanism: Mechanism, linkage: Linkage) -> PanelFigure:
    """Return total torque, shaking force and shaking moment over a revolution, with the torque of each cylinder."""
    theta = sampled_crank_angles(multi_cylinder_breakpoints(mechanism, linkage), turns=cycle_turns(mechanism))
    degrees, now = np.degrees(theta), multi_cylinder_curves(mechanism, linkage, theta)
    single_lines = [Line("each" if k == 0 else "", degrees, torque, FAINT) for k, torque in enumerate(now.torques)]
    together = Line("together", degrees, now.torque)
    forces = [Line("along x", degrees, now.force_x), Line("along y", degrees, now.force_y, 1)]
    panels = [
        crank_angle_panel("drive torque", *single_lines, together, kind=TORQUE),
        crank_angle_panel("shaking force", *forces, kind=FORCE),
        crank_angle_panel("shaking moment about the shaft", Line("together", degrees, now.moment), kind=TORQUE),
    ]
    if mechanism.arrangement is not None and mechanism.arrangement.places:
        couple = [Line("about x", degrees, now.couple_x), Line("about y", degrees, now.couple_y, 1)]
        panels.append(crank_angle_panel("rocking couple", *couple, kind=TORQUE))
    return PanelFigure("Cylinders on one crankshaft", "", tuple(panels), width=6.4, height=2.25, stacked=True)
