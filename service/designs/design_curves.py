"""Curves of a design that rotates fully or swings: as CSV, and at evenly spaced points over its cycle."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...model.arrays import Array
from ...model.cycle.crank_speed import turn_time
from ...model.linkage.linkage import Linkage
from ...model.machine.cylinders_and_turns import cycle_turns
from ...model.machine.mechanism import Mechanism
from ...model.swing.swing import Swing, require_swing, swing_between_crank_angles
from ...model.turning_cylinder.cylinder_and_pin_forces import LeverCurves, LeverMachine, LeverSwing, lever_curves
from ...model.turning_cylinder.lever_of_design import (
    lever_machine,
    lever_swing,
    movable_lever_linkage,
    state_at_crank_angles,
)
from ...objectives.kinds import System
from ...objectives.tables.cycle_curves import cycle_curves, even_angles
from ...objectives.tables.swing_curves import (
    POINTS,
    curves_at_even_times,
    curves_of_both_strokes,
    defined_curves,
    force_components,
    motion_and_drive_curves,
    require_even_point_count,
)
from ..runs.result import curves_csv, json_ready, rows_of_columns
from .display_units import convert_rows
from .stored_designs import StoredDesign

LEAST, MOST = 4, 3600
_ANGLES = 360
_MOTION = (
    *("crank_angle", "slider_position", "slider_velocity", "slider_acceleration", "slider_jerk"),
    *("rod_angle", "transmission_angle"),
)
_LEFT_OUT = ("slider_jerk", "rod_angle", "power")


@dataclass(frozen=True)
class CurveColumn:
    """Curve. key: key in JSON. values: values over the crank angles; NaN where friction leaves it undetermined."""

    key: str
    title: str
    unit: str
    values: list[float]


def cycle_table(mechanism: Mechanism, linkage: Linkage, *, angles: int = 360, turns: int = 1) -> list[CurveColumn]:
    """Return the curves of one fully rotating linkage at evenly spaced crank angles from 0 deg, in metric units.

    turns: number of crank revolutions that the angles span. The curves are those of `objectives.tables.cycle_curves`;
    raises `InputError` for too few or too many angles.
    """

    curves = cycle_curves(mechanism, linkage, turns * even_angles(angles, MOST))
    return [
        CurveColumn(curve.field, curve.title, metric.symbol, (metric.factor * curve.values).tolist())
        for curve, metric in ((curve, curve.kind.metric) for curve in curves)
        if curve.name not in _LEFT_OUT
    ]


def cycle_csv(mechanism: Mechanism, linkage: Linkage, system: System = "metric", *, machine: bool = True) -> str:
    """Return a row per degree of a cycle, with a column for each curve of `cycle_curves`; empty where undefined.

    machine: whether masses, loads and tolerances are known; otherwise only the motion is returned.
    """

    turns = cycle_turns(mechanism)
    curves = cycle_curves(mechanism, linkage, turns * even_angles(turns * _ANGLES))
    columns = {
        curve.field: (curve.kind.metric.factor * curve.values).tolist()
        for curve in curves
        if machine or curve.name in _MOTION
    }
    return curves_csv(convert_rows(rows_of_columns(columns), system))


@dataclass(frozen=True)
class DesignCurves:
    """Curves of a design at evenly spaced points over its cycle. turns: crank revolutions per cycle; 0 for a swing.

    seconds: duration of the cycle; None if there is no speed, and for a quasi-static swing. centres: crank angles of
    the inner and outer dead centres, deg; None for a swing. slider_ends: slider positions there, or at both ends of a
    swing, mm.
    """

    turns: int
    seconds: float | None
    centres: tuple[float, float] | None
    slider_ends: tuple[float, float]
    columns: list[CurveColumn]


def design_curves(design: StoredDesign, count: int) -> DesignCurves:
    """Return the curves at `count` crank angles from 0 deg, or evenly spaced times of a swing back and forth.

    A 720 deg cycle includes both revolutions. For a swing, the number of points is even; the first point is the start
    and the middle one the end. Raises `InputError` for too few or too many points, and the errors of the design's
    motion.
    """
    if design.part.motion is None:
        turns = cycle_turns(design.mechanism)
        inner, outer = (math.degrees(float(angle)) for angle in design.linkage.dead_centre_angles)
        seconds = turns * turn_time(design.mechanism) if design.mechanism.speed else None
        columns = cycle_table(design.mechanism, design.linkage, angles=count, turns=turns)
        at_inner, at_outer = (1e3 * float(x) for x in design.linkage.dead_centres)
        return DesignCurves(turns, seconds, (inner, outer), (at_inner, at_outer), columns)
    if design.mechanism.lever is not None:
        count = require_even_point_count(count, MOST)
        return lever_design_curves(design.mechanism, design.linkage, design.part.motion, count)
    linkage = require_swing(design.mechanism, design.linkage, design.part.motion)
    swing = swing_between_crank_angles(design.mechanism, linkage, design.part.motion)
    ways = curves_at_even_times(design.mechanism, linkage, swing, require_even_point_count(count, MOST))
    start, end = (1e3 * float(ways[0].slider_position[place]) for place in (0, -1))  # both on the forward stroke
    return DesignCurves(
        0,
        None if swing.duration is None else 2.0 * swing.duration,
        None,
        (start, end),
        [
            CurveColumn(
                curve.field,
                curve.title,
                curve.kind.metric.symbol,
                np.concatenate([curve.values_in(way) for way in ways]).tolist(),
            )
            for curve in defined_curves(design.mechanism, swing)
        ],
    )


def rows_of_swing_curves(mechanism: Mechanism, linkage: Linkage, swing: Swing) -> list[dict[str, Any]]:
    """Return a row for each point of both strokes, metric: time, motion, drive, power, joint forces, errors."""
    all_curves = (*motion_and_drive_curves(swing), *force_components())
    rows = []
    for way, curves in zip(("forth", "back"), curves_of_both_strokes(mechanism, linkage, swing), strict=True):
        time = {} if swing.duration is None else {"time_s": swing.duration * curves.share}
        columns = time | {curve.field: curve.values_in(curves) for curve in all_curves}
        plain = {name: json_ready(values.tolist(), gaps=True) for name, values in columns.items()}
        rows += [{"way": way} | {name: values[i] for name, values in plain.items()} for i in range(POINTS)]
    return rows


def lever_design_curves(mechanism: Mechanism, linkage: Linkage, motion: Swing, count: int) -> DesignCurves:
    """Return the curves of a lever at even times, out and back: the same places and forces, but opposite speeds."""
    linkage = movable_lever_linkage(mechanism, linkage, motion)
    machine, _ = lever_machine(mechanism, linkage, motion)
    if motion.of_full_turn:
        speed = mechanism.speed
        angles: Array = np.arange(count, dtype=np.float64) * math.copysign(2.0 * np.pi / count, speed)
        columns = crank_turn_columns(mechanism, linkage, angles)
        least, greatest = machine.sizes.closable_length_range
        return DesignCurves(
            0,
            2.0 * np.pi / abs(speed) if speed else None,
            None,
            (1e3 * least, 1e3 * greatest),
            [CurveColumn(key, title, unit, values.tolist()) for key, title, unit, values in columns],
        )
    swing = lever_swing(mechanism, linkage, motion)
    share = np.arange(count, dtype=np.float64) * (2.0 / count)
    columns = lever_columns(lever_curves(machine, swing, np.minimum(share, 2.0 - share)))
    way = np.where(share <= 1.0, 1.0, -1.0)
    start, end = (1e3 * float(machine.sizes.cylinder_length(at)) for at in (swing.start, swing.end))
    return DesignCurves(
        0,
        None if swing.duration is None else 2.0 * swing.duration,
        None,
        (start, end),
        [
            CurveColumn(key, title, unit, (way * values if key == "cylinder_speed_m_s" else values).tolist())
            for key, title, unit, values in columns
            if swing.duration is not None or key != "cylinder_speed_m_s"
        ],
    )


def lever_columns(curves: LeverCurves) -> list[tuple[str, str, str, Array]]:
    """Return key, title, unit and metric values of the curves of a lever."""
    columns = [
        ("lever_angle_deg", "lever angle", "deg", np.degrees(curves.lever_angle)),
        ("length_mm", "cylinder length", "mm", 1e3 * curves.length),
        ("cylinder_angle_deg", "cylinder angle", "deg", np.degrees(curves.cylinder_angle)),
        ("cylinder_speed_m_s", "cylinder speed", "m/s", curves.speed),
        ("push_N", "push without seal friction", "N", curves.push),
        ("transmission_angle_deg", "angle between cylinder and lever", "deg", np.degrees(curves.transmission)),
    ]
    forces = {
        "pin": ("lever pin force", curves.pin),
        "pivot": ("lever pivot force", curves.pivot),
        "cylinder_pivot": ("cylinder pivot force", curves.cylinder_pivot),
    }
    for name, (title, force) in forces.items():
        components = zip("xy", (force.real, force.imag), strict=True)
        columns += [(f"{name}_{axis}_N", f"{title}, {axis}", "N", part) for axis, part in components]
    return columns


def rows_of_lever_curves(machine: LeverMachine, swing: LeverSwing) -> list[dict[str, Any]]:
    """Return a row for each point of a lever's swing from start to end, metric, at even times."""
    found = lever_curves(machine, swing, np.linspace(0.0, 1.0, POINTS))
    time = {} if swing.duration is None else {"time_s": (swing.duration * found.share).tolist()}
    return rows_of_columns(time | {key: values.tolist() for key, _, _, values in lever_columns(found)})


