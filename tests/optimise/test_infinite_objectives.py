"""Objectives that are infinite for every design are told before a search."""

from __future__ import annotations

from copy import deepcopy
from typing import Any

import numpy as np
import pytest

from slidercrank.model.errors import InputError
from slidercrank.optimise.feasibility.infeasibility import require_finite
from slidercrank.optimise.job import parse_job
from slidercrank.optimise.search.elimination import elimination_branches
from slidercrank.optimise.search.evaluation import Evaluator
from slidercrank.optimise.solve import solve

JOB: dict[str, Any] = {
    "name": "pull",
    "mechanism": {
        "speed": "1 rpm",
        "rod": {"width": "20 mm", "depth": "10 mm", "density": "7850 kg/m^3"},
        "slider": {"mass": "0.01 kg"},
    },
    "load": [{"force": "500 N", "direction": "outward"}],
    "sections": {
        "pins": {"crank_pivot": "12 mm", "crank_pin": "10 mm", "slider_pin": "10 mm"},
        "material": {
            "density": "7850 kg/m^3",
            "elasticity": "207 GPa",
            "yield_strength": "600 MPa",
            "ultimate_strength": "800 MPa",
            "endurance": "200 MPa",
            "bearing_pressure": "40 MPa",
        },
    },
    "variables": {"crank": "30 mm", "rod": ["120 mm", "200 mm"], "offset": "0 mm"},
    "objectives": {"buckling_safety": "maximise", "rod_mass": "minimise"},
}


def job(direction: str, speed: float) -> dict[str, Any]:
    data = deepcopy(JOB)
    data["load"][0]["direction"] = direction
    data["mechanism"]["speed"] = f"{speed:g} rpm"
    return data


@pytest.mark.parametrize("wish", ["minimise", "maximise", {"target": 3.0}])
def test_the_buckling_safety_of_bars_that_are_only_pulled_is_no_objective(wish: Any) -> None:
    data = job("outward", 1.0)
    data["objectives"]["buckling_safety"] = wish
    with pytest.raises(InputError, match=r"^objectives.buckling_safety: .*infinite for all .*leave it out$"):
        solve(parse_job(data))


def test_it_is_one_where_any_design_is_compressed() -> None:
    """A slider pushed inward compresses the rod of every design; a fast one that is pulled, that of some."""
    random = np.random.default_rng(4)
    told = set()
    for speed in (1.0, *random.uniform(500.0, 9000.0, 8)):
        for direction in ("inward", "outward"):
            problem = parse_job(job(direction, speed))
            evaluators = [Evaluator(problem, branch) for branch in elimination_branches(problem)]
            designs = np.column_stack([np.full(41, 0.03), np.linspace(0.12, 0.2, 41), np.zeros(41)])
            safety = problem.quantity("buckling_safety").evaluate(problem.mechanism, designs).values
            infinite = bool(np.isinf(safety).all())
            told.add(infinite)
            if infinite:
                with pytest.raises(InputError, match="never compressed"):
                    require_finite(problem, evaluators)
            else:
                require_finite(problem, evaluators)
    assert told == {True, False}
