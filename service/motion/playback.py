"""Motion of a linkage for playback on a page, fully rotating or swinging."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ...model.arrays import Array
from ...model.cycle.crank_speed import turn_time
from ...model.cycle.gas_work import cylinder_loads, indicator_diagram
from ...model.linkage.linkage import Linkage
from ...model.machine.cylinders_and_turns import cycle_turns
from ...model.machine.mechanism import Mechanism
from ...model.swing.swing import Swing
from ...model.turning_cylinder.lever_of_design import lever_machine, lever_swing
from ...objectives.kinds import System
from ...objectives.tables.curve_extremes import curve_extremes
from ...objectives.tables.swing_curves import curves_at_even_times, has_position_error, motion_and_drive_curves
from ..designs.design_curves import CurveColumn, cycle_table, lever_design_curves
from ..designs.length_with_tolerance import tolerances_of
from ..drawings import layers as on
from ..drawings.lever_parts import fixed_lever_shapes, lever_extent, lever_parts
from ..drawings.linkage_shapes import (
    LinkageSizes,
    fixed_shapes,
    lengths_in_words,
    linkage_sizes,
    round_ended_bar,
    slider_block,
)
from ..drawings.shapes import Circle, Shape
from ..drawings.swing_parts import body_shapes, fixed_swing_shapes, piston_rod_and_barrel, swing_sizes

ANGLES = 360
"""Number of curve points per revolution: one per degree."""
_READOUT = (
    "slider_position_mm",
    "slider_velocity",
    "slider_acceleration",
    "transmission_angle_deg",
    "torque_Nm",
)
"""Curves with readouts and strip charts, by the prefix of their keys."""


@dataclass(frozen=True)
class PlayerText:
    """Words on a page.

    control: label of the position slider. times: unit of the speed. span_name: range of the curves.
    """

    control: str
    times: str
    span_name: str
    note: str


@dataclass(frozen=True)
class Playback:
    """Motion that a page plays in a loop.

    summary: description of the linkage in one line. record: numbers for the script, with the positions of slider and
    rod. columns: curves at the same points. marks: positions of marker lines in them, deg. turns: crank revolutions
    until the motion repeats; 1 for a swing. still, moving: fixed and moving shapes of the drawing, the moving ones by
    name, each in its own coordinates. extent: left, bottom, right, top, mm. size: reference length for line types.
    ends: exact minimum and maximum of curves, by key; others have those of their points.
    """

    summary: str
    record: Mapping[str, Any]
    columns: list[CurveColumn]
    marks: tuple[float, ...]
    still: list[Shape]
    moving: Mapping[str, list[Shape]]
    extent: tuple[float, float, float, float]
    size: float
    words: PlayerText
    turns: int = 1
    ends: Mapping[str, tuple[float, float]] = field(default_factory=dict)


EXACT_PARTS = "Pivots are exact; {}, and so are the widths of links that the job does not describe by a section."
_TURNS = PlayerText(
    control="Crank angle",
    times="turns a minute",
    span_name="a turn of the crank",
    note="Dead centres are dashed in the drawing and dotted lines in the curves. "
    + EXACT_PARTS.format("slider and pins\nare schematic"),
)
_SWING = PlayerText(
    control="Back and forth",
    times="swings a minute",
    span_name="the swing, back and forth",
    note="Both ends of the swing are dashed in the drawing; a dotted line in the curves marks the reversal. "
    + EXACT_PARTS.format("slider, pins, the cylinder and the body on the crank are schematic"),
)
_LEVER = replace(
    _SWING,
    note="Both ends of the swing are dashed in the drawing; a dotted line in the curves marks the reversal. "
    "Pivots and pins are exact; the widths and the barrel are schematic.",
)
_LEVER_TURN = replace(
    _TURNS,
    note="Both ends of the fast stroke are dashed in the drawing. Pivots and pins are exact; widths are schematic.",
)
_LEFT_OUT = ("crank_angle", "load")


def turn_playback(mechanism: Mechanism, linkage: Linkage, system: System = "metric") -> Playback:
    """Return the motion of a fully rotating linkage. Raises `AssemblyError` for a linkage that does not rotate fully.

    A 720 deg cycle includes both revolutions. system: unit system of the summary.
    """
    turns = cycle_turns(mechanism)
    curves = cycle_table(mechanism, linkage, angles=turns * ANGLES, turns=turns)
    look = linkage_sizes(mechanism, linkage)
    angles = np.arange(turns * ANGLES, dtype=np.float64) * (2.0 * math.pi / ANGLES)
    turn, extremes = linkage.at(angles), curve_extremes(mechanism, linkage)
    dead = [math.degrees(float(angle)) % 360.0 for angle in linkage.dead_centre_angles]
    rpm = mechanism.speed * 30.0 / math.pi
    factors = ((f"{curve.name}{curve.kind.metric.suffix}", curve.kind.metric.factor, curve) for curve in extremes)
    turning = f"{abs(rpm):.6g} rpm, {'clockwise' if rpm < 0.0 else 'counter-clockwise'}" if rpm else "no crank speed"
    return Playback(
        summary=f"{lengths_in_words(linkage, tolerances_of(mechanism, linkage), system, stroke=True)}; {turning}",
        record={
            **position_record(look, turn.slider_position, turn.rod_angle),
            "direction": -1 if mechanism.speed < 0.0 else 1,
            "perSecond": 1.0 / turn_time(mechanism),
        },
        columns=[
            *(column for key in _READOUT for column in curves if column.key.startswith(key)),
            *_pressure_columns(mechanism, linkage, angles),
        ],
        marks=tuple(angle + 360.0 * number for number in range(turns) for angle in dead),
        still=fixed_shapes(linkage, look, bearing_below=True),
        moving=moving_link_shapes(look),
        extent=look.extent,
        size=look.longer_side,
        ends={
            key: (factor * curve.least.value, factor * curve.greatest.value)
            for key, factor, curve in factors
            if math.isfinite(curve.least.value + curve.greatest.value)
        },
        words=replace(
            _TURNS,
            span_name=_TURNS.span_name if turns == 1 else f"{turns} turns of the crank",
            note=f"{_TURNS.note} Bore and clearance of the cylinder are exact." if look.barrels else _TURNS.note,
        ),
        turns=turns,
    )


def _pressure_columns(mechanism: Mechanism, linkage: Linkage, angles: Array) -> list[CurveColumn]:
    """Return the pressure in each cylinder at crank angles, rad."""
    loads = cylinder_loads(mechanism)
    return [
        CurveColumn(
            f"pressure_{place + 1}_bar",
            "pressure" if len(loads) == 1 else f"pressure, load {place + 1}",
            "bar",
            (1e-5 * indicator_diagram(mechanism, linkage, load, angles).pressure).tolist(),
        )
        for place, load in loads
    ]


def position_record(look: LinkageSizes, slider: Any, rod: Any) -> dict[str, Any]:
    """Return crank, offset and slider positions, mm, and rod angles, deg, at the points of a motion.

    slider: slider positions, m. rod: rod angles, rad.
    """
    angles = np.degrees(np.unwrap(rod))
    return {
        "crank": look.crank,
        "offset": look.offset,
        "slider": [round(1e3 * float(x), 9) for x in slider],
        "rod": [round(float(angle), 7) for angle in angles],
    }


def moving_link_shapes(look: LinkageSizes) -> dict[str, list[Shape]]:
    """Return slider, rod, crank and pins, each in its own coordinates."""
    pin = (0.0, 0.0)
    return {
        "slider": [slider_block(on.SLIDER, pin, look)],
        "rod": [round_ended_bar(on.ROD, pin, (look.rod, 0.0), look.rod_width)],
        "crank": [round_ended_bar(on.CRANK, pin, (look.crank, 0.0), look.crank_width)],
        **{
            name: [Circle(on.PINS, pin, radius)]
            for name, radius in zip(("pivot", "crank-pin", "slider-pin"), look.pins, strict=True)
        },
    }


def swing_playback(mechanism: Mechanism, linkage: Linkage, swing: Swing, system: System = "metric") -> Playback:
    """Return the motion of a swinging linkage. system: unit system of the summary. Raises as `require_swing`."""
    drawn = swing_sizes(mechanism, linkage, swing)
    ways = curves_at_even_times(mechanism, drawn.linkage, drawn.swing, ANGLES)
    angles = np.concatenate([way.crank_angle for way in ways])
    at = drawn.linkage.at(angles)
    columns = [
        CurveColumn(
            curve.field,
            curve.title,
            curve.kind.metric.symbol,
            np.concatenate([curve.values_in(way) for way in ways]).tolist(),
        )
        for curve in motion_and_drive_curves(drawn.swing)
        if curve.name not in _LEFT_OUT
        and (curve.attribute != "driven_error" or has_position_error(mechanism, drawn.swing))
    ]
    moving = moving_link_shapes(drawn.look)
    if drawn.body is not None:
        moving["crank"] = [*moving["crank"], *body_shapes(drawn.body, drawn.look, 0.0)]
    pushed: dict[str, list[Shape]] = {}
    if drawn.cylinder is not None:
        rod, barrel = piston_rod_and_barrel(drawn.cylinder, drawn.look)
        pushed = {"push": [rod], "barrel": [barrel]}
    timed = drawn.swing.duration
    start, end = (math.degrees(angle) for angle in (drawn.swing.start, drawn.swing.end))
    how = "slowly" if timed is None else f"{drawn.swing.law} law, {timed:g} s per stroke"
    return Playback(
        summary=f"{lengths_in_words(drawn.linkage, tolerances_of(mechanism, drawn.linkage), system)}; "
        f"from {start:.6g} to {end:.6g} deg, the {drawn.swing.driver} driven, {how}",
        record={
            **position_record(drawn.look, at.slider_position, at.rod_angle),
            "angles": [round(math.degrees(angle), 9) for angle in angles],
            "direction": 1,
            "perSecond": 0.0 if timed is None else 0.5 / timed,
        },
        columns=columns,
        marks=(0.5 * ANGLES,),
        still=fixed_swing_shapes(drawn),
        moving={**pushed, **moving},
        extent=drawn.extent,
        size=drawn.look.longer_side,
        words=_SWING,
    )


def lever_playback(mechanism: Mechanism, linkage: Linkage, swing: Swing, system: System = "metric") -> Playback:
    """Return the motion of a lever and its cylinder. system: unit system of the summary.

    Raises as `movable_lever_linkage`.
    """
    curves = lever_design_curves(mechanism, linkage, swing, ANGLES)
    placed, (machine, _) = lever_swing(mechanism, linkage, swing), lever_machine(mechanism, linkage, swing)
    angles, _, line_angles, *_ = (column.values for column in curves.columns)
    sizes, extent = machine.sizes, lever_extent(machine, placed)
    base = 1e3 * sizes.frame * math.cos(sizes.frame_angle), 1e3 * sizes.frame * math.sin(sizes.frame_angle)
    start, end = (math.degrees(angle) for angle in (placed.start, placed.end))
    turns = placed.of_full_turn
    lengths, *_ = lengths_in_words(linkage, {}, system).split("; ")
    motion = "rotates fully" if turns else f"swings from {start:.6g} to {end:.6g} deg"
    return Playback(
        summary=f"{lengths}; the crank {motion}",
        record={
            "crank": 1e3 * sizes.crank,
            "pin": math.degrees(sizes.pin_angle),
            "offset": base[1],
            "slider": [base[0]] * ANGLES,
            "rod": [round(angle, 7) for angle in line_angles],
            "angles": [round(angle, 9) for angle in angles],
            "direction": 1,
            "perSecond": 1.0 / curves.seconds if curves.seconds else 0.0,
        },
        columns=[column for column in curves.columns if not column.key.endswith(("_x_N", "_y_N"))],
        marks=() if turns else (0.5 * ANGLES,),
        still=fixed_lever_shapes(machine, placed),
        moving=lever_parts(machine, placed),
        extent=extent,
        size=max(extent[2] - extent[0], extent[3] - extent[1]),
        words=_LEVER_TURN if turns else _LEVER,
    )