def crank_turn_columns(mechanism: Mechanism, linkage: Linkage, angles: Array) -> list[tuple[str, str, str, Array]]:
    """Return key, title, unit and metric values of each curve of a turning arm at crank angles, rad."""
    found, speed = state_at_crank_angles(mechanism, linkage, angles), mechanism.speed
    columns = [
        ("crank_angle_deg", "crank angle", "deg", np.degrees(angles)),
        ("length_mm", "length along the arm", "mm", 1e3 * found.length),
        ("arm_angle_deg", "arm angle", "deg", np.degrees(np.unwrap(np.arctan2(found.line[1], found.line[0])))),
        ("arm_speed_ratio", "arm speed over crank speed", "", found.turn_1),
        ("arm_acceleration_ratio", "arm acceleration over squared crank speed", "", found.turn_2),
        ("torque_Nm", "torque on the crank", "N m", found.torque),
    ]
    if speed:
        columns.append(("cylinder_speed_m_s", "speed along the arm", "m/s", speed * found.length_1))
    if speed and np.any(found.ram_1):
        columns.append(("ram_speed_m_s", "speed of the ram", "m/s", speed * found.ram_1))
    names = {"pin": "crank pin force", "pivot": "crank pivot force", "cylinder_pivot": "arm pivot force"}
    for name, title in names.items():
        forces = zip("xy", getattr(found, name), strict=True)
        columns += [(f"{name}_{axis}_N", f"{title}, {axis}", "N", force) for axis, force in forces]
    return columns


