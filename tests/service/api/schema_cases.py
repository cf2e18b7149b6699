"""The API against its own description: cases made by schemathesis, also one after the other along the links.

    python -m tests.service.api.schema_cases 10000 1

asks about that many, with a seed. Meanwhile jobs come, are solved, fail and are cancelled, so that every answer occurs.
"""

from __future__ import annotations

import contextlib
import json
import os
import random
import subprocess
import sys
import tempfile
import threading
import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from slidercrank.service.api.app import create_app
from slidercrank.service.api.job_requests import EXAMPLE
from slidercrank.service.api.settings import Settings
from slidercrank.service.jobs.submission import submit
from slidercrank.service.runs.result import Result
from slidercrank.service.store import Limits, Store
from slidercrank.service.workers.worker import work
from tests.service.api.serving import TOKEN, serving
from tests.service.store.contents import progress

# A job can be wrong in ways that no schema tells, so that data which the schema allows may be refused; and one that was
# taken in has no design 1 where it has no solution.
_UNCHECKED = "positive_data_acceptance,ensure_resource_availability"
_HOOKS = "tests.service.api.schemathesis_hooks"
_ROOT = Path(__file__).parents[3]
ALL = "examples,coverage,fuzzing,stateful"


@dataclass(frozen=True)
class Outcome:
    """Outcome of a run of schemathesis. cases: requests that were answered; statuses: how often with which."""

    code: int
    cases: int
    statuses: Counter[int]
    seconds: float
    text: str


def run(place: Path, each: int, phases: str = ALL, seed: int = 1) -> Outcome:
    """Serve a store in a folder and ask `each` cases of every operation, and as many chains along the links.

    phases: of schemathesis, separated by commas.
    """
    report = place / "report.ndjson"
    with Store(place / "store.db", most_queued=1_000_000) as store:
        found = _example_result(store)
        settings = Settings(token=TOKEN, submissions_per_minute=0, limits=Limits(seconds=60.0))
        with serving(create_app(store, settings)) as address, _end_jobs_meanwhile(store, found):
            command = [
                *(sys.executable, "-m", "schemathesis.cli", "run", f"{address}/api/v1/openapi.json"),
                *("--header", f"Authorization: Bearer {TOKEN}", "--checks", "all", "--exclude-checks", _UNCHECKED),
                *(
                    "--phases",
                    phases,
                    "--max-examples",
                    str(each),
                    "--seed",
                    str(seed),
                    "--generation-database",
                    "none",
                ),
                *("--report", "ndjson", "--report-ndjson-path", str(report), "--no-color", "--warnings", "off"),
                *("--suppress-health-check", "all", "--request-timeout", "60"),
                # Not 10 s: a report takes 5 s of a processor that others may be using, too.
                *("--max-response-time", "50"),
            ]
            start = time.monotonic()
            hooks = os.environ | {"SCHEMATHESIS_HOOKS": _HOOKS, "PYTHONPATH": str(_ROOT)}
            done = subprocess.run(command, cwd=place, env=hooks, capture_output=True, text=True, check=False)
    statuses = Counter(_statuses(report))
    return Outcome(done.returncode, statuses.total(), statuses, time.monotonic() - start, done.stdout + done.stderr)


def _example_result(store: Store) -> Result:
    submit(store, EXAMPLE)
    work(store, drain=True)
    found = store.result(1)
    for _ in range(30):
        submit(store, EXAMPLE)
        claim = store.claim("lively")
        assert claim is not None
        claim.finish(found)
    return found


@contextlib.contextmanager
def _end_jobs_meanwhile(store: Store, found: Result) -> Iterator[None]:
    """While entered, end some of the jobs that come, each in its own way, and leave some as they are."""
    end, chance = threading.Event(), random.Random(1)

    def lively() -> None:
        while not end.wait(0.02):
            claim = store.claim("lively", lease=5.0)
            if claim is None:
                continue
            claim.report(progress(1))
            way = chance.choice(["done", "done", "done", "infeasible", "cancelled", "failed", "left"])
            if way == "failed":
                claim.fail("made to fail", again=False)
            elif way != "left":
                claim.finish(found if way != "infeasible" else _without_designs(found))

    thread = threading.Thread(target=lively)
    thread.start()
    try:
        yield
    finally:
        end.set()
        thread.join()


def _without_designs(found: Result) -> Result:
    from dataclasses import replace

    return replace(found, status="infeasible", message="nothing", designs=[], extremes={}, knee=None, trade_offs=[])


def _statuses(report: Path) -> Iterator[int]:
    with report.open() as lines:
        for line in lines:
            yield from _statuses_in(json.loads(line))


def _statuses_in(node: object) -> Iterator[int]:
    if isinstance(node, dict):
        for key, value in node.items():
            if key == "status_code" and isinstance(value, int):
                yield value
            else:
                yield from _statuses_in(value)
    elif isinstance(node, list):
        for value in node:
            yield from _statuses_in(value)


if __name__ == "__main__":
    wanted, chosen = int(sys.argv[1]), int(sys.argv[2])
    with tempfile.TemporaryDirectory() as folder:
        outcome = run(Path(folder), max(1, wanted // 28), seed=chosen)
    sys.stdout.write(outcome.text)
    statuses = ", ".join(f"{status}: {count}" for status, count in sorted(outcome.statuses.items()))
    sys.stdout.write(f"{outcome.cases} cases in {outcome.seconds:.0f} s; {statuses}\n")
    sys.exit(outcome.code)
