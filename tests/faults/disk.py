"""`slidercrank optimise` and `serve` on disks that are full: told at once, nothing lost, gone on with."""

from __future__ import annotations

import csv
import os
import random
import subprocess
import sys
import tempfile
import threading
import time
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

from slidercrank.service.store import Store

from .lifeline import die_with_parent
from .serving import Serving, left_over
from .small_disk import Disk, small_disk
from .verdict import Verdict

PLACES = ("store", "runs", "figures", "kernels", "temporary")
SAYS = 5.0  # s
_HANGS = 120.0  # s
_JOB = """
name = "full"
[mechanism]
speed = "300 rpm"
slider = { mass = "2 kg" }
[variables]
crank = ["20 mm", "200 mm"]
rod = ["60 mm", "600 mm"]
offset = ["0 mm", "200 mm"]
[constraints]
transmission_angle = { min = "40 deg" }
[objectives]
time_ratio = "maximise"
peak_torque = "minimise"
[optimiser]
method = "nsga2"
samples = 40
evaluations = 4000
designs = 8
"""
Where = str


def disk(count: int, seed: int) -> Verdict:
    """Fill each disk that a run writes to `count` times, and a service's once; return the verdict."""
    chance, verdict = random.Random(seed), Verdict()
    with tempfile.TemporaryDirectory(prefix="faults-") as folder:
        job = Path(folder) / "job.toml"
        job.write_text(_JOB)
        whole = _run_undisturbed(job, Path(folder) / "undisturbed") if count else []
        for number in range(count):
            for where in PLACES:
                with small_disk() as small:
                    _run_on_full_disk(verdict, small, where, job, Path(folder) / f"{where} {number}", whole, chance)
        with small_disk() as small:
            _serve(verdict, small)
    return verdict


def _run_undisturbed(job: Path, runs: Path) -> list[list[str]]:
    process = _optimise(runs, {}, str(job), "--no-figures")
    _, errors = process.communicate()
    if process.returncode:
        raise SystemExit(f"the run without faults ended with {process.returncode}: {errors}")
    return _designs(runs)


def _designs(runs: Path) -> list[list[str]]:
    (front,) = runs.glob("*/front.csv")
    return list(csv.reader(front.read_text().splitlines()))


def _optimise(runs: Path, environment: dict[str, str], *arguments: str) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-m", "slidercrank", "optimise", "--runs", str(runs), *arguments],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, **environment},
        preexec_fn=die_with_parent,
    )


def _run_on_full_disk(
    verdict: Verdict, small: Disk, where: Where, job: Path, runs: Path, whole: list[list[str]], chance: random.Random
) -> None:
    """Run a job with one place on a disk that fills at some moment; then make room and resume."""
    verdict.jobs += 1
    if where in ("runs", "figures"):
        runs = small.folder / "runs"
    environment = {
        "SLIDERCRANK_STORE": str(small.folder / "store.db") if where == "store" else str(runs.with_suffix(".db")),
        **({"NUMBA_CACHE_DIR": str(small.folder)} if where == "kernels" else {}),
        **({"TMPDIR": str(small.folder)} if where == "temporary" else {}),
    }
    if where in ("runs", "figures"):
        environment["SLIDERCRANK_STORE"] = str(runs.parent.parent / f"{small.folder.name}.db")
    if where in ("kernels", "temporary"):
        small.fill()
    process = _optimise(runs, environment, str(job), *([] if where == "figures" else ["--no-figures"]))
    if where in ("store", "runs"):
        # What does not write yet cannot know: the search is to be under way.
        _until(lambda: any("evaluated" in log.read_text() for log in runs.glob("*/log.txt")), 120.0)
        time.sleep(chance.uniform(0.0, 0.5))
        small.fill()
    elif where == "figures":
        _until(lambda: list(runs.glob("*/front.csv")), 120.0)
        small.fill()
    filled = time.monotonic()
    errors, told, hung = _listen(process, str(small.folder))
    if hung:
        verdict.violate("late", f"{where}: nothing for {time.monotonic() - filled:.0f} s")
        return
    if process.returncode not in (0, 2) or (process.returncode == 2 and told is None):
        verdict.violate("lost", f"{where}: exit code {process.returncode}: {errors.strip()[-600:]}")
    elif where in ("store", "runs") and told is not None and told - filled > SAYS:
        verdict.violate("late", f"{where}: told after {told - filled:.1f} s")
    verdict.resumed(0.0 if told is None else told - filled)
    verdict.failed += process.returncode == 2
    small.empty()
    if process.returncode == 2 and where in ("store", "runs"):
        _resume_run(verdict, where, runs, environment, whole)
    elif process.returncode == 0 and _designs(runs) != whole:
        verdict.violate("designs differ", where)
    Path(environment["SLIDERCRANK_STORE"]).unlink(missing_ok=True)