def rows_of_crank_turn_curves(mechanism: Mechanism, linkage: Linkage) -> list[dict[str, Any]]:
    """Return a metric row for each crank angle of a full turn; speeds and forces are at the crank speed."""
    angles = np.linspace(0.0, 2.0 * np.pi, _ANGLES, endpoint=False)
    columns = crank_turn_columns(mechanism, linkage, angles)
    return rows_of_columns({key: values.tolist() for key, _, _, values in columns})


def design_csv(design: StoredDesign, system: System = "metric") -> str:
    """Return the curves as CSV: `cycle_csv`, both strokes of a swing, or the travel or turn of a lever."""
    if design.part.motion is None:
        return cycle_csv(design.mechanism, design.linkage, system)
    if design.mechanism.lever is not None:
        if design.part.motion.of_full_turn:
            return curves_csv(convert_rows(rows_of_crank_turn_curves(design.mechanism, design.linkage), system))
        machine, _ = lever_machine(design.mechanism, design.linkage, design.part.motion)
        swing = lever_swing(design.mechanism, design.linkage, design.part.motion)
        return curves_csv(convert_rows(rows_of_lever_curves(machine, swing), system))
    return curves_csv(convert_rows(rows_of_swing_curves(design.mechanism, design.linkage, design.part.motion), system))
