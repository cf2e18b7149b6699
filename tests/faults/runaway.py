"""Own functions that never return, leave processes behind or print for ever: cancelled, out of time, killed, ended."""

from __future__ import annotations

import contextlib
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
import tomllib
from collections.abc import Mapping
from itertools import cycle
from pathlib import Path
from typing import Any

from slidercrank.objectives.own.guard_process import PRINTED

from .lifeline import die_with_parent
from .serving import Serving, left_over
from .verdict import Verdict
from .waits import Stopwatch

SOON = 2.0  # s without waits for a processor, within which a function is gone once its call is to end
_OF_THE_SERVICE = 1_000_000  # bytes of its own log
SLACK = 1.0  # s, for looking at it on a busy machine
LOOPS = {
    "python": "while True: pass",
    "sleeps": "import time; time.sleep(1e6)",
    "holds the interpreter": "7 ** 10 ** 9",
    "ignores signals": (
        "import signal\n    for n in (1, 2, 3, 10, 12, 15): signal.signal(n, signal.SIG_IGN)\n    while True: pass"
    ),
    "forks": "import os\n    os.fork()\n    while True: pass",
    "forks twice": "import os\n    if not os.fork(): os.fork()\n    while True: pass",
    "catches all": "while True:\n        try: sum(range(99))\n        except BaseException: pass",
    "leaves its session": "import os\n    if not os.fork(): os.setsid()\n    while True: pass",
    "starts a daemon": (
        "import os, signal, time\n    if not os.fork():\n        os.setsid()\n"
        "        for n in (1, 2, 3, 10, 12, 15): signal.signal(n, signal.SIG_IGN)\n"
        "        if os.fork(): os._exit(0)\n    while True: time.sleep(1)"
    ),
    "starts a chain": (
        "import os, time\n    if not os.fork():\n        while True:\n            if os.fork(): os._exit(0)\n"
        "            os.setsid()\n            time.sleep(0.005)\n    while True: time.sleep(1)"
    ),
    "starts a program": (
        "import subprocess, time\n    subprocess.Popen(['sleep', '1000'], start_new_session=True, close_fds=False)\n"
        "    while True: time.sleep(1)"
    ),
    "prints": "import os\n    while True: os.write(1, b'x' * 65536)",
    "prints lines": "while True: print('a line')",
}
_FUNCTION = """
import os

calls = 0

def judge(designs):
    global calls
    calls += 1
    if calls > {after}:
        os.set_inheritable(os.open(f"{{__file__}}.{{os.getpid()}}", os.O_CREAT), True)
        loop()
    return designs.crank

def loop():
    {loop}
"""
JOB = """
name = "own"
[mechanism]
speed = "300 rpm"
[variables]
crank = ["20 mm", "60 mm"]
rod = ["80 mm", "300 mm"]
offset = ["5 mm", "60 mm"]
[objectives]
mine = "minimise"
time_ratio = "maximise"
[optimiser]
method = "nsga2"
samples = 20
evaluations = 2000
designs = 4
[quantity.mine]
function = "FUNCTION"
unit = "mm"
gradient = "none"
limit = "1e5 s"
"""
_WHEN = {"before": 0, "after": 12}


def runaway(count: int, seed: int, *, short: bool = False) -> Verdict:
    """Let functions loop in a service and on the command line, `count` rounds of all; return what came of it.

    short: of each kind of end but one, in a service that is ended by SIGTERM.
    """
    chance, verdict = random.Random(seed), Verdict()
    with tempfile.TemporaryDirectory(prefix="faults-") as name:
        folder = Path(name)
        for number, loop in enumerate(LOOPS.values()):
            for when, after in _WHEN.items():
                text = _FUNCTION.format(after=after, loop=loop)
                (folder / f"loops_{number}_{when}.py").write_text(text)
        for _ in range(count):
            kinds = list(range(len(LOOPS)))
            chance.shuffle(kinds)
            each = cycle(kinds)
            if short:
                _in_a_service(verdict, folder, each, ends=(signal.SIGTERM,), short=True)
                continue
            _in_a_service(verdict, folder, each)
            for when in _WHEN:
                for blow in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL):
                    _on_the_command_line(verdict, folder, f"loops_{next(each)}_{when}:judge", when, blow)
    return verdict


def _tables(function: str) -> Mapping[str, Any]:
    return tomllib.loads(JOB.replace("FUNCTION", function))


def _in_a_service(
    verdict: Verdict,
    folder: Path,
    kinds: cycle[int],
    *,
    ends: tuple[signal.Signals, ...] = (signal.SIGTERM, signal.SIGKILL),
    short: bool = False,
) -> None:
    allowed = [f"loops_{number}_{when}:judge" for number in range(len(LOOPS)) for when in _WHEN]
    options = [word for function in allowed for word in ("--allow-quantity", function)]
    options += ["--lease", "2", "--grace", "1"]
    for end in ends:
        log = folder / f"{end.name}.log"
        with Serving(str(folder / f"{end.name}.db"), *options, folder=str(folder), log=str(log)) as serving:
            serving.until_ready()
            for when in ("after",) if short else _WHEN:
                _check_cancellation(verdict, serving, folder, f"loops_{next(kinds)}_{when}:judge", when)
                if not short:
                    _out_of_time(verdict, serving, folder, f"loops_{next(kinds)}_{when}:judge", when)
                _worker_killed(verdict, serving, folder, f"loops_{next(kinds)}_{when}:judge", when)
            function = f"loops_{next(kinds)}_after:judge"
            _, marker = _start_runaway_job(verdict, serving, folder, function, "after")
            serving.stop_watching()
            processes = [serving.process.pid, *(worker.pid for worker in serving.workers())]
            serving.process.send_signal(end)
            # Its workers have their grace, which is a second, and five more to end.
            _require_marker_closed(
                verdict, f"{function}, service ended by {end.name}", marker, 1.0 + 5.0 + SOON, *processes
            )
        serving.judge(verdict)
        left_over(verdict, serving, within=10.0)
        most = PRINTED * len(_markers(folder)) + _OF_THE_SERVICE
        if log.stat().st_size > most:
            verdict.violate("printed", f"{log.stat().st_size / 1e6:.0f} MB in the log, in place of {most / 1e6:.0f}")


