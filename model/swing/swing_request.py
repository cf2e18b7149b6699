"""A requested swing, with missing values taken from the machine's job."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from ..errors import InputError
from ..machine.mechanism import Mechanism, Start
from .swing import Swing, with_start_of_machine
from .swing_types import Driver, Law, Side

_ANGLES, _POSITIONS = ("start", "end"), ("slider_start", "slider_end")


@dataclass(frozen=True, kw_only=True)
class SwingRequest:
    """Requested ends and law of a swing; None keeps the job's value.

    start, end: crank angles, rad. slider_start, slider_end: m.

    side, driver, law, duration (s), actuator_tolerance (m): as in `Swing`.
    """

    start: float | None = None
    end: float | None = None
    slider_start: float | None = None
    slider_end: float | None = None
    side: Side | None = None
    driver: Driver | None = None
    law: Law | None = None
    duration: float | None = None
    actuator_tolerance: float | None = None


def resolve_swing(
    mechanism: Mechanism, motion: Swing | None, request: SwingRequest, field_names: Mapping[str, str] | None = None
) -> tuple[Mechanism, Swing]:
    """Return the requested swing, and the machine without its own start.

    motion: the job's swing, from the start that the machine of one design has; None if it has none. By default the
    crank drives, slowly. A start requested alone moves the end along if the job states the angle or the travel.
    field_names: names of the fields of `SwingRequest` in messages, if they differ from Python's.

    Raises `InputError` for ends of two kinds, missing ends, and a tabulated motion if the job has no table.
    """
    names = {name: (field_names or {}).get(name, name) for name in SwingRequest.__dataclass_fields__}
    motion = None if motion is None else with_start_of_machine(mechanism, motion)
    fields: dict[str, Any] = {
        **_requested_ends(request, motion, names),
        **{
            name: getattr(request, name)
            for name in ("side", "driver", "law", "duration", "actuator_tolerance")
            if getattr(request, name) is not None
        },
    }
    if request.law == "table" and (motion is None or not motion.points):
        raise InputError(
            f"a tabulated motion law must be in a job; got {names['law']} table; write its points as law_times and "
            f"law_shares in the job's [motion], and leave {names['law']} out"
        )
    if request.law == "slow":
        fields.setdefault("duration", None)
    if request.law not in (None, "table"):
        fields.setdefault("points", ())
    if request.driver == "crank":
        fields.setdefault("actuator_tolerance", 0.0)
    if motion is not None and fields.get("stated_for", motion.stated_for) == motion.stated_for:
        swing = replace(motion, **fields)
    else:
        motion_fields = ("driver", "law", "duration", "points", "actuator_tolerance")
        swing = _new_swing(
            ({} if motion is None else {name: getattr(motion, name) for name in motion_fields}) | fields, names
        )
    return replace(mechanism, start=Start()), replace(swing, follows=False)


def _requested_ends(request: SwingRequest, motion: Swing | None, names: Mapping[str, str]) -> dict[str, Any]:
    """Return the requested start and end, and whether they refer to the crank or the slider."""
    stated = {name: getattr(request, name) for name in (*_ANGLES, *_POSITIONS) if getattr(request, name) is not None}
    if not stated:
        return {}
    stated_for = "crank" if next(iter(stated)) in _ANGLES else "slider"
    fields = _ANGLES if stated_for == "crank" else _POSITIONS
    if any(name not in fields for name in stated):
        raise InputError(
            "a swing must run between two crank angles or between two slider positions; got "
            f"{', '.join(names[name] for name in stated)}; give only one of these pairs"
        )
    ends = {end: stated[name] for end, name in zip(_ANGLES, fields, strict=True) if name in stated}
    if motion is not None and motion.follows and motion.stated_for == stated_for and "end" not in ends:
        ends["end"] = ends["start"] + (motion.end - motion.start)
    return ends | {"stated_for": stated_for}


def _new_swing(fields: dict[str, Any], names: Mapping[str, str]) -> Swing:
    slider = fields.get("stated_for") == "slider"
    for name, key in zip(_ANGLES, _POSITIONS if slider else _ANGLES, strict=True):
        if name not in fields:
            raise InputError(
                f"a swing must run from one {'slider position' if slider else 'crank angle'} to another; got no "
                f"{names[key]}; give both, or use a job with [motion]"
            )
    return Swing(**fields)
