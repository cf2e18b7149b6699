"""Problems shared by the tests of the optimiser: a machine, problems stated in one line, the shipped jobs."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from slidercrank.model.machine.links_and_joints import Bar
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.mechanism import Mechanism, Tolerance, Tolerances
from slidercrank.optimise.front.front import ParetoFront
from slidercrank.optimise.job import load_job
from slidercrank.optimise.methods.auto import auto
from slidercrank.optimise.problem.problem import Problem, Settings
from slidercrank.optimise.problem.requirements import Constraint, Objective, Range, Sense
from slidercrank.optimise.search import sample_and_zoom
from slidercrank.optimise.search.sample_and_zoom import WIDTHS
from slidercrank.optimise.solve import solve
from tests.shared import computed_once

JOBS = ("feeder", "sieve", "turning_support", "compressor")
RUNS = Path(__file__).parents[2] / "runs"
DATA = Path(__file__).parents[1] / "data"

MACHINE = Mechanism(
    speed=30.0,
    crank=Bar(width=0.03, depth=0.02, density=7800.0),
    rod=Bar(width=0.03, depth=0.02, density=7800.0),
    slider_mass=2.0,
    gravity=(0.0, -9.81),
    loads=(StrokeForce(outward=-60.0, inward=60.0),),
    tolerances=Tolerances(
        crank=Tolerance(absolute=5e-5),
        rod=Tolerance(absolute=1e-4),
        offset=Tolerance(absolute=1e-4),
        crank_angle=Tolerance(absolute=1e-3),
    ),
)

LEVER: dict[str, Any] = {
    "name": "Tipper",
    "mechanism": {
        "inversion": "turning cylinder",
        "frame_angle": "-60 deg",
        "crank": {"mass": "80 kg", "centre": "700 mm"},
        "gravity": "9.81 m/s^2",
    },
    "motion": {"kind": "swing", "from": "-20 deg", "to": "50 deg", "law": "harmonic", "duration": "8 s"},
    "cylinder": {
        **{"bore": "40 mm", "rod": "25 mm", "supply_pressure": "160 bar", "seal_friction": "30 N"},
        **{"closed_length": "640 mm", "stroke": "440 mm", "length_tolerance": "1 mm"},
    },
    "tolerances": {"crank": "0.5 mm"},
    "variables": {"crank": ["300 mm", "450 mm"], "rod": ["700 mm", "1100 mm"], "offset": ["-50 mm", "50 mm"]},
    "objectives": {"peak_cylinder_force": "minimise", "lever_angle_error": "minimise"},
    "optimiser": {"designs": 6, "samples": 256, "seed": 1},
}
"""Tables of a lever moved by a cylinder that turns."""

SHAPER: dict[str, Any] = {
    "name": "Shaper",
    "mechanism": {"inversion": "turning cylinder", "frame_angle": "-90 deg", "speed": "60 rpm", "gravity": 9.81},
    "arm": {"mass": "20 kg", "centre": "300 mm", "inertia": 1.2, "ram": "500 mm", "ram_mass": 40, "ram_force": "2 kN"},
    "variables": {"crank": ["60 mm", "180 mm"], "rod": ["250 mm", "500 mm"], "offset": ["0 mm", "20 mm"]},
    "objectives": {"arm_time_ratio": "maximise", "peak_crank_torque": "minimise"},
    "optimiser": {"designs": 4, "samples": 64, "seed": 1},
}
"""Tables of a crank that rotates fully and turns an arm."""

Ends = tuple[float, float] | float
Bounds = tuple[float | None, float | None] | float


def degrees(angle: float) -> float:
    """Return an angle given in degrees, rad."""
    return math.radians(angle)


def problem(
    objectives: Mapping[str, Sense | float],
    constraints: Mapping[str, Bounds] | None = None,
    *,
    crank: Ends = (0.02, 0.2),
    rod: Ends = (0.06, 0.6),
    offset: Ends = (0.0, 0.2),
    mechanism: Mechanism = MACHINE,
    designs: int = 16,
    samples: int | None = None,
    seed: int = 1,
) -> Problem:
    """Return a problem, SI. A number as objective is its target; a number as constraint asks this value."""
    wanted = [
        Objective(quantity=name, sense="target", target=wish)
        if isinstance(wish, float)
        else Objective(quantity=name, sense=wish)
        for name, wish in objectives.items()
    ]
    held = []
    for name, bounds in (constraints or {}).items():
        lower, upper = bounds if isinstance(bounds, tuple) else (bounds, bounds)
        held.append(Constraint(quantity=name, lower=lower, upper=upper))
    return Problem(
        name="test",
        mechanism=mechanism,
        crank=_range(crank),
        rod=_range(rod),
        offset=_range(offset),
        objectives=tuple(wanted),
        constraints=tuple(held),
        settings=Settings(designs=designs, samples=samples, seed=seed),
    )


def _range(ends: Ends) -> Range:
    lower, upper = ends if isinstance(ends, tuple) else (ends, ends)
    return Range(lower=lower, upper=upper)


_FEW = {"_FEWEST": 6, "_EXTREMES": 2, "_STARTS": 6}
_ALL = {name: getattr(auto, name) for name in _FEW}


def polish_few(patch: pytest.MonkeyPatch) -> None:
    """Polish few designs a search, for what does not depend on how near to the best they come."""
    for name, count in _FEW.items():
        patch.setattr(auto, name, count)


def search_little(patch: pytest.MonkeyPatch) -> None:
    """Zoom in half as many rounds, and polish few designs."""
    patch.setattr(sample_and_zoom, "WIDTHS", WIDTHS[::2])
    polish_few(patch)


@cache
def shipped(job: str) -> Problem:
    """Return the problem of a shipped job."""
    return load_job((DATA if job == "turning_support" else RUNS) / f"{job}.toml")


@computed_once
def shipped_front(job: str) -> ParetoFront:
    """Return the front of a shipped job, for tests that search little too: they share it with all others."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sample_and_zoom, "WIDTHS", WIDTHS)
        for name, count in _ALL.items():
            patch.setattr(auto, name, count)
        return solve(shipped(job))
