"""The table speed_profile of a job file: a crank speed that varies over the turn."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Any

import numpy as np
from pydantic import Field

from ...model.errors import InputError
from ...model.machine.speed_profile import Harmonics, Profile, SpeedTable
from ...objectives.kinds import ANGLE, ANGULAR_SPEED, TIME
from ...objectives.units import value_of_one_si_unit_in
from .curve_file import Curve, curve_of_table, drop_closing_point
from .named_files import MOST_POINTS, SOURCE, Files, read_named_table, require_point_count, table_in, unread_file_error
from .value_types import Angle, AngularSpeed, Checked, Number, Source, optional_entry, summary_entry

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
    angles, speeds = curve.texts()
    profile = {"crank_angles": angles, "speeds": speeds, SOURCE: curve.source(file)}
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
