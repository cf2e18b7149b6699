"""Lever and its pivoting cylinder over a swing: the JSON record, its text, curves and figure."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, Any

from ....model.linkage.linkage import Linkage
from ....model.machine.links_and_joints import RigidLink
from ....model.machine.mechanism import Mechanism
from ....model.swing.swing_types import LeverLaw
from ....model.turning_cylinder.swing_summary import LeverPoint, LeverSummary, summarise_swing
from ....objectives.kinds import (
    ANGLE,
    FORCE,
    LENGTH,
    POWER,
    PRESSURE,
    RATIO,
    SPEED,
    VOLUME_FLOW,
    Kind,
    name_and_kind_of_key,
)
from ...designs.design_curves import rows_of_lever_curves
from ...designs.display_units import convert_rows
from ...render.blocks import Block, NamedNumber, Text, named_number, number_list, sentence, value_from_record, words
from ..record_types import Keys, Note
from .request import LeverRequest, lever_request

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ....objectives.kinds import System

_TELESCOPIC = (
    "no single-stage cylinder is {longest:.6g} mm long open and {shortest:.6g} mm closed: its stroke is less than "
    "its closed length; move a pivot, reduce the swing, or use a telescopic cylinder"
)
_IDLE = "the cylinder never has to push or pull: nothing has weight or is accelerated; give a mass, or gravity"
_BUCKLING = (
    "buckling: Euler's formula, both ends pinned, for a steel bar as thick as the piston rod over its whole length"
)
_FULL_BORE = "pull pressure and retracting flow are based on the full bore, because no piston rod was given"
_POINTS = {
    "peak_push": FORCE,
    "peak_pull": FORCE,
    "least_transmission_angle": ANGLE,
    "peak_pin_force": FORCE,
    "peak_pivot_force": FORCE,
    "peak_cylinder_pivot_force": FORCE,
    "lever_angle_error": ANGLE,
    "peak_cylinder_speed": SPEED,
    "peak_power": POWER,
    "buckling_margin": RATIO,
}
"""Values with the lever angle and the cylinder length at which they occur."""
_LACKS = {
    "lever_angle_error": "null without tolerances",
    "peak_cylinder_speed": "null for a slow swing",
    "peak_power": "null for a slow swing",
    "buckling_margin": "null without a piston rod, and where the cylinder never pushes",
    "push_pressure": "null without a bore",
    "pull_pressure": "null without a bore",
    "extending_flow": "null without a bore, and for a slow swing",
    "retracting_flow": "null without a bore, and for a slow swing",
    "time_ratio": "null where the lever cannot rotate fully",
    "fitting_lesser": "null without closed length and stroke, and if no linkage fits them",
    "fitting_greater": "null without closed length and stroke, and if no linkage fits them",
    "duration": "null for a slow swing",
}


def _type_of(name: str) -> Any:
    return Annotated[float | None, Note(_LACKS[name])] if name in _LACKS else float


def _record_keys(names: Mapping[str, Kind]) -> dict[str, Any]:
    return {f"{name}{kind.metric.suffix}": _type_of(name) for name, kind in names.items()}


def _place_keys(name: str) -> dict[str, Any]:
    kind = Annotated[float | None, Note("null where the value is null")]
    return {f"{name}_at_lever_angle_deg": kind, f"{name}_at_length_mm": kind}


LeverNumbers = Annotated[
    dict[str, Any],
    Keys(
        "LeverNumbers",
        "A lever and the cylinder that moves it out and back.",
        {
            **_record_keys(
                {"crank": LENGTH, "frame": LENGTH, "frame_angle": ANGLE, "offset": LENGTH, "pin_angle": ANGLE}
            ),
            **_record_keys({"start_lever_angle": ANGLE, "end_lever_angle": ANGLE}),
            "law": LeverLaw,
            "duration_s": _type_of("duration"),
            **_record_keys({"start_length": LENGTH, "end_length": LENGTH, "travel": LENGTH, "extension_ratio": RATIO}),
            "single_stage": bool,
            **_record_keys({"push_at_start": FORCE, "push_at_end": FORCE}),
            **{
                key: type_
                for name, kind in _POINTS.items()
                for key, type_ in (_record_keys({name: kind}) | _place_keys(name)).items()
            },
            "dead_point_margin_deg": float,
            "work_out_J": float,
            "work_back_J": float,
            **_record_keys({"push_pressure": PRESSURE, "pull_pressure": PRESSURE}),
            **_record_keys({"extending_flow": VOLUME_FLOW, "retracting_flow": VOLUME_FLOW}),
            **_record_keys({"time_ratio": RATIO, "fitting_lesser": LENGTH, "fitting_greater": LENGTH}),
            "notes": Annotated[list[str], Note("which parts are included, omitted or impossible to build")],
        },
    ),
]


def compute_shared_options(
    mechanism: Mechanism, linkage: Linkage, *, cancelled: Any = None, request: LeverRequest | None = None, **inputs: Any
) -> dict[str, Any]:
    """Return the request that numbers, curves and figure share. inputs: by name, in SI, with `swing` and `words`."""
    return {"request": request or lever_request(mechanism, linkage, **inputs)}


def numbers(mechanism: Mechanism, _: Linkage, *, request: LeverRequest, **options: Any) -> LeverNumbers:
    """Return the numbers of a swing, ready for JSON.

    Raises `AssemblyError` if the linkage does not close, and `InputError` for a dead point within the swing or an
    unsuitable cylinder.
    """
    summary = summarise_swing(request.machine, request.swing, request.cylinder, request.errors)
    sizes, swing = request.machine.sizes, request.swing
    record: dict[str, Any] = {
        "crank_mm": 1e3 * sizes.crank,
        "frame_mm": 1e3 * sizes.frame,
        "frame_angle_deg": math.degrees(sizes.frame_angle),
        "offset_mm": 1e3 * sizes.offset,
        "pin_angle_deg": math.degrees(sizes.pin_angle),
        "start_lever_angle_deg": math.degrees(swing.start),
        "end_lever_angle_deg": math.degrees(swing.end),
        "law": swing.law,
        "duration_s": swing.duration,
        "start_length_mm": 1e3 * summary.lengths[0],
        "end_length_mm": 1e3 * summary.lengths[1],
        "travel_mm": 1e3 * abs(summary.lengths[1] - summary.lengths[0]),
        "extension_ratio": summary.extension_ratio,
        "single_stage": summary.suits_single_stage_cylinder,
        "push_at_start_N": summary.hold[0],
        "push_at_end_N": summary.hold[1],
    }
    points = (
        *(summary.push, summary.pull, summary.transmission, summary.pin, summary.pivot, summary.cylinder_pivot),
        *(summary.angle_error, summary.speed, summary.power, summary.buckling_margin),
    )
    for (name, kind), point in zip(_POINTS.items(), points, strict=True):
        record |= _value_and_place(name, kind, point)
    push_pressure, pull_pressure = summary.pressures or (None, None)
    extending, retracting = summary.flows or (None, None)
    lesser, greater = sorted(summary.fitting_sizes or ()) or (None, None)
    record |= {
        "dead_point_margin_deg": math.degrees(summary.dead_point_margin),
        "work_out_J": summary.energy_out,
        "work_back_J": summary.energy_back,
        **_metric_entry("push_pressure", PRESSURE, push_pressure),
        **_metric_entry("pull_pressure", PRESSURE, pull_pressure),
        **_metric_entry("extending_flow", VOLUME_FLOW, extending),
        **_metric_entry("retracting_flow", VOLUME_FLOW, retracting),
        "time_ratio": summary.time_ratio,
        **_metric_entry("fitting_lesser", LENGTH, lesser),
        **_metric_entry("fitting_greater", LENGTH, greater),
        "notes": _notes(mechanism, request, summary),
    }
    return record


def _metric_entry(name: str, kind: Kind, value: float | None) -> dict[str, float | None]:
    return {f"{name}{kind.metric.suffix}": None if value is None else kind.metric.factor * value + 0.0}


def _value_and_place(name: str, kind: Kind, point: LeverPoint | None) -> dict[str, float | None]:
    """Return a value with the lever angle and the length at which it occurs; no location for zero."""
    place = None if point is None or point.value == 0.0 else point
    return {
        **_metric_entry(name, kind, None if point is None else point.value),
        **_metric_entry(f"{name}_at_lever_angle", ANGLE, None if place is None else place.lever_angle),
        **_metric_entry(f"{name}_at_length", LENGTH, None if place is None else place.length),
    }


def _notes(mechanism: Mechanism, request: LeverRequest, summary: LeverSummary) -> list[str]:
    spring = request.machine.spring
    notes = [] if spring is None else [f"with the spring of the job: {spring.text}"]
    if not summary.suits_single_stage_cylinder:
        shortest, longest = sorted(1e3 * length for length in summary.lengths)
        notes.append(_TELESCOPIC.format(shortest=shortest, longest=longest))
    if summary.push.value == summary.pull.value == 0.0:
        notes.append(_IDLE)
    if summary.buckling_margin is not None:
        notes.append(_BUCKLING)
    has_annular_area = request.cylinder.bore is None or request.cylinder.rod is not None
    if not has_annular_area and (summary.pull.value > 0.0 or summary.flows is not None):
        notes.append(_FULL_BORE)
    absent = {
        "its loads": bool(mechanism.loads),
        "friction": mechanism.friction.acts,
        "masses of rod and slider": mechanism.slider_mass > 0.0 or mechanism.rod != RigidLink(mass=0.0),
    }
    left_out = [name for name, is_stated in absent.items() if is_stated]
    if left_out:
        notes.append(f"left out of the job, as a lever has neither rod nor slider: {', '.join(left_out)}")
    return notes


def blocks(record: Mapping[str, Any]) -> list[Block]:
    """Return the numbers of a metric record in human-readable form."""
    how = "slowly" if record["law"] == "slow" else f"by the law {record['law']}, {record['duration_s']:g} s each way"
    skipped = ("law", "duration_s", "single_stage", "notes")
    keys = [key for key in record if key not in skipped and "_at_lever" not in key and "_at_length" not in key]
    lines: list[NamedNumber] = []
    for key in keys:
        if record[key] is not None and not key.startswith("fitting"):
            name, value, _ = named_number(record, key)
            lines.append((name, value, _place_text(record, name_and_kind_of_key(key)[0])))
    found = number_list(f"Lever moved by a cylinder that turns, {how}", lines)
    if record["fitting_lesser_mm"] is not None:
        crank, frame = ("lesser", "greater") if record["crank_mm"] < record["frame_mm"] else ("greater", "lesser")
        found.append(
            sentence(
                "The swing uses the whole stroke of the cylinder if crank and frame are {crank} and {frame}.",
                crank=value_from_record(record, f"fitting_{crank}_mm"),
                frame=value_from_record(record, f"fitting_{frame}_mm"),
            )
        )
    return found


def _place_text(record: Mapping[str, Any], name: str) -> Text:
    if record.get(f"{name}_at_lever_angle_deg") is None:
        return ""
    return words(
        "at {angle}, cylinder {length} long",
        angle=value_from_record(record, f"{name}_at_lever_angle_deg", decimals=2),
        length=value_from_record(record, f"{name}_at_length_mm"),
    )


def curves(
    mechanism: Mechanism, linkage: Linkage, *, units: System, request: LeverRequest, **_: Any
) -> list[dict[str, Any]]:
    """Return rows of the curves from start to end, at evenly spaced times."""
    return convert_rows(rows_of_lever_curves(request.machine, request.swing), units)


def figure(
    mechanism: Mechanism, linkage: Linkage, *, units: System = "metric", request: LeverRequest, **_: Any
) -> Figure:
    """Return plots of force, length and transmission angle against lever angle, below the lever at both ends."""
    from ...figures.swing_figure import lever_figure

    return lever_figure(request.machine, request.swing, request.cylinder, units)
