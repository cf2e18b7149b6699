"""Methods that go generation by generation: what a generation is, and what comes of all of them."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from slidercrank.model.arrays import Array
from slidercrank.model.errors import InputError
from slidercrank.objectives.registry import QUANTITIES
from slidercrank.optimise.front.front import ParetoFront
from slidercrank.optimise.methods import nsga as evolutionary
from slidercrank.optimise.methods import population
from slidercrank.optimise.methods.population import Brood, Generation, generation_seed
from slidercrank.optimise.methods.registry import methods_by_name
from slidercrank.optimise.problem.constraint_violation import FEASIBLE
from slidercrank.optimise.problem.problem import Problem
from slidercrank.optimise.search.elimination import elimination_branches
from slidercrank.optimise.search.evaluation import Evaluator
from slidercrank.optimise.search.sample_and_zoom import Archive, Run
from slidercrank.optimise.solve import solve
from tests.optimise.problems import MACHINE, Bounds, degrees, problem

ABLE = ("nsga2", "nsga3", "tpe", "cmaes", "random", "sobol")
# Both signs of the offset, so that there are two branches; a peak among the objectives and one among the constraints.
HELD: dict[str, Bounds] = {"stroke": (0.16, 0.22), "transmission_angle": (degrees(30.0), None)}
LIMITED: dict[str, Bounds] = HELD | {"peak_slider_speed": (None, 4.0)}
SIZES = {"tpe": (8, 40), "cmaes": (6, 60)}


def asked(method: str) -> Problem:
    """Return a small problem for a method: five generations or more."""
    samples, evaluations = SIZES.get(method, (16, 80))
    alone = methods_by_name()[method].objectives == "one"
    given = problem(
        {"peak_torque": "minimise"} if alone else {"peak_torque": "minimise", "time_ratio": "maximise"},
        LIMITED,
        crank=(0.05, 0.15),
        rod=(0.2, 0.6),
        offset=(-0.1, 0.15),
        designs=12,
    )
    return replace(
        given, settings=replace(given.settings, method=method, samples=samples, evaluations=evaluations, seed=5)
    )


def bred(given: Problem) -> tuple[ParetoFront, tuple[Generation, ...]]:
    """Return the front of a problem and all generations that led to it."""
    found: list[Generation] = []
    inner = population._evaluate_brood

    def evaluated(
        evaluators: list[Evaluator], brood: Brood, archive: Archive, known: population._Evaluations
    ) -> Generation:
        found.append(inner(evaluators, brood, archive, known))
        return found[-1]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(population, "_evaluate_brood", evaluated)
        return solve(given), tuple(found)


@cache
def whole(method: str) -> tuple[ParetoFront, tuple[Generation, ...]]:
    """Return the front of a method's problem and all generations that led to it."""
    return bred(asked(method))


def same(one: Generation, two: Generation) -> bool:
    """Return whether two generations are the same bit for bit."""
    names = ("branch", "u", "parents", "values", "violation")
    return all(getattr(one, name).tobytes() == getattr(two, name).tobytes() for name in names)


@pytest.mark.parametrize("method", ABLE)
def test_every_delivered_design_honours_every_constraint(method: str) -> None:
    front, generations = whole(method)
    given = asked(method)
    for index, branch in enumerate(elimination_branches(given)):
        own = front.dimensions[np.sign(front.dimensions[:, 2]) == branch.sign]
        ranges = np.array([[r.lower, r.upper] for r in (given.crank, given.rod, given.offset)])
        assert (own >= ranges[:, 0] - 1e-12).all(), index
        assert (own <= ranges[:, 1] + 1e-12).all(), index
    for name in front.designs.columns[front.designs.columns.str.startswith("slack_")]:
        scale = np.abs(front.designs[name.removeprefix("slack_")])
        assert (front.designs[name] >= -1e-9 * scale).all(), name
    # and what was not feasible was there to be told apart
    violation = np.concatenate([generation.violation for generation in generations])
    assert (violation > FEASIBLE).any()
    assert (violation <= FEASIBLE).any()


@pytest.mark.parametrize("method", ABLE)
def test_each_generation_has_its_own_random_numbers_and_the_seed_changes_all(method: str) -> None:
    _, generations = whole(method)
    given = asked(method)
    _, other = bred(replace(given, settings=replace(given.settings, seed=6)))
    assert not any(same(*pair) for pair in zip(generations, other, strict=False))
    assert len({generation_seed(5, number) for number in range(1000)}) == 1000


