"""Limits and permissions of jobs in a worker. All searches are made up."""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from slidercrank.optimise.front.front import ParetoFront
from slidercrank.optimise.problem.problem import Problem
from slidercrank.service.jobs.submission import submit
from slidercrank.service.store import Limits, Store
from slidercrank.service.workers.engines import EngineOptions
from slidercrank.service.workers.worker import Terms, work
from tests.service import fronts
from tests.service.made_up_search import Search, made_up_front, search, until
from tests.service.store.contents import progress as progress_at

TABLES = tomllib.loads(fronts.JOB)


@pytest.fixture
def store(tmp_path: Path) -> Iterator[Store]:
    """Return an empty store."""
    with Store(tmp_path / "store.db") as opened:
        yield opened


@pytest.fixture
def searches(monkeypatch: pytest.MonkeyPatch) -> Callable[[Search], None]:
    """Return a function that puts another search in the place of `solve`."""
    return lambda search: monkeypatch.setattr("slidercrank.optimise.solve.solve", search)


def test_a_search_ends_at_its_limit_of_time_with_what_it_found(store: Store, searches: Any) -> None:
    def long(problem: Problem, *, cancelled: Any, **_: Any) -> ParetoFront:
        until(cancelled)
        return made_up_front(problem, "cancelled")

    searches(long)
    job = submit(store, TABLES, limits=Limits(seconds=0.05))
    assert work(store, drain=True) == 1
    ended = store.job(job.id)
    assert (ended.state, ended.reason) == ("cancelled", "1 design; its search reached its time limit of 0.05 s")


def test_a_search_ends_at_its_limit_of_evaluations_with_what_it_found(store: Store, searches: Any) -> None:
    searches(search)  # of 16 evaluations a round
    job = submit(store, TABLES, limits=Limits(evaluations=1000))
    other = submit(store, TABLES)
    assert work(store, drain=True, terms=Terms(limits=Limits(evaluations=20))) == 2
    for ended in map(store.job, (job.id, other.id)):
        assert (ended.state, ended.records) == ("cancelled", 2)
        assert ended.reason == "1 design; its search reached its limit of 20 evaluations"


def test_a_job_that_is_cancelled_at_its_limit_was_cancelled(store: Store, searches: Any) -> None:
    def cancelled_at_once(problem: Problem, *, cancelled: Any, progress: Any, **_: Any) -> ParetoFront:
        store.cancel(1)
        progress(progress_at(1))
        assert cancelled()
        return made_up_front(problem, "cancelled")

    searches(cancelled_at_once)
    submit(store, TABLES, limits=Limits(evaluations=1))
    work(store, drain=True)
    assert store.job(1).reason == "1 design"


def test_as_many_jobs_are_in_work_as_may_be(store: Store, searches: Any) -> None:
    searches(search)
    first, second = submit(store, TABLES), submit(store, TABLES)
    held = store.claim("other", lease=60.0)
    assert held is not None
    assert store.claim("third", most_running=1) is None
    assert work(store, drain=True, most_running=2) == 1
    assert [store.job(job.id).state for job in (first, second)] == ["running", "done"]


def test_functions_of_jobs_run_only_where_the_operator_allows_them(store: Store, searches: Any) -> None:
    searches(search)
    own = {**TABLES, "quantity": {"mine": {"function": "os:getcwd", "unit": "mm"}}}
    job = store.submit(own, name="own")
    assert work(store, drain=True) == 1
    assert store.job(job.id).state == "failed"
    assert "only functions that the operator allows may run here" in store.job(job.id).reason


def test_heavy_work_goes_where_the_worker_is_told(store: Store, searches: Any) -> None:
    engines: list[Any] = []

    def watched(*given: Any, engine: Any, **more: Any) -> ParetoFront:
        engines.append(engine)
        return search(*given, **more)

    searches(watched)
    for options in (EngineOptions(cores=1), EngineOptions(cores=3), EngineOptions(scheduler="tcp://127.0.0.1:8786")):
        submit(store, TABLES)
        work(store, drain=True, terms=Terms(engine=options))
    assert [type(engine).__name__ for engine in engines] == ["Serial", "Processes", "Cluster"]
    assert (engines[1].workers, engines[2].address) == (3, "tcp://127.0.0.1:8786")
