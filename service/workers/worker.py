"""Worker: claims jobs in a store, solves them, and writes the results."""

import contextlib
import logging
import os
import secrets
import socket
import time
import traceback
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, replace
from functools import partial
from typing import Any

from ...model.arrays import Array
from ...model.errors import ForeignRecords, InfeasibleError, InputError, LeaseLost, StoreError
from ...optimise.engine.engine import Engine
from ...optimise.front.progress import LOADING, Progress
from ...optimise.problem.problem import Problem
from ..jobs.submission import (
    LONGEST_CALL,
    end_custom_processes_on_exit,
    parse_with_allowed_functions,
    with_time_limit_per_call,
)
from ..resources.disk import full_places_text, is_disk_full
from ..resources.memory import TOLERATED, Memory
from ..runs.result import infeasible_result, json_text, result_of
from ..store import LEASE, NO_LIMITS, Artefact, Claim, Limits, Store
from ..store.database import Full
from .engines import EngineOptions, engine_of
from .heartbeat import PULSE, Budget, Heartbeat, Stop
from .logs import log_subject

_log = logging.getLogger(__name__)
_AWAY = 1.0  # s between two attempts while the database is unreachable
_FULL = 10.0  # s until a job that found a full disk is retried
_PARTS = 2  # parts loaded before a search: its functions, then the job with its records
_PATIENCE = 1.0  # s that a cancelled job waits for a search that has not started
MOST = 64
"""Maximum designs of an interim front: enough for its shape, and at most a few kB."""
_DELAY = 2.0  # s before another attempt after the first error; doubled with each further error


@dataclass(frozen=True, kw_only=True)
class Terms:
    """Limits and permissions that a worker applies to its jobs.

    limits: limits for every job, in addition to its own. The process ends if the memory limit is exceeded. It also ends
    after `grace`, the time that a round may take after the worker must stop, s; see `Heartbeat`. allowed_quantities:
    functions, "module:function", that jobs may use as custom quantities. engine: engine for expensive evaluations.
    """

    limits: Limits = NO_LIMITS
    grace: float | None = None
    allowed_quantities: tuple[str, ...] = ()
    engine: EngineOptions = EngineOptions(cores=1)


DEFAULT = Terms()


class Stopped(Exception):
    """The worker must stop, so its job goes back to the queue."""


class Stale(Exception):
    """Earlier jobs occupy so much memory that a fresh process must take the next one."""


def worker_name() -> str:
    """Return a unique name for a worker: machine, process, and some letters."""
    return f"{socket.gethostname()}-{os.getpid()}-{secrets.token_hex(3)}"


def work(
    store: Store,
    *,
    name: str | None = None,
    lease: float = LEASE,
    stop: Stop | None = None,
    drain: bool = False,
    most_running: int | None = None,
    terms: Terms = DEFAULT,
) -> int:
    """Solve jobs in a store one after another, and return the number of claimed ones.

    lease: time that a job stays with this worker without a heartbeat, s; renewed after every third of it. stop:
    function called between rounds and while no job waits; once true, the current job returns to the queue and work
    ends. drain: end as soon as no job waits. most_running: number of running jobs at which no more are claimed.

    An unreachable database is retried every second; with `drain`, it raises `StoreError` unless the disk is full.
    Raises `Stale`, but only if there is a grace.
    """
    memory = Memory()
    name = name or worker_name()
    stop = stop or (lambda: False)
    count, greeted, away = 0, -lease, False
    with log_subject(worker=name), engine_of(terms.engine) as engine:
        while not stop():
            try:
                if time.monotonic() - greeted > lease / 3.0:
                    store.register(name)
                    greeted = time.monotonic()
                claim = store.claim(name, lease=lease, most_running=most_running)
            except StoreError as error:
                if drain and not isinstance(error, Full):
                    raise
                if not away:
                    _log.warning("%s; trying again until it is available", error)
                away = True
                time.sleep(_AWAY)
                continue
            if away:
                _log.info("the store is available again")
                away = False
            if claim is not None:
                memory.begin_job()
                if _is_out_of_memory(claim, memory, terms):
                    with contextlib.suppress(StoreError):
                        store.unregister(name)
                    raise Stale
                solve_claimed(store, claim, stop, terms, engine, memory)
                count += 1
            elif drain and not store.has_waiting_jobs():
                break
            else:
                time.sleep(PULSE)
        with contextlib.suppress(StoreError):  # if it cannot be reached, the worker's heartbeat simply stops
            store.unregister(name)
    return count


