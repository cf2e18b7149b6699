"""Small jobs of a second or so, and what each finds when nothing goes wrong."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

_JOB = """
[mechanism]
speed = "300 rpm"
slider = { mass = "2 kg" }
[variables]
crank = ["20 mm", "200 mm"]
rod = ["60 mm", "600 mm"]
offset = ["0 mm", "200 mm"]
[constraints]
stroke = { equals = "280 mm" }
transmission_angle = { min = "40 deg" }
[objectives]
time_ratio = "maximise"
transmission_angle = "maximise"
"""
_SEARCHES: dict[str, dict[str, Any]] = {
    "nsga2 1": {"method": "nsga2", "samples": 20, "evaluations": 300, "seed": 1},
    "nsga2 2": {"method": "nsga2", "samples": 10, "evaluations": 300, "seed": 2},
    "random 1": {"method": "random", "samples": 200, "evaluations": 4000, "seed": 1},
    "random 2": {"method": "random", "samples": 50, "evaluations": 1500, "seed": 2},
    "random 3": {"method": "random", "samples": 50, "evaluations": 250, "seed": 3},
    "sobol": {"method": "sobol", "samples": 256, "evaluations": 4096},
    "auto": {"method": "auto", "samples": 512},
}
KINDS = tuple(_SEARCHES)


def tables(kind: str) -> Mapping[str, Any]:
    """Return a job as the tables of its file. kind: one of `KINDS`, which is also its name."""
    return {"name": kind, **tomllib.loads(_JOB), "optimiser": {"designs": 8, **_SEARCHES[kind]}}


@dataclass(frozen=True)
class Found:
    """Result of a job, as the store has it. designs: number and cells; record: all else, but for times and places."""

    designs: tuple[tuple[int, str], ...]
    record: Mapping[str, Any]
