"""Delivery of pumps and compressors: mean flow, ripple over the cycle, torque from pressure only."""

from dataclasses import replace
from typing import Annotated

import numpy as np

from ....model.arrays import Array
from ....model.cycle.multi_cylinder import multi_cylinder_breakpoints, multi_cylinder_curves
from ....model.errors import InputError
from ....model.linkage.linkage import Linkage
from ....model.machine.arrangement import Arrangement
from ....model.machine.cylinders_and_turns import machines_of_arrangement
from ....model.machine.loads.cylinder import Cylinder
from ....model.machine.mechanism import Mechanism
from ....objectives.flow import FLOW, FLOW_RIPPLE, liquid_pumps
from ....objectives.kinds import TORQUE, VOLUME_FLOW
from ....objectives.quantity import Quantity
from ....objectives.torque_and_power import MEAN_TORQUE, PEAK_TORQUE
from ...figures.panel_figure import FAINT, Line, PanelFigure, crank_angle_panel, sampled_crank_angles
from ...render.blocks import Block, named_number, number_list
from ..peaks import lengths_row
from ..record_types import Note, Record
from ..static_forces.analysis import massless_mechanism


class Delivery(Record):
    """Total delivery of all cylinders, and the torque from pressure only."""

    flow_L_min: float
    """Mean over a revolution; gas is measured at suction pressure."""
    flow_ripple: Annotated[float | None, Note("of a liquid, over the mean; null for gas and with a speed profile")]
    mean_torque_Nm: float
    peak_torque_Nm: float


def numbers(mechanism: Mechanism, linkage: Linkage) -> Delivery:
    """Return flow, ripple and pressure torque of all cylinders together, ready for JSON.

    flow_ripple: None for gas, and with a speed profile. Raises `InputError` if there is no pump or compressor, or no
    speed.
    """
    reason = FLOW.undefined_because([mechanism])
    if reason:
        raise InputError(reason)
    alone = _with_pressures_only(mechanism)
    return {
        "flow_L_min": VOLUME_FLOW.metric.factor * _evaluate_quantity(FLOW, mechanism, linkage),
        "flow_ripple": _evaluate_quantity(FLOW_RIPPLE, mechanism, linkage) if _has_ripple(mechanism) else None,
        "mean_torque_Nm": _evaluate_quantity(MEAN_TORQUE, alone, linkage),
        "peak_torque_Nm": _evaluate_quantity(PEAK_TORQUE, alone, linkage),
    }


def _evaluate_quantity(quantity: Quantity, mechanism: Mechanism, linkage: Linkage) -> float:
    return float(quantity.evaluate(mechanism, lengths_row(linkage)).values[0])


def _has_ripple(mechanism: Mechanism) -> bool:
    """Whether the flow has a ripple, as for liquid at constant speed."""
    return not FLOW_RIPPLE.undefined_because([mechanism])


def _with_pressures_only(mechanism: Mechanism) -> Mechanism:
    """Return the machine with the cylinder pressures as its only loads."""
    return replace(
        massless_mechanism(mechanism), loads=tuple(load for load in mechanism.loads if isinstance(load, Cylinder))
    )


def _flow_curves(mechanism: Mechanism, linkage: Linkage, theta: Array) -> list[Array]:
    """Return the flow of each liquid cylinder, m^3/s, at crank angles of the shaft, rad."""
    flows = []
    pumps = [
        (pump.area, 1.0 if pump.head == "outer dead centre" else -1.0) for pump in liquid_pumps(mechanism).values()
    ]
    for member in machines_of_arrangement(mechanism):
        rate = linkage.at(theta + member.lead, speed=mechanism.speed).slider_velocity * mechanism.sign
        flows.append(sum((area * np.maximum(sign * rate, 0.0) for area, sign in pumps), np.zeros(len(theta))))
    return flows


def blocks(numbers: Delivery) -> list[Block]:
    """Return the answer in human-readable form."""
    remarks = {
        "flow_L_min": "mean over a turn; gas volume at suction pressure",
        "flow_ripple": "maximum minus minimum liquid flow, relative to its mean",
        "mean_torque_Nm": "from the pressures only",
        "peak_torque_Nm": "from the pressures only",
    }
    defined = [key for key, value in numbers.items() if value is not None]
    lines = [named_number(numbers, key, remark) for key, remark in remarks.items() if key in defined]
    return number_list("Delivery", lines)


def figure(mechanism: Mechanism, linkage: Linkage) -> PanelFigure:
    """Return the flow per cylinder and in total, for a liquid, and the pressure torque."""
    shaft = mechanism if mechanism.arrangement else replace(mechanism, arrangement=Arrangement(phases=(0.0,)))
    alone = _with_pressures_only(shaft)
    theta = sampled_crank_angles(multi_cylinder_breakpoints(alone, linkage))
    degrees, panels = np.degrees(theta), []
    if _has_ripple(mechanism):
        flows = _flow_curves(shaft, linkage, theta)
        single = [
            Line("each" if k == 0 else "", degrees, flow, FAINT) for k, flow in enumerate(flows) if len(flows) > 1
        ]
        together = Line("together", degrees, np.sum(flows, axis=0))
        panels.append(crank_angle_panel("liquid flow", *single, together, kind=VOLUME_FLOW))
    torque = multi_cylinder_curves(alone, linkage, theta).torque
    panels.append(crank_angle_panel("pressure torque", Line("", degrees, torque), kind=TORQUE))
    return PanelFigure("Delivery", "", tuple(panels), width=6.4, height=2.4, stacked=True)
