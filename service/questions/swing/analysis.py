"""Swing of one design: the JSON record, its text, and its curves, with units in the keys."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, Any, Literal, NotRequired

from ....model.linkage.dimensions import DIMENSIONS
from ....model.linkage.linkage import Linkage
from ....model.machine.mechanism import Branch, Mechanism, Window
from ....model.swing.request_and_summary import SwingRequest, SwingSummary, resolve_swing, summarise_swing
from ....model.swing.swing import Swing
from ....model.swing.swing_cycle import SwingCycle, SwingPoint
from ....model.swing.swing_types import Driver, Law, Side
from ....objectives.kinds import (
    ANGLE,
    ANGULAR_ACCELERATION,
    ANGULAR_SPEED,
    FORCE,
    LENGTH,
    POWER,
    TORQUE,
    name_and_kind_of_key,
)
from ....objectives.tables.cycle_curves import KINDS
from ....objectives.tables.swing_curves import (
    driven_side_name,
    force_magnitudes,
    kind_of_drive_effort,
    kind_of_driven_side_error,
    motion_and_drive_curves,
)
from ...designs.design_curves import rows_of_swing_curves
from ...designs.display_units import convert_rows
from ...render.blocks import Block, NamedNumber, Text, heading, number_list, value_from_record, words
from ...render.extremes_table import extremes_table
from ...text.tables import finite_or_none
from ..record_types import Keys, Note, keys_of_kinds

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ....objectives.kinds import System

WITHOUT_LOADS = (
    "the drive is zero: there is no load, weight or inertia; give a JOB with a load, or with masses and "
    "either gravity or a motion law"
)
LOCKED = "friction may lock the linkage {way}, first at a crank angle of {angle:.5g} deg: the drive is undefined"
WINDOW = "the position error is that of the whole swing: during and part_of_stroke in [tolerances] are ignored"
COASTS = "forces at the ends are omitted: the speed jumps there, and the driver's acceleration is undefined"
_TITLES = {
    "start_crank_angle": "crank angle at the start",
    "end_crank_angle": "crank angle at the end",
    "start_slider_position": "slider position at the start",
    "end_slider_position": "slider position at the end",
    "drive_at_start_forth": "drive at the start, forward stroke",
    "drive_at_start_back": "drive at the start, return stroke",
    "drive_at_end_forth": "drive at the end, forward stroke",
    "drive_at_end_back": "drive at the end, return stroke",
    "energy_forth": "drive energy, forward stroke",
    "energy_back": "drive energy, return stroke",
    "stored_energy": "stored in the forward stroke, without friction",
}


_Known = Annotated[float | None, Note("null where friction may lock the linkage")]
_Way = Annotated[Literal["forth", "back"] | None, Note("null where the value is null")]
_Place = Annotated[float | None, Note("null where the value is null, and for a constant curve")]
_ENDS = [f"drive_at_{end}_{way}" for end in ("start", "end") for way in ("forth", "back")]
_DRIVES = (TORQUE, FORCE)  # units of the crank and of the slider
_PLACES = {"at_crank_angle_deg": _Place, "at_slider_position_mm": _Place}
_KINDS = (*KINDS, ANGULAR_SPEED, ANGULAR_ACCELERATION)


def _location_keys(name: str, *, way: bool = True) -> dict[str, Any]:
    """Return the keys for the location of a value."""
    return {f"{name}_{place}": kind for place, kind in (_PLACES | ({"way": _Way} if way else {})).items()}


def _optional_keys(keys: dict[str, Any]) -> dict[str, Any]:
    return {key: NotRequired[kind] for key, kind in keys.items()}


_CURVE = {
    "title": str,
    **keys_of_kinds(("least", "greatest"), _KINDS),
    **_location_keys("least"),
    **_location_keys("greatest"),
}
_Curve = Annotated[
    dict[str, Any], Keys("SwingExtremes", "Minimum and maximum of a curve over both strokes.", _CURVE, 9)
]
SwingNumbers = Annotated[
    dict[str, Any],
    Keys(
        "SwingNumbers",
        "A swing back and forth, driven by a torque on the crank or a force on the slider.",
        {
            **{f"{name}_mm": float for name in DIMENSIONS},
            "branch": Branch,
            "driver": Driver,
            "law": Law,
            "duration_s": Annotated[float | None, Note("of one stroke; null for a slow swing")],
            **{f"{end}_crank_angle_deg": float for end in ("start", "end")},
            "swing_angle_deg": float,
            **{f"{end}_slider_position_mm": float for end in ("start", "end")},
            "travel_mm": float,
            "least_transmission_angle_deg": float,
            **_location_keys("least_transmission_angle", way=False),
            **keys_of_kinds(("peak_drive",), _DRIVES),
            **_location_keys("peak_drive"),
            **keys_of_kinds(_ENDS, _DRIVES),
            "holds_by_friction": bool,
            "energy_forth_J": _Known,
            "energy_back_J": _Known,
            "stored_energy_J": _Known,
            "efficiency": Annotated[float | None, Note("null where neither stroke is driven")],
            "peak_power_W": NotRequired[_Known],
            **_optional_keys(_location_keys("peak_power")),
            **keys_of_kinds(("slider_position_error",), (LENGTH,)),
            **keys_of_kinds(("crank_position_error",), (ANGLE,)),
            **_optional_keys(_location_keys("slider_position_error", way=False)),
            **_optional_keys(_location_keys("crank_position_error", way=False)),
            "extremes": Annotated[dict[str, _Curve], Note("by curve")],
            "notes": Annotated[list[str], Note("undefined or omitted values, with reasons")],
        },
    ),
]


def numbers(mechanism: Mechanism, linkage: Linkage, **options: Any) -> SwingNumbers:
    """Return the numbers of a swing, ready for JSON. options: inputs, in SI, with `swing` and `words`.

    Raises `AssemblyError` if the linkage does not close, and the errors of `asked_swing`.
    """
    machine, swing = _swing_from_inputs(mechanism, **options)
    return swing_record(machine, summarise_swing(machine, linkage, swing))


def _swing_from_inputs(
    mechanism: Mechanism,
    *,
    swing: Swing | None,
    words: Mapping[str, str] | None = None,
    crank_side: Side | None = None,
    **inputs: Any,
) -> tuple[Mechanism, Swing]:
    return resolve_swing(mechanism, swing, SwingRequest(side=crank_side, **inputs), words)


def curves(mechanism: Mechanism, linkage: Linkage, *, units: System, **options: Any) -> list[dict[str, Any]]:
    """Return rows of the curves for both strokes."""
    machine, swing = _swing_from_inputs(mechanism, **options)
    return convert_rows(rows_of_swing_curves(machine, linkage, swing), units)


def figure(mechanism: Mechanism, linkage: Linkage, *, units: System, **options: Any) -> Figure:
    """Return the curves of both strokes below the machine."""
    from ...figures.swing_figure import swing_figure

    machine, swing = _swing_from_inputs(mechanism, **options)
    return swing_figure(machine, linkage, swing, units)


def swing_record(mechanism: Mechanism, summary: SwingSummary) -> SwingNumbers:
    """Return the metric numbers of a swing; null if undefined, with notes that give the reason."""
    swing, linkage = summary.swing, summary.linkage
    drive, error = kind_of_drive_effort(swing).metric, kind_of_driven_side_error(swing).metric
    record: dict[str, Any] = {
        **{f"{name}_mm": 1e3 * float(getattr(linkage, name)) for name in ("crank", "rod", "offset")},
        "branch": linkage.branch,
        "driver": swing.driver,
        "law": swing.law,
        "duration_s": swing.duration,
        "start_crank_angle_deg": math.degrees(swing.start),
        "end_crank_angle_deg": math.degrees(swing.end),
        "swing_angle_deg": math.degrees(summary.swing_angle),
        "start_slider_position_mm": 1e3 * summary.slider_positions[0],
        "end_slider_position_mm": 1e3 * summary.slider_positions[1],
        "travel_mm": 1e3 * summary.travel,
        **_value_and_location("least_transmission_angle_deg", summary.least_transmission, ANGLE.metric.factor),
        **_value_and_location(f"peak_drive{drive.suffix}", summary.peak_drive, drive.factor, way=True),
    }
    for end, pair in (("start", summary.drive_start), ("end", summary.drive_end)):
        for way, value in zip(("forth", "back"), pair, strict=True):
            record[f"drive_at_{end}_{way}{drive.suffix}"] = finite_or_none(drive.factor * value + 0.0)
    record |= {
        "holds_by_friction": summary.holds,
        "energy_forth_J": finite_or_none(summary.energy_forward),
        "energy_back_J": finite_or_none(summary.energy_back),
        "stored_energy_J": finite_or_none(summary.stored),
        "efficiency": summary.efficiency,
    }
    if summary.peak_power is not None:
        record |= _value_and_location("peak_power_W", summary.peak_power, 1.0, way=True)
    if summary.position_error is not None:
        record |= _value_and_location(
            f"{driven_side_name(swing)}_position_error{error.suffix}", summary.position_error, error.factor
        )
    return record | {"extremes": _curve_extremes(mechanism, summary), "notes": _swing_notes(mechanism, summary)}


def _curve_extremes(mechanism: Mechanism, summary: SwingSummary) -> dict[str, Any]:
    """Return title, minimum and maximum of each curve over both strokes, with locations; null if undefined.

    Zero loads, errors without tolerances and forces without a cause are omitted.
    """
    strokes = SwingCycle(mechanism, summary.linkage, summary.swing)
    entries: dict[str, Any] = {}
    for curve in (*motion_and_drive_curves(summary.swing), *force_magnitudes()):
        least, greatest = strokes.range_of_curve(curve.attribute)
        acts = curve.kind not in (FORCE, TORQUE, POWER) and curve.attribute != "driven_error"
        if curve.name == "crank_angle" or (not acts and least.value == greatest.value == 0.0):
            continue
        entry: dict[str, Any] = {"title": curve.title}
        for word, at in (("least", least), ("greatest", greatest)):
            fields = _value_and_location(
                f"{word}{curve.kind.metric.suffix}", at, curve.kind.metric.factor, way=True, stem=word
            )
            # Near a position where friction locks, forces grow without bound.
            is_bounded = summary.locked is None or curve.kind not in (FORCE, TORQUE, POWER)
            entry |= fields if is_bounded and math.isfinite(at.value) else dict.fromkeys(fields)
        entries[curve.name] = entry
    return entries


def _value_and_location(
    key: str, at: SwingPoint, factor: float, *, way: bool = False, stem: str = ""
) -> dict[str, Any]:
    """Return a value and its location. stem: prefix of the location's keys; the value's key without unit if empty."""
    stem = stem or key.rpartition("_")[0]
    return {
        key: finite_or_none(factor * at.value + 0.0),
        **({f"{stem}_way": "back" if at.back else "forth"} if way else {}),
        f"{stem}_at_crank_angle_deg": math.degrees(at.crank_angle),
        f"{stem}_at_slider_position_mm": 1e3 * at.slider_position,
    }


def _swing_notes(mechanism: Mechanism, summary: SwingSummary) -> list[str]:
    notes = []
    if summary.locked is not None:
        way = "on the return stroke" if summary.locked.back else "on the forward stroke"
        notes.append(LOCKED.format(way=way, angle=math.degrees(summary.locked.crank_angle)))
    elif summary.peak_drive.value == 0.0:
        notes.append(WITHOUT_LOADS)
    if summary.position_error is not None and mechanism.tolerances.window != Window():
        notes.append(WINDOW)
    if summary.swing.law == "constant":
        notes.append(COASTS)
    return notes


def swing_title(record: Mapping[str, Any]) -> str:
    """Return drive and motion law of the swing in a record."""
    how = "slowly" if record["law"] == "slow" else f"{record['law']} law, {record['duration_s']:g} s per stroke"
    return f"Swing driven at the {record['driver']}, {how}"


def swing_numbers(record: Mapping[str, Any]) -> list[NamedNumber]:
    """Return the numbers of a metric record except its extremes, each with its location."""
    lines: list[NamedNumber] = []
    for key, value in record.items():
        name, _ = name_and_kind_of_key(key)
        is_excluded = isinstance(value, str | list | dict | bool) or key == "duration_s"
        if not is_excluded and "_at_crank_angle" not in name and "_at_slider_position" not in name:
            lines.append(
                (
                    _TITLES.get(name, name.replace("_", " ")),
                    value_from_record(record, key),
                    _location_text(record, name),
                )
            )
    return [*lines, ("held by friction alone, everywhere", "yes" if record["holds_by_friction"] else "no", "")]


def blocks(record: Mapping[str, Any]) -> list[Block]:
    """Return the numbers of a metric record, and the extremes of its curves, in human-readable form."""
    title = heading("Extreme values over both strokes, with continuous crank angles")
    return [*number_list(swing_title(record), swing_numbers(record)), title, extremes_table(record["extremes"])]


def _location_text(record: Mapping[str, Any], name: str) -> Text:
    if record.get(f"{name}_at_crank_angle_deg") is None:
        return ""
    return words(
        "{way}at {angle}, slider at {position}",
        way=f"{record[f'{name}_way']}, " if f"{name}_way" in record else "",
        angle=value_from_record(record, f"{name}_at_crank_angle_deg", decimals=2),
        position=value_from_record(record, f"{name}_at_slider_position_mm"),
    )
