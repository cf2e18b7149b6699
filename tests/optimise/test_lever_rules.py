"""Exact lengths of a lever's cylinder: dimensions in closed form, for fixed and for varying angles."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest

import slidercrank as sc
from slidercrank.optimise.search.elimination import elimination_branches
from slidercrank.optimise.search.evaluation import Evaluator
from tests.optimise.test_lever_jobs import lever

EXACT = {
    "least_cylinder_length": "650 mm",
    "greatest_cylinder_length": "1060 mm",
    "cylinder_travel": "410 mm",
    "extension_ratio": 1060.0 / 650.0,
}
"""Requirements that agree with each other."""
VARIABLES: list[dict[str, Any]] = [
    {},
    {"mechanism.frame_angle": ["-75 deg", "-45 deg"]},
    {"mechanism.frame_angle": ["-75 deg", "-45 deg"], "motion.from": ["-25 deg", "-10 deg"]},
]


def job(names: tuple[str, ...], variables: dict[str, Any], **swing: Any) -> sc.Problem:
    """Return a problem that requires some lengths exactly."""
    wanted = {name: {"equals": EXACT[name]} for name in names}
    motion = {"motion": swing} if swing else {}
    wide = {"crank": ["200 mm", "600 mm"], "rod": ["500 mm", "1400 mm"], "offset": ["0 mm", "60 mm"]}
    return sc.problem(
        lever(constraints=wanted, variables=wide | variables, cylinder=None, **motion, tolerances=None)
        | {"objectives": {"peak_cylinder_force": "minimise"}}
    )


@pytest.mark.parametrize("variables", VARIABLES)
@pytest.mark.parametrize(
    "names",
    [
        ("least_cylinder_length",),
        ("greatest_cylinder_length",),
        ("extension_ratio",),
        *itertools.combinations(EXACT, 2),
    ],
)
def test_lengths_that_are_required_hold_exactly(names: tuple[str, ...], variables: dict[str, Any]) -> None:
    problem = job(names, variables)
    random, met = np.random.default_rng(5), 0
    for branch in elimination_branches(problem):
        assert set(branch.eliminated) == set(names)
        assert len(branch.free) == 3 + len(problem.mechanism.varying) - len(names)
        evaluator, u = Evaluator(problem, branch), random.random((400, len(branch.free)))
        u = u[evaluator.can_evaluate(u)]
        if len(u):
            designs = branch.designs_at_points(u)
            found = problem.evaluate(designs, list(names))
            by_name = {item.quantity: item.lower for item in problem.constraints}
            assert found == pytest.approx(np.tile([by_name[name] for name in names], (len(u), 1)), rel=1e-9)
            step = 1e-6
            for column in range(len(branch.free)):
                moved = np.clip(u, 0.01, 0.99)
                ahead, behind = moved.copy(), moved.copy()
                ahead[:, column] += step
                behind[:, column] -= step
                slope = (branch.designs_at_points(ahead) - branch.designs_at_points(behind)) / (2.0 * step)
                exact = branch.jacobian(moved)[:, :, column]
                regular = np.isfinite(slope).all(axis=1) & (np.abs(slope).max(axis=1) < 10.0)
                assert exact[regular] == pytest.approx(slope[regular], rel=1e-4, abs=1e-6)
            met += len(u)
    assert met


@pytest.mark.slow
def test_a_front_of_exact_lengths_has_them_and_is_as_good_as_without_elimination() -> None:
    names = ("least_cylinder_length", "greatest_cylinder_length")
    problem = job(names, VARIABLES[1])
    front = sc.solve(problem)
    assert front.status == "done", front.message
    found = problem.evaluate(front.dimensions, [*names, "peak_cylinder_force"])
    assert found[:, :2] == pytest.approx(np.tile([0.65, 1.06], (len(front), 1)), rel=1e-9)
    random = np.random.default_rng(6)
    branches = elimination_branches(problem)
    designs = np.concatenate([branch.designs_at_points(random.random((2000, len(branch.free)))) for branch in branches])
    values = problem.evaluate(designs, [*names, "lever_transmission_angle", "peak_cylinder_force"])
    held = np.abs(values[:, :2] - [0.65, 1.06]).max(axis=1) < 1e-9
    held &= (values[:, 2] >= np.radians(10.0)) & (designs[:, 0] <= 0.6) & (designs[:, 1] <= 1.4)
    assert held.sum() > 100
    assert values[held, 3].min() >= found[:, 2].min() * (1.0 - 1e-7)
