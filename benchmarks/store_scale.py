"""Speed of a store with 10,000 runs and a million designs: `python -m benchmarks.store_scale`.

Runs, designs, events and files are made up; their columns, widths and lengths are those of a run of the feeder.
"""

from __future__ import annotations

import asyncio
import json
import random
import sys
import time
import tomllib
from collections.abc import Callable, Iterator
from dataclasses import asdict, replace
from functools import partial
from pathlib import Path
from typing import Any

import httpx
from sqlalchemy import Connection, insert, select, text

from slidercrank.optimise.front.progress import Progress
from slidercrank.optimise.job import parse_job
from slidercrank.optimise.solve import solve
from slidercrank.service.api.app import create_app
from slidercrank.service.api.server import freeze_imported_objects
from slidercrank.service.jobs.submission import submit
from slidercrank.service.runs.result import Result, json_text, result_of
from slidercrank.service.store import Store
from slidercrank.service.store.schema import jobs
from slidercrank.service.store.serialisation import cells_json, compact_json, result_summary

from .report import Row, machine, show

RUNS = 10_000
DESIGNS = 100
LARGE = 10_000  # designs of the one large run
MOST = 300.0  # ms
FIRST_PAGE = 100.0  # ms
ROW = 600.0  # bytes of a run in the list
REPEATS = 50
_STATES = ["done"] * 95 + ["infeasible"] * 2 + ["cancelled"] * 2 + ["failed"]
_NAMES = [f"{machine} of line {number}" for number in range(1, 21) for machine in ("Feeder", "Sieve", "Press")]
_EVENTS = 12


def measure(address: str, *, runs: int = RUNS, large: int = LARGE, repeats: int = REPEATS) -> list[Row]:
    """Fill a new store and return how long reading and submitting take, ms."""
    with Store(address, most_queued=runs) as store:
        begin = time.perf_counter()
        tables, found = _feeder()
        with store.writing() as connection:
            _fill(connection, tables, found, runs, large)
        with store.engine.connect().execution_options(isolation_level="AUTOCOMMIT") as connection:
            connection.exec_driver_sql("ANALYZE")
        filled = Row(f"filling with {runs} runs of {len(found.designs)} designs, s", [time.perf_counter() - begin])
        with store.reading() as connection:
            done = list(connection.execute(select(jobs.c.id).where(jobs.c.state == "done", jobs.c.id < runs)).scalars())
        freeze_imported_objects()  # as the service does
        with asyncio.Runner() as loop:
            questions = [*_questions(store, tables, done, runs), *_requests(store, loop, done, runs)]
            return [filled, _row(store, loop), *(_timed(what, ask, repeats) for what, ask in questions)]


def _questions(
    store: Store, tables: dict[str, Any], done: list[int], runs: int
) -> Iterator[tuple[str, Callable[[], object]]]:
    chance = random.Random(1)

    def some() -> int:
        return chance.choice(done)

    yield "list: first page of 100", store.jobs
    yield "list: page of 100 somewhere", lambda: store.jobs(before=some())
    yield "list: of one state", lambda: store.jobs(states=["failed"])
    yield "list: of one state, somewhere", lambda: store.jobs(states=["cancelled", "failed"], before=some())
    yield "list: by a part of the name", lambda: store.jobs(name="press of line 7")
    yield "list: by a name that none has", lambda: store.jobs(name="loom")
    yield "list: by state and name", lambda: store.jobs(states=["infeasible"], name="sieve")
    yield "how many are in each state", store.count_by_state
    yield "one job", lambda: store.job(some())
    yield "events of a job", lambda: store.events(some())
    yield "front of a job without designs", lambda: store.result_record(some())
    yield "front of a job with its designs", lambda: store.result(some())
    yield "front of the large run without designs", lambda: store.result_record(runs)
    yield "front of the large run with its designs", lambda: store.result(runs)
    yield "submission", lambda: submit(store, tables)
    yield "claim", lambda: store.claim("bench", lease=60.0)
    yield "cancelling", lambda: store.cancel(store.jobs(states=["running", "queued"], limit=1)[0].id)
    yield "deleting a run", lambda: store.delete(done.pop())


def _requests(
    store: Store, loop: asyncio.Runner, done: list[int], runs: int
) -> Iterator[tuple[str, Callable[[], object]]]:
    chance, client = random.Random(3), _client(store)

    def get(path: str) -> None:
        answer = loop.run(client.get(path.format(chance.choice(done))))
        if answer.status_code != 200:
            raise SystemExit(f"{path}: {answer.status_code} {answer.text[:500]}")

    for path in (
        "jobs",
        "jobs?before={0}",
        "jobs?state=failed",
        "jobs?name=press%20of%20line%207",
        "front-points?job={0}&job=1&job=2&job=3",
        "jobs/{0}",
        "jobs/{0}/front",
        "jobs/{0}/designs",
        "jobs/{0}/designs?where=transmission_angle>=30 deg&sort=peak_torque&limit=20",
        "jobs/{0}/pick?knee=true",
        f"jobs/{runs}/front",
        f"jobs/{runs}/designs?sort=peak_torque&offset=5000",
        f"jobs/{runs}/pick?knee=true",
    ):
        large = path.startswith(f"jobs/{runs}/")
        shown = path.replace(f"{runs}/", "LARGE/") if large else path.replace("{0}", "N")
        yield f"GET {shown}", partial(get, path)


