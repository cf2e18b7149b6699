"""Events of jobs: none missed, none twice, in order, however often a client comes back."""

from __future__ import annotations

import asyncio
import contextlib
import json
import threading
import time
from collections.abc import Iterator
from typing import Any

import httpx
import pytest

from slidercrank.model.errors import StoreError
from slidercrank.service.api import events
from slidercrank.service.store import Claim, Store
from tests.service.api.conftest import Serve
from tests.service.api.serving import refusal_sentence
from tests.service.store.contents import add, claim_waiting_job, progress, result

STREAM = {"Accept": "text/event-stream"}


def read(lines: Iterator[str]) -> Iterator[dict[str, Any]]:
    """Yield the events of a stream, each with what its fields say; comments have the kind "comment"."""
    fields: dict[str, str] = {}
    for line in lines:
        if line.startswith(":"):
            yield {"kind": "comment"}
        elif line:
            name, _, value = line.partition(": ")
            fields[name] = value
        elif "data" in fields:
            event = json.loads(fields["data"])
            assert fields["id"] == str(event["number"])
            assert fields["event"] == event["kind"]
            yield event
            fields = {}


@contextlib.contextmanager
def streaming(client: httpx.Client, job: int, after: int | None = None) -> Iterator[Iterator[dict[str, Any]]]:
    """Give the events of a job after one, as they come."""
    headers = STREAM if after is None else {**STREAM, "Last-Event-ID": str(after)}
    with client.stream("GET", f"/jobs/{job}/events", headers=headers) as response:
        assert response.status_code == 200
        assert response.headers["content-type"].startswith("text/event-stream")
        yield read(response.iter_lines())


def numbers(found: Iterator[dict[str, Any]] | list[dict[str, Any]]) -> list[int]:
    """Return the numbers of events."""
    return [event["number"] for event in found]


def working(claim: Claim, rounds: int, pause: float = 0.0) -> threading.Thread:
    """Start a worker that goes through rounds, with an event each, and ends its job."""

    def work() -> None:
        for number in range(1, rounds + 1):
            claim.report(progress(number))
            time.sleep(pause)
        claim.finish(result())

    thread = threading.Thread(target=work)
    thread.start()
    return thread


def test_a_stream_tells_everything_and_ends_with_the_job(client: httpx.Client, store: Store) -> None:
    job = add(store)
    with streaming(client, job.id) as found:
        assert next(found)["data"] == {"state": "queued", "reason": ""}
        worker = working(claim_waiting_job(store), 30, 0.01)
        told = list(found)
    worker.join()
    assert numbers(told) == list(range(2, 34))
    assert [event["kind"] for event in told] == ["state", *["progress"] * 30, "state"]
    assert told[-1]["data"]["state"] == "done"
    assert told[5]["data"]["round"] == 5


def test_a_client_that_comes_back_misses_nothing(client: httpx.Client, store: Store) -> None:
    job = add(store)
    worker = working(claim_waiting_job(store), 60, 0.01)
    told: list[dict[str, Any]] = []
    while not told or told[-1]["data"].get("state") != "done":
        with streaming(client, job.id, told[-1]["number"] if told else None) as found:
            for event, _ in zip(found, range(7), strict=False):
                told.append(event)
    worker.join()
    assert numbers(told) == list(range(1, store.job(job.id).events + 1))


def test_an_ended_job_is_told_at_once_and_need_not_be_asked_again(client: httpx.Client, store: Store) -> None:
    job = add(store)
    claim_waiting_job(store).finish(result())
    with streaming(client, job.id) as found:
        assert numbers(found) == [1, 2, 3]
    with streaming(client, job.id, 1) as found:
        assert numbers(found) == [2, 3]
    for last in (3, 10**9):
        response = client.get(f"/jobs/{job.id}/events", headers={**STREAM, "Last-Event-ID": str(last)})
        assert response.status_code == 204, "a browser would ask for ever otherwise"


def test_a_stream_of_a_resumed_job_goes_on_past_its_earlier_ends(client: httpx.Client, store: Store) -> None:
    job = add(store)
    store.cancel(job.id)
    store.resume(job.id)
    claim_waiting_job(store).fail("no memory", again=False)
    store.resume(job.id)
    claim = claim_waiting_job(store)
    with streaming(client, job.id) as whole, streaming(client, job.id, 2) as rest:
        assert [next(whole)["number"] for _ in range(7)] == list(range(1, 8))
        claim.report(progress(1))
        assert next(whole)["kind"] == "progress"
        claim.finish(result())
        assert numbers(whole) == [9]
        assert numbers(rest) == list(range(3, 10))