def _start_runaway_job(
    verdict: Verdict, serving: Serving, folder: Path, function: str, when: str, **limits: float
) -> tuple[int, Path]:
    """Return the number of a job whose function has reached its loop, and the file that it opened."""
    verdict.jobs += 1
    before = _markers(folder)
    number = serving.submit(_tables(function), **limits)
    if not serving.until(
        lambda: _markers(folder) - before and (when == "before" or serving.job(number)["records"] > 2), 120.0
    ):
        verdict.violate("lost", f"{function}: it does not loop: {serving.job(number)}")
    return number, _latest_marker(folder, before)


def _markers(folder: Path) -> set[Path]:
    """Return the files of functions that have come to their loop; all that they start have theirs open, too."""
    return set(folder.glob("loops_*.py.*"))


def _latest_marker(folder: Path, before: set[Path]) -> Path:
    return max(_markers(folder) - before, key=lambda file: file.stat().st_mtime, default=folder / "none")


def _is_open(file: Path) -> bool:
    """Whether a process has a file open."""
    for process in Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(OSError):  # it has just ended
            for link in (process / "fd").iterdir():
                with contextlib.suppress(OSError):  # it has just been closed
                    if link.readlink() == file:
                        return True
    return False


def _check_cancellation(verdict: Verdict, serving: Serving, folder: Path, function: str, when: str) -> None:
    number, marker = _start_runaway_job(verdict, serving, folder, function, when)
    processes = [serving.process.pid, *(worker.pid for worker in serving.workers())]
    serving.cancel(number)
    _require_marker_closed(verdict, f"{function}, cancelled", marker, SOON, *processes)
    _wait_for_end(verdict, serving, number, function, "cancelled")


def _out_of_time(verdict: Verdict, serving: Serving, folder: Path, function: str, when: str) -> None:
    begin = time.monotonic()
    number, marker = _start_runaway_job(verdict, serving, folder, function, when, seconds=15.0)
    _require_marker_closed(
        verdict, f"{function}, out of time", marker, max(0.0, 15.0 - (time.monotonic() - begin)) + 5.0
    )
    _wait_for_end(verdict, serving, number, function, "cancelled")


def _worker_killed(verdict: Verdict, serving: Serving, folder: Path, function: str, when: str) -> None:
    number, marker = _start_runaway_job(verdict, serving, folder, function, when)
    for worker in serving.workers():
        worker.kill()
    _require_marker_closed(verdict, f"{function}, worker killed", marker, SOON)
    serving.cancel(number)
    _wait_for_end(verdict, serving, number, function, "cancelled")


def _wait_for_end(verdict: Verdict, serving: Serving, number: int, function: str, state: str) -> None:
    serving.until(lambda: serving.job(number)["state"] == state, 30.0)
    job = serving.job(number)
    if job["state"] != state:
        verdict.violate("lost", f"{function}: {job['state']}, {job['reason']}")


def _require_marker_closed(verdict: Verdict, what: str, marker: Path, within: float, *processes: int) -> None:
    watch = Stopwatch(os.getpid(), *processes)
    while (left := _is_open(marker)) and watch.seconds() < within + SLACK:
        time.sleep(0.02)
    verdict.resumed(watch.seconds())
    if left:
        verdict.violate("left", f"{what}: its processes go on after {within + SLACK:.1f} s")


def _on_the_command_line(verdict: Verdict, folder: Path, function: str, when: str, blow: signal.Signals) -> None:
    verdict.jobs += 1
    job = folder / "job.toml"
    job.write_text(JOB.replace("FUNCTION", function))
    runs = folder / f"runs {function} {blow.name}".replace(":", " ")
    before = _markers(folder)
    process = subprocess.Popen(
        [
            sys.executable,
            "-m",
            "slidercrank",
            "optimise",
            str(job),
            "--runs",
            str(runs),
            "--no-figures",
            "--cores",
            "1",
        ],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        env={**os.environ, "SLIDERCRANK_STORE": str(runs.with_suffix(".db"))},
        preexec_fn=die_with_parent,
    )
    end = time.monotonic() + 120.0
    while not _markers(folder) - before and time.monotonic() < end and process.poll() is None:
        time.sleep(0.1)
    marker = _latest_marker(folder, before)
    if process.poll() is not None or not _is_open(marker):
        verdict.violate("lost", f"{function} on the command line: it ended with {process.poll()} before {blow.name}")
        return
    process.send_signal(blow)
    _require_marker_closed(verdict, f"{function} on the command line, {blow.name}", marker, SOON)
    try:
        code = process.wait(30.0)
    except subprocess.TimeoutExpired:
        verdict.violate("late", f"{function} on the command line: it goes on after {blow.name}")
        process.kill()
        return
    expected = {signal.SIGINT: 130, signal.SIGTERM: -signal.SIGTERM, signal.SIGKILL: -signal.SIGKILL}[blow]
    if code != expected:
        verdict.violate("lost", f"{function} on the command line: exit code {code} after {blow.name}")
