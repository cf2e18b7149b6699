"""Capability of a press before a dead centre: force, speed and work at a rated torque, and dwell.

The force is static and frictionless, by virtual work: F = T / |x'| with the slider's travel x' per crank angle.
"""

import math
from dataclasses import replace
from typing import Annotated, Literal

import numpy as np

from ....model.arrays import Array
from ....model.errors import InputError
from ....model.linkage.linkage import Linkage
from ....model.machine.mechanism import Mechanism
from ....objectives.dead_centre import DWELL_ANGLE, angle_and_travel_rate_before_dead_centre
from ....objectives.kinds import ANGLE, FORCE, LENGTH, SPEED
from ....objectives.torque_and_power import PEAK_TORQUE
from ...figures.panel_figure import Line, Panel, PanelFigure
from ...render.blocks import Block, NamedNumber, Table, column, named_number, note, number_list, values_from_record
from ..peaks import lengths_row
from ..record_types import Note, Record

_ROWS = 10
_SAMPLES = 200
_CAPTION = "distance before the dead centre"


Timed = Annotated[float | None, Note("null without a constant crank speed")]
Dwelling = Annotated[float | None, Note("null without a dwell distance")]


class Press(Record):
    """Force, speed, work and dwell of a press before a dead centre, with lists over the distance to it."""

    dead_centre: Literal["inner", "outer"]
    rated_torque_Nm: float
    torque_is_peak_of_design: bool
    """True if no rated torque was given."""
    touch_distance_mm: float
    touch_angle_deg: float
    touch_speed_m_s: Timed
    touch_force_N: float
    work_J: float
    """Work of the rated torque from there to the dead centre."""
    dwell_distance_mm: Dwelling
    dwell_angle_deg: Dwelling
    dwell_time_s: Annotated[float | None, Note("null without a dwell distance or a constant crank speed")]
    distances_mm: list[float]
    angles_deg: list[float]
    forces_N: list[float]
    speeds_m_s: Annotated[list[float] | None, Note("null without a constant crank speed")]


def numbers(
    mechanism: Mechanism,
    linkage: Linkage,
    *,
    touch_distance: float | None = None,
    dwell_distance: float | None = None,
    rated_torque: float | None = None,
) -> Press:
    """Return force, speed and work before the dead centre, and the dwell, ready for JSON.

    touch_distance, dwell_distance: distances to the dead centre, m; None for those of the machine. rated_torque: rated
    torque, N m; None for the peak torque of the design. Speeds and times are None if the crank speed is not constant,
    dwell values if there is no dwell distance. Raises `InputError` if the touch distance or the torque is missing, or
    if a distance exceeds the stroke.
    """
    touch, torque = _touch_distance(mechanism, touch_distance), _rated_or_peak_torque(mechanism, linkage, rated_torque)
    distances = touch * np.arange(1, _ROWS + 1) / _ROWS
    angles, travels = _angles_before_dead_centre(mechanism, linkage, distances)
    speed = _crank_speed(mechanism)
    speeds = speed * travels if speed else None
    dwell = mechanism.slider.dwell if dwell_distance is None else dwell_distance
    dwelling = None if dwell is None else _dwell_angle(mechanism, linkage, dwell)
    return {
        "dead_centre": mechanism.slider.dead_centre,
        "rated_torque_Nm": torque,
        "torque_is_peak_of_design": rated_torque is None,
        "touch_distance_mm": LENGTH.metric.factor * touch,
        "touch_angle_deg": math.degrees(angles[-1]),
        "touch_speed_m_s": None if speeds is None else float(speeds[-1]),
        "touch_force_N": torque / float(travels[-1]),
        "work_J": torque * float(angles[-1]),
        "dwell_distance_mm": None if dwell is None else LENGTH.metric.factor * dwell,
        "dwell_angle_deg": None if dwelling is None else math.degrees(dwelling),
        "dwell_time_s": None if dwelling is None or not speed else dwelling / speed,
        "distances_mm": (LENGTH.metric.factor * distances).tolist(),
        "angles_deg": np.degrees(angles).tolist(),
        "forces_N": (torque / travels).tolist(),
        "speeds_m_s": None if speeds is None else speeds.tolist(),
    }


def _crank_speed(mechanism: Mechanism) -> float:
    """Return the magnitude of the crank speed, rad/s; 0 with a speed profile, where it varies."""
    return abs(mechanism.speed) if mechanism.speed_profile is None else 0.0