def test_more_events_than_are_kept_are_told_too(
    client: httpx.Client, store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(events, "_PAGE", 7)
    monkeypatch.setattr(events, "_RECENT", 16)
    job = add(store)
    claim = claim_waiting_job(store)
    with contextlib.ExitStack() as stack:
        first = stack.enter_context(streaming(client, job.id))
        assert next(first)["number"] == 1
        working(claim, 80).join()
        late = stack.enter_context(streaming(client, job.id, 30))
        assert numbers(first) == list(range(2, 84))
        assert numbers(late) == list(range(31, 84))


def test_a_number_that_is_not_there_yet_keeps_no_other_stream_waiting(client: httpx.Client, store: Store) -> None:
    job = add(store)
    claim = claim_waiting_job(store)
    with streaming(client, job.id, 10**6) as ahead, streaming(client, job.id) as found:
        working(claim, 5).join()
        assert numbers(found) == list(range(1, 9))
        assert numbers(ahead) == list(range(3, 9)), "it is told what comes after the last one there was"


def test_silence_is_filled_with_comments(client: httpx.Client, store: Store, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(events, "HEARTBEAT", 0.05)
    job = add(store)
    with streaming(client, job.id) as found:
        assert next(found)["number"] == 1
        assert [next(found)["kind"] for _ in range(3)] == ["comment"] * 3
        store.cancel(job.id)
        assert [event["number"] for event in found if event["kind"] != "comment"] == [2]


def test_a_stream_ends_when_its_job_is_deleted(client: httpx.Client, store: Store) -> None:
    one, other = add(store), add(store)
    store.cancel(one.id)
    store.resume(one.id)
    with streaming(client, one.id) as found:
        assert [next(found)["number"] for _ in range(3)] == [1, 2, 3]
        store.cancel(one.id)
        store.delete(one.id)
        assert numbers(found) in ([], [4])
    assert client.get(f"/jobs/{other.id}").status_code == 200


def test_streams_go_on_after_the_database_was_away(
    client: httpx.Client, store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(events, "_PATIENCE", 0.05)
    job = add(store)
    news, away = store.news, True

    def failing(*arguments: Any, **options: Any) -> Any:
        if away:
            raise StoreError("the store must be reached; it is away; wait")
        return news(*arguments, **options)

    monkeypatch.setattr(store, "news", failing)
    with streaming(client, job.id) as found:
        assert next(found)["number"] == 1
        store.cancel(job.id)
        time.sleep(0.2)
        away = False
        assert numbers(found) == [2]


def test_events_come_as_pages_of_json(client: httpx.Client, store: Store) -> None:
    job = add(store)
    working(claim_waiting_job(store), 4).join()
    everything = client.get(f"/jobs/{job.id}/events").json()
    assert numbers(everything["events"]) == list(range(1, 8))
    assert everything["last"] == 7
    page = client.get(f"/jobs/{job.id}/events", params={"after": 2, "limit": 3}).json()
    assert page["events"] == everything["events"][2:5]
    assert page["last"] == 5
    assert client.get(f"/jobs/{job.id}/events", headers={"Last-Event-ID": "5"}).json()["last"] == 7
    assert client.get(f"/jobs/{job.id}/events", params={"after": 99}).json() == {"events": [], "last": 7}
    for last in ("-1", "x", "9" * 40):
        refusal_sentence(client.get(f"/jobs/{job.id}/events", headers={**STREAM, "Last-Event-ID": last}), 422)
    refusal_sentence(client.get("/jobs/99/events", headers=STREAM), 404)


def test_a_hundred_streams_ask_the_store_no_more_often_than_one(serve: Serve, store: Store) -> None:
    client = serve()
    claims: list[Claim] = []
    for _ in range(10):
        add(store)
        claims.append(claim_waiting_job(store))
    asked: list[int] = []
    news = store.news

    def counted(after: dict[int, int], **options: Any) -> Any:
        asked.append(len(after))
        return news(after, **options)

    store.news = counted  # type: ignore[method-assign,assignment]

    async def follow(session: httpx.AsyncClient, job: int) -> list[int]:
        async with session.stream("GET", f"/jobs/{job}/events", headers=STREAM) as response:
            return numbers(list(read(iter([line async for line in response.aiter_lines()]))))

    async def follow_all() -> list[list[int]]:
        limits = httpx.Limits(max_connections=None)
        async with httpx.AsyncClient(base_url=client.base_url, timeout=60.0, limits=limits, trust_env=False) as session:
            return await asyncio.gather(*(follow(session, claim.job.id) for claim in claims for _ in range(10)))

    start = time.monotonic()
    workers = [working(claim, 10, 0.1) for claim in claims]
    told = asyncio.run(follow_all())
    for worker in workers:
        worker.join()
    assert told == [list(range(1, 14))] * 100
    assert len(asked) <= (time.monotonic() - start) / events.POLL + 2
    assert max(asked) <= 10


def test_a_follower_that_is_slow_at_the_end_does_not_end_the_streams_of_the_resumed_job(store: Store) -> None:
    job = add(store)

    async def follow() -> list[int]:
        feed = events.Feed(store)
        slow = feed.stream(job.id, 0, last=1, heartbeat=30.0)
        await anext(slow)
        store.cancel(job.id)
        while (await anext(slow)) is None:
            pass  # it has the event of the end, and does not come back
        store.resume(job.id)
        found = []
        async for event in feed.stream(job.id, 1, last=3, heartbeat=30.0):
            assert event is not None
            found.append(event.number)
            if event.number == 3:
                store.cancel(job.id)
        await slow.aclose()  # type: ignore[attr-defined]
        return found

    assert asyncio.run(asyncio.wait_for(follow(), 10.0)) == [2, 3, 4]


def test_the_feed_ends_all_streams_when_the_service_stops(store: Store) -> None:
    job = add(store)

    async def follow() -> list[int]:
        feed = events.Feed(store)
        found = []
        async for event in feed.stream(job.id, 0, last=1, heartbeat=30.0):
            assert event is not None
            found.append(event.number)
            asyncio.get_running_loop().call_later(0.05, feed.close)
        return found

    assert asyncio.run(asyncio.wait_for(follow(), 10.0)) == [1]
