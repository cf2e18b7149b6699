"""Starts of the descent to the least violation: those of all points, of which most are not judged in full."""

from __future__ import annotations

import numpy as np
import pytest

from slidercrank.optimise.feasibility.best_value import find_best_design, with_single_objective
from slidercrank.optimise.problem.problem import Problem
from slidercrank.optimise.search import evaluation
from slidercrank.optimise.search.batch_quantities import screen_quantities
from slidercrank.optimise.search.elimination import elimination_branches
from slidercrank.optimise.search.evaluation import Evaluator
from slidercrank.optimise.search.least_violation import greatest_violations
from slidercrank.optimise.search.sampling import distant_rows
from tests.optimise.independent import Array
from tests.optimise.problems import Bounds, degrees, problem

HELD: dict[str, Bounds] = {
    "stroke": (0.18, 0.2),
    "transmission_angle": (degrees(40.0), None),
    "time_ratio": (1.1, None),
    "peak_torque": (None, 15.0),
}
COUNT = 8


@pytest.mark.parametrize("held", [HELD, {**HELD, "rms_torque": (None, 8.0)}, {"peak_torque": (None, 1.0)}])
def test_the_best_starts_are_those_of_all_points(held: dict[str, Bounds]) -> None:
    for branch in elimination_branches(
        problem({"peak_torque": "minimise"}, held, offset=(-0.15, 0.15)), eliminate=False
    ):
        evaluator = Evaluator(problem({"peak_torque": "minimise"}, held, offset=(-0.15, 0.15)), branch)
        u = np.random.default_rng(3).random((4000, evaluator.dimension))
        u = u[evaluator.can_evaluate(u)]
        whole = evaluator.objective_and_constraint_rows(u, goals=False)[1].values.max(axis=1, initial=0.0)
        assert (evaluator.violation_without_cycle(u) <= whole + 1e-12).all()
        judged = evaluator.evaluations
        found = greatest_violations(evaluator, u, COUNT)
        judged = evaluator.evaluations - judged
        one = np.zeros(len(u), np.int64)
        np.testing.assert_array_equal(distant_rows(found, u, one, COUNT), distant_rows(whole, u, one, COUNT))
        np.testing.assert_array_equal(found[np.isfinite(found)], whole[np.isfinite(found)])
        if len(held) > 1:
            assert judged < len(u) / 2, judged


def test_the_best_of_one_objective_takes_few_cycles(monkeypatch: pytest.MonkeyPatch) -> None:
    """With 16,384 samples and four zooms 39,187 were judged, for the same value."""
    judged: list[int] = []

    def counted(problem: Problem, names: tuple[str, ...], dimensions: Array) -> list[Array]:
        if any(not problem.quantity(name).depends_only_on_dimensions for name in names):
            judged.append(len(dimensions))
        return screen_quantities(problem, names, dimensions)

    monkeypatch.setattr(evaluation, "screen_quantities", counted)
    held: dict[str, Bounds] = {"transmission_angle": (degrees(40.0), None), "peak_torque": (None, 20.0)}
    found = find_best_design(with_single_objective(problem({"peak_torque": "minimise"}, held), "stroke", "maximise"))
    assert found is not None
    assert sum(judged) < 5000
