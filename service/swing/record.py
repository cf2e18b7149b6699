"""A swing of one design: the record of JSON and its curves, with keys that carry their units."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ...model.linkage.linkage import Linkage
from ...model.machine.mechanism import Mechanism, Window
from ...model.swing.forces import JOINTS
from ...model.swing.over import At
from ...model.swing.summary import SwingSummary
from ...model.swing.swing import Swing
from ...objectives.kinds import ANGLE
from ..designs.swing_curves import POINTS, both_ways, drive_kind, driven, error_kind
from ..text.tables import plain

WITHOUT_LOADS = (
    "the drive is zero: no load acts and no mass weighs or is moved; "
    "give a JOB with a load, or with masses and gravity or a law of motion"
)
LOCKED = (
    "friction may lock the linkage {way}, first at a crank angle of {angle:.5g} deg: what drives it is not determined"
)
WINDOW = "the position error is that of the whole swing: during and part_of_stroke of [tolerances] do not limit it"
COASTS = "forces at the ends, where the speed jumps, are left out: the driver's acceleration is not stated there"


def swing_record(mechanism: Mechanism, found: SwingSummary) -> dict[str, Any]:
    """Return a swing in numbers, metric; null for what is undefined, and notes that say why."""
    swing, linkage = found.swing, found.linkage
    drive, error = drive_kind(swing).metric, error_kind(swing).metric
    record: dict[str, Any] = {
        **{f"{name}_mm": 1e3 * float(getattr(linkage, name)) for name in ("crank", "rod", "offset")},
        "branch": linkage.branch,
        "driver": swing.driver,
        "law": swing.law,
        "duration_s": swing.duration,
        "start_crank_angle_deg": math.degrees(swing.start),
        "end_crank_angle_deg": math.degrees(swing.end),
        "swing_angle_deg": math.degrees(found.swing_angle),
        "start_slider_position_mm": 1e3 * found.slider_positions[0],
        "end_slider_position_mm": 1e3 * found.slider_positions[1],
        "travel_mm": 1e3 * found.travel,
        **_at("least_transmission_angle_deg", found.least_transmission, ANGLE.metric.factor),
        **_at(f"peak_drive{drive.suffix}", found.peak_drive, drive.factor, way=True),
    }
    for end, pair in (("start", found.drive_start), ("end", found.drive_end)):
        for way, value in zip(("forth", "back"), pair, strict=True):
            record[f"drive_at_{end}_{way}{drive.suffix}"] = plain(drive.factor * value + 0.0)
    record |= {
        "holds_by_friction": found.holds,
        "energy_forth_J": plain(found.energy_forth),
        "energy_back_J": plain(found.energy_back),
        "stored_energy_J": plain(found.stored),
        "efficiency": found.efficiency,
    }
    if found.peak_power is not None:
        record |= _at("peak_power_W", found.peak_power, 1.0, way=True)
    if found.position_error is not None:
        record |= _at(f"{driven(swing)}_position_error{error.suffix}", found.position_error, error.factor)
    return record | {"notes": _notes(mechanism, found)}


def _at(key: str, at: At, factor: float, *, way: bool = False) -> dict[str, Any]:
    """Return a value and its places; the key without its unit begins those of the places."""
    stem = key.rpartition("_")[0]
    return {
        key: plain(factor * at.value + 0.0),
        **({f"{stem}_way": "back" if at.back else "forth"} if way else {}),
        f"{stem}_at_crank_angle_deg": math.degrees(at.crank_angle),
        f"{stem}_at_slider_position_mm": 1e3 * at.slider_position,
    }


def _notes(mechanism: Mechanism, found: SwingSummary) -> list[str]:
    notes = []
    if found.locked is not None:
        way = "on the way back" if found.locked.back else "on the way forth"
        notes.append(LOCKED.format(way=way, angle=math.degrees(found.locked.crank_angle)))
    elif found.peak_drive.value == 0.0:
        notes.append(WITHOUT_LOADS)
    if found.position_error is not None and mechanism.tolerances.window != Window():
        notes.append(WINDOW)
    if found.swing.law == "constant":
        notes.append(COASTS)
    return notes


def swing_rows(mechanism: Mechanism, linkage: Linkage, swing: Swing) -> list[dict[str, Any]]:
    """Return a row for each place of both ways, metric: time, motion, drive, power, joint forces, errors."""
    drive, error = drive_kind(swing).metric, error_kind(swing).metric
    rows = []
    for way, curves in zip(("forth", "back"), both_ways(mechanism, linkage, swing), strict=True):
        columns: dict[str, Any] = {
            "time_s": curves.share * (swing.duration or np.nan),
            "crank_angle_deg": np.degrees(curves.crank_angle),
            "slider_position_mm": 1e3 * curves.slider_position,
            "slider_velocity_m_s": curves.slider_velocity,
            "slider_acceleration_m_s2": curves.slider_acceleration,
            f"drive{drive.suffix}": drive.factor * curves.drive,
            "power_W": curves.power,
            "load_N": curves.load,
            "transmission_angle_deg": np.degrees(curves.driven_angle),
            f"{driven(swing)}_position_error{error.suffix}": error.factor * curves.driven_error,
            **{f"{name}_N": getattr(curves, name) for name in JOINTS},
        }
        if swing.duration is None:
            for name in ("time_s", "slider_velocity_m_s", "slider_acceleration_m_s2", "power_W"):
                del columns[name]
        rows += [{"way": way} | {name: plain(values[i]) for name, values in columns.items()} for i in range(POINTS)]
    return rows
