"""Indicator diagram of one design: pressure against volume for each cylinder, valve events, work."""

import math
from dataclasses import replace
from typing import Annotated

import numpy as np

from ....model.cycle.gas_work import burning_end_angle, cylinder_loads, indicator_diagram, valve_events
from ....model.errors import InputError
from ....model.linkage.linkage import Linkage
from ....model.machine.cylinders_and_turns import cycle_turns
from ....model.machine.loads.cylinder import Cylinder
from ....model.machine.mechanism import Mechanism
from ....objectives.kinds import PRESSURE, VOLUME, display_unit
from ...figures.panel_figure import Line, Panel, PanelFigure, crank_angle_panel, sampled_crank_angles
from ...render.blocks import Block, NamedNumber, number_list, value_from_record
from ..record_types import Note, Record

_GAS_PRESSURE = replace(PRESSURE, metric=display_unit("bar", 1e-5))
Event = Annotated[float | None, Note("null without such an event")]
_BAR, _CM3 = _GAS_PRESSURE.metric.factor, VOLUME.metric.factor


class CylinderPressures(Record):
    """Volumes, absolute pressures and event crank angles for one cylinder."""

    load: int
    """Number of the cylinder among the loads of the job."""
    least_volume_cm3: float
    greatest_volume_cm3: float
    least_pressure_bar: float
    greatest_pressure_bar: float
    expansion_ends_deg: Event
    compression_ends_deg: Event
    burning_ends_deg: Event


class Indicator(Record):
    """Indicator diagrams."""

    cylinders: list[CylinderPressures]


def _require_cylinders(mechanism: Mechanism) -> tuple[tuple[int, Cylinder], ...]:
    loads = cylinder_loads(mechanism)
    if not loads:
        raise InputError(
            "an indicator diagram needs a cylinder; this job has none; for example, add to the job "
            '[[load]] with bore = "70 mm", suction = "1 bar", discharge = "8 bar" and clearance = 0.05'
        )
    return loads


def numbers(mechanism: Mechanism, linkage: Linkage) -> Indicator:
    """Return volumes, pressures and events of each cylinder, in the order of the loads.

    The end of expansion, compression or combustion at peak pressure is None if there is no such event. Raises
    `InputError` for a machine without a cylinder.
    """
    records: list[CylinderPressures] = []
    for place, load in _require_cylinders(mechanism):
        curve = indicator_diagram(mechanism, linkage, load, sampled_crank_angles(np.array(linkage.dead_centre_angles)))
        ends = *valve_events(mechanism, linkage, load), burning_end_angle(mechanism, linkage, load)
        expansion, compression, burning = (None if angle is None else math.degrees(angle) for angle in ends)
        least, greatest = float(curve.volume.min()), float(curve.volume.max())
        records.append(
            {
                "load": place + 1,
                "least_volume_cm3": _CM3 * least,
                "greatest_volume_cm3": _CM3 * greatest,
                "least_pressure_bar": _BAR * load.low,
                "greatest_pressure_bar": _BAR * load.high,
                "expansion_ends_deg": expansion,
                "compression_ends_deg": compression,
                "burning_ends_deg": burning,
            }
        )
    return {"cylinders": records}


def blocks(numbers: Indicator) -> list[Block]:
    """Return the answer in human-readable form."""
    result_blocks: list[Block] = []
    for cylinder in numbers["cylinders"]:
        lines: list[NamedNumber] = [
            ("least volume", value_from_record(cylinder, "least_volume_cm3"), ""),
            ("greatest volume", value_from_record(cylinder, "greatest_volume_cm3"), ""),
            ("least pressure", value_from_record(cylinder, "least_pressure_bar"), ""),
            ("greatest pressure", value_from_record(cylinder, "greatest_pressure_bar"), ""),
        ]
        valve, falls = "a valve opens", "the pressure falls from its peak"
        for name, event in (("expansion", valve), ("compression", valve), ("burning", falls)):
            angle = value_from_record(cylinder, f"{name}_ends_deg")
            if angle.number is not None:
                lines.append((f"{name} ends", angle, event))
        result_blocks += number_list(f"Indicator diagram of load {cylinder['load']} (pressures are absolute)", lines)
    return result_blocks


def figure(mechanism: Mechanism, linkage: Linkage) -> PanelFigure:
    """Return plots of pressure against volume and crank angle, with a line for each cylinder."""
    over_volume, over_angle = [], []
    for style, (place, load) in enumerate(_require_cylinders(mechanism)):
        ends = *valve_events(mechanism, linkage, load), burning_end_angle(mechanism, linkage, load)
        events = [angle for angle in ends if angle is not None]
        theta = sampled_crank_angles(np.array(linkage.dead_centre_angles), events, turns=cycle_turns(mechanism))
        curve = indicator_diagram(mechanism, linkage, load, theta)
        # Closed curve: the diagram ends where it began.
        volume, pressure = (np.append(values, values[0]) for values in (curve.volume, curve.pressure))
        name = f"load {place + 1}"
        over_volume.append(Line(name, volume, pressure, style))
        over_angle.append(Line(name, np.degrees(theta), curve.pressure, style))
    panels = (
        Panel("pressure", "volume", tuple(over_volume), kind=_GAS_PRESSURE, x_kind=VOLUME),
        crank_angle_panel("pressure", *over_angle, kind=_GAS_PRESSURE),
    )
    return PanelFigure("Indicator diagram", "", panels, width=6.4, height=3.0)
