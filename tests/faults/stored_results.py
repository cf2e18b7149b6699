"""Results of jobs, read from the rows of a store as they are."""

from __future__ import annotations

import json
import tempfile
from functools import cache
from pathlib import Path

from sqlalchemy import select

from slidercrank.service.jobs.submission import submit
from slidercrank.service.store import Store
from slidercrank.service.store.database import Database
from slidercrank.service.store.schema import designs, jobs
from slidercrank.service.workers.worker import work

from .jobs import KINDS, Found, tables

_OF_THE_RUN = ("seconds", "run")


def results_in_store(address: str) -> dict[int, Found]:
    """Return the result of each job of a store that has ended with one."""
    database = Database(address)
    with database.reading() as connection:
        rows: dict[int, list[tuple[int, str]]] = {}
        for row in connection.execute(select(designs).order_by(designs.c.job, designs.c.number)):
            rows.setdefault(row.job, []).append((row.number, row.cells))
        results = connection.execute(select(jobs.c.id, jobs.c.result).where(jobs.c.result.is_not(None))).all()
    database.close()
    records = {job: json.loads(result) for job, result in results}
    return {
        job: Found(
            designs=tuple(rows.get(job, [])),
            record={key: value for key, value in record.items() if key not in _OF_THE_RUN},
        )
        for job, record in records.items()
    }


@cache
def undisturbed() -> dict[str, Found]:
    """Return the result of each kind of job when nothing goes wrong."""
    with tempfile.TemporaryDirectory(prefix="faults-") as folder:
        file = Path(folder) / "store.db"
        with Store(file) as store:
            numbers = {submit(store, tables(kind)).id: kind for kind in KINDS}
            work(store, drain=True)
        every = results_in_store(str(file))
    return {kind: every[number] for number, kind in numbers.items()}
