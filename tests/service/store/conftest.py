"""A store of each kind, empty, for every test that asks for one."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest

from slidercrank.service.store import Store
from tests.service.store import postgresql


@pytest.fixture(scope="session")
def server() -> Iterator[postgresql.Cluster]:
    """Return a PostgreSQL server."""
    reason = postgresql.why_not()
    if reason:
        pytest.skip(reason)
    programs = postgresql.programs()
    assert programs is not None
    with postgresql.cluster(programs) as started:
        yield started


@pytest.fixture(params=["sqlite", "postgresql"])
def address(request: pytest.FixtureRequest, tmp_path: Path) -> str:
    """Return the address of an empty database, once of each kind."""
    if request.param == "sqlite":
        return str(tmp_path / "store.db")
    server: postgresql.Cluster = request.getfixturevalue("server")
    return server.new_address()


@pytest.fixture
def store(address: str, empty_file: Path) -> Iterator[Store]:
    """Return an open, empty store, once of each kind."""
    if not address.startswith("postgresql:"):
        shutil.copy(empty_file, address)
    with Store(address) as opened:
        yield opened
