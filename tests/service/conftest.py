"""Fixtures of every test of the service: a place for its runs, and the command line in this process."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from sqlalchemy import create_engine, inspect
from typer.testing import CliRunner, Result

from slidercrank.service.cli import app
from slidercrank.service.store import Store
from slidercrank.service.store.database import Database
from slidercrank.service.store.schema_version import LATEST, create_or_upgrade_tables
from tests.service import fronts
from tests.service.api.fixed_front import Solved, solved_in

Command = Callable[..., Result]


class Compiled(dict[Any, Any]):
    """Statements that are compiled, of all engines of a dialect: SQLAlchemy compiles them anew for every engine."""

    def get(self, key: Any, default: Any = None) -> Any:
        """Return the cached value of a key that begins with the dialect of an engine."""
        return super().get((key[0].name, *key[1:]), default)

    def __setitem__(self, key: Any, value: Any) -> None:
        super().__setitem__((key[0].name, *key[1:]), value)


@pytest.fixture(scope="session", autouse=True)
def _compiled_once() -> Iterator[None]:
    """Compile each statement once, not for every store of a test: a third of the time of the store's tests."""
    engine = partial(create_engine, execution_options={"compiled_cache": Compiled()})
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("slidercrank.service.store.database.create_engine", engine)
        yield


@pytest.fixture(scope="session", autouse=True)
def _tables_made_once(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Copy the tables of another store into a new one; Alembic takes ten times as long."""
    kept = Database(tmp_path_factory.mktemp("tables") / "store.db")
    create_or_upgrade_tables(kept)
    with kept.reading() as connection:
        told = connection.exec_driver_sql("SELECT sql FROM sqlite_master WHERE name NOT LIKE 'sqlite_%'")
        statements = [*told.scalars(), f"INSERT INTO alembic_version VALUES ('{LATEST}')"]
    kept.close()

    def copied(database: Database) -> None:
        if database.sqlite and not _tables(database):
            with database.writing() as connection:
                if not inspect(connection).get_table_names():
                    for statement in statements:
                        connection.exec_driver_sql(statement)
        create_or_upgrade_tables(database)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("slidercrank.service.store.store.create_or_upgrade_tables", copied)
        yield


def _tables(database: Database) -> list[str]:
    with database.reading() as connection:
        return inspect(connection).get_table_names()


@pytest.fixture(scope="session", autouse=True)
def _no_certificates(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Let clients read no certificates, 20 ms each: all services under test are without TLS."""
    with pytest.MonkeyPatch.context() as patch:
        patch.delenv("SSL_CERT_FILE", raising=False)
        patch.setenv("SSL_CERT_DIR", str(tmp_path_factory.mktemp("certificates")))
        yield


@pytest.fixture
def runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return the place where the runs of a test are kept."""
    place = tmp_path / "kept"
    monkeypatch.setenv("SLIDERCRANK_RUNS", str(place))
    monkeypatch.delenv("SLIDERCRANK_DEBUG", raising=False)
    monkeypatch.setenv("COLUMNS", "100")
    return place


@pytest.fixture
def command(runs: Path) -> Command:
    """Return a function that runs the command line in this process: `command("front", "latest")`."""

    def run(*arguments: object) -> Result:
        return CliRunner().invoke(app, [str(argument) for argument in arguments])

    return run


@pytest.fixture(scope="session")
def solved_once(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a place with a run of the small job, to be copied."""
    place = tmp_path_factory.mktemp("solved_once")
    job = fronts.job_file(tmp_path_factory.mktemp("job"))
    done = CliRunner().invoke(app, ["optimise", str(job), "--runs", str(place), "--no-figures"])
    assert done.exit_code == 0
    return place


@pytest.fixture(scope="module")
def kept(solved_once: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a place with a run of the small job."""
    return shutil.copytree(solved_once, tmp_path_factory.mktemp("kept") / "runs")


@pytest.fixture(scope="session")
def empty_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the file of an empty store, to be copied: to make its tables takes ten times as long."""
    file = tmp_path_factory.mktemp("empty") / "store.db"
    Store(file).close()
    return file


@pytest.fixture
def store(tmp_path: Path, empty_file: Path) -> Iterator[Store]:
    """Return an empty store."""
    with Store(shutil.copy(empty_file, tmp_path / "store.db")) as opened:
        yield opened


@pytest.fixture(scope="session")
def solved(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Solved]:
    """Return a small job that was solved, which the tests leave as it is."""
    with solved_in(tmp_path_factory.mktemp("solved")) as found:
        yield found
