"""A job whose crank pin is too thin for its load, and the result of its search."""

from __future__ import annotations

from functools import cache
from typing import Any

from slidercrank.optimise.job import parse_job
from slidercrank.optimise.solve import solve
from slidercrank.service.runs.result import Result, result_of

BAR = {"width": "40 mm", "depth": "20 mm", "density": "7850 kg/m^3"}
MATERIAL = {
    "density": "7850 kg/m^3",
    "elasticity": "207 GPa",
    "yield_strength": "350 MPa",
    "ultimate_strength": "520 MPa",
    "endurance": "150 MPa",
    "bearing_pressure": "20 MPa",
}
TABLES: dict[str, Any] = {
    "name": "Weak pins",
    "mechanism": {"speed": "300 rpm", "slider": {"mass": "2 kg"}, "crank": BAR, "rod": BAR},
    "load": [{"force": "4 kN", "opposes": "motion"}],
    "sections": {
        "pins": {"crank_pivot": "20 mm", "crank_pin": "5 mm", "slider_pin": "16 mm"},
        "material": MATERIAL,
    },
    "variables": {"crank": "50 mm", "rod": ["120 mm", "300 mm"], "offset": ["0 mm", "40 mm"]},
    "objectives": {"time_ratio": "maximise", "peak_torque": "minimise"},
    "optimiser": {"designs": 4, "samples": 64},
}


@cache
def result() -> Result:
    """Return the result of the job."""
    return result_of(solve(parse_job(TABLES)), "weak")
