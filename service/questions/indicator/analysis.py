"""Indicator diagram of one design: pressure over volume in each cylinder, valve events, work."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Annotated

import numpy as np

from ....model.cycle.gas_cycle import cylinders
from ....model.cycle.indicator import burning_ends, indicator, valve_events
from ....model.errors import InputError
from ....model.linkage.linkage import Linkage
from ....model.machine.loads.cylinder import Cylinder
from ....model.machine.mechanism import Mechanism
from ....model.machine.two_turns import cycle_turns
from ....objectives.kinds import PRESSURE, VOLUME, display_unit
from ...figures.sheets import Line, Panel, Sheet, over_turn, turn
from ...render.blocks import Block, NamedNumber, number_list, recorded
from ..answers import Note, Record

_GAS_PRESSURE = replace(PRESSURE, metric=display_unit("bar", 1e-5))
Event = Annotated[float | None, Note("null where no such event comes")]
_BAR, _CM3 = _GAS_PRESSURE.metric.factor, VOLUME.metric.factor


class CylinderPressures(Record):
    """A cylinder: its volumes, its absolute pressures, and crank angles of events."""

    load: int
    """Its number among the loads of the job."""
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
    found = cylinders(mechanism)
    if not found:
        raise InputError(
            "an indicator diagram needs a cylinder; this job has none; add to the job for example "
            '[[load]] with bore = "70 mm", suction = "1 bar", discharge = "8 bar" and clearance = 0.05'
        )
    return found


def numbers(mechanism: Mechanism, linkage: Linkage) -> Indicator:
    """Return volumes, pressures and events of each cylinder, in the order of the loads.

    The end of expansion, compression or burning at peak pressure is None where no such event comes. Raises `InputError`
    without a cylinder.
    """
    found: list[CylinderPressures] = []
    for place, load in _require_cylinders(mechanism):
        curve = indicator(mechanism, linkage, load, turn(np.array(linkage.dead_centre_angles)))
        ends = *valve_events(mechanism, linkage, load), burning_ends(mechanism, linkage, load)
        expansion, compression, burning = (None if angle is None else math.degrees(angle) for angle in ends)
        least, most = float(curve.volume.min()), float(curve.volume.max())
        found.append(
            {
                "load": place + 1,
                "least_volume_cm3": _CM3 * least,
                "greatest_volume_cm3": _CM3 * most,
                "least_pressure_bar": _BAR * load.low,
                "greatest_pressure_bar": _BAR * load.high,
                "expansion_ends_deg": expansion,
                "compression_ends_deg": compression,
                "burning_ends_deg": burning,
            }
        )
    return {"cylinders": found}


def blocks(numbers: Indicator) -> list[Block]:
    """Return the numbers for people."""
    found: list[Block] = []
    for one in numbers["cylinders"]:
        shown: list[NamedNumber] = [
            ("least volume", recorded(one, "least_volume_cm3"), ""),
            ("greatest volume", recorded(one, "greatest_volume_cm3"), ""),
            ("least pressure", recorded(one, "least_pressure_bar"), ""),
            ("greatest pressure", recorded(one, "greatest_pressure_bar"), ""),
        ]
        valve, falls = "a valve opens", "the pressure falls from its peak"
        for name, event in (("expansion", valve), ("compression", valve), ("burning", falls)):
            angle = recorded(one, f"{name}_ends_deg")
            if angle.number is not None:
                shown.append((f"{name} ends", angle, event))
        found += number_list(f"Indicator diagram of load {one['load']} (pressures are absolute)", shown)
    return found


def figure(mechanism: Mechanism, linkage: Linkage) -> Sheet:
    """Return pressure over volume and over the crank angle, a line for each cylinder."""
    over_volume, over_angle = [], []
    for style, (place, load) in enumerate(_require_cylinders(mechanism)):
        ends = *valve_events(mechanism, linkage, load), burning_ends(mechanism, linkage, load)
        events = [angle for angle in ends if angle is not None]
        theta = turn(np.array(linkage.dead_centre_angles), events, turns=cycle_turns(mechanism))
        curve = indicator(mechanism, linkage, load, theta)
        # Closed: the diagram ends where it began.
        volume, pressure = (np.append(values, values[0]) for values in (curve.volume, curve.pressure))
        name = f"load {place + 1}"
        over_volume.append(Line(name, volume, pressure, style))
        over_angle.append(Line(name, np.degrees(theta), curve.pressure, style))
    panels = (
        Panel("pressure", "volume", tuple(over_volume), kind=_GAS_PRESSURE, along=VOLUME),
        over_turn("pressure", *over_angle, kind=_GAS_PRESSURE),
    )
    return Sheet("Indicator diagram", "", panels, width=6.4, height=3.0)
