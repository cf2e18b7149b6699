"""Indicator diagram of one design: pressure over volume in each cylinder, valve events, work."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from rich.console import Console

from ....model.cycle.gas_cycle import cylinders
from ....model.cycle.indicator import burning_ends, indicator, valve_events
from ....model.errors import InputError
from ....model.linkage.linkage import Linkage
from ....model.machine.loads.cylinder import Cylinder
from ....model.machine.mechanism import Mechanism
from ....model.machine.two_turns import cycle_turns
from ...figures.sheets import Line, Panel, Sheet, over_turn, turn
from ...text import tables as text

_BAR, _CM3 = 1e-5, 1e6


def _of(mechanism: Mechanism) -> tuple[tuple[int, Cylinder], ...]:
    found = cylinders(mechanism)
    if not found:
        raise InputError(
            "an indicator diagram is of a cylinder; got none; add to the job for example "
            '[[load]] with bore = "70 mm", suction = "1 bar", discharge = "8 bar" and clearance = 0.05'
        )
    return found


def numbers(mechanism: Mechanism, linkage: Linkage) -> dict[str, Any]:
    """Return volumes, pressures and events of each cylinder, in the order of the loads.

    The end of expansion, compression or burning at peak pressure is None where no such event comes. Raises `InputError`
    without a cylinder.
    """
    found = []
    for place, load in _of(mechanism):
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


def show(console: Console, numbers: dict[str, Any]) -> None:
    """Write the numbers for people."""
    for one in numbers["cylinders"]:
        lines: list[text.Line] = [
            ("least volume", one["least_volume_cm3"], "cm³", ""),
            ("greatest volume", one["greatest_volume_cm3"], "cm³", ""),
            ("least pressure", one["least_pressure_bar"], "bar", ""),
            ("greatest pressure", one["greatest_pressure_bar"], "bar", ""),
        ]
        valve, falls = "a valve opens", "the pressure falls from its peak"
        for name, note in (("expansion", valve), ("compression", valve), ("burning", falls)):
            angle = one[f"{name}_ends_deg"]
            if angle is not None:
                lines.append((f"{name} ends", angle, "deg", note))
        text.show_lines(console, f"Indicator diagram of load {one['load']} (pressures are absolute)", lines)


def figure(mechanism: Mechanism, linkage: Linkage) -> Sheet:
    """Return pressure over volume and over the crank angle, a line for each cylinder."""
    over_volume, over_angle = [], []
    for style, (place, load) in enumerate(_of(mechanism)):
        ends = *valve_events(mechanism, linkage, load), burning_ends(mechanism, linkage, load)
        events = [angle for angle in ends if angle is not None]
        theta = turn(np.array(linkage.dead_centre_angles), events, turns=cycle_turns(mechanism))
        curve = indicator(mechanism, linkage, load, theta)
        # Closed: the diagram ends where it began.
        volume, pressure = (_CM3 * np.append(curve.volume, curve.volume[0]), _BAR * curve.pressure)
        name = f"load {place + 1}"
        over_volume.append(Line(name, volume, np.append(pressure, pressure[0]), style))
        over_angle.append(Line(name, np.degrees(theta), pressure, style))
    panels = (
        Panel("pressure, bar", "volume, cm³", tuple(over_volume)),
        over_turn("pressure, bar", *over_angle),
    )
    return Sheet("Indicator diagram", "", panels, width=6.4, height=3.0)
