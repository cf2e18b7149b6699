"""Processor time of commands from the shell, over that of a process that only imports NumPy, pandas and scipy.optimize.

Ratios, since the speed of a machine changes by the minute; the reference is measured between the commands. The first
use is a command with an empty folder of kernels.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path
from time import perf_counter

from .report import Row

_REFERENCE = [sys.executable, "-c", "import numpy, pandas, scipy.optimize"]
_DESIGN = ["--crank", "60 mm", "--rod", "230 mm", "--offset", "70 mm"]


def commands(repeats: int = 5) -> list[Row]:
    """Return the ratios of commands on the feeder; none if the command is not installed beside this Python."""
    command = str(Path(sys.executable).with_name("slidercrank"))
    if not Path(command).exists():
        return []
    with tempfile.TemporaryDirectory() as folder:
        runs = ["--runs", folder]
        solve = [command, "optimise", "runs/feeder.toml", *runs]
        asked = [
            ("check", [command, "check", "runs/feeder.toml"], 0.7),
            ("front", [command, "front", "latest", *runs], 0.7),
            ("jobs", [command, "jobs", "--store", f"{folder}/slidercrank.db"], 0.7),
            ("analyse", [command, "analyse", "runs/feeder.toml", *_DESIGN], 1.2),
            ("optimise, without figures", [*solve, "--no-figures"], 2.0),
            ("optimise, with its figures", solve, 4.0),
        ]
        _seconds(solve)  # compiles, and leaves a run for `front`
        rows = [
            Row(
                f"{name}, over the reference",
                [_seconds(line) / _seconds(_REFERENCE) for _ in range(repeats)],
                at_most=most,
            )
            for name, line, most in asked
        ]
        begin = perf_counter()
        _seconds([*solve, "--no-figures"], XDG_CACHE_HOME=folder, NUMBA_CACHE_DIR="")
        return [*rows, Row("first use of optimise, compiling included, s", [perf_counter() - begin], at_most=20.0)]


def _seconds(command: list[str], **environment: str) -> float:
    """Return the processor time of a command and its children, s."""
    before = os.times()
    subprocess.run(command, check=True, capture_output=True, env=os.environ | environment)
    after = os.times()
    return after.children_user + after.children_system - before.children_user - before.children_system
