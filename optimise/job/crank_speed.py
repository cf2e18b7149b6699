"""Crank speed as a job states it: as speed, cycle time, or strokes per minute, constant or with a speed_profile."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field, ValidationError, model_validator

from ...model.errors import InputError
from ...model.machine.speed_profile import Harmonics, Profile, SpeedTable
from ...objectives.kinds import ANGLE, ANGULAR_SPEED, STROKE_RATE, TIME
from ...objectives.units import quote, value_of_one_si_unit_in
from .curve_file import Curve, curve_of_table, drop_closing_point
from .named_files import (
    MOST_POINTS,
    SOURCE,
    Files,
    read_named_table,
    require_point_count,
    table_in,
    tables_in,
    unread_file_error,
)
from .value_types import (
    Angle,
    AngularAcceleration,
    AngularSpeed,
    Checked,
    Number,
    Part,
    PhysicalWithin,
    Source,
    optional_entry,
    summary_entry,
)
from .variables import paths_set_by_options, stated_variables

_TOLERANCE = 1e-3  # relative tolerance for a table's mean against the speed, and for the end of a turn against 360 deg


def _build_profile(**given: Any) -> Profile:
    if given.get("file") is not None:
        raise unread_file_error(given["file"], "points")
    table = {name: given[name] for name in ("crank_angles", "speeds") if given.get(name) is not None}
    waves = {name: given[name] for name in ("cosines", "sines") if given.get(name) is not None}
    if bool(table) == bool(waves):
        raise InputError(
            f"a speed profile must have either harmonics or points; got {'both' if table else 'neither'}; give "
            "cosines and sines, or crank_angles and speeds"
        )
    if waves:
        return Harmonics(**waves)
    return SpeedTable(angles=table.get("crank_angles", ()), speeds=table.get("speeds", ()))


class SpeedProfilePart(Checked[Profile]):
    """Crank speed over the crank angle; `speed` is its mean, or a cycle time scales it."""

    makes = staticmethod(_build_profile)

    cosines: tuple[Number, ...] | None = optional_entry(
        "fraction of the mean in cos(k crank angle), k = 1, 2, ...", [0.0, 0.05], max_length=100
    )
    sines: tuple[Number, ...] | None = optional_entry(
        "fraction of the mean in sin(k crank angle)", [0.02], max_length=100
    )
    crank_angles: tuple[Angle, ...] | None = optional_entry(
        "crank angles of points, increasing, spanning less than 360 deg; a periodic cubic spline joins them",
        ["0 deg", "90 deg", "180 deg", "270 deg"],
        max_length=MOST_POINTS,
    )
    speeds: tuple[AngularSpeed, ...] | None = optional_entry(
        "speed at each point, negative if clockwise; only the shape counts if a cycle time is given",
        ["300 rpm", "290 rpm", "310 rpm", "300 rpm"],
        max_length=MOST_POINTS,
    )
    file: Annotated[str, Field(max_length=200)] | None = optional_entry(
        "instead of points: a table beside the job file, of speed_rpm over crank_angle_deg, or over time_s from crank "
        "angle 0 on",
        "speed.csv",
    )
    source: Source = summary_entry()

    def require_mean_speed(self, speed: float) -> None:
        """Raise `InputError` unless the points' mean is the given speed, rad/s."""
        built = self.build()
        if isinstance(built, SpeedTable) and abs(built.mean_speed - speed) > _TOLERANCE * abs(speed):
            mean = built.mean_speed * 30.0 / math.pi
            raise InputError(
                f"speed must be the mean of speed_profile over the crank angle, {mean:.6g} rpm; got "
                f'{speed * 30.0 / math.pi:.6g} rpm; give speed = "{mean:.6g} rpm"'
            )


def speed_profile_file(data: Mapping[str, Any]) -> str | None:
    """Return the file from which a job's speed profile is read; None if it is not read from a file."""
    part = table_in(table_in(data, "mechanism"), "speed_profile")
    file = part.get("file") if len(part) == 1 else None
    return file if isinstance(file, str) else None


def with_speed_points(data: Mapping[str, Any], files: Files) -> dict[str, Any]:
    """Return a job with its speed profile's file replaced by the points in it. Raises `InputError`."""
    file, job = speed_profile_file(data), dict(data)
    if file is None:
        return job
    curve = curve_of_table(
        read_named_table(files, "mechanism.speed_profile.file", file), (ANGLE, TIME), (ANGULAR_SPEED,)
    )
    curve = drop_closing_point(_convert_time_to_turn_angle(curve) if curve.argument_head.kind is TIME else curve)
    require_point_count(len(curve.arguments), curve.name, 4)
    angles, speeds = curve.argument_and_value_texts()
    profile = {"crank_angles": angles, "speeds": speeds, SOURCE: curve.summary_text(file)}
    return {**job, "mechanism": {**job["mechanism"], "speed_profile": profile}}


def _convert_time_to_turn_angle(curve: Curve) -> Curve:
    """Return a curve over time as a curve over crank angle, deg: the first turn, from crank angle 0."""
    from scipy.interpolate import CubicSpline

    at, rpm = (
        curve.arguments / value_of_one_si_unit_in(curve.argument_head.unit),
        curve.values / value_of_one_si_unit_in(curve.value_head.unit) * (30.0 / math.pi),
    )
    if len(at) < 4 or np.any(np.diff(at) <= 0.0):
        raise InputError(
            f"{curve.name}: times must increase and be at least four; got {len(at)}; sort them and remove repeated "
            "times"
        )
    angles = 6.0 * CubicSpline(at, rpm).antiderivative()(at)  # deg, from rpm and s
    way = 1.0 if angles[-1] >= 0.0 else -1.0
    turned = way * angles
    if np.any(np.diff(turned) <= 0.0):
        raise InputError(
            f"{curve.name}: the speed must not be zero or change sign; got a record that stops; give one of steady "
            "running"
        )
    last = max(1, int(np.argmin(abs(turned - 360.0))))
    # The limit of half a step ensures that a step is not mistaken for rounding.
    near = min(360.0 * _TOLERANCE, 0.5 * (turned[last] - turned[last - 1]))
    if 360.0 - near <= turned[-1] < 360.0:
        turned *= 360.0 / turned[-1]
    if turned[-1] < 360.0 - near:
        raise InputError(
            f"{curve.name}: a record over time must cover at least one turn; got {turned[-1]:.6g} deg; record longer"
        )
    in_turn = np.flatnonzero(turned < 360.0 - near)  # a closer point repeats the first one
    end = float(CubicSpline(turned, rpm)(360.0))
    if abs(end - rpm[0]) > 0.02 * abs(rpm[0]):
        raise InputError(
            f"{curve.name}: the speed must repeat after a turn, within 2 %; got {rpm[0]:.6g} rpm at its start and "
            f"{end:.6g} rpm at its end; record steady running"
        )
    angles = np.mod(way * turned[in_turn], 360.0)
    order = np.argsort(angles, kind="stable")
    argument_head, value_head = (
        curve.argument_head._replace(kind=ANGLE, unit="deg"),
        curve.value_head._replace(unit="rpm"),
    )
    notes = (*curve.notes, f"the first of {turned[-1] / 360.0:.4g} turns over time")
    return Curve(curve.name, argument_head, value_head, angles[order], rpm[in_turn][order], notes)


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