def _touch_distance(mechanism: Mechanism, distance: float | None) -> float:
    touch = mechanism.slider.touch if distance is None else distance
    if touch is None:
        raise InputError(
            'a touch distance is missing; give it as an input, or in the job [mechanism] slider = { mass = "80 kg", '
            'touch_distance = "12 mm" }'
        )
    return touch


def _rated_or_peak_torque(mechanism: Mechanism, linkage: Linkage, rated: float | None) -> float:
    torque = float(PEAK_TORQUE.evaluate(mechanism, lengths_row(linkage)).values[0]) if rated is None else rated
    if not torque > 0.0:
        raise InputError(
            "the press force needs a torque, but the peak torque of this design is zero; give a rated torque, such as "
            "50 N m"
        )
    return torque


def _angles_before_dead_centre(mechanism: Mechanism, linkage: Linkage, distances: Array) -> tuple[Array, Array]:
    """Return the crank angle to the dead centre, rad, and |x'|, m, at distances before the dead centre, m."""
    _require_stroke(distances[-1], float(linkage.stroke))
    return angle_and_travel_rate_before_dead_centre(mechanism, lengths_row(linkage)[0], distances)


def _dwell_angle(mechanism: Mechanism, linkage: Linkage, distance: float) -> float:
    _require_stroke(distance, float(linkage.stroke))
    near = replace(mechanism, slider=replace(mechanism.slider, dwell=distance))
    return float(DWELL_ANGLE.evaluate(near, lengths_row(linkage)).values[0])


def _require_stroke(distance: float, stroke: float) -> None:
    if not distance < stroke:
        raise InputError(
            f"distances before a dead centre must be less than the stroke, {1e3 * stroke:.6g} mm; got "
            f"{1e3 * distance:.6g} mm; reduce the distance"
        )


def blocks(numbers: Press) -> list[Block]:
    """Return the answer in human-readable form."""
    origin = "the peak torque of this design" if numbers["torque_is_peak_of_design"] else ""
    lines: list[NamedNumber] = [
        named_number(numbers, "rated_torque_Nm", origin),
        named_number(numbers, "touch_distance_mm", f"before the {numbers['dead_centre']} dead centre"),
        named_number(numbers, "touch_force_N", "available from the rated torque at the touch distance"),
        named_number(numbers, "work_J", "available from the rated torque between touch and dead centre"),
    ]
    if numbers["touch_speed_m_s"] is not None:
        lines.append(named_number(numbers, "touch_speed_m_s", ""))
    if numbers["dwell_distance_mm"] is not None:
        lines += [
            named_number(numbers, "dwell_distance_mm", "on both sides of the dead centre"),
            named_number(numbers, "dwell_angle_deg", ""),
        ]
    if numbers["dwell_time_s"] is not None:
        lines.append(named_number(numbers, "dwell_time_s", ""))
    columns = {
        "distances_mm": column("before the dead centre", LENGTH),
        "angles_deg": column("crank angle to it", ANGLE),
        "forces_N": column("force", FORCE),
        "speeds_m_s": column("slider speed", SPEED),
    }
    defined = [key for key, value in numbers.items() if value is not None]
    heads = {key: head for key, head in columns.items() if key in defined}
    rows = tuple(zip(*(values_from_record(numbers, key) for key in heads), strict=True))
    return [
        *number_list("Press", lines),
        Table(tuple(heads.values()), rows, ruled=True),
        note("Static forces, without friction and inertia."),
    ]


def figure(
    mechanism: Mechanism, linkage: Linkage, *, touch_distance: float | None = None, rated_torque: float | None = None
) -> PanelFigure:
    """Return available force and slider speed over the distance before the dead centre."""
    touch, torque = _touch_distance(mechanism, touch_distance), _rated_or_peak_torque(mechanism, linkage, rated_torque)
    distances = touch * np.arange(1, _SAMPLES + 1) / _SAMPLES
    _, travels = _angles_before_dead_centre(mechanism, linkage, distances)
    drawn = slice(_SAMPLES // _ROWS - 1, None)  # at smaller distances the force tends to infinity
    forces = Line("", distances[drawn], (torque / travels)[drawn])
    panels = [Panel("available force", _CAPTION, (forces,), FORCE, LENGTH)]
    speed = _crank_speed(mechanism)
    if speed:
        speeds = Line("", distances[drawn], (speed * travels)[drawn])
        panels.append(Panel("slider speed", _CAPTION, (speeds,), SPEED, LENGTH))
    subtitle = f"before the {mechanism.slider.dead_centre} dead centre, static, without friction"
    return PanelFigure("Press", subtitle, tuple(panels), width=6.4, height=2.6)
