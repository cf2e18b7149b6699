"""The table [target_motion] of a job file: the desired slider motion as points, stated there or in a file."""

from collections.abc import Mapping
from typing import Annotated, Any

from pydantic import Field, WrapValidator

from ...model.errors import InputError, JobError
from ...model.kinematics.target_motion import Freedom, TargetMotion
from ...objectives.kinds import ANGLE, LENGTH, TIME
from ...objectives.motion_deviation import DEVIATIONS
from .crank_speed import stated_speed
from .curve_file import convert_time_to_angle, curve_of_table, drop_closing_point
from .loads import require_increasing
from .named_files import MOST_POINTS, SOURCE, Files, read_named_table, require_point_count, table_in, unread_file_error
from .value_types import Angle, Checked, Length, Part, Source, optional_entry, summary_entry


class TargetMotionPart(Checked[TargetMotion]):
    """A desired motion of the slider as points; deviations from it are the quantities motion_deviation(_rms)."""

    makes = TargetMotion

    crank_angles: Annotated[tuple[Angle, ...], WrapValidator(require_increasing)] | None = optional_entry(
        "crank angles of the points, increasing, spanning less than 360 deg",
        ["0 deg", "90 deg", "180 deg"],
        min_length=3,
        max_length=MOST_POINTS,
    )
    positions: tuple[Length, ...] | None = optional_entry(
        "slider position at each point, from the crank pivot outward",
        ["240 mm", "200 mm", "160 mm"],
        min_length=3,
        max_length=MOST_POINTS,
    )
    file: Annotated[str, Field(max_length=200)] | None = optional_entry(
        "instead of the two: a table beside the job file, of position_mm over crank_angle_deg or time_s", "motion.csv"
    )
    source: Source = summary_entry()
    phase: Freedom = optional_entry(
        "whether the crank may be mounted on its shaft at any angle; the best one is used", "free", default="fixed"
    )
    shift: Freedom = optional_entry(
        "whether positions may be measured from any point on the slider line; the best one is used",
        "free",
        default="fixed",
    )

    def build(self) -> TargetMotion:
        """Return the target motion for the model."""
        if self.file is not None:
            raise unread_file_error(self.file, "points")
        if self.crank_angles is None or self.positions is None:
            raise InputError("a target motion needs crank_angles and positions, or a file; got neither; add them")
        return super().build()


def require_target(target: TargetMotionPart | None, objectives: Part, constraints: Part) -> None:
    """Raise JobError if a job uses a deviation without a target motion."""
    for table, part in (("objectives", objectives), ("constraints", constraints)):
        for name in DEVIATIONS if target is None else ():
            if getattr(part, name) is not None:
                raise JobError(
                    f"{table}.{name}: a motion deviation needs a target motion; got none; add "
                    "[target_motion] with crank_angles and positions, or with a file"
                )


def target_motion_file(data: Mapping[str, Any]) -> str | None:
    """Return the file that a job's target motion names; None if it names none."""
    file = table_in(data, "target_motion").get("file")
    return file if isinstance(file, str) else None


def with_target_motion(data: Mapping[str, Any], files: Files) -> dict[str, Any]:
    """Return a job with its target motion's file replaced by the points in it. Raises `InputError`."""
    file, job = target_motion_file(data), dict(data)
    if file is None or {"crank_angles", "positions"} & set(job["target_motion"]):
        return job
    curve = curve_of_table(read_named_table(files, "target_motion.file", file), (ANGLE, TIME), (LENGTH,))
    curve = drop_closing_point(
        convert_time_to_angle(curve, stated_speed(data, curve.name)) if curve.argument_head.kind is TIME else curve
    )
    require_point_count(len(curve.arguments), curve.name, 3)
    angles, positions = curve.argument_and_value_texts()
    rest = {key: value for key, value in job["target_motion"].items() if key != "file"}
    points = {"crank_angles": angles, "positions": positions, SOURCE: curve.summary_text(file)}
    return {**job, "target_motion": rest | points}
