"""The table speed_profile of a job file: a crank speed that varies over the turn."""

from __future__ import annotations

import math
from collections.abc import Mapping
from itertools import pairwise
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import Field

from ...model.errors import InputError, JobError
from ...model.machine.speed_profile import Harmonics, Profile, SpeedTable
from ...objectives.units import shown
from .beside import MOST_POINTS, beside, require_few_points, table_of
from .values import Angle, AngularSpeed, Checked, Number, optional

HEADERS = ("crank_angle_deg", "speed_rpm"), ("time_s", "speed_rpm")
"""First line of a file of speeds."""
_TOLERANCE = 1e-3  # relative, for the mean of a table against the speed and the end of a turn against 360 deg


def _profile(**given: Any) -> Profile:
    if given.get("file") is not None:
        raise InputError(
            f"a file is read beside a job file only, and instead of points; got file {shown(given['file'])}; give "
            "crank_angles and speeds, or the file alone in a job file"
        )
    table = {name: given[name] for name in ("crank_angles", "speeds") if given.get(name) is not None}
    waves = {name: given[name] for name in ("cosines", "sines") if given.get(name) is not None}
    if bool(table) == bool(waves):
        raise InputError(
            f"a speed profile is of harmonics or of points; got {'both' if table else 'neither'}; give cosines and "
            "sines, or crank_angles and speeds"
        )
    if waves:
        return Harmonics(**waves)
    return SpeedTable(angles=table.get("crank_angles", ()), speeds=table.get("speeds", ()))


class SpeedProfilePart(Checked[Profile]):
    """Crank speed over the crank angle; `speed` is its mean, or a cycle time scales it."""

    makes = staticmethod(_profile)

    cosines: tuple[Number, ...] | None = optional(
        "fraction of the mean in cos(k crank angle), k = 1, 2, ...", [0.0, 0.05], max_length=100
    )
    sines: tuple[Number, ...] | None = optional("fraction of the mean in sin(k crank angle)", [0.02], max_length=100)
    crank_angles: tuple[Angle, ...] | None = optional(
        "crank angles of points, increasing, spanning less than 360 deg; a periodic cubic spline joins them",
        ["0 deg", "90 deg", "180 deg", "270 deg"],
        max_length=MOST_POINTS,
    )
    speeds: tuple[AngularSpeed, ...] | None = optional(
        "speed at each point, with the sign of the direction; only the shape counts if a cycle time is given",
        ["300 rpm", "290 rpm", "310 rpm", "300 rpm"],
        max_length=MOST_POINTS,
    )
    file: Annotated[str, Field(max_length=200)] | None = optional(
        f"instead of points: a CSV file beside the job file, with columns {' or '.join(map(' and '.join, HEADERS))}",
        "speed.csv",
    )

    def require_mean(self, speed: float) -> None:
        """Raise `InputError` unless the mean of points is the given speed, rad/s."""
        built = self.build()
        if isinstance(built, SpeedTable) and abs(built.mean - speed) > _TOLERANCE * abs(speed):
            mean = built.mean * 30.0 / math.pi
            raise InputError(
                f"speed must be the mean of speed_profile over the crank angle, {mean:.6g} rpm; got "
                f'{speed * 30.0 / math.pi:.6g} rpm; give speed = "{mean:.6g} rpm"'
            )


def speeds_file(data: Mapping[str, Any]) -> str | None:
    """Return the file that a job's speed profile names alone; None if it names none."""
    mechanism = data.get("mechanism")
    part = mechanism.get("speed_profile") if isinstance(mechanism, Mapping) else None
    file = part.get("file") if isinstance(part, Mapping) and len(part) == 1 else None
    return file if isinstance(file, str) else None


def with_speeds(data: Mapping[str, Any], folder: Path) -> dict[str, Any]:
    """Return a job with the points of its profile's file, found in `folder`, in place of the file. Raises JobError."""
    file, job = speeds_file(data), dict(data)
    if file is None:
        return job
    path, name = beside(folder, "mechanism.speed_profile.file", file)
    (of, _), lines = table_of(path, name, HEADERS)
    values: list[tuple[float, float]] = []
    for number, line in enumerate(lines, start=2):
        try:
            at, speed = map(float, line)
            if not (math.isfinite(at) and math.isfinite(speed)):
                raise ValueError
        except ValueError:
            raise JobError(
                f"{name} must have two finite numbers per line; got {','.join(line)!r} in line {number}; correct it"
            ) from None
        values.append((at, speed))
    try:
        angles, speeds = _points(of, [at for at, _ in values], [speed for _, speed in values])
    except InputError as error:
        raise JobError(f"{name}: {error}") from None
    require_few_points(len(angles), name, " in a turn")
    profile = {"crank_angles": [f"{angle!r} deg" for angle in angles], "speeds": [f"{speed!r} rpm" for speed in speeds]}
    return {**job, "mechanism": {**job["mechanism"], "speed_profile": profile}}


def _points(of: str, at: list[float], speeds: list[float]) -> tuple[list[float], list[float]]:
    """Return crank angles, deg, and speeds, rpm; over time, those of the first turn, from crank angle 0 on."""
    if of != "time_s":
        return at, speeds
    from scipy.interpolate import CubicSpline

    if len(at) < 4 or any(after <= before for before, after in pairwise(at)):
        raise InputError(f"times must increase, four at least; got {len(at)}; sort them and drop what repeats")
    curve = CubicSpline(at, speeds)
    angles = 6.0 * curve.antiderivative()(at)  # deg, of rpm and s
    way = 1.0 if angles[-1] >= 0.0 else -1.0
    turned = way * angles
    if any(after <= before for before, after in pairwise(turned)):
        raise InputError("the speed must not be zero or change its sign; got a record that stops; give one that runs")
    last = max(1, int(np.argmin(abs(turned - 360.0))))
    near = min(360.0 * _TOLERANCE, 0.5 * (turned[last] - turned[last - 1]))  # so that no step is mistaken for rounding
    if 360.0 - near <= turned[-1] < 360.0:
        turned *= 360.0 / turned[-1]
    if turned[-1] < 360.0 - near:
        raise InputError(f"a record over time must cover at least one turn; got {turned[-1]:.6g} deg; record longer")
    kept = np.flatnonzero(turned < 360.0 - near)  # a point closer than that repeats the first one
    end = float(CubicSpline(turned, speeds)(360.0))
    if abs(end - speeds[0]) > 0.02 * abs(speeds[0]):
        raise InputError(
            f"the speed must repeat after a turn, to 2 %; got {speeds[0]:.6g} rpm at its start and {end:.6g} rpm at "
            "its end; record steady running"
        )
    points = sorted((float(way * turned[k]) % 360.0, speeds[k]) for k in kept)
    return [angle for angle, _ in points], [speed for _, speed in points]
