"""A service under load: `python -m benchmarks.service_load [sqlite|postgresql]`. All of it stays on this machine."""

from __future__ import annotations

import asyncio
import json
import random
import sys
import threading
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from statistics import median, quantiles
from typing import Any

import httpx

from slidercrank.service.jobs.submission import submit
from slidercrank.service.store import Store
from tests.faults.jobs import tables
from tests.faults.places import place

from .report import Row, machine, show
from .service_process import headers, service

CLIENTS = 100
_EVERY = 1.0  # s between two reads of one client
_AT_REST = 10  # clients by which the answers of a service at rest are measured
_ASKING = 4  # clients that have something computed, one thing after the other, while the others read
_LONG = {"method": "nsga2", "samples": 50, "evaluations": 10_000_000, "designs": 100}
_COMPUTED = (
    "jobs/{done}/designs/{design}/analysis",
    "jobs/{done}/designs/{design}/topics/balance",
    "jobs/{done}/figures/design_{design}.svg",
    "jobs/{done}/designs/{design}/report.html",
)
_SMALL = {"method": "random", "samples": 50, "evaluations": 100, "designs": 8}


def warm(url: str, done: int) -> None:
    """Ask for everything once: what a service imports when it is first asked."""
    with httpx.Client(base_url=url, headers=headers(), timeout=120.0, trust_env=False) as client:
        for path in _paths(done):
            client.get(path).raise_for_status()


def _paths(done: int) -> list[str]:
    return [
        "jobs?limit=50",
        "jobs?state=done&name=a",
        f"jobs/{done}",
        f"jobs/{done}/front",
        f"jobs/{done}/designs?limit=100",
        f"jobs/{done}/designs/1",
        f"jobs/{done}/pick?knee=true",
        f"jobs/{done}/events",
        f"jobs/{done}/job",
        "health/ready",
    ]


async def reads(
    url: str, done: int, seconds: float, clients: int = CLIENTS, asking: int = 0
) -> tuple[list[float], Counter[str]]:
    """Let clients read at once, each once a second; return how long each read took, ms, and what went wrong.

    done: number of a job that has ended. asking: clients that have analyses, figures and reports made meanwhile.
    """
    paths = _paths(done)
    times: list[float] = []
    errors: Counter[str] = Counter()

    async def read(number: int) -> None:
        chance = random.Random(number)
        await asyncio.sleep(chance.uniform(0.0, _EVERY))
        end = time.monotonic() + seconds
        async with _client(url) as client:
            while time.monotonic() < end:
                path = chance.choice(paths)
                begin = time.perf_counter()
                try:
                    answer = await client.get(path)
                    if answer.status_code != 200:
                        errors[f"{path}: {answer.status_code}"] += 1
                except httpx.TransportError as error:
                    errors[type(error).__name__] += 1
                taken = time.perf_counter() - begin
                times.append(1e3 * taken)
                await asyncio.sleep(max(0.0, _EVERY - taken))

    async def ask(number: int) -> None:
        chance = random.Random(-1 - number)
        end = time.monotonic() + seconds
        async with _client(url) as client:
            while time.monotonic() < end:
                design = chance.randint(1, designs)
                answer = await client.get(chance.choice(_COMPUTED).format(done=done, design=design))
                if answer.status_code != 200:
                    errors[f"{answer.request.url.path}: {answer.status_code}"] += 1

    async with _client(url) as client:
        designs = len((await client.get(f"jobs/{done}/designs?limit=20")).json()["designs"])
    await asyncio.gather(*(read(number) for number in range(clients)), *(ask(number) for number in range(asking)))
    return times, errors


async def streams(url: str, jobs: list[int], each: int, last: int) -> tuple[int, int, int]:
    """Follow jobs by `each` streams until event `last`; return how many events were expected, missed, and breaks.

    Every stream is broken off now and then, and goes on after the last event that it got.
    """
    missed = breaks = 0

    async def follow(job: int, number: int) -> None:
        nonlocal missed, breaks
        chance = random.Random(f"{job} {number}")
        got: list[int] = []
        async with _client(url) as client:
            while not got or got[-1] < last:
                enough = chance.randrange(5, 40)
                more = {"Accept": "text/event-stream", "Last-Event-ID": str(got[-1] if got else 0)}
                async with client.stream("GET", f"jobs/{job}/events", headers=more) as answer:
                    async for line in answer.aiter_lines():
                        if line.startswith("data:"):
                            got.append(json.loads(line[5:])["number"])
                            enough -= 1
                        if not enough or (got and got[-1] >= last):
                            break
                breaks += 1
        missed += len(set(range(1, last + 1)).symmetric_difference(got)) + (got != sorted(got))

    await asyncio.gather(*(follow(job, number) for job in jobs for number in range(each)))
    return len(jobs) * each * last, missed, breaks


@contextmanager
def telling(store: Store, count: int, rate: float, events: int) -> Iterator[tuple[list[int], list[float]]]:
    """Give jobs to which `events` messages are added, `rate` a second each, and the times, in s, that each took."""
    claims = []
    for _ in range(count):
        submit(store, tables("random 3"), priority=1000)
        claim = store.claim("benchmark", lease=600.0)
        assert claim is not None
        claims.append(claim)
    times: list[float] = []

    def tell() -> None:
        begin = time.monotonic()
        for number in range(events):
            for place_in_turn, claim in enumerate(claims):
                time.sleep(max(0.0, begin + (number + place_in_turn / len(claims)) / rate - time.monotonic()))
                before = time.monotonic()
                claim.add_message(f"message {number}")
                times.append(time.monotonic() - before)

    thread = threading.Thread(target=tell, daemon=True)
    thread.start()
    yield [claim.job.id for claim in claims], times
    thread.join()
    for claim in claims:
        claim.fail("the benchmark is over", again=False)


