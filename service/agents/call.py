"""Tool call: the folder that it may read and write, its cancellation, and its answer."""

from __future__ import annotations

import contextlib
import io
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...model.errors import InfeasibleError, InputError, NotFound
from ...optimise.job import parse_job, read_job, with_file_contents
from ...optimise.job.job_file import require_few_values_and_no_nulls, toml_tables
from ..jobs.stores import find_run, open_store
from ..jobs.submission import (
    LONGEST_CALL,
    LONGEST_WAIT,
    parse_with_allowed_functions,
    require_allowed_functions,
    with_time_limit_per_call,
)
from ..presets.jobs import shipped_jobs
from ..runs.result import Result
from ..runs.runs_on_disk import job_file, problem_of, read_run

if TYPE_CHECKING:
    from rich.console import Console

    from ...optimise.front.progress import Progress
    from ...optimise.problem.problem import Problem
    from ..store import Store

Job = str | dict[str, Any]
_LONGEST = 255  # characters in a name; no file system allows longer names


@dataclass(frozen=True)
class ToolResult:
    """Answer of a tool. record: for programs. text: for readers. is_error: whether the caller must act."""

    record: dict[str, Any]
    text: str
    is_error: bool = False


@dataclass(frozen=True)
class Call:
    """Tool call.

    runs: the only folder that it reads and writes. allowed: functions that jobs may use, as "module:function".

    cancelled: whether the caller has given up. report: progress listener.
    """

    runs: Path
    allowed: frozenset[str]
    cancelled: Callable[[], bool]
    report: Callable[[Progress], None]

    def run_folder(self, name: str) -> Path:
        """Return the folder of a run.

        Raises `InputError` for a folder outside `runs`, or for links that lead outside.
        """
        self._require_inside_runs(self.runs / name, name)
        folder = find_run(name, self.runs)
        for path in (folder, *folder.rglob("*")):
            self._require_inside_runs(path, name)
        return folder

    def load_run(self, name: str) -> tuple[Path, Result]:
        """Return the folder of a run, as `run_folder` does, and its result.

        Raises `RunError` for a run without a result.
        """
        folder = self.run_folder(name)
        return folder, read_run(folder, "optimise with resume =")

    def _require_inside_runs(self, path: Path, name: str) -> None:
        try:
            is_inside = len(name) <= _LONGEST and path.resolve().is_relative_to(self.runs.resolve())
        except (OSError, ValueError, RuntimeError):  # not a file name, or a loop of links
            is_inside = False
        if not is_inside:
            raise InputError(
                f"a run is a folder in {self.runs} without links that lead elsewhere; got {name[:200]!r}; name one "
                "from the list of runs"
            )

    def load_run_with_designs(self, name: str) -> tuple[Path, Result]:
        """Return a run that has designs, as `load_run` does. Raises `InfeasibleError` for a run without designs."""
        folder, result = self.load_run(name)
        if not result.designs:
            raise InfeasibleError(result.message)
        return folder, result

    def problem_of_run(self, folder: Path, result: Result) -> Problem:
        """Return the problem of a run. Raises `JobError` for functions that are not allowed."""
        file = job_file(folder)
        if file is not None:
            require_allowed_functions(read_job(file), self.allowed)
        return with_time_limit_per_call(problem_of(folder, result), LONGEST_WAIT)

    def problem(self, tables: Mapping[str, Any], *, seconds: float = LONGEST_WAIT, feasible: bool = True) -> Problem:
        """Return the problem of a job. seconds: time limit per function call, s. feasible: whether it must be feasible.

        Raises `JobError`.
        """
        return with_time_limit_per_call(
            parse_with_allowed_functions(tables, self.allowed, require_feasible=feasible), seconds
        )

    def problem_to_resume(self, tables: Mapping[str, Any], folder: Path) -> Problem:
        """Return the problem of a search that is to continue in a folder. Raises `JobError`."""
        require_allowed_functions(tables, self.allowed)
        return with_time_limit_per_call(parse_job(tables, folder=folder), LONGEST_CALL)

    @contextlib.contextmanager
    def store(self) -> Iterator[Store]:
        """Yield the store of the runs, and close it afterwards.

        Raises `StoreError` for a store that cannot be written.
        """
        with open_store(None, self.runs) as store:
            store.require_writable()
            yield store


def tables_with_files(job: Job, files: Mapping[str, str]) -> dict[str, Any]:
    """Return the tables of a job with the contents of its files inserted.

    job: tables, TOML text, or the name of an included job.

    Raises `JobError`, also for a referenced file that the caller did not supply: no file is read.
    """
    if isinstance(job, str) and "=" not in job:
        jobs = shipped_jobs()
        if job.strip() not in jobs:
            raise NotFound(
                f"a job must be its tables, its TOML text or the name of an included job, {', '.join(jobs)}; got "
                f"{job[:60]!r}; give one of them"
            )
        job = jobs[job.strip()]
    tables = toml_tables(job) if isinstance(job, str) else job
    require_few_values_and_no_nulls(tables)
    return with_file_contents(tables, files)


def text_printed_by(show: Callable[[Console], None]) -> str:
    """Return the output of a function that writes to a console, as plain text."""
    from rich.console import Console

    out = io.StringIO()
    show(Console(file=out, width=100, highlight=False, markup=False, emoji=False, color_system=None))
    return out.getvalue().strip()
