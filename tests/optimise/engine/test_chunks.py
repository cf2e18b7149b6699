"""When a batch leaves the process, and into how many chunks it is cut."""

import os
import time
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import pytest

from slidercrank.optimise.engine import engine as chunks
from slidercrank.optimise.engine.engine import Chunked, Poll, Serial, Shared
from slidercrank.optimise.engine.processes import Processes
from slidercrank.optimise.solve import solve
from tests.optimise.engine import work
from tests.optimise.problems import shipped

ROWS = np.arange(200.0).reshape(100, 2)


class Noted:
    """An engine that notes what it is given, and says that it has four workers."""

    workers = 4

    def __init__(self, *, worth: bool = True) -> None:
        self.wanted, self.items, self.asked = worth, list[int](), list[float]()

    def should_map(self, seconds: float) -> bool:
        self.asked.append(seconds)
        return self.wanted

    def map(self, function: Callable[[Any], Any], items: Sequence[Any], *, poll: Poll | None = None) -> list[Any]:
        self.items.append(len(items))
        return Serial().map(function, items, poll=poll)

    def close(self) -> None:
        pass


def test_rows_come_back_in_order_however_they_are_cut() -> None:
    engine = Noted()
    parts = Chunked(Shared(2.0), engine)(work.doubled, "twice", ROWS)
    assert np.array_equal(np.concatenate([part for _, part in parts]), 2.0 * ROWS)
    assert len(engine.items) == 1


def test_chunks_are_of_50_ms_at_least() -> None:
    engine = Noted()
    chunked = Chunked(Shared(2.0), engine)
    chunked(work.doubled, "twice", ROWS)
    chunked(work.doubled, "twice", ROWS)  # 2 ms a row, on a busy machine more
    assert 1 <= engine.items[1] <= 4 * 4
    assert engine.items[1] <= engine.asked[-1] / 0.05


def test_light_work_is_neither_offered_nor_cut() -> None:
    engine = Noted()
    chunked = Chunked(Shared(2.0), engine)
    chunked(work.light, "once", ROWS)
    assert len(chunked(work.light, "once", ROWS)) == 1
    assert not engine.items
    assert not engine.asked


def test_nothing_is_cut_where_nothing_is_gained() -> None:
    assert len(Chunked(Shared(2.0), Serial())(work.doubled, "twice", ROWS)) == 1


def test_processes_start_only_when_so_much_was_heavy_that_they_pay() -> None:
    engine = Processes(2)
    assert [engine.should_map(seconds) for seconds in (1.0, 1.0, 1.5)] == [False, False, True]


def test_a_light_job_starts_no_process(monkeypatch: pytest.MonkeyPatch) -> None:
    def never(*_: object, **__: object) -> None:
        raise AssertionError("it was mapped")

    alone = solve(shipped("sieve"))  # kernels are compiled then
    engine = Processes(2)
    monkeypatch.setattr(engine, "map", never)
    monkeypatch.setattr(chunks, "perf_counter", time.process_time)  # whatever else this machine does
    found = solve(shipped("sieve"), engine=engine)
    assert found.designs.equals(alone.designs)
    assert engine._refused < 2.0


def test_what_cannot_leave_the_process_stays_in_it(processes: Processes) -> None:
    chunked = Chunked(Shared(lambda: 2.0), processes)
    parts = chunked(_call, "twice", np.repeat(ROWS, 3, axis=0))
    assert {pid for pid, _ in parts} == {os.getpid()}


def test_a_shared_value_is_made_once_in_a_process(processes: Processes) -> None:
    shared = Shared(work.Made())
    items = [(shared, index) for index in range(12)]
    made = processes.map(work.made, items)
    assert len(set(made)) <= processes.workers


def _call(subject: Callable[[], float], asked: str, rows: Any) -> Any:
    return work.doubled(subject(), asked, rows)