async def same_key(url: str, count: int) -> tuple[int, int]:
    """Submit one job `count` times with one key; return how many jobs came of it, and how many answers were errors."""
    answers = await _submitted(url, [({"job": tables("random 3")}, "one-key")] * count)
    return len({answer["id"] for answer in answers if answer}), sum(answer is None for answer in answers)


async def many(url: str, count: int) -> tuple[float, float, Counter[str]]:
    """Submit small jobs and wait for all; return the seconds for each of both, and how many ended in each state."""
    begin = time.monotonic()
    job = {"job": {**tables("random 3"), "name": "small", "optimiser": _SMALL}}
    answers = await _submitted(url, [(job, f"small-{number}") for number in range(count)])
    submitted = time.monotonic()
    numbers = {answer["id"] for answer in answers if answer}
    states: Counter[str] = Counter()
    async with _client(url) as client:
        while True:
            found = await _all_jobs(client, "small")
            states = Counter(job["state"] for job in found if job["id"] in numbers)
            if not states["queued"] + states["running"]:
                return submitted - begin, time.monotonic() - submitted, states
            await asyncio.sleep(1.0)


async def _submitted(url: str, asked: Sequence[tuple[dict[str, Any], str]]) -> list[dict[str, Any] | None]:
    """Submit jobs, each with its key, by all clients at once; return the answers in any order, None for errors."""
    waiting = iter(asked)
    answers: list[dict[str, Any] | None] = []

    async def submitting() -> None:
        async with _client(url) as client:
            for body, key in waiting:
                answer = await client.post("jobs", json=body, headers={"Idempotency-Key": key})
                answers.append(answer.json() if answer.is_success else None)

    await asyncio.gather(*(submitting() for _ in range(CLIENTS)))
    return answers


async def _all_jobs(client: httpx.AsyncClient, name: str) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = []
    before: dict[str, int] = {}
    while True:
        page = (await client.get("jobs", params={"name": name, "limit": 1000, **before})).json()
        found += page["jobs"]
        if page["next"] is None:
            return found
        before = {"before": page["next"]}


def _client(url: str) -> httpx.AsyncClient:
    """Return one client; it has its own connection: looking for a free one among 100 takes longer than most reads."""
    return httpx.AsyncClient(base_url=url, headers=headers(), timeout=120.0, trust_env=False, verify=False)


def load(
    address: str,
    folder: Path,
    *,
    seconds: float = 30.0,
    clients: int = CLIENTS,
    keyed: int = 1000,
    small: int = 1000,
    workers: int = 2,
) -> list[Row]:
    """Return the figures of a service on a new store, all of whose workers are busy."""
    with Store(address) as store, service(address, folder, workers=workers) as running:
        url = running.url
        first = submit(store, tables("nsga2 1"))
        _until(store, first.id, "done")
        warm(url, first.id)
        rest = median(asyncio.run(reads(url, first.id, seconds / 3.0, _AT_REST))[0])
        busy = [submit(store, {**tables("random 1"), "name": "long", "optimiser": _LONG}) for _ in range(workers)]
        for job in busy:
            _until(store, job.id, "running")
        before = running.processor_time()
        times, errors = asyncio.run(reads(url, first.id, seconds, clients))
        each = 1e3 * (running.processor_time() - before) / len(times)
        beside, more = asyncio.run(reads(url, first.id, seconds, clients, _ASKING))
        errors += more
        for what, count in errors.items():
            print(f"{count} times {what}")
        percentiles = quantiles(times, n=100)
        events = int(10 * seconds)
        with telling(store, 5, 10.0, events) as (jobs, _):
            expected, missed, breaks = asyncio.run(streams(url, jobs, clients // 5, events))
        for job in busy:
            store.cancel(job.id)
        made, refused = asyncio.run(same_key(url, keyed))
        submitting, solving, states = asyncio.run(many(url, small))
    return [
        Row(
            f"errors in {len(times) + len(beside)} reads by {clients} clients, workers busy",
            [sum(errors.values())],
            at_most=0,
        ),
        Row("a read, ms, median", [percentiles[49]]),
        Row("a read, ms, 99th percentile", [percentiles[98]], at_most=300),
        Row(f"a read by {_AT_REST} clients, workers at rest, ms, median", [rest]),
        Row("99th percentile as a multiple of that", [percentiles[98] / rest], at_most=50),
        Row("slowest answer as a multiple of that", [max(times) / rest]),
        Row(f"99th percentile, {_ASKING} more having figures made", [quantiles(beside, n=100)[98] / rest], at_most=50),
        Row("slowest answer, likewise", [max(beside) / rest]),
        Row("of the processor, a read, ms", [each]),
        Row(f"events missed of {expected} in {clients} streams at 10 Hz, {breaks} breaks", [missed], at_most=0),
        Row(f"jobs made by {keyed} submissions with one key", [made], at_most=1),
        Row("errors in these", [refused], at_most=0),
        Row(f"{small} small jobs: done", [states["done"]], at_least=small),
        Row("submitting these, s", [submitting]),
        Row("until all had ended, s", [solving]),
    ]


def _until(store: Store, number: int, state: str) -> None:
    end = time.monotonic() + 600.0
    while store.job(number).state != state:
        if time.monotonic() > end:
            raise SystemExit(f"job {number} is {store.job(number).state}, not {state}")
        time.sleep(0.1)


def main() -> None:
    """Measure and print."""
    print(machine())
    for kind in sys.argv[1:] or ("sqlite", "postgresql"):
        with place("sqlite" if kind == "sqlite" else "postgresql") as where:
            show(f"Service under load on {kind}", load(where.address, where.folder))


if __name__ == "__main__":
    main()
