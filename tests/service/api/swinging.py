"""Jobs that swing, or have a cycle of two turns, solved at once in a store."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

from slidercrank.optimise.job import parse_job
from slidercrank.optimise.solve import solve
from slidercrank.service.runs.result import result_of
from slidercrank.service.store import Store
from tests.service.api.fixed_front import store_result

_FEW = {"method": "sobol", "evaluations": 200, "designs": 3, "seed": 1}
ENGINE: dict[str, Any] = {
    "name": "Engine",
    "mechanism": {"speed": "3000 rpm", "slider": {"mass": "0.5 kg"}},
    "load": [
        {
            **{"bore": "86 mm", "compression_ratio": 10, "intake": "0.9 bar", "heat": "1.6 MJ/m^3"},
            **{"exhaust": "1.1 bar", "cycle": "720 deg"},
        }
    ],
    "variables": {"crank": "43 mm", "rod": ["120 mm", "180 mm"], "offset": "0 mm"},
    "objectives": {"peak_torque": "minimise", "peak_guide_force": "minimise"},
}


def support(**motion: Any) -> dict[str, Any]:
    """Return the tables of the shipped support with changes to its motion."""
    job: dict[str, Any] = tomllib.loads(Path("runs/support.toml").read_text(encoding="utf-8"))
    job["motion"] = {**job["motion"], **motion}
    return job


def solved_at_once(store: Store, job: dict[str, Any]) -> int:
    """Solve a job with few designs and return its number in the store."""
    job = {**job, "optimiser": _FEW}
    return store_result(store, result_of(solve(parse_job(job)), job["name"]), job)
