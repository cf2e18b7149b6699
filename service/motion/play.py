"""The motion of a linkage as a page plays it, and that of one that turns."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...model.linkage.linkage import Linkage
from ...model.machine.mechanism import Mechanism
from ..designs.cycle_table import CurveColumn, cycle_table
from ..drawings import layers as on
from ..drawings.parts import Look, bar, block, in_words, look_of, scenery
from ..drawings.shapes import Circle, Shape

ANGLES = 360
"""Places of the curves: of a turn a degree apart."""
_READOUT = (
    "slider_position_mm",
    "slider_velocity",
    "slider_acceleration",
    "transmission_angle_deg",
    "torque_Nm",
)
"""Curves that are read out, and their strips, by how their keys begin."""


@dataclass(frozen=True)
class Words:
    """Words of a page. control: label of what sets the place. times: of the speeds. over: what the curves are over."""

    control: str
    times: str
    over: str
    note: str


@dataclass(frozen=True)
class Play:
    """A motion as a page plays it, over and over.

    summary: a line on the linkage. record: numbers for the script, with the places of slider and rod. columns: the
    curves at the same places. marks: places of lines in them, deg of 360. still, moving: shapes of the drawing, those
    that move by their name, each in its own coordinates. extent: left, bottom, right, top, mm. size: of line types.
    """

    summary: str
    record: Mapping[str, Any]
    columns: list[CurveColumn]
    marks: tuple[float, ...]
    still: list[Shape]
    moving: Mapping[str, list[Shape]]
    extent: tuple[float, float, float, float]
    size: float
    words: Words


SHOWN = "Pivots are exact; {}, and so are the widths of links that the job does not describe by a section."
_TURNS = Words(
    control="Crank angle",
    times="turns a minute",
    over="a turn of the crank",
    note="Dead centres are dashed in the drawing and dotted lines in the curves. "
    + SHOWN.format("slider and pins\nare for show"),
)


def play_of_turn(mechanism: Mechanism, linkage: Linkage) -> Play:
    """Return the motion of a fully turning linkage. Raises `AssemblyError` for one that does not turn fully."""
    curves = cycle_table(mechanism, linkage, angles=ANGLES)
    look = look_of(mechanism, linkage)
    turn = linkage.at(np.arange(ANGLES) * (2.0 * math.pi / ANGLES))
    inner, outer = (math.degrees(float(angle)) for angle in linkage.dead_centre_angles)
    rpm = mechanism.speed * 30.0 / math.pi
    turning = f"{abs(rpm):.6g} rpm, {'clockwise' if rpm < 0.0 else 'counter-clockwise'}" if rpm else "no crank speed"
    return Play(
        summary=f"{in_words(linkage, 6)}; {turning}",
        record={
            **places(look, turn.slider_position, turn.rod_angle),
            "direction": -1 if mechanism.speed < 0.0 else 1,
            "perSecond": abs(mechanism.speed) / (2.0 * math.pi),
        },
        columns=[column for key in _READOUT for column in curves if column.key.startswith(key)],
        marks=(inner, outer),
        still=scenery(linkage, look, below=True),
        moving=links_of(look),
        extent=look.extent,
        size=look.size,
        words=_TURNS,
    )


def places(look: Look, slider: Any, rod: Any) -> dict[str, Any]:
    """Return crank and offset, mm, and for the places of a motion slider positions, mm, and rod angles, deg.

    slider: m. rod: rad.
    """
    angles = np.degrees(np.unwrap(rod))
    return {
        "crank": look.crank,
        "offset": look.offset,
        "slider": [round(1e3 * float(x), 9) for x in slider],
        "rod": [round(float(angle), 7) for angle in angles],
    }


def links_of(look: Look) -> dict[str, list[Shape]]:
    """Return slider, rod, crank and pins, each in its own coordinates."""
    pin = (0.0, 0.0)
    return {
        "slider": [block(on.SLIDER, pin, look.block)],
        "rod": [bar(on.ROD, pin, (look.rod, 0.0), look.rod_width)],
        "crank": [bar(on.CRANK, pin, (look.crank, 0.0), look.crank_width)],
        **{name: [Circle(on.PINS, pin, look.pin)] for name in ("pivot", "crank-pin", "slider-pin")},
    }
