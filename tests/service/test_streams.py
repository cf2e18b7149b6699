"""Standard output that is closed, full or no longer read; too little memory: a sentence and an exit code each."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from tests.service.conftest import Command

needs_full = pytest.mark.skipif(sys.platform != "linux", reason="/dev/full is a device of Linux")


def run(command: str) -> subprocess.CompletedProcess[str]:
    script = f"'{sys.executable}' -m slidercrank {command}"
    return subprocess.run(["bash", "-c", script], capture_output=True, text=True)


@needs_full
@pytest.mark.parametrize("command", ["--version > /dev/full", "--version >&-", "--help > /dev/full"])
def test_output_that_cannot_be_written_is_one_sentence(command: str) -> None:
    done = run(command)
    assert done.returncode == 2
    assert done.stderr.startswith("slidercrank: cannot write to standard output: ")
    assert done.stderr.count("\n") == 1


@pytest.mark.parametrize(
    ("options", "code", "said"),
    [([], 0, ""), (["--json"], 0, ""), (["--where", "crank <= 1 mm"], 3, "slidercrank: none of the ")],
)
def test_a_reader_that_leaves_changes_neither_exit_code_nor_messages(
    options: list[str], code: int, said: str, kept: Path
) -> None:
    (folder,) = (place for place in kept.iterdir() if place.is_dir())
    command = [sys.executable, "-m", "slidercrank", "front", str(folder), *options]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert process.stdout is not None
    process.stdout.close()  # before anything is written
    process.stdout = None
    _, messages = process.communicate()
    assert process.returncode == code
    assert messages.startswith(said)
    assert messages.count("\n") == (1 if said else 0)


@needs_full
@pytest.mark.parametrize("errors", ["2> /dev/full", "2>&-"])
def test_messages_that_cannot_be_written_leave_the_exit_code(errors: str) -> None:
    assert run(f"check nowhere.toml {errors}").returncode == 2


@pytest.mark.parametrize(
    "error",
    [
        MemoryError(),
        RuntimeError("can't start new thread"),
        OSError(12, "Cannot allocate memory"),
        ImportError("libx.so: failed to map segment from shared object"),
    ],
)
def test_too_little_memory_is_no_fault_of_the_software(
    error: Exception, command: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object, **__: object) -> None:
        raise ValueError("what came of it") from error

    monkeypatch.setattr("slidercrank.service.commands.doctor.diagnose", fail)
    done = command("doctor")
    assert (done.exit_code, done.stdout) == (2, "")
    assert "not enough memory" in done.stderr
