"""Minimum and maximum of every curve of one design over the revolution, and differences between the strokes."""

import math
from typing import Annotated, Any, NotRequired

import numpy as np

from ....model.cycle.self_locking import locking_reason
from ....model.cycle.stroke_times import scaled_stroke_times
from ....model.linkage.linkage import Linkage
from ....model.machine.cylinders_and_turns import cycle_turns
from ....model.machine.mechanism import Mechanism
from ....objectives.kinds import RATIO, SPEED, TIME
from ....objectives.machine_needs import ONE_TIMING
from ....objectives.tables.curve_extremes import (
    CurveExtremes,
    Extreme,
    crank_angles_of_cuts,
    curve_extremes,
    defined_curves,
)
from ....objectives.tables.cycle_curves import KINDS
from ...figures.panel_figure import Line, Panel, PanelFigure, crank_angle_panel, sampled_crank_angles
from ...render.blocks import (
    Block,
    NamedNumber,
    Text,
    Value,
    dimensions_text,
    heading,
    joined,
    number_list,
    sentence,
    value_from_record,
    words,
)
from ...render.extremes_table import extremes_table
from ...render.numerals import format_number
from ...text.tables import finite_or_none
from ..record_types import Keys, Note, Record, keys_of_kinds

_PANELS = ("slider_position", "slider_velocity", "slider_acceleration", "torque", "crank_pin", "load")
_STROKES = ("outward", "inward")
_Place = Annotated[float | None, Note("null for a constant curve, and where friction leaves the curve undetermined")]
_OfAll = Annotated[float | None, Note("null where cylinders have different ones")]
_PLACES = ("at_crank_angle_deg", "at_slider_position_mm")
_CURVE = {
    "title": str,
    **keys_of_kinds(("least", "greatest"), KINDS),
    **{f"{word}_{place}": _Place for word in ("least", "greatest") for place in _PLACES},
}
_STROKE = {
    "crank_angle_deg": float,
    "duration_s": NotRequired[_OfAll],
    "greatest_speed_m_s": NotRequired[float],
    **{f"greatest_speed_{place}": NotRequired[_Place] for place in _PLACES},
}
_Stroke = Annotated[dict[str, Any], Keys("StrokeNumbers", "A stroke of the slider.", _STROKE)]
_OF_STROKES = {
    **dict.fromkeys(_STROKES, _Stroke),
    "angle_ratio": float,
    "duration_ratio": _OfAll,
    "duration_difference_s": NotRequired[_OfAll],
    "greatest_speed_ratio": NotRequired[float],
    "greatest_speed_difference_m_s": NotRequired[float],
}
_Curve = Annotated[dict[str, Any], Keys("CurveExtremes", "Minimum and maximum of a curve.", _CURVE, 7)]


class Extremes(Record):
    """Extremes of each curve over the revolution, and both strokes; ratios and differences: outward to inward."""

    curves: dict[str, _Curve]
    """Curves by name, if the machine defines them."""
    strokes: Annotated[dict[str, Any], Keys("Strokes", "Both strokes, compared.", _OF_STROKES)]
    undefined_because: NotRequired[str]
    """Why curves are undetermined; absent if all are determined."""


def numbers(mechanism: Mechanism, linkage: Linkage) -> Extremes:
    """Return the extremes of each curve, by name, and the strokes: durations, maximum speeds and ratios.

    A curve is omitted if the masses, loads or speed that it needs are missing. Values that friction leaves undetermined
    are None, with the reason, as are crank angle and slider position for a constant curve. Ratios and differences are
    those of the outward stroke relative to the inward stroke.
    """
    extremes = {curve.name: curve for curve in curve_extremes(mechanism, linkage)}
    locks = locking_reason(mechanism.friction, linkage)
    record: Extremes = {
        "curves": {name: _curve_entry(curve) for name, curve in extremes.items()},
        "strokes": _stroke_numbers(mechanism, linkage, extremes.get("slider_velocity")),
    }
    if locks:
        record["undefined_because"] = f"friction locks this design: {locks}"
    return record


def _curve_entry(curve: CurveExtremes) -> dict[str, Any]:
    entry: dict[str, Any] = {"title": curve.title}
    for word, extreme in (("least", curve.least), ("greatest", curve.greatest)):
        entry[f"{word}{curve.kind.metric.suffix}"] = finite_or_none(curve.kind.metric.factor * extreme.value)
        entry |= _location_fields(word, extreme)
    return entry


def _location_fields(word: str, extreme: Extreme) -> dict[str, float | None]:
    return {
        f"{word}_at_crank_angle_deg": finite_or_none(math.degrees(extreme.crank_angle)),
        f"{word}_at_slider_position_mm": finite_or_none(1e3 * extreme.slider_position),
    }