def _resume_run(
    verdict: Verdict, where: Where, runs: Path, environment: dict[str, str], whole: list[list[str]]
) -> None:
    with Store(environment["SLIDERCRANK_STORE"]) as store:
        run = store.jobs()[0].run
    again = _optimise(runs, environment, "--resume", run, "--no-figures")
    _, errors = again.communicate()
    if again.returncode:
        verdict.violate("lost", f"{where}: not gone on with, exit code {again.returncode}: {errors.strip()[-600:]}")
    elif _designs(runs) != whole:
        verdict.violate("designs differ", f"{where}, gone on with")


def _listen(process: subprocess.Popen[str], disk: str) -> tuple[str, float | None, bool]:
    """Return a process's messages, the time when it first told a disk's room, and whether it hung."""
    assert process.stderr is not None
    timer = threading.Timer(_HANGS, process.kill)
    timer.start()
    lines, told = [], None
    with process.stderr:
        for line in process.stderr:
            lines.append(line)
            if told is None and disk in line and "free" in line:
                told = time.monotonic()
    process.wait()
    timer.cancel()
    return "".join(lines), told, timer.finished.is_set() and process.returncode == -9


def _serve(verdict: Verdict, small: Disk) -> None:
    """Fill the disk of a service's store in the middle of a job, and give it room again."""
    verdict.jobs += 1
    tables = {**tomllib.loads(_JOB), "name": "served"}
    with Serving(str(small.folder / "store.db")) as serving:
        serving.until_ready()
        number = serving.submit(tables)
        serving.until(lambda: serving.job(number)["records"] > 2, 60.0)
        small.fill()
        begin = time.monotonic()
        serving.until(lambda: serving.ready().status_code == 503, SAYS)
        answer, job = serving.ready().text, serving.job(number)
        if str(small.folder) not in answer:
            verdict.violate("lost", f"ready does not name the disk: {answer}")
        if job["state"] not in ("queued", "running") or str(small.folder) not in job["reason"]:
            verdict.violate("lost", f"the job does not wait for the disk: {job['state']}, {job['reason']}")
        time.sleep(max(0.0, SAYS - (time.monotonic() - begin)))
        small.empty()
        _until_done(serving, number)
        if serving.job(number)["state"] != "done":
            verdict.violate("lost", f"the job did not go on: {serving.job(number)}")
        if serving.ready().status_code != 200:
            verdict.violate("late", f"ready still says {serving.ready().text}")
    serving.judge(verdict)
    left_over(verdict, serving)


def _until_done(serving: Serving, number: int) -> None:
    """Wait until a job is done, or has made no progress for two minutes."""
    records = -1

    def has_moved() -> bool:
        job = serving.job(number)
        return bool(job["state"] == "done" or job["records"] > records)

    while serving.until(has_moved, 120.0):
        job = serving.job(number)
        if job["state"] == "done":
            return
        records = job["records"]


def _until(condition: Callable[[], Any], seconds: float) -> None:
    end = time.monotonic() + seconds
    while not condition() and time.monotonic() < end:
        time.sleep(0.02)
