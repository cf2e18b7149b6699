"""Searches with an own function, suspended for longer than a call may take: alone (Ctrl-Z) or with all processes."""

from __future__ import annotations

import os
import random
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import psutil

from .lifeline import die_with_parent
from .runaway import JOB
from .verdict import Verdict

_LIMIT = 1.0  # s, of a call; the process is ended ten seconds later
_LONGER = 10.0, 14.0  # s beyond the limit
_FUNCTION = """
import time

def judge(designs):
    time.sleep(0.6)
    return designs.crank
"""


def suspends(count: int, seed: int) -> Verdict:
    """Suspend one search after the other, `count` in all; return what came of them, compared with one left alone."""
    chance, verdict = random.Random(seed), Verdict(jobs=count)
    with tempfile.TemporaryDirectory(prefix="faults-") as name:
        folder = Path(name)
        (folder / "naps.py").write_text(_FUNCTION)
        text = JOB.replace("FUNCTION", "naps:judge").replace("1e5 s", f"{_LIMIT:g} s")
        (folder / "job.toml").write_text(
            text.replace("evaluations = 2000", "evaluations = 40").replace("samples = 20", "samples = 8")
        )
        alone = _suspended_front(verdict, folder, 0, None, all_of_it=False)
        if not alone:
            verdict.violate("lost", "the search that was left alone has no front")
        for number in range(1, count + 1):
            moment = chance.uniform(2.0, 5.0), _LIMIT + chance.uniform(*_LONGER)
            found = _suspended_front(verdict, folder, number, moment, all_of_it=number % 2 == 0)
            if found != alone:
                verdict.violate("designs differ", f"search {number}, suspended at {moment[0]:.2f} s")
    return verdict


def _suspended_front(
    verdict: Verdict, folder: Path, number: int, moment: tuple[float, float] | None, *, all_of_it: bool
) -> bytes:
    """Return the front of a search, suspended at a moment for a time, s."""
    runs = folder / f"runs {number}"
    command = [sys.executable, "-m", "slidercrank", "optimise", str(folder / "job.toml"), "--runs", str(runs)]
    process = subprocess.Popen(
        [*command, "--no-figures", "--cores", "1"],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        env={**os.environ, "SLIDERCRANK_STORE": str(runs.with_suffix(".db"))},
        preexec_fn=die_with_parent,
    )
    if moment is not None:
        own = psutil.Process(process.pid)
        while not (functions := own.children(recursive=True)) and process.poll() is None:
            time.sleep(0.05)
        time.sleep(moment[0])
        if process.poll() is not None:
            verdict.violate("lost", f"search {number} had ended before it was suspended")
        suspended = [own, *(functions if all_of_it else [])]
        for each in suspended:
            each.suspend()
        time.sleep(moment[1])
        for each in suspended:
            each.resume()
    _, errors = process.communicate()
    if process.returncode:
        verdict.violate("lost", f"search {number}: exit code {process.returncode}: {errors.decode()[-300:]}")
    return b"".join(path.read_bytes() for path in sorted(runs.rglob("front.csv")))
