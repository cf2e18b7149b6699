"""A swing that is asked for, with what is not said as the job of the machine has it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from ..errors import InputError
from ..machine.mechanism import Mechanism
from ..machine.start import Start
from .swing import Swing, started
from .swing_types import Driver, Law, Side

_ANGLES, _POSITIONS = ("start", "end"), ("slider_start", "slider_end")


@dataclass(frozen=True, kw_only=True)
class SwingRequest:
    """Limits and law asked of a swing; None for what stays. start, end: crank angles, rad. slider_start, slider_end: m.

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
    mechanism: Mechanism, motion: Swing | None, asked: SwingRequest, names: Mapping[str, str] | None = None
) -> tuple[Mechanism, Swing]:
    """Return the swing that is asked for, and the machine without a start of its own.

    motion: of the job, from the start that the machine of one design has; None without one. Then the crank drives,
    slowly. A start that is asked for alone takes the end along where the job states the angle or the travel. names: of
    the fields of `SwingRequest`, for messages, where they are not those of Python. Raises `InputError` for ends of two
    kinds, ends that are missing, and a table of motion that no job gives.
    """
    said = {name: (names or {}).get(name, name) for name in SwingRequest.__dataclass_fields__}
    motion = None if motion is None else started(mechanism, motion)
    given: dict[str, Any] = {
        **_requested_ends(asked, motion, said),
        **{
            name: getattr(asked, name)
            for name in ("side", "driver", "law", "duration", "actuator_tolerance")
            if getattr(asked, name) is not None
        },
    }
    if asked.law == "table" and (motion is None or not motion.points):
        raise InputError(
            f"a motion by a table is that of a job; got {said['law']} table; give its points in [motion] of the job, "
            f"law_times and law_shares, and leave {said['law']} out"
        )
    if asked.law == "slow":
        given.setdefault("duration", None)
    if asked.law not in (None, "table"):
        given.setdefault("points", ())
    if asked.driver == "crank":
        given.setdefault("actuator_tolerance", 0.0)
    if motion is not None and given.get("of", motion.of) == motion.of:
        found = replace(motion, **given)
    else:
        kept = ("driver", "law", "duration", "points", "actuator_tolerance")
        found = _new_swing(({} if motion is None else {name: getattr(motion, name) for name in kept}) | given, said)
    return replace(mechanism, start=Start()), replace(found, follows=False)


def _requested_ends(asked: SwingRequest, motion: Swing | None, said: Mapping[str, str]) -> dict[str, Any]:
    """Return start and end that are asked for, and what they are of."""
    found = {name: getattr(asked, name) for name in (*_ANGLES, *_POSITIONS) if getattr(asked, name) is not None}
    if not found:
        return {}
    of = "crank" if next(iter(found)) in _ANGLES else "slider"
    own = _ANGLES if of == "crank" else _POSITIONS
    if any(name not in own for name in found):
        raise InputError(
            "a swing runs between two crank angles, or between two places of the slider; got "
            f"{', '.join(said[name] for name in found)}; give the two of one"
        )
    ends = {end: found[name] for end, name in zip(_ANGLES, own, strict=True) if name in found}
    if motion is not None and motion.follows and motion.of == of and "end" not in ends:
        ends["end"] = ends["start"] + (motion.end - motion.start)
    return ends | {"of": of}


def _new_swing(given: dict[str, Any], said: Mapping[str, str]) -> Swing:
    slider = given.get("of") == "slider"
    for name, key in zip(_ANGLES, _POSITIONS if slider else _ANGLES, strict=True):
        if name not in given:
            raise InputError(
                f"a swing runs from one {'slider position' if slider else 'crank angle'} to another; got no "
                f"{said[key]}; give both, or a job with [motion]"
            )
    return Swing(**given)
