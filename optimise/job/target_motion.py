"""The table [target_motion] of a job file: the wanted slider motion as points, given there or in a file."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any

from pydantic import Field, WrapValidator

from ...model.errors import InputError, JobError
from ...model.kinematics.target_motion import Freedom, TargetMotion
from ...objectives.motion_deviation import DEVIATIONS
from ...objectives.units import shown
from .beside import MOST_POINTS, beside, require_few_points, table_of
from .loads import increasing
from .values import Angle, Checked, Length, Part, optional

HEADER = ("crank_angle_deg", "position_mm")
"""First line of a file of points."""


class TargetMotionPart(Checked[TargetMotion]):
    """A wanted motion of the slider as points; the deviations from it are the quantities motion_deviation(_rms)."""

    makes = TargetMotion

    crank_angles: Annotated[tuple[Angle, ...], WrapValidator(increasing)] | None = optional(
        "crank angles of the points, increasing, spanning less than 360 deg",
        ["0 deg", "90 deg", "180 deg"],
        min_length=3,
        max_length=MOST_POINTS,
    )
    positions: tuple[Length, ...] | None = optional(
        "slider position at each point, from the crank pivot outward",
        ["240 mm", "200 mm", "160 mm"],
        min_length=3,
        max_length=MOST_POINTS,
    )
    file: Annotated[str, Field(max_length=200)] | None = optional(
        f"instead of the two: a CSV file beside the job file, with the columns {' and '.join(HEADER)}", "motion.csv"
    )
    phase: Freedom = optional(
        "whether the crank may sit on its shaft at any angle: the best one counts", "free", default="fixed"
    )
    shift: Freedom = optional(
        "whether positions may count from anywhere on the slider line: the best place counts", "free", default="fixed"
    )

    def build(self) -> TargetMotion:
        """Return the target motion as the model has it."""
        if self.file is not None:
            raise InputError(
                f"a file is read beside a job file only, and instead of points; got file {shown(self.file)}; "
                "give crank_angles and positions, or the file alone in a job file"
            )
        if self.crank_angles is None or self.positions is None:
            raise InputError("a target motion needs crank_angles and positions, or a file; got neither; add them")
        return super().build()


def require_target(target: TargetMotionPart | None, objectives: Part, constraints: Part) -> None:
    """Raise JobError if a job asks for a deviation without saying from what."""
    for table, part in (("objectives", objectives), ("constraints", constraints)):
        for name in DEVIATIONS if target is None else ():
            if getattr(part, name) is not None:
                raise JobError(
                    f"{table}.{name}: a motion deviation comes from a target motion; got none; add "
                    "[target_motion] with crank_angles and positions, or with a file"
                )


def points_file(data: Mapping[str, Any]) -> str | None:
    """Return the file that a job's target motion names; None if it names none."""
    part = data.get("target_motion")
    file = part.get("file") if isinstance(part, Mapping) else None
    return file if isinstance(file, str) else None


def with_points(data: Mapping[str, Any], folder: Path) -> dict[str, Any]:
    """Return a job with the points of its file, found in `folder`, in place of the file. Raises JobError."""
    file, job = points_file(data), dict(data)
    if file is None or {"crank_angles", "positions"} & set(job["target_motion"]):
        return job
    path, name = beside(folder, "target_motion.file", file)
    _, lines = table_of(path, name, [HEADER])
    for number, line in enumerate(lines, start=2):
        if len(line) != 2:
            raise JobError(f"{name} must have two values a line; got {len(line)} in line {number}; correct it")
    require_few_points(len(lines), name)
    points = {
        "crank_angles": [f"{angle} deg" for angle, _ in lines],
        "positions": [f"{position} mm" for _, position in lines],
    }
    rest = {key: value for key, value in job["target_motion"].items() if key != "file"}
    return {**job, "target_motion": rest | points}
