"""The clock of the database is set, forward and back by hours, while jobs wait and are solved."""

from __future__ import annotations

import time
from collections.abc import Iterator
from typing import Any

import pytest
from sqlalchemy import Engine, event

from slidercrank.model.errors import LeaseLost
from slidercrank.service.store import Store
from slidercrank.service.store.clock import JUMP, SETTLING, Jumps
from slidercrank.service.workers.heartbeat import Heartbeat
from tests.service.store.contents import add, progress, result, search_record, taken

HOURS = [7200.0, -7200.0, 1200.0, -1200.0]
steps = pytest.mark.parametrize("step", HOURS, ids=[f"{step / 60:+.0f} min" for step in HOURS])


class Clock:
    """The clock of all databases of this process. ahead: of the true time, s."""

    ahead = 0.0

    def told(self, _connection: Any, _cursor: Any, statement: str, parameters: Any, *_: Any) -> tuple[str, Any]:
        """Return a statement that sees the time of this clock."""
        for text in ("((julianday('now') - 2440587.5) * 86400.0)", "CAST(extract(epoch FROM clock_timestamp()) AS"):
            if text.startswith("CAST"):
                statement = statement.replace(text, text.replace(" AS", f" + {self.ahead!r} AS"))
            else:
                statement = statement.replace(text, f"({text} + {self.ahead!r})")
        return statement, parameters


@pytest.fixture
def clock() -> Iterator[Clock]:
    """Return a clock that can be set."""
    made = Clock()
    event.listen(Engine, "before_cursor_execute", made.told, retval=True)
    yield made
    event.remove(Engine, "before_cursor_execute", made.told)


@pytest.fixture
def at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let claims settle within a moment of a jump, but not before a heartbeat has looked."""
    monkeypatch.setattr("slidercrank.service.store.clock.SETTLING", 0.8)


@steps
@pytest.mark.usefixtures("at_once")
def test_a_job_stays_with_its_worker_when_the_clock_is_set(store: Store, clock: Clock, step: float) -> None:
    job = add(store)
    store.greet("first")
    claim = taken(store, "first", lease=30.0)
    assert store.claim("second") is None  # it has seen the clock as it was
    with Heartbeat(claim):
        clock.ahead = step
        for _ in range(6):
            assert store.claim("second") is None
            time.sleep(0.2)
        claim.keep(search_record(1))
        claim.tell(progress(1))
    claim.finish(result())
    ended = store.job(job.id)
    assert (ended.state, ended.fence) == ("done", 1)


@steps
def test_a_write_between_a_jump_and_the_next_renewal_is_taken(store: Store, clock: Clock, step: float) -> None:
    add(store)
    claim = taken(store)
    clock.ahead = step
    claim.tell(progress(1))
    left = store.job(1).lease_until
    assert left is not None
    assert left == pytest.approx(time.time() + step + claim.lease, abs=5.0)


@steps
def test_the_job_of_a_dead_worker_goes_to_another_one_when_the_clock_was_set(
    store: Store, address: str, clock: Clock, step: float
) -> None:
    job = add(store)
    store.greet("first")
    lost = taken(store, "first", lease=30.0)
    lost.tell(progress(1))
    clock.ahead = step
    with Store(address) as other:  # one that has not seen the jump
        again = other.claim("second")
        assert again is not None
        assert (again.job.id, again.job.fence) == (job.id, 2)
        with pytest.raises(LeaseLost):
            lost.finish(result())
        again.finish(result())
    states = [one.data["state"] for one in store.events(job.id) if one.kind == "state"]
    assert states == ["queued", "running", "running", "done"]


@pytest.mark.parametrize("ahead", [7200.0, 600.0])
def test_a_job_that_was_submitted_under_a_clock_set_back_since_is_claimed_at_once(
    store: Store, address: str, clock: Clock, ahead: float
) -> None:
    clock.ahead = ahead
    job = add(store)
    clock.ahead = 0.0
    with Store(address) as other:
        claim = other.claim("first")
    assert claim is not None
    assert claim.job.id == job.id


def test_a_job_that_is_tried_again_is_due_within_a_minute(store: Store) -> None:
    job = add(store, most_attempts=100)
    taken(store).fail("an error", again=True, delay=1e30)
    assert store.job(job.id).due - time.time() < 61.0
    assert store.claim("second") is None


@steps
def test_a_worker_that_is_gone_does_not_look_alive_when_the_clock_was_set(
    store: Store, clock: Clock, step: float
) -> None:
    store.greet("first")
    clock.ahead = step
    store.greet("second")
    assert [worker.id for worker in store.workers() if worker.silent < 30.0] == ["second"]


def test_jumps_are_told_from_delays_and_from_sleep() -> None:
    here = 100.0
    jumps = Jumps(lambda: here)
    assert jumps.settled(5000.0)
    for passed, there, settled in (
        (10.0, 5010.0, True),
        (0.5, 5010.5 + 0.9 * JUMP, True),  # a slow answer
        (0.5, 5011.0, True),
        (0.5, 8611.5, False),
        (SETTLING - 0.5, 8611.5 + SETTLING - 0.5, False),
        (0.5, 8611.5 + SETTLING, True),
        (0.5, 8612.0 + SETTLING - 2.0 * JUMP, False),
    ):
        here += passed
        assert jumps.settled(there) is settled, there
