"""Limits of jobs: the stricter one holds, and a search that reaches one says so."""

from __future__ import annotations

import time

import pytest

from slidercrank.model.errors import InputError
from slidercrank.service.resources.memory import parse_size, size_text
from slidercrank.service.store import NO_LIMITS, Limits
from slidercrank.service.workers.heartbeat import Budget
from tests.service.store.contents import result


def test_the_stricter_of_two_limits_holds() -> None:
    asked = Limits(seconds=10.0, evaluations=500, memory=None)
    ceiling = Limits(seconds=20.0, evaluations=100, memory=10**9)
    assert asked.stricter(ceiling) == Limits(seconds=10.0, evaluations=100, memory=10**9)
    assert ceiling.stricter(asked) == asked.stricter(ceiling)
    assert NO_LIMITS.stricter(NO_LIMITS) == NO_LIMITS


def test_a_search_without_limits_is_never_over() -> None:
    budget = Budget(NO_LIMITS)
    budget.count_evaluations(10**12)
    assert not budget.is_spent()
    assert budget.with_limit_named(result("cancelled")) == result("cancelled")


def test_evaluations_are_spent_when_as_many_were_made() -> None:
    budget = Budget(Limits(evaluations=100))
    budget.count_evaluations(99)
    assert not budget.is_spent()
    budget.count_evaluations(100)
    assert budget.is_spent()
    assert (
        budget.with_limit_named(result("cancelled")).message
        == "2 designs; its search reached its limit of 100 evaluations"
    )


def test_time_is_spent_when_it_has_passed() -> None:
    budget = Budget(Limits(seconds=0.05))
    assert not budget.is_spent()
    time.sleep(0.06)
    assert budget.is_spent()
    message = budget.with_limit_named(result("cancelled")).message
    assert message == "2 designs; its search reached its time limit of 0.05 s"


def test_a_search_that_was_done_in_time_says_nothing_of_limits() -> None:
    budget = Budget(Limits(evaluations=1))
    budget.count_evaluations(1)
    assert budget.with_limit_named(result("done")) == result("done")


@pytest.mark.parametrize(
    ("text", "size"),
    [("500 MB", 500_000_000), ("2GB", 2_000_000_000), ("1.5 GiB", 1_610_612_736), ("1000", 1000), (" 3 kb ", 3000)],
)
def test_amounts_of_memory_are_read_with_their_unit(text: str, size: int) -> None:
    assert parse_size(text, "--memory") == size


@pytest.mark.parametrize("text", ["", "much", "-1 GB", "1 parsec", "0 MB", "1e9", "nan", "9" * 30, "1 GB 2"])
def test_what_is_no_amount_of_memory_is_refused_with_the_name_of_the_option(text: str) -> None:
    with pytest.raises(InputError, match="--memory must be an amount of memory with its unit"):
        parse_size(text, "--memory")


def test_amounts_are_shown_with_three_digits() -> None:
    sizes = (0, 999, 1000, 127_400_000, 999_499_000, 999_600_000, 2e12)
    assert [size_text(size) for size in sizes] == ["0 bytes", "999 bytes", "1 kB", "127 MB", "999 MB", "1 GB", "2 TB"]
