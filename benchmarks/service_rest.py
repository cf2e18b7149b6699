"""A service at rest, and how soon it shows a front: `python -m benchmarks.service_rest`. SQLite, one worker."""

from __future__ import annotations

import tempfile
import time
import tomllib
from pathlib import Path

import httpx
import psutil

from .report import Row, machine, show
from .service_process import Service, headers, service

_SETTLED = 5.0  # s after which a service has imported what it imports without being asked
_PATIENCE = 60.0  # s for a job


def rest(repeats: int = 3) -> list[Row]:
    """Return the memory of processes before their first job, and the time from a submission to the first front."""
    with (
        tempfile.TemporaryDirectory() as folder,
        service(f"sqlite:///{folder}/store.db", Path(folder), workers=1) as serving,
    ):
        time.sleep(_SETTLED)
        workers = serving.process.children(recursive=True)
        memory = [
            Row("memory of the API at rest, MB", [_megabytes(serving.process)], at_most=200.0),
            Row("memory of a worker before its first job, MB", [max(map(_megabytes, workers))], at_most=150.0),
        ]
        times = [_first_front(serving) for _ in range(repeats + 1)]  # the first loads kernels
    return [*memory, Row("from a submission to the first front in the API's answer, s", times[1:], at_most=1.0)]


def _megabytes(process: psutil.Process) -> float:
    return float(process.memory_info().rss) / 1e6


def _first_front(serving: Service) -> float:
    """Return how long a submitted feeder job takes to have a front, s; wait for its end."""
    tables = tomllib.loads(Path("runs/feeder.toml").read_text(encoding="utf-8"))
    with httpx.Client(base_url=serving.url, headers=headers(), timeout=_PATIENCE, trust_env=False) as client:
        begin = time.perf_counter()
        answer = client.post("jobs", json={"job": tables})
        answer.raise_for_status()
        seen, number = 0.0, answer.json()["id"]
        while time.perf_counter() - begin < _PATIENCE:
            job = client.get(f"jobs/{number}").json()
            if not seen and ((job["progress"] or {}).get("front") or job["summary"]):
                seen = time.perf_counter() - begin
            if job["state"] not in ("queued", "running"):
                return seen
            time.sleep(0.02)
    raise SystemExit(f"job {number} has not ended within {_PATIENCE:g} s")


if __name__ == "__main__":
    print(machine())
    show("A service at rest", rest())
