"""Crank speed as a job states it: as speed, cycle time, or strokes per minute."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import ValidationError, model_validator

from ...model.errors import InputError
from ...model.machine.speed_profile import SpeedTable
from ...objectives.kinds import ANGULAR_SPEED, STROKE_RATE, TIME
from ...objectives.units import quote
from .named_files import table_in, tables_in
from .speed_profile import SpeedProfilePart
from .value_types import AngularAcceleration, Part, PhysicalWithin, optional_entry
from .variables import paths_set_by_options, stated_variables

Direction = Literal["counter-clockwise", "clockwise"]
SPEED_KEYS = ("speed", "cycle_time", "strokes_per_minute")
"""Keys that state how fast the crank turns; a job has one of them."""
TIME_KEYS = SPEED_KEYS[1:]
"""Keys that state a time; if a job has one, a profile defines only the shape."""
_RPM = 30.0 / math.pi


_FASTEST, _SLOWEST = 2e-5, TIME.limit
"""Limits on the time per turn, s, for all three keys."""
_HINT = "others are beyond any machine; check the unit"
_ROUNDING = 1e-12  # relative error of a speed in rpm
_CYCLE_TIME = PhysicalWithin(
    TIME, "positive", rule="a time from 20 us to 1e9 s", hint=_HINT, least=_FASTEST, greatest=_SLOWEST
)
_STROKES = PhysicalWithin(
    STROKE_RATE,
    "positive",
    rule="a number from 6e-8 to 3e6",
    hint=_HINT,
    least=6e-8,
    greatest=3e6,
)


class _CrankSpeedMarker(PhysicalWithin):
    """Marks a crank speed: in either direction, within the limits on the time per turn."""

    def read(self, value: object) -> float:
        """Return the value in rad/s; raises InputError."""
        speed = super().read(value)
        if speed == 0.0:
            raise InputError(
                "must not be 0, because its sign gives the direction of rotation; got 0; for a very slow machine give "
                'a small speed, for example "0.1 rpm"'
            )
        if abs(speed) < 2.0 * math.pi / _SLOWEST * (1.0 - _ROUNDING):
            raise InputError(f"must be {self.rule}; got {quote(value)}; {self.hint}")
        return speed


_SPEED = _CrankSpeedMarker(
    ANGULAR_SPEED,
    rule="a speed from 6e-8 to 3e6 rpm, either way",
    hint=_HINT,
    least=-2.0 * math.pi / _FASTEST * (1.0 + _ROUNDING),
    greatest=2.0 * math.pi / _FASTEST * (1.0 + _ROUNDING),
)


class CrankSpeedPart(Part):
    """Crank speed and its variation over a turn."""

    speed: Annotated[float, _SPEED] | None = optional_entry(
        "crank speed, positive counter-clockwise, negative clockwise; not for a swing",
        "300 rpm",
    )
    cycle_time: Annotated[float, _CYCLE_TIME] | None = optional_entry(
        "instead of speed: time of one cycle, which is one turn, or two if a load has a cycle of 720 deg", "2 s"
    )
    strokes_per_minute: Annotated[float, _STROKES] | None = optional_entry(
        "instead of speed: crank turns per minute", 30
    )
    direction: Direction | None = optional_entry(
        "direction of rotation, with cycle_time or strokes_per_minute; default counter-clockwise", "clockwise"
    )
    acceleration: AngularAcceleration = optional_entry(
        "angular acceleration of the crank, the same at every crank angle",
        "20 rad/s^2",
        default=0.0,
    )
    speed_profile: SpeedProfilePart | None = optional_entry(
        "variation of the speed with the crank angle; applies to all quantities except stresses and wear",
        {"cosines": [0.0, 0.05]},
    )

    @property
    def speed_keys(self) -> tuple[str, ...]:
        """Keys that state how fast the crank turns: one, or none for a swing."""
        return tuple(key for key in SPEED_KEYS if getattr(self, key) is not None)

    def crank_speed(self, turns: int) -> float:
        """Return the mean speed over the crank angle, rad/s, 0 if none is stated. turns: turns of the crank per cycle.

        A turn takes 2 pi / (speed s), where s is the profile's mean over time divided by its mean over angle.
        """
        if self.speed is not None:
            return self.speed
        rate = 0.0 if self.strokes_per_minute is None else self.strokes_per_minute / _RPM
        if self.cycle_time is not None:
            rate = 2.0 * math.pi * turns / self.cycle_time
        share = 1.0 if self.speed_profile is None else self.speed_profile.build().time_mean_over_angle_mean
        return (-rate if self.direction == "clockwise" else rate) / share

    @model_validator(mode="after")
    def _require_stated_mean_speed(self) -> CrankSpeedPart:
        if self.speed_profile is not None and self.speed is not None:
            self.speed_profile.require_mean_speed(self.speed)
        return self

    @model_validator(mode="after")
    def _require_one_speed(self) -> CrankSpeedPart:
        if len(self.speed_keys) > 1:
            raise InputError(
                f"only one of {', '.join(SPEED_KEYS)} may set the crank speed; got {' and '.join(self.speed_keys)}; "
                "leave out all but one"
            )
        if self.speed is not None and self.direction not in (None, _direction_of_speed(self.speed)):
            raise InputError(
                "the sign of speed must match direction, positive counter-clockwise; got "
                f'{_RPM * self.speed:.6g} rpm and direction = "{self.direction}"; give speed = '
                f'"{-_RPM * self.speed:.6g} rpm", or leave out direction'
            )
        if self.speed is None and self.speed_keys:
            self._require_repeating_cycle(self.speed_keys[0])
        return self

    def _require_repeating_cycle(self, key: str) -> None:
        """Raise `InputError` unless the crank has a cycle of known duration."""
        if self.acceleration:
            raise InputError(
                f"{key} needs a cycle that repeats; got an acceleration of {self.acceleration:g} rad/s^2; give speed, "
                f"which holds at every crank angle, in place of {key}"
            )
        way = self.direction or "counter-clockwise"
        profile = None if self.speed_profile is None else self.speed_profile.build()
        if isinstance(profile, SpeedTable) and _direction_of_speed(profile.mean_speed) != way:
            table_direction = _direction_of_speed(profile.mean_speed)
            raise InputError(
                "speeds of speed_profile must have the sign of the direction, positive counter-clockwise; got "
                f'{_RPM * profile.speeds[0]:.6g} rpm, {table_direction}, with direction = "{way}"; give direction = '
                f'"{table_direction}", '
                "or correct the signs"
            )


def _direction_of_speed(speed: float) -> Direction:
    return "clockwise" if speed < 0.0 else "counter-clockwise"


def stated_speed(data: Mapping[str, Any], name: str) -> float:
    """Return the constant speed that a job's tables state, rad/s, for a file over time. Raises `InputError`.

    name: file name for messages.
    """
    stated_mechanism = table_in(data, "mechanism")
    varies = {f"mechanism.{key}" for key in SPEED_KEYS} & (set(stated_variables(data)) | paths_set_by_options(data))
    if "speed_profile" in stated_mechanism or stated_mechanism.get("acceleration") or varies:
        raise InputError(f"{name} is given over time, which needs a constant crank speed; give crank angles instead")
    stated = {key: stated_mechanism[key] for key in (*SPEED_KEYS, "direction") if key in stated_mechanism}
    try:
        part = CrankSpeedPart.model_validate(stated)
    except ValidationError:
        stated = {}
    if not stated:
        raise InputError(f"{name} is given over time, which needs the crank speed; got none; give speed in [mechanism]")
    return part.crank_speed(2 if any(load.get("cycle") == "720 deg" for load in tables_in(data, "load")) else 1)
