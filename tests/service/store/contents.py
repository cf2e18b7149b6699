"""Contents that the tests put into a store, made by hand, and changes made behind its back."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
from sqlalchemy import select, update

from slidercrank.optimise.front.progress import Progress
from slidercrank.optimise.search.checkpoints import Identity, Record
from slidercrank.service.runs.result import Result, Row, StoredObjective
from slidercrank.service.store import Claim, Job, Store
from slidercrank.service.store.database import Database
from slidercrank.service.store.database_clock import now
from slidercrank.service.store.schema import jobs, metadata

TABLES = {"name": "Feeder", "variables": {"crank": ["20 mm", "200 mm"]}, "optimiser": {"designs": 8}}
ROWS: list[Row] = [
    {"crank_mm": 0.1 + 0.2, "time_ratio": 1.25, "motion_error_mm": math.inf, "status": "stationary"},
    {"crank_mm": 1e-300, "time_ratio": 1.0, "motion_error_mm": math.nan, "status": "best found"},
]

_NONE = np.zeros(0, np.int64)


def add(store: Store, name: str = "Feeder", **options: Any) -> Job:
    """Return a job that was submitted."""
    return store.submit(TABLES, name=name, **options)


def claim_waiting_job(store: Store, worker: str = "first", *, lease: float = 60.0) -> Claim:
    """Return the claim of a job that waits."""
    claim = store.claim(worker, lease=lease)
    assert claim is not None
    return claim


def search_record(number: int) -> Record:
    """Return a unique record of a round of a search, with values that only an exact copy keeps."""
    random = np.random.default_rng(number)
    floats = np.array([*random.random(9), np.nan, np.inf, 1e-300, -0.0])
    return Record(Identity("0f" * 16, '{"slidercrank": "1"}'), number, number, 0.1 * number, floats.view(np.int64))


def is_same_record(one: Record, other: Record) -> bool:
    """Whether two records are the same, bit for bit."""
    return replace(one, words=_NONE) == replace(other, words=_NONE) and one.words.tobytes() == other.words.tobytes()


def progress(number: int) -> Progress:
    """Return the progress after a round."""
    return Progress("evolving", number, 9, 16 * number, number, 0.5, 0.1 * number)


def result(status: str = "done", rows: list[Row] | None = None) -> Result:
    """Return the result of a search."""
    rows = ROWS if rows is None else rows
    return Result(
        run="job",
        name="Feeder",
        status=status,
        message=f"{len(rows)} designs",
        objectives=(
            StoredObjective(quantity="time_ratio", sense="maximise", column="time_ratio", title="Time ratio", unit=""),
        ),
        designs=rows,
        hypervolume=0.5,
        evaluations=400,
        seconds=0.1,
        seed=1,
        extremes={"time_ratio": 0} if rows else {},
        knee=len(rows) - 1 if rows else None,
        trade_offs=["nothing is free"],
    )


def end_lease(address: str, job: int) -> None:
    """Let a lease end, as if its time had passed."""
    database = Database(address)
    with database.writing() as connection:
        connection.execute(update(jobs).where(jobs.c.id == job).values(lease_until=now() - 1.0))
    database.close()


def all_rows(address: str) -> dict[str, list[tuple[Any, ...]]]:
    """Return all rows of all tables."""
    database = Database(address)
    with database.reading() as connection:
        tables = {
            table.name: [tuple(row) for row in connection.execute(select(table).order_by(*table.primary_key))]
            for table in metadata.sorted_tables
        }
    database.close()
    return tables
