"""Search in this process: its job is claimed in the store, and its run folder written at the same time."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...model.file_name_encoding import path_text
from ...model.optional_packages import is_installed
from ..jobs.direct_run import begin_run, claim_stopped_job, end_job_on_error, folder_to_resume, stopped_job
from ..runs.result import Result, result_of
from ..runs.run_folder import RunFolder
from .heartbeat import Budget, Heartbeat
from .worker import versions_file

if TYPE_CHECKING:
    from ...optimise.engine.engine import Engine
    from ...optimise.front.front import ParetoFront
    from ...optimise.front.progress import Progress
    from ...optimise.problem.problem import Problem
    from ..store import Artefact, Claim, Store

Opened = tuple[RunFolder, "Problem", "Claim"]


def with_settings(
    problem: Problem, tables: Mapping[str, Any], changes: Mapping[str, Any]
) -> tuple[Problem, dict[str, Any]]:
    """Return a problem and its tables with other settings: designs, seed."""
    settings = replace(problem.settings, **changes)
    stated = {"designs": settings.designs, "seed": settings.seed}
    return replace(problem, settings=settings), {**tables, "optimiser": {**tables.get("optimiser", {}), **stated}}


@contextlib.contextmanager
def new_run(
    store: Store, place: Path, problem: Problem, tables: Mapping[str, Any], files: Sequence[Artefact]
) -> Iterator[Opened]:
    """Enter the run of a new job. files: the job and the files that it names, for the run folder."""
    with RunFolder(place, problem.name) as folder:
        yield folder, problem, begin_run(store, folder, tables, problem.name, files)


@contextlib.contextmanager
def resumed_run(
    store: Store, place: Path, text: str, read: Callable[[Mapping[str, Any], Path], Problem]
) -> Iterator[Opened]:
    """Enter a stopped run.

    text: its name or number. read: function that returns a job's problem from its run folder.
    """
    from ...optimise.solve import require_resumable

    job = stopped_job(store, text, place)
    with folder_to_resume(store, job, place) as folder:
        problem = read(store.tables(job.id), folder.path)
        require_resumable(problem, store.evaluation_records(job.id))
        claim = claim_stopped_job(store, job)
        with end_job_on_error(claim):
            folder.resume()
        yield folder, problem, claim


@contextlib.contextmanager
def renewing_claim(claim: Claim, *, again: str) -> Iterator[None]:
    """Within this context, renew the claim; an error ends its job. again: command that continues the run."""
    with end_job_on_error(claim, again=again), Heartbeat(claim):
        yield


def search(
    opened: Opened, engine: Engine, *, cancelled: Callable[[], bool], show: Callable[[Progress], None]
) -> ParetoFront:
    """Return the front of an open run. show: progress listener; store and log receive the progress too."""
    from ...optimise.solve import solve

    run, problem, claim = opened

    def report(at: Progress) -> None:
        claim.report(at)
        show(at)

    def report_and_log(at: Progress) -> None:
        report(at)
        run.log(
            f"{at.stage} {at.round}/{at.rounds}: {at.evaluations} evaluated, {at.feasible} feasible, "
            f"hypervolume {at.hypervolume:.6g}, {at.seconds:.2f} s"
        )

    return solve(
        problem,
        progress=report_and_log,
        stages=report,
        cancelled=lambda: cancelled() or claim.cancel_asked,
        resume=tuple(claim.evaluation_records()),
        keep=claim.keep_record,
        engine=engine,
    )


def save_result(opened: Opened, front: ParetoFront, budget: Budget | None = None) -> Result:
    """Write the result of a search to its run folder and the store, and return it. budget: budget of the search."""
    run, _, claim = opened
    result = result_of(front, path_text(run.path))
    result = result if budget is None else budget.with_limit_named(result)
    versions = dict(front.versions)
    if is_installed("matplotlib"):
        from importlib.metadata import version

        versions["matplotlib"] = version("matplotlib")
    run.keep_result(result, versions)
    claim.finish(replace(result, run=claim.job.run), [versions_file(versions)])
    run.log(f"{result.status}: {result.message}")
    return result
