"""The command line as a process: help, exit codes, signals, what is left after kill -9."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from importlib.metadata import version
from pathlib import Path

import pytest

from slidercrank.model.errors import RunError
from slidercrank.service.runs.runs_on_disk import read_run
from tests.service import fronts
from tests.service.conftest import Command

ROOT = Path(fronts.__file__).parents[2]

# Stands for a long search: tells of a round, then waits to be cancelled or killed.
SLOW = """
import sys, time
import slidercrank.optimise.solve as module
from slidercrank.optimise.front.progress import Progress
from slidercrank.service.cli import main
from tests.service import fronts

def solve(problem, *, progress, cancelled, **_):
    for number in range(1, 1000):
        progress(Progress("sampling", number, 1000, 100 * number, 10 * number, 0.1, 0.05 * number))
        while {stuck}:
            time.sleep(0.02)
        time.sleep(0.02)
        if cancelled():
            from dataclasses import replace
            return replace(fronts.front(designs=3), status="cancelled", message="cancelled: 3 designs")

module.solve = solve
sys.argv = ["slidercrank", *sys.argv[1:]]
main()
"""


def start(script: str, *arguments: object) -> subprocess.Popen[str]:
    """Start a script, able to import the tests' stand-ins."""
    return subprocess.Popen(
        [sys.executable, "-c", script, *map(str, arguments)],
        cwd=ROOT,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def folder_of_running_search(place: Path, process: subprocess.Popen[str]) -> Path:
    """Return the run's folder once its search has told of a round."""
    for _ in range(1500):
        assert process.poll() is None, process.communicate()
        for log in place.glob("2*/log.txt"):
            if "sampling 1/" in log.read_text():
                return log.parent
        time.sleep(0.02)
    raise AssertionError("the search did not start")


def test_help_names_every_command(command: Command) -> None:
    done = command("--help")
    assert done.exit_code == 0
    for name in (
        "optimise",
        "analyse",
        "inverse",
        "swing",
        "lever",
        "check",
        "schema",
        "front",
        "export",
        "like",
        "round",
        "compare",
        "cases",
    ):
        assert f"  {name} " in done.stdout
        assert command(name, "--help").exit_code == 0


def test_version_is_that_of_the_package(command: Command) -> None:
    assert command("--version").stdout == f"slidercrank {version('slidercrank')}\n"


@pytest.mark.parametrize("arguments", [("optimize", "x"), ("front",), ("--nothing",)])
def test_wrong_usage_is_exit_code_2(arguments: tuple[str, ...], command: Command) -> None:
    done = command(*arguments)
    assert done.exit_code == 2
    assert "Usage: " in done.stderr


def test_a_job_runs_as_a_process(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-m", "slidercrank", "optimise", fronts.job_file(tmp_path), "--json", "--no-figures"],
        cwd=tmp_path,
        env={name: value for name, value in os.environ.items() if name != "SLIDERCRANK_RUNS"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0
    assert done.stderr.splitlines() == [
        'note: masses are given without gravity, so nothing has weight; add gravity = "9.81 m/s^2", or gravity = 0'
    ]
    record = json.loads(done.stdout)
    assert record["designs"]
    assert read_run(tmp_path / record["run"]).record() == {**record, "run": str(tmp_path / record["run"])}
    assert Path(record["run"]).parent == Path("runs")


def test_a_missing_job_is_a_message_and_exit_code_2(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-m", "slidercrank", "optimise", "none.toml", "--runs", tmp_path / "runs"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == "slidercrank: none.toml: no such file; check the name and the folder\n"
    assert not (tmp_path / "runs").exists()


def test_debugging_shows_the_traceback_of_a_fault(tmp_path: Path) -> None:
    script = "import slidercrank.optimise.job as j; j.load_job = None; from slidercrank.service.cli import main; main()"
    done = subprocess.run(
        [sys.executable, "-c", script, "check", "x.toml"],
        env={**os.environ, "SLIDERCRANK_DEBUG": "1"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 1
    assert "TypeError: 'NoneType' object is not callable" in done.stderr
    assert "Traceback" in done.stderr


@pytest.mark.skipif(os.name == "nt", reason="signals of Unix")
def test_a_killed_run_is_marked_unfinished(tmp_path: Path, command: Command) -> None:
    process = start(SLOW.format(stuck=False), "optimise", fronts.job_file(tmp_path), "--runs", tmp_path / "runs")
    run = folder_of_running_search(tmp_path / "runs", process)
    process.send_signal(signal.SIGKILL)
    process.communicate()
    with pytest.raises(RunError, match="is unfinished"):
        read_run(run)
    done = command("front", run)
    assert done.exit_code == 2
    assert "is unfinished" in done.stderr


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="signals of Unix")
def test_interrupting_keeps_what_was_found(tmp_path: Path) -> None:
    arguments = ("optimise", fronts.job_file(tmp_path), "--json", "--runs", tmp_path / "runs")
    process = start(SLOW.format(stuck=False), *arguments)
    run = folder_of_running_search(tmp_path / "runs", process)
    process.send_signal(signal.SIGINT)
    output, message = process.communicate()
    assert process.returncode == 130, message
    assert "stopping after this step" in message
    assert "Traceback" not in message
    record = json.loads(output)
    assert (record["status"], len(record["designs"])) == ("cancelled", 3)
    assert read_run(run).status == "cancelled"


@pytest.mark.skipif(os.name == "nt", reason="signals of Unix")
def test_interrupting_twice_stops_at_once(tmp_path: Path) -> None:
    process = start(SLOW.format(stuck=True), "optimise", fronts.job_file(tmp_path), "--runs", tmp_path / "runs")
    run = folder_of_running_search(tmp_path / "runs", process)
    process.send_signal(signal.SIGINT)
    time.sleep(0.2)
    process.send_signal(signal.SIGINT)
    output, message = process.communicate()
    assert (process.returncode, output) == (130, "")
    assert "slidercrank: interrupted" in message
    assert "Traceback" not in message
    with pytest.raises(RunError, match="stopped by an error: interrupted"):
        read_run(run)
