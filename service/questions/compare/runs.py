"""Runs in a comparison."""

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ....model.errors import SlidercrankError
from ...runs.result import Result
from ...runs.runs_on_disk import job_file


@dataclass(frozen=True)
class ComparedRun:
    """Run in a comparison.

    name: its name in the answer. place: its folder, or its number in the store. tables: tables of its job, None if
    there is no readable job.
    """

    name: str
    place: Path | int
    result: Result
    tables: Mapping[str, Any] | None

    @property
    def method(self) -> str:
        """Search method of its job."""
        from ....optimise.job.model import Job

        if self.tables is None:
            return "unknown"
        default = Job.model_fields["optimiser"].default.method
        return str(self.tables.get("optimiser", {}).get("method", default))


def compared_run(folder: Path, result: Result) -> ComparedRun:
    """Return the run in a folder. result: its result."""
    from ....optimise.job import read_job

    file, tables = job_file(folder), None
    with suppress(SlidercrankError):  # the job cannot be read, but the front can still be compared
        tables = None if file is None else read_job(file)
    place = folder.resolve()
    return ComparedRun(place.name, place, result, tables)
