"""Services that are asked to end while they start: right after they print their address, or at a random moment."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import psutil

from .lifeline import die_with_parent
from .serving import alive
from .verdict import Verdict

_ENDS = 15.0  # s: its imports, the grace of its workers, and time for a busy machine
_START = 3.0  # s, the longest random moment: from the first import to a service that answers
_LISTENS = "slidercrank serves"


def starts(count: int, seed: int, *, random_moments: bool = True) -> Verdict:
    """Start services and ask each to end, by SIGTERM and Ctrl-C in turn; return what came of it.

    random_moments: every second one is asked at a random moment instead of right after the address is printed.
    """
    chance, verdict = random.Random(seed), Verdict(jobs=count)
    with tempfile.TemporaryDirectory(prefix="faults-") as name:
        for number in range(count):
            moment = chance.uniform(0.0, _START) if random_moments and number // 2 % 2 else None
            _start(verdict, Path(name), (signal.SIGTERM, signal.SIGINT)[number % 2], moment)
    return verdict


def _start(verdict: Verdict, folder: Path, blow: signal.Signals, moment: float | None) -> None:
    what = f"{blow.name} " + ("after the address" if moment is None else f"after {moment:.2f} s")
    command = [sys.executable, "-m", "slidercrank", "serve", "--store", str(folder / "store.db"), "--port", "0"]
    with (folder / "errors").open("w+b") as errors, (folder / "output").open("w+b") as output:
        process = subprocess.Popen(
            [*command, "--workers", "1", "--grace", "1"],
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=errors,
            env={**os.environ, "PYTHONUNBUFFERED": "1"},
            preexec_fn=die_with_parent,
        )
        begin = time.monotonic()
        printed = Path(output.name)
        while time.monotonic() - begin < 60.0 if moment is None else time.monotonic() - begin < moment:
            if moment is None and _LISTENS in printed.read_text():
                break
            time.sleep(0.002)
        started = psutil.Process(process.pid).children(recursive=True)
        process.send_signal(blow)
        try:
            code = process.wait(_ENDS)
        except subprocess.TimeoutExpired:
            verdict.violate("late", f"{what}: it goes on")
            started = psutil.Process(process.pid).children(recursive=True)
            process.kill()
            code = process.wait()
        else:
            _judge(verdict, what, blow, code, listened=_LISTENS in printed.read_text(), errors=Path(errors.name))
            if any(map(alive, started)):
                verdict.violate("left", f"{what}: a worker goes on")
    for left in started:
        if alive(left):
            left.kill()


def _judge(verdict: Verdict, what: str, blow: signal.Signals, code: int, *, listened: bool, errors: Path) -> None:
    """Check the exit code: 0 once the address was printed, else possibly that of a command that was interrupted."""
    early = () if listened else (-blow, 130)
    if code not in (0, *early):
        verdict.violate("lost", f"{what}: exit code {code}")
    if listened and "Traceback" in (said := errors.read_text()):
        verdict.violate("lost", f"{what}: {said[-400:]}")