def _is_out_of_memory(claim: Claim, memory: Memory, terms: Terms) -> bool:
    """Return a job to the queue, and true, if earlier jobs occupy too much memory in this process."""
    allowed = claim.job.limits.stricter(terms.limits).memory
    if terms.grace is None or allowed is None or memory.left_by_earlier_jobs <= TOLERATED * allowed:
        return False
    with contextlib.suppress(LeaseLost, StoreError):  # otherwise its lease expires
        claim.hand_back("a new worker continues it: earlier jobs left too little memory in this one")
    return True


def solve_claimed(
    store: Store,
    claim: Claim,
    stop: Stop,
    terms: Terms = DEFAULT,
    engine: Engine | None = None,
    memory: Memory | None = None,
) -> None:
    """Solve a claimed job and end it; after a failure, return it to the queue with the reason.

    Designs evaluated under earlier claims are not evaluated again. If the lease is lost, or the database is unreachable
    until it ends, nothing is written: the next worker continues from the stored records.
    """
    budget = Budget(claim.job.limits.stricter(terms.limits), waited=lambda: claim.waited)
    claim.patient = lambda _: not (claim.cancel_asked or stop())
    with log_subject(job=claim.job.id):
        _log.info("claimed")
        heartbeat = Heartbeat(
            claim, budget=budget, memory=memory or Memory(), stop=stop, grace=terms.grace, patience=_PATIENCE
        )
        try:
            with heartbeat:
                _solve_and_end(claim, lambda: _solve(store, claim, budget, terms, engine, heartbeat, stop))
        except (LeaseLost, StoreError) as error:
            _log.warning("left as it is: %s", error)
            with contextlib.suppress(StoreError):  # otherwise its lease expires
                claim.release()


def _solve_and_end(claim: Claim, solve: Callable[[], None]) -> None:
    """Solve a job; after a failure, return it to the queue with the reason."""
    try:
        solve()
    except Stopped:
        claim.hand_back("its worker stopped; another one continues")
        _log.info("handed back")
    except InfeasibleError as error:
        claim.finish(infeasible_result(error, claim.job.run))
        _log.info("infeasible: %s", error)
    except InputError as error:
        claim.fail(str(error), again=False)
        _log.warning("failed: %s", error)
    except Full as error:  # the job or its worker is to end while a write waits for space
        if claim.cancel_asked:
            claim.end_as_cancelled()
        else:
            claim.hand_back(f"waits: {error}")
        _log.warning("given back: %s", error)
    except (LeaseLost, StoreError):
        raise
    except OSError as error:
        if not is_disk_full(error):
            _fail_and_retry(claim, error)
            return
        claim.hand_back(f"waits: Disk full: {full_places_text(error)}", delay=_FULL)
        _log.warning("handed back: %s; trying again in %g s", full_places_text(error), _FULL)
    except Exception as error:  # noqa: BLE001 - whatever it is, the job and not the worker ends
        _fail_and_retry(claim, error)
    except BaseException:
        with contextlib.suppress(LeaseLost, StoreError):  # the interruption matters more
            claim.hand_back("its worker was interrupted; another one continues")
        raise


