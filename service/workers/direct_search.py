"""Search in this process: its job is claimed in the store, and its run folder written at the same time."""

import contextlib
import os
import socket
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from ...model.errors import InputError, LeaseLost, StoreError
from ...model.file_name_encoding import path_text
from ...model.optional_packages import is_installed
from ...optimise.engine.engine import Engine
from ...optimise.front.front import ParetoFront
from ...optimise.front.progress import Progress
from ...optimise.problem.problem import Problem
from ..jobs.stores import find_folder
from ..runs.result import Result, result_of
from ..runs.run_folder import RunFolder
from ..store import RESUMABLE, Artefact, Claim, Job, Store
from .heartbeat import Budget, Heartbeat
from .worker import versions_file

Opened = tuple[RunFolder, Problem, Claim]
LEASE = 3600.0
"""s. A run suspended by Ctrl-Z for less time continues; a killed run becomes free after this time, or when resumed."""
_PATIENCE = 2.0  # s to wait for disk space for the store: a user is waiting
_WORKER = "command line"
_MEDIA = {".toml": "application/toml", ".json": "application/json"}


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
        yield folder, problem, store_and_claim_run(store, folder, tables, problem.name, files)


@contextlib.contextmanager
def resumed_run(
    store: Store, place: Path, text: str, read: Callable[[Mapping[str, Any], Path], Problem]
) -> Iterator[Opened]:
    """Enter a stopped run.

    text: its name or number. read: function that returns a job's problem from its run folder.
    """
    from ...optimise.solve import require_resumable

    job = find_stopped_job(store, text, place)
    with folder_to_resume(store, job, place) as folder:
        problem = read(store.job_tables(job.id), folder.path)
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


def _may_wait_longer(waited: float) -> bool:
    return waited < _PATIENCE


def job_and_attached_files(job: Path, attached: Sequence[Path]) -> list[Artefact]:
    """Return a job file and the accompanying files that it names, as stored."""
    files = {
        f"job{job.suffix.lower()}": job,
        **{path_text(file.relative_to(job.parent).as_posix()): file for file in attached},
    }
    return [
        Artefact(name=name, media_type=_MEDIA.get(file.suffix.lower(), "text/plain"), content=file.read_bytes())
        for name, file in files.items()
    ]


def store_and_claim_run(
    store: Store, folder: RunFolder, tables: Mapping[str, Any], name: str, files: Sequence[Artefact]
) -> Claim:
    """Add the job of a new folder to the store, rename the folder to match, and return the claim."""
    worker = _worker_name()
    claim = store.begin(tables, name=name, run=folder.path.name, worker=worker, lease=LEASE, files=files)
    claim.patient = _may_wait_longer
    folder.rename(claim.job.run)
    folder.keep_files({file.name: file.content for file in files})
    return claim


def find_stopped_job(store: Store, text: str, place: Path) -> Job:
    """Return the job of a run to resume, given by its number or in a form that `find_run` accepts.

    Raises `InputError` for a run that is not in the store, or that cannot be resumed.
    """
    if text.isdecimal():
        job = store.job(int(text))
    else:
        folder = find_folder(text, place)
        stored = store.find_by_run(folder.name)
        if stored is None:
            raise InputError(
                f"a run can only continue from its records in the store; {folder.name} is not in {store.name}; run "
                "its job again"
            )
        job = stored
    if not (job.state in RESUMABLE or _is_abandoned(job)):
        raise _not_resumable_error(job)
    return job


def folder_to_resume(store: Store, job: Job, place: Path) -> RunFolder:
    """Return the unchanged folder of a job to resume, or a new one if there is none here."""
    path = place / job.run
    if path.is_dir():
        return RunFolder.reopen(path)
    folder = RunFolder(place, job.name)
    folder.rename(job.run)
    folder.keep_files({name: store.artefact(job.id, name).content for name in store.artefact_names(job.id)})
    return folder


def claim_stopped_job(store: Store, job: Job) -> Claim:
    """Claim a stopped job again. Its folder is open, so no other command-line process uses it.

    Raises `InputError` for a job that cannot be resumed.
    """
    try:
        claim = store.reclaim(job.id, worker=_worker_name(), lease=LEASE, alone=_is_abandoned(job))
    except InputError:
        raise _not_resumable_error(store.job(job.id)) from None
    claim.patient = _may_wait_longer
    return claim


def _is_abandoned(job: Job) -> bool:
    """Whether a command-line process still claims to run a job; if the folder is free, that process has ended."""
    return job.state == "running" and (job.worker or "").startswith(_WORKER)


def _not_resumable_error(job: Job) -> InputError:
    return InputError(f"only an interrupted or cancelled run can continue; {job.run} is {job.state}; run its job again")


@contextlib.contextmanager
def end_job_on_error(claim: Claim, *, again: str = "") -> Iterator[None]:
    """While this context is active, an error also ends the job in the store.

    The job can then be resumed immediately. again: command that continues the run; empty if its store is deleted after
    the run.
    """
    try:
        yield
    except StoreError as error:
        if not again:
            raise
        raise StoreError(f"{error}; the designs found so far are kept; then continue with: {again}") from error
    except LeaseLost:
        raise
    except BaseException as error:
        with contextlib.suppress(LeaseLost, StoreError):  # the pending error matters more
            claim.fail(str(error) or "interrupted", again=False)
        raise


def _worker_name() -> str:
    return f"{_WORKER} on {socket.gethostname()}, process {os.getpid()}"
