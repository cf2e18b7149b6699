"""Contract of every store on watching many jobs at once."""

from __future__ import annotations

import time

import pytest

from slidercrank.service.store import Store
from tests.service.store.contents import add, claim_waiting_job, progress, result


def test_news_are_the_events_after_the_one_that_is_known(store: Store) -> None:
    one, other, third = (add(store).id for _ in range(3))
    claim = claim_waiting_job(store)
    for number in range(1, 6):
        claim.report(progress(number))
    news = store.news({one: 3, other: 1, third: 0})
    assert [event.number for event in news[one].events] == [4, 5, 6, 7]
    assert news[one].events == store.events(one, after=3)
    assert (news[one].state, news[one].last_number, news[one].is_over) == ("running", 7, False)
    assert (news[other].state, news[other].events) == ("queued", [])
    assert news[third].events == store.events(third)


def test_news_are_told_at_most_so_many_at_a_time_and_none_is_left_out(store: Store) -> None:
    job = add(store).id
    claim = claim_waiting_job(store)
    for number in range(1, 8):
        claim.report(progress(number))
    claim.finish(result())
    found, over = [0], False
    while not over:
        news = store.news({job: found[-1]}, limit=4)[job]
        assert len(news.events) <= 4
        found += [event.number for event in news.events]
        over = news.is_over
    assert found == list(range(11))
    assert store.news({job: 10})[job].is_over
    assert not store.news({job: 10})[job].events


def test_news_of_many_jobs_come_at_once_and_of_none_that_is_gone(store: Store) -> None:
    numbers = [add(store).id for _ in range(130)]
    store.cancel(numbers[7])
    store.delete(numbers[7])
    news = store.news(dict.fromkeys([*numbers, 10_000], 0))
    assert sorted(news) == [number for number in numbers if number != numbers[7]]
    assert all(len(one.events) == 1 for one in news.values())
    assert store.news({}) == {}


def test_the_longest_wait_is_that_of_the_oldest_job_that_may_be_claimed(store: Store) -> None:
    assert store.longest_wait() == 0.0
    add(store)
    time.sleep(0.05)
    assert 0.05 <= store.longest_wait() < 30.0
    claim_waiting_job(store).fail("later", again=True, delay=60.0)
    assert store.longest_wait() == pytest.approx(0.0), "it may not be claimed yet"