def _fail_and_retry(claim: Claim, error: Exception) -> None:
    trace = "".join(traceback.format_exception(error)).encode(errors="replace")
    claim.write_files(Artefact(name="error.txt", media_type="text/plain", content=trace))
    reason = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
    claim.fail(reason, again=True, delay=_DELAY * 2.0 ** (claim.job.attempts - 1))
    _log.warning("stopped by an error", exc_info=error)


def _solve(
    store: Store, claim: Claim, budget: Budget, terms: Terms, engine: Engine | None, heartbeat: Heartbeat, stop: Stop
) -> None:
    _report_loading(claim, 0)
    from ...optimise.solve import solve

    _report_loading(claim, 1)
    problem = parse_with_allowed_functions(store.job_tables(claim.job.id), terms.allowed_quantities)
    problem = with_time_limit_per_call(problem, min(LONGEST_CALL, budget.limits.seconds or LONGEST_CALL))

    latest = (claim.job.progress or {}).get("front")  # of an earlier claim, until this search has its own

    def show(front: Array) -> None:
        nonlocal latest
        latest = front_progress(problem, front)

    def report(at: Progress) -> None:
        claim.report(at, latest)
        budget.count_evaluations(at.evaluations)

    def should_end() -> bool:
        return _must_end(claim, heartbeat, stop) or budget.is_spent()

    solve_and_report = partial(solve, problem, progress=report, stages=report, fronts=show)
    search = partial(solve_and_report, cancelled=should_end, keep=claim.keep_record, engine=engine)
    with end_custom_processes_on_exit(problem, engine):
        try:
            front = search(resume=claim.evaluation_records())
        except ForeignRecords as error:  # from an earlier release, or another type of machine
            claim.start_over(f"starts again: {error}")
            latest = None
            front = search(resume=[])
        result = result_of(front, claim.job.run)
    if not claim.cancel_asked:
        result = budget.with_limit_named(result)
    claim.finish(result, [versions_file(front.versions)])
    _log.info("%s: %s", result.status, result.message)


def front_progress(problem: Problem, values: Array) -> dict[str, Any]:
    """Return at most `MOST` designs of a front, evenly spread along its first objective, as JSON.

    values: objectives (n, m), SI, all minimised. columns: columns of the objectives in tables of designs. points:
    values in their units; for an objective with a target, the distance from it.
    """
    import numpy as np

    quantities = [problem.quantity(objective.quantity) for objective in problem.objectives]
    factors = [
        quantity.unit.factor * (-1.0 if objective.sense == "maximise" else 1.0)
        for quantity, objective in zip(quantities, problem.objectives, strict=True)
    ]
    ordered = values[np.argsort(values[:, 0], kind="stable")]
    rows = np.linspace(0, len(ordered) - 1, min(len(ordered), MOST)).round().astype(int)
    return {"columns": [quantity.field for quantity in quantities], "points": (ordered[rows] * factors).tolist()}


def _report_loading(claim: Claim, parts: int) -> None:
    """Report how much of a search is loaded, with the earlier numbers and front of the job."""
    earlier = {name: value for name, value in (claim.job.progress or {}).items() if value is not None}
    front = earlier.pop("front", None)
    last = Progress(**{**asdict(Progress(LOADING, 0, 0, 0, 0, 0.0, 0.0)), **earlier})
    claim.report(replace(last, stage=LOADING, step=parts, steps=_PARTS), front)


def versions_file(versions: Mapping[str, str]) -> Artefact:
    """Return the file with the software versions that computed a result."""
    return Artefact(name="versions.json", media_type="application/json", content=json_text(versions).encode())


def _must_end(claim: Claim, heartbeat: Heartbeat, stop: Stop) -> bool:
    """Whether the search must end with its result so far; raises the error that ends it without a result."""
    if heartbeat.lost:
        raise LeaseLost(f"job {claim.job.id}: {heartbeat.lost}")
    if not claim.cancel_asked and stop():
        raise Stopped
    return claim.cancel_asked
