"""What every test of the service has: its own place for runs, and the command line in this process."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from slidercrank.service.cli import app

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
    """Return what runs the command line in this process: `command("front", "latest")`."""

    def run(*arguments: object) -> Result:
        return CliRunner().invoke(app, [str(argument) for argument in arguments])

    return run