def _client(store: Store) -> httpx.AsyncClient:
    return httpx.AsyncClient(transport=httpx.ASGITransport(create_app(store)), base_url="http://127.0.0.1/api/v1/")


def _row(store: Store, loop: asyncio.Runner) -> Row:
    answer = loop.run(_client(store).get("jobs"))
    return Row("a run in the list, bytes", [len(answer.content) / len(answer.json()["jobs"])], at_most=ROW)


def _timed(what: str, ask: Callable[[], object], repeats: int) -> Row:
    times = []
    for _ in range(repeats):
        begin = time.perf_counter()
        ask()
        times.append(1e3 * (time.perf_counter() - begin))
    return Row(f"{what}, ms", times, at_most=FIRST_PAGE if what == "GET jobs" else MOST, worst=True)


def _feeder() -> tuple[dict[str, Any], Result]:
    """Return the feeder's job and what a plain search finds for it, repeated to `DESIGNS` designs."""
    tables = tomllib.loads(Path("runs/feeder.toml").read_text(encoding="utf-8"))
    quick = {**tables, "optimiser": {"method": "sobol", "evaluations": 4000, "designs": DESIGNS, "seed": 1}}
    found = result_of(solve(parse_job(quick)), "20261121-193012-feeder")
    rows = [found.designs[number % len(found.designs)] for number in range(DESIGNS)]
    return tables, replace(found, designs=rows)


def _fill(connection: Connection, tables: dict[str, Any], found: Result, runs: int, large: int) -> None:
    chance = random.Random(2)
    record = found.record()
    del record["designs"]
    record["columns"] = list(found.designs[0])
    stated, result, summary = compact_json(tables), compact_json(record), compact_json(result_summary(found))
    told = asdict(Progress("polishing", 10, 10, 50_000, 900, 0.5, 9.0))
    columns = [wanted.column for wanted in found.objectives]
    points = [[row[column] for column in columns] for row in found.designs[:64]]
    progress = compact_json({**told, "front": {"columns": columns, "points": points}})
    rows = []
    for number in range(1, runs + 1):
        state = chance.choice(_STATES) if number < runs else "done"
        at = 1.7e9 + 600.0 * number
        rows.append(
            {
                "id": number,
                "name": chance.choice(_NAMES),
                "run": f"20261121-{number:06d}-feeder",
                "tables": stated,
                "state": state,
                "reason": "100 designs, 53575 evaluated",
                "most_attempts": 3,
                "submitted": at,
                "due": at,
                "started": at + 1.0,
                "finished": at + 9.0,
                "fence": 1,
                "writes": _EVENTS,
                "events": _EVENTS,
                "progress": progress,
                "summary": summary if state == "done" else None,
                "result": result if state == "done" else None,
            }
        )
    connection.execute(insert(jobs), rows)
    if connection.dialect.name == "postgresql":  # whose next number is counted apart
        connection.exec_driver_sql(f"SELECT setval(pg_get_serial_sequence('jobs', 'id'), {runs})")
    connection.exec_driver_sql("CREATE TEMPORARY TABLE front (number INTEGER, cells TEXT)")
    cells = [{"number": number, "cells": cells_json(row)} for number, row in enumerate(found.designs)]
    connection.execute(text("INSERT INTO front VALUES (:number, :cells)"), cells)
    connection.exec_driver_sql(
        "INSERT INTO designs (job, number, cells) SELECT jobs.id, front.number, front.cells FROM jobs CROSS JOIN front "
        "WHERE jobs.result IS NOT NULL"
    )
    more = [{"job": runs, "number": number, "cells": cells[number % len(cells)]["cells"]} for number in range(large)]
    connection.execute(
        text("INSERT INTO designs (job, number, cells) VALUES (:job, :number, :cells)"), more[len(cells) :]
    )
    connection.execute(
        text(
            "WITH RECURSIVE counted(number) AS "
            "(SELECT 1 UNION ALL SELECT number + 1 FROM counted WHERE number < :events) "
            "INSERT INTO events (job, number, at, kind, data) "
            "SELECT jobs.id, counted.number, jobs.started + counted.number, 'progress', :told "
            "FROM jobs CROSS JOIN counted"
        ),
        {"events": _EVENTS, "told": compact_json(told)},
    )
    for name, content in (("job.json", json_text(tables)), ("versions.json", json.dumps({"slidercrank": "0.1.0"}))):
        connection.execute(
            text(
                "INSERT INTO artefacts (job, name, media_type, at, content) "
                "SELECT id, :name, 'application/json', finished, :content FROM jobs"
            ),
            {"name": name, "content": content.encode()},
        )


def main() -> None:
    """Measure both kinds of store and print the figures."""
    from tests.faults.places import place

    print(machine())
    kinds = sys.argv[1:] or ("sqlite", "postgresql")
    for kind in kinds:
        with place("sqlite" if kind == "sqlite" else "postgresql") as where:
            show(f"Store with {RUNS} runs and a million designs on {kind}: worst of {REPEATS}", measure(where.address))


if __name__ == "__main__":
    main()
