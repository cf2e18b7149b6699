"""Short versions of the faults of `make faults`: real processes, real signals, and a search of the service's own."""

from __future__ import annotations

import sys

import pytest

from tests.faults.clocks import clocks
from tests.faults.commits import commits
from tests.faults.dask_faults import strike
from tests.faults.disk import disk
from tests.faults.flood import flood
from tests.faults.full_disk import fill_disk_at_random
from tests.faults.full_store_disk import fill_store_disk
from tests.faults.kills import kills
from tests.faults.pauses import pauses
from tests.faults.places import Kind
from tests.faults.restarts import restarts
from tests.faults.runaway import runaway
from tests.faults.small_disk import small_disk
from tests.faults.stalls import stall
from tests.faults.starts import starts
from tests.faults.watched import SIGNS
from tests.service.store import postgresql

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(sys.platform != "linux", reason="the harness uses signals and limits of Linux"),
]
needs_disk = pytest.mark.usefixtures("mountable")
needs_server = pytest.mark.skipif(postgresql.why_not() is not None, reason=str(postgresql.why_not()))
both = pytest.mark.parametrize("kind", ["sqlite", pytest.param("postgresql", marks=needs_server)])


@pytest.fixture
def mountable() -> None:
    """Skip a test where no small disk can be mounted."""
    try:
        with small_disk():
            pass
    except SystemExit as reason:
        pytest.skip(str(reason))


@both
def test_killed_workers_lose_and_double_nothing(kind: Kind) -> None:
    verdict = kills(kind, 2, seed=3)
    assert verdict.violations == []
    assert verdict.resumptions > 0


def test_paused_workers_write_nothing_after_their_lease() -> None:
    verdict = pauses("sqlite", 2, seed=1)
    assert verdict.violations == []
    assert verdict.refused > 0


@needs_server
def test_a_server_that_crashes_loses_nothing() -> None:
    count, verdict = restarts(3.0, seed=1)
    assert verdict.violations == []
    assert count > 0


def test_a_full_disk_loses_and_damages_nothing() -> None:
    verdict = fill_disk_at_random(2, seed=1)
    assert verdict.violations == []
    assert verdict.failed > 0


@both
def test_no_commit_that_fails_loses_anything(kind: Kind) -> None:
    count, verdict = commits(kind, every=6)
    assert verdict.violations == []
    assert count >= 3


def test_killed_dask_workers_and_schedulers_lose_no_evaluation() -> None:
    struck = strike(1, 1, seed=1, between=2.0, designs=3, samples=200)
    assert (struck.workers, struck.schedulers) == (1, 1)
    assert struck.violations == []
    assert (struck.lost, struck.doubled) == (0, 0)


def test_no_flood_of_requests_keeps_others_out() -> None:
    flooded = flood(1, seed=1)
    assert flooded.violations == []
    assert flooded.signs >= SIGNS


def test_answers_that_nobody_takes_cost_neither_room_nor_memory() -> None:
    flooded = stall("many", 3.0)
    assert flooded.violations == []
    assert flooded.signs >= SIGNS


def test_functions_that_loop_end_with_their_job_their_worker_and_their_service() -> None:
    verdict = runaway(1, seed=1, short=True)
    assert verdict.violations == []
    assert verdict.resumptions == 3


def test_a_service_ends_by_a_signal_right_after_it_prints_its_address() -> None:
    verdict = starts(2, seed=1, random_moments=False)
    assert verdict.violations == []


def test_a_clock_that_is_set_ends_no_worker_before_its_queue_is_empty() -> None:
    verdict = clocks("sqlite", 1, seed=1)
    assert verdict.violations == []
    assert verdict.jobs > 0


@needs_disk
def test_a_disk_without_room_for_a_round_fails_no_job() -> None:
    verdict = fill_store_disk(1, seed=1)
    assert verdict.violations == []
    assert verdict.failed > 0


@needs_disk
def test_a_service_on_a_full_disk_says_so_and_goes_on_when_there_is_room() -> None:
    verdict = disk(0, seed=1)
    assert verdict.violations == []
    assert verdict.jobs == 1
