"""Reading of runs from disk."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...model.errors import JobError, RunError
from ...model.file_name_encoding import path_text
from .result import ExactDesigns, Result, Row, StoredObjective, json_ready, rows_from_csv
from .run_folder import MARK

if TYPE_CHECKING:
    from ...optimise.problem.problem import Problem


def read_run(folder: Path, resume_command: str = "slidercrank optimise --resume") -> Result:
    """Return the result of a run. Raises `RunError` if it is unfinished, damaged, or not a run.

    again: how to continue an unfinished run, in the words of the current interface.
    """
    try:
        if (folder / MARK).exists():
            text = (folder / MARK).read_text(encoding="utf-8", errors="replace").strip().rstrip(".")
            raise RunError(f"the run {folder} is unfinished: {text}; continue it with `{resume_command} {folder.name}`")
        if not (folder / "front.json").is_file():
            raise RunError(f"a run must have a file front.json; {folder} has none; name another folder")
        record = json.loads((folder / "front.json").read_text(encoding="utf-8"))
        rows = rows_from_csv((folder / "front.csv").read_text(encoding="utf-8"))
        if json_ready(rows) != record["designs"]:
            raise ValueError("front.csv and front.json differ")
        result = result_from(record, rows, path_text(folder))
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        raise RunError(f"the run {folder} is damaged: {type(error).__name__}: {reason}; run its job again") from error
    return result


def result_from(record: dict[str, Any], rows: list[Row], run: str, exact: ExactDesigns | None = None) -> Result:
    """Return the result for a record of front.json without its designs, and the rows of its designs.

    exact: the same designs as the search left them, if stored.

    Raises ValueError, KeyError or TypeError if they contradict each other or are incomplete.
    """
    objectives = tuple(StoredObjective(**item) for item in record["objectives"])
    result = Result(
        run=run,
        name=str(record["name"]),
        status=str(record["status"]),
        message=str(record["message"]),
        objectives=objectives,
        designs=rows,
        hypervolume=float(record["hypervolume"]),
        evaluations=int(record["evaluations"]),
        seconds=float(record["seconds"]),
        seed=int(record["seed"]),
        extremes={str(name): int(row) for name, row in record["extremes"].items()},
        knee=None if record["knee"] is None else int(record["knee"]),
        trade_offs=[str(sentence) for sentence in record["trade_offs"]],
        warnings=tuple(str(sentence) for sentence in record.get("warnings", ())),  # runs of earlier versions have none
        violated={
            str(key): [float(excess) for excess in amounts] for key, amounts in record.get("violated", {}).items()
        },
        discrete=record.get("discrete"),
        exact=exact,
    )
    if exact is not None and len(exact.dimensions) != len(rows):
        raise ValueError(f"{len(rows)} designs, dimensions of {len(exact.dimensions)}")
    marked = [*result.extremes.values(), *([] if result.knee is None else [result.knee])]
    if any(not 0 <= row < len(rows) for row in marked):
        raise ValueError("a marked design is not among the designs")
    if rows and (missing := {item.column for item in objectives} - set(rows[0])):
        raise ValueError(f"the designs have no column {missing.pop()}")
    return result


def problem_of(folder: Path, result: Result) -> Problem:
    """Return the problem that a run solved: that of its job, with the seed of the run.

    Does not warn about the job: the result of the run has the warnings for its own designs. Raises `RunError` if the
    run has no job, or a job that is no longer valid.
    """
    from ...optimise.job import parse_job, read_job

    job = job_file(folder)
    if job is None:
        raise RunError(f"a run must have its job as job.toml or job.json; {folder} has neither; name another run")
    try:
        problem = parse_job(read_job(job), folder=folder)
    except JobError as error:
        raise RunError(f"the job of the run {folder} cannot be read: {error}; run it again") from error
    return replace(problem, settings=replace(problem.settings, seed=result.seed))


def job_file(folder: Path) -> Path | None:
    """Return the job file of a run, or None if there is none."""
    return next((file for name in ("job.toml", "job.json") if (file := folder / name).is_file()), None)