def _stroke_numbers(mechanism: Mechanism, linkage: Linkage, velocity: CurveExtremes | None) -> dict[str, Any]:
    """Return crank angle, duration and maximum slider speed of both strokes, with ratios and differences.

    Durations are None for several cylinders with a speed profile, since they differ between cylinders.
    """
    inner, outer = (float(angle) for angle in linkage.dead_centre_angles)
    outward = (mechanism.direction * (outer - inner)) % (2.0 * math.pi)
    angles = {"outward": outward, "inward": 2.0 * math.pi - outward}
    strokes: dict[str, dict[str, Any]] = {name: {"crank_angle_deg": math.degrees(angles[name])} for name in _STROKES}
    times = (
        scaled_stroke_times(mechanism, linkage.crank, linkage.rod, linkage.offset)
        if ONE_TIMING.is_met(mechanism)
        else None
    )
    record: dict[str, Any] = {
        **strokes,
        "angle_ratio": angles["outward"] / angles["inward"],
        "duration_ratio": None if times is None else float(times.outward_to_inward_ratio),
    }
    if velocity is None:
        return record
    # Outward is along +x on the open branch, along -x on the crossed branch.
    ends = (velocity.greatest, velocity.least) if mechanism.branch == "open" else (velocity.least, velocity.greatest)
    durations = [None if times is None else float(getattr(times, name)) / abs(mechanism.speed) for name in _STROKES]
    for name, extreme, duration in zip(_STROKES, ends, durations, strict=True):
        strokes[name] |= {
            "duration_s": duration,
            "greatest_speed_m_s": abs(extreme.value),
            **_location_fields("greatest_speed", extreme),
        }
    fast, back = (strokes[name]["greatest_speed_m_s"] for name in _STROKES)
    outward_s, inward_s = durations
    return record | {
        "duration_difference_s": None if outward_s is None or inward_s is None else outward_s - inward_s,
        "greatest_speed_ratio": fast / back,
        "greatest_speed_difference_m_s": fast - back,
    }


def blocks(numbers: Extremes) -> list[Block]:
    """Return a line for each curve, and the strokes."""
    result_blocks: list[Block] = [
        heading("Extreme values over the turn, with continuous crank angles"),
        extremes_table(numbers["curves"]),
    ]
    if "undefined_because" in numbers:
        result_blocks.append(sentence("Undefined: {reason}", reason=numbers["undefined_because"]))
    strokes, lines = numbers["strokes"], list[NamedNumber]()
    for name in _STROKES:
        stroke = strokes[name]
        lines.append((f"{name} stroke", value_from_record(stroke, "crank_angle_deg"), ""))
        if "duration_s" in stroke:
            at = value_from_record(stroke, "greatest_speed_at_crank_angle_deg", decimals=2)
            if stroke["duration_s"] is not None:
                lines.append(("  duration", Value(stroke["duration_s"], TIME), ""))
            lines.append(
                ("  greatest slider speed", value_from_record(stroke, "greatest_speed_m_s"), words("at {at}", at=at))
            )
    for title, key, kind in (
        ("ratio of crank angles", "angle_ratio", RATIO),
        ("ratio of durations", "duration_ratio", RATIO),
        ("difference of durations", "duration_difference_s", TIME),
        ("ratio of greatest speeds", "greatest_speed_ratio", RATIO),
        ("difference of greatest speeds", "greatest_speed_difference_m_s", SPEED),
    ):
        if strokes.get(key) is not None:
            lines.append((title, Value(strokes[key], kind), "outward against inward"))
    return [*result_blocks, *number_list("Strokes", lines)]


def figure(mechanism: Mechanism, linkage: Linkage) -> PanelFigure:
    """Return the main curves over the revolution with their extremes: of six curves those that the machine defines.

    Curves have gaps where friction leaves them undetermined.
    """
    extremes = {extreme_curve.name: extreme_curve for extreme_curve in curve_extremes(mechanism, linkage)}
    marked = [e.crank_angle for name in _PANELS if name in extremes for e in _minimum_and_maximum(extremes[name])]
    theta = sampled_crank_angles(
        crank_angles_of_cuts(mechanism, linkage),
        [angle for angle in marked if math.isfinite(angle)],
        turns=cycle_turns(mechanism),
    )
    curves = {curve.name: curve.values for curve in defined_curves(mechanism, linkage, theta)}
    degrees = np.degrees(theta)
    panels = tuple(_curve_panel(extremes[name], degrees, curves[name]) for name in _PANELS if name in extremes)
    return PanelFigure(
        "Extreme values over the turn", dimensions_text(linkage), panels, columns=min(2, len(panels)), width=5.2
    )


def _minimum_and_maximum(curve: CurveExtremes) -> tuple[Extreme, Extreme]:
    return curve.least, curve.greatest


def _curve_panel(curve: CurveExtremes, degrees: np.ndarray, values: np.ndarray) -> Panel:
    lines = [Line("", degrees, values)]
    ends = [end for end in _minimum_and_maximum(curve) if math.isfinite(end.crank_angle)]
    note: Text = "constant" if math.isfinite(curve.least.value) else "undefined where friction locks"
    if ends:
        angles, sizes = np.degrees([end.crank_angle for end in ends]), [end.value for end in ends]
        lines.append(Line("", angles, np.array(sizes), points=True))
        note = joined(
            [
                words(f"{{value}} at {format_number(at)}°", value=Value(size, curve.kind, digits=4, bare=True))
                for size, at in zip(sizes, angles, strict=True)
            ]
        )
    return crank_angle_panel(curve.title, *lines, kind=curve.kind, note=note)
