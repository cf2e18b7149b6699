"""Fixtures of every test of the service: a place for its runs, and the command line in this process."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from slidercrank.service.cli import app
from slidercrank.service.store import Store
from tests.service import fronts
from tests.service.api.fixed_front import Solved, solved_in

Command = Callable[..., Result]


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


@pytest.fixture(scope="module")
def kept(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a place with a run of the small job."""
    place = tmp_path_factory.mktemp("kept")
    job = fronts.job_file(tmp_path_factory.mktemp("job"))
    done = CliRunner().invoke(app, ["optimise", str(job), "--runs", str(place), "--no-figures"])
    assert done.exit_code == 0
    return place


@pytest.fixture
def store(tmp_path: Path) -> Iterator[Store]:
    """Return an empty store."""
    with Store(tmp_path / "store.db") as opened:
        yield opened


@pytest.fixture(scope="session")
def solved(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Solved]:
    """Return a small job that was solved, which the tests leave as it is."""
    with solved_in(tmp_path_factory.mktemp("solved")) as found:
        yield found
