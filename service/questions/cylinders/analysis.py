"""Several cylinders on one crankshaft: total torque, shaking force, moment and rocking couple; peaks per cylinder."""

import math
from typing import Annotated, Any

import numpy as np

from ....model.cycle.multi_cylinder import (
    MultiCylinderCycle,
    multi_cylinder_breakpoints,
    multi_cylinder_curves,
    multi_cylinder_cycle,
)
from ....model.linkage.linkage import Linkage
from ....model.machine.cylinder_machines import member_machines, single_cylinder
from ....model.machine.mechanism import Mechanism
from ....model.machine.two_turn_machine import cycle_turns
from ....model.signals.signals import Signal
from ....objectives.kinds import ANGLE, FORCE, LENGTH, TORQUE
from ...figures.panel_figure import FAINT, Line, PanelFigure, crank_angle_panel, sampled_turn
from ...render.blocks import Block, Table, Text, column, named_number, number_list, remark_with_value, value_from_record
from ..peaks import peak
from ..record_types import SHAKING, Keys, Note, NullIfLocked, PeakAngle

_CYLINDER = Keys(
    "Cylinder",
    "Single cylinder.",
    {
        "phase_deg": (float, lambda member, _: math.degrees(member.lead + member.bank)),
        "bank_deg": (float, lambda member, _: math.degrees(member.bank)),
        "place_mm": (float, lambda member, _: 1e3 * member.place),
        **{
            key: (
                NullIfLocked,
                lambda member, linkage, signal=signal: peak(member.mechanism, signal, linkage).value,
            )
            for key, signal in (
                ("peak_torque_Nm", Signal.TORQUE),
                ("peak_crank_pin_force_N", Signal.CRANK_PIN_FORCE),
                ("peak_slider_pin_force_N", Signal.SLIDER_PIN_FORCE),
                ("peak_guide_force_N", Signal.GUIDE_FORCE),
            )
        },
    },
)
Cylinder = Annotated[dict[str, Any], _CYLINDER]


def _value_and_angle(key: str, unit: str, name: str, kind: Any = float) -> dict[str, Any]:
    def degrees(shaft: MultiCylinderCycle, *_: object) -> float | None:
        angle = getattr(shaft, name).angle
        return None if math.isnan(angle) else math.degrees(angle)

    return {
        f"{key}_{unit}": (kind, lambda shaft, *_: getattr(shaft, name).value),
        f"{key}_angle_deg": (PeakAngle, degrees),
    }


_CYLINDERS = Keys(
    "Cylinders",
    "Total torque and shaking of all cylinders.",
    {
        "cylinders": (
            list[Cylinder],
            lambda _, mechanism, linkage: [_CYLINDER.of(member, linkage) for member in member_machines(mechanism)],
        ),
        **_value_and_angle("peak_torque", "Nm", "peak", NullIfLocked),
        "peak_torque_Nm": (NullIfLocked, lambda shaft, *_: abs(shaft.peak.value)),
        **_value_and_angle("least_torque", "Nm", "least", NullIfLocked),
        **_value_and_angle("greatest_torque", "Nm", "greatest", NullIfLocked),
        "mean_torque_Nm": (NullIfLocked, lambda shaft, *_: shaft.mean),
        "rms_torque_Nm": (NullIfLocked, lambda shaft, *_: shaft.rms),
        "torque_fluctuation_Nm": (
            Annotated[float | None, Note("RMS deviation from the mean; null where friction locks")],
            lambda shaft, *_: shaft.fluctuation,
        ),
        "energy_change_J": (
            Annotated[float | None, Note("that a flywheel takes up and gives back; null where friction locks")],
            lambda shaft, *_: shaft.energy_change,
        ),
        **_value_and_angle("peak_shaking_force", "N", "shaking_force"),
        "rms_shaking_force_N": (float, lambda shaft, *_: shaft.rms_shaking_force),
        **_value_and_angle("peak_shaking_moment", "Nm", "shaking_moment", SHAKING["peak_shaking_moment_Nm"]),
        "rms_shaking_moment_Nm": (float, lambda shaft, *_: shaft.rms_shaking_moment),
        **_value_and_angle("peak_rocking_couple", "Nm", "couple"),
        **{
            f"peak_shaking_{name}_of_one_{unit}": (
                float,
                lambda _, mechanism, linkage, signal=signal: peak(single_cylinder(mechanism), signal, linkage).value,
            )
            for name, unit, signal in (("force", "N", Signal.SHAKING_FORCE), ("moment", "Nm", Signal.SHAKING_MOMENT))
        },
    },
)
Cylinders = Annotated[dict[str, Any], _CYLINDERS]


def numbers(mechanism: Mechanism, linkage: Linkage) -> Cylinders:
    """Return total torque and shaking of all cylinders, and the peaks of each. None: the angle of a zero value.

    Raises `InputError` for a machine without cylinders in its job.
    """
    return _CYLINDERS.of(multi_cylinder_cycle(mechanism, linkage), mechanism, linkage)


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
    theta = sampled_turn(multi_cylinder_breakpoints(mechanism, linkage), turns=cycle_turns(mechanism))
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