def test_a_point_is_evaluated_once_however_often_it_comes() -> None:
    given = asked("nsga2")
    evaluators = [Evaluator(given, branch) for branch in elimination_branches(given)]
    point = np.array([[0.3, 0.4, 0.2], [0.3, 0.4, 0.2], [0.7, 0.8, 0.1]])
    screened: list[int] = []

    def breed(past: object) -> Brood:
        return Brood(np.array([0, 1, 0]), point, np.zeros(0, np.int64))

    for evaluator in evaluators:
        inner = evaluator.screen_designs_objectives_violation

        def counted(u: Array, *, band: float = 0.0, inner: object = inner) -> tuple[Array, Array, Array]:
            screened.append(len(u))
            return inner(u, band=band)  # type: ignore[operator, no-any-return]

        evaluator.screen_designs_objectives_violation = counted  # type: ignore[method-assign]
    run = Run(given, 1)
    population.evolve(given, evaluators, run, breed, size=3)
    # As many generations as fit into the budget; the same coordinates on two branches are two designs.
    assert len(run.round_reports) == 80 // 3
    assert sum(screened) == 3


def test_genetic_search_meets_duplicates_and_does_not_count_them() -> None:
    front, generations = whole("nsga2")
    keys = {
        (int(branch), point.tobytes())
        for generation in generations
        for branch, point in zip(generation.branch, generation.u, strict=True)
    }
    assert len(keys) < sum(len(generation) for generation in generations)
    assert front.evaluations - len(keys) <= 2 * len(front) + 32  # what the delivery evaluates


def test_what_is_not_finite_is_never_told_as_feasible(monkeypatch: pytest.MonkeyPatch) -> None:
    given = asked("nsga2")
    evaluator = Evaluator(given, elimination_branches(given)[0])
    u = np.array([[0.5, 0.5, 0.5]] * 4)
    wrong = np.array([[np.nan, 1.0], [np.inf, 1.0], [1.0, 1.0], [1.0, 1.0]])
    met = np.array([0.0, 0.0, np.nan, 0.0])
    monkeypatch.setattr(
        evaluator, "screen_designs_objectives_violation", lambda u, *, band: (u, wrong.copy(), met.copy())
    )
    values, violation = population.objectives_and_violations(evaluator, u)
    assert violation.tolist() == [np.inf, np.inf, np.inf, 0.0]
    assert np.isnan(values[:3]).all()
    assert values[3].tolist() == [1.0, 1.0]


def test_an_equality_that_stays_is_met_in_the_end() -> None:
    given = problem(
        {"transmission_angle": "maximise", "time_ratio": "maximise"}, {"stroke": 0.2, "peak_slider_speed": 4.0}
    )
    settings = replace(given.settings, method="nsga2", samples=30, evaluations=300)
    front = solve(replace(given, settings=settings))
    assert len(front) > 0
    speed = QUANTITIES["peak_slider_speed"].evaluate(MACHINE, front.dimensions).values
    assert np.abs(speed / 4.0 - 1.0).max() <= 1e-9


def test_nothing_free_is_one_design() -> None:
    given = problem({"peak_torque": "minimise"}, crank=0.1, rod=0.3, offset=0.05)
    for method in ("nsga2", "tpe", "cmaes", "random", "sobol"):
        front, generations = bred(replace(given, settings=replace(given.settings, method=method)))
        assert front.dimensions.tolist() == [[0.1, 0.3, 0.05]]
        assert not generations  # evaluated, not searched


def test_reference_directions_are_about_as_many_as_designs() -> None:
    # Das and Dennis: (p + m - 1 over m - 1) directions; 13 divisions of 3 axes give 105, 12 give 91.
    assert evolutionary.axis_divisions(100, 3) == 12
    assert evolutionary.axis_divisions(100, 4) == 6
    assert evolutionary.axis_divisions(100, 2) == 99


def test_a_population_of_one_cannot_breed() -> None:
    given = asked("nsga2")
    with pytest.raises(InputError, match="needs at least two designs to breed from; got 1"):
        solve(replace(given, settings=replace(given.settings, samples=1)))


def test_the_archive_has_what_no_other_design_dominates() -> None:
    from slidercrank.optimise.methods.population import search_random_points

    given = asked("random")
    archive = search_random_points(
        given, [Evaluator(given, branch) for branch in elimination_branches(given)], Run(given, 1)
    )
    values = np.concatenate([generation.values for generation in whole("random")[1]])
    values = values[np.isfinite(values).all(axis=1)]
    best = {row.tobytes() for row in values if not ((values <= row).all(axis=1) & (values < row).any(axis=1)).any()}
    assert {row.tobytes() for row in archive.values} == best
    assert archive.feasible == len(values)
