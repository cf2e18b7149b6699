"""A small job solved by a store's worker and on the command line, and a service of that store."""

from __future__ import annotations

import contextlib
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import httpx
import pytest
from typer.testing import CliRunner

from slidercrank.service.api.app import create_app
from slidercrank.service.api.settings import DEFAULT, Settings
from slidercrank.service.cli import app as command_line
from slidercrank.service.jobs.submission import submit
from slidercrank.service.runs.result import Result, Row
from slidercrank.service.runs.runs_on_disk import read_run
from slidercrank.service.store import Store
from slidercrank.service.workers.worker import work
from tests.service import fronts as made
from tests.service.api.serving import serving

API = "/api/v1"


@dataclass(frozen=True)
class Solved:
    """A job that a worker solved. folder, job, result: run, file and result of the same job on the command line."""

    number: int
    store: Store
    folder: Path
    job: Path
    result: Result

    @property
    def path(self) -> str:
        """Path of the job in the API."""
        return f"{API}/jobs/{self.number}"


@contextlib.contextmanager
def solved_in(place: Path) -> Iterator[Solved]:
    """Solve a job in a store and on the command line; yield it, and close the store at the end."""
    job = made.job_file(place)
    with pytest.MonkeyPatch.context() as patch:
        patch.delenv("SLIDERCRANK_STORE", raising=False)
        done = CliRunner().invoke(command_line, ["optimise", str(job), "--runs", str(place / "runs"), "--no-figures"])
    assert done.exit_code == 0, done.stderr
    (folder,) = (path.parent for path in place.glob("runs/*/front.json"))
    with Store(place / "store.db") as store:
        number = submit(store, tomllib.loads(made.JOB)).id
        work(store, drain=True)
        yield Solved(number, store, folder, job, read_run(folder))


@contextlib.contextmanager
def served(store: Store, settings: Settings = DEFAULT, *, port: int = 0) -> Iterator[str]:
    """Serve a store on loopback while entered; yield the address."""
    with serving(create_app(store, settings), port=port) as address:
        yield address


@contextlib.contextmanager
def client_of(store: Store, settings: Settings = DEFAULT) -> Iterator[httpx.Client]:
    """Serve a store on loopback while entered; yield a client of it."""
    with served(store, settings) as address, httpx.Client(base_url=address, timeout=60.0, verify=False) as client:
        yield client


@contextlib.contextmanager
def varied_in(place: Path) -> Iterator[tuple[Store, int]]:
    """Solve the job with a variable width in a store; yield the store and the job number, then close it."""
    with Store(place / "varied.db") as store:
        number = submit(store, tomllib.loads(made.VARIED)).id
        work(store, drain=True)
        yield store, number


def store_result(store: Store, result: Result, tables: dict[str, Any], **changes: Any) -> int:
    """Put a result into a store as if a worker had found it, and return the number of its job."""
    store.submit(tables, name=result.name)
    claim = store.claim("test")
    assert claim is not None
    claim.finish(replace(result, **changes))
    return claim.job.id


def rows_with(rows: list[Row], **cells: Any) -> list[Row]:
    """Return the rows with these cells in all of them."""
    return [{**row, **cells} for row in rows]
