"""Time that commands take from the shell, the second time."""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from time import perf_counter

from .report import Row


def commands(repeats: int = 3) -> list[Row]:
    """Return the wall times of `--help` and of the feeder job with figures, s; none if the command is not found."""
    command = Path(sys.executable).with_name("slidercrank")
    if not command.exists():
        found = shutil.which("slidercrank")
        if found is None:
            return []
        command = Path(found)
    with tempfile.TemporaryDirectory() as folder:
        return [
            Row("slidercrank --help, s", _times([str(command), "--help"], repeats), at_most=0.5),
            Row(
                "slidercrank optimise runs/feeder.toml, figures included, s",
                _times([str(command), "optimise", "runs/feeder.toml", "--runs", folder], repeats),
                at_most=10.0,
            ),
        ]


def _times(command: list[str], repeats: int) -> list[float]:
    times = []
    for _ in range(repeats + 1):
        begin = perf_counter()
        subprocess.run(command, check=True, capture_output=True)
        times.append(perf_counter() - begin)
    return times[1:]
