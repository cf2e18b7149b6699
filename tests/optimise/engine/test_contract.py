"""Contract of every engine: serial, processes and a Dask cluster."""

import os

import pytest

from slidercrank.model.errors import InputError
from slidercrank.optimise.engine.engine import Engine, Serial
from tests.optimise.engine import work


class Enough(Exception):
    """Exception that the polling of these tests raises."""


def test_results_come_in_the_order_of_the_items(engine: Engine) -> None:
    assert engine.map(work.later_ones_first, range(12)) == list(range(12))
    assert engine.map(work.square, []) == []


def test_work_is_done_by_as_many_processes_as_there_are_workers(engine: Engine) -> None:
    found = set(engine.map(work.process, range(8)))
    assert len(found) == engine.workers
    assert (os.getpid() in found) == isinstance(engine, Serial)


def test_what_the_function_raises_is_raised_as_it_is(engine: Engine) -> None:
    with pytest.raises(InputError, match=r"^it must not be three; got 3; take another one$"):
        engine.map(work.refuse_three, range(6))
    assert engine.map(work.square, range(3)) == [0, 1, 4]


def test_what_the_polling_raises_ends_the_map_within_a_second(engine: Engine) -> None:
    asked = 0

    def poll() -> None:
        nonlocal asked
        asked += 1
        if asked == 3:
            raise Enough

    with pytest.raises(Enough):
        engine.map(work.slow, range(200), poll=poll)
    assert asked == 3
    assert engine.map(work.square, range(3)) == [0, 1, 4]


def test_an_engine_that_was_closed_starts_again(engine: Engine) -> None:
    engine.close()
    assert engine.map(work.square, range(3)) == [0, 1, 4]
