"""Methods that go generation by generation: a run that goes on from any of them ends as if it had never stopped."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from slidercrank.model.errors import InputError
from slidercrank.objectives.registry import QUANTITIES
from slidercrank.optimise.elimination import sheets
from slidercrank.optimise.evaluation import FEASIBLE, Evaluator
from slidercrank.optimise.front import ParetoFront
from slidercrank.optimise.methods import evolutionary, population
from slidercrank.optimise.methods.generation import Brood, Generation, generation_seed
from slidercrank.optimise.methods.registry import METHODS
from slidercrank.optimise.problem import Problem
from slidercrank.optimise.search import Archive, Run
from slidercrank.optimise.solve import solve
from slidercrank.optimise.stationarity import Array
from tests.optimise.problems import MACHINE, Bounds, degrees, problem

ABLE = [name for name, method in METHODS.items() if method.generations]
# Both signs of the offset, so that there are two sheets; a peak among the objectives and one among the constraints.
HELD: dict[str, Bounds] = {"stroke": (0.16, 0.22), "transmission_angle": (degrees(30.0), None)}
LIMITED: dict[str, Bounds] = HELD | {"peak_slider_speed": (None, 4.0)}
SIZES = {"tpe": (8, 40), "cmaes": (6, 60)}


def asked(method: str) -> Problem:
    """Return a small problem for a method: five generations or more."""
    samples, evaluations = SIZES.get(method, (16, 80))
    alone = METHODS[method].objectives == "one"
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


@cache
def whole(method: str) -> tuple[ParetoFront, tuple[Generation, ...]]:
    """Return the front of an uninterrupted run and all its generations."""
    kept: list[Generation] = []
    front = solve(asked(method), keep=kept.append)
    return front, tuple(kept)


def same(one: Generation, two: Generation) -> bool:
    """Return whether two generations are the same bit for bit."""
    names = ("sheet", "u", "parents", "values", "violation")
    return all(getattr(one, name).tobytes() == getattr(two, name).tobytes() for name in names)


@pytest.mark.parametrize("method", ABLE)
def test_a_run_goes_on_from_any_generation_bit_for_bit(method: str) -> None:
    front, generations = whole(method)
    assert len(generations) >= 5
    assert len(front) > 0
    for cut in (1, 2, len(generations) - 1, len(generations)):
        kept: list[Generation] = []
        again = solve(asked(method), resume=generations[:cut], keep=kept.append)
        assert len(kept) == len(generations) - cut
        assert all(same(*pair) for pair in zip(kept, generations[cut:], strict=True))
        assert again.dimensions.tobytes() == front.dimensions.tobytes()
        assert again.values.tobytes() == front.values.tobytes()
        assert again.evaluations == front.evaluations


@pytest.mark.parametrize("method", ABLE)
def test_a_cancelled_run_has_kept_what_it_needs(method: str) -> None:
    front, _ = whole(method)
    kept: list[Generation] = []
    part = solve(asked(method), keep=kept.append, cancelled=lambda: len(kept) >= 3)
    assert part.status == "cancelled"
    assert len(kept) == 3
    again = solve(asked(method), resume=kept)
    assert again.status == "done"
    assert again.dimensions.tobytes() == front.dimensions.tobytes()


@pytest.mark.parametrize("method", ABLE)
def test_every_delivered_design_honours_every_constraint(method: str) -> None:
    front, generations = whole(method)
    given = asked(method)
    for index, sheet in enumerate(sheets(given)):
        own = front.dimensions[np.sign(front.dimensions[:, 2]) == sheet.sign]
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
    other: list[Generation] = []
    given = asked(method)
    solve(replace(given, settings=replace(given.settings, seed=6)), keep=other.append)
    assert not any(same(*pair) for pair in zip(generations, other, strict=False))
    assert len({generation_seed(5, number) for number in range(1000)}) == 1000


def test_a_point_is_evaluated_once_however_often_it_comes() -> None:
    given = asked("nsga2")
    evaluators = [Evaluator(given, sheet) for sheet in sheets(given)]
    point = np.array([[0.3, 0.4, 0.2], [0.3, 0.4, 0.2], [0.7, 0.8, 0.1]])
    screened: list[int] = []

    def breed(past: object) -> Brood:
        return Brood(np.array([0, 1, 0]), point, np.zeros(0, np.int64))

    for evaluator in evaluators:
        inner = evaluator.screen

        def counted(u: Array, *, band: float = 0.0, inner: object = inner) -> tuple[Array, Array, Array]:
            screened.append(len(u))
            return inner(u, band=band)  # type: ignore[operator, no-any-return]

        evaluator.screen = counted  # type: ignore[method-assign]
    kept: list[Generation] = []
    run = Run(given, None, None, 1, keep=kept.append)
    population.evolve(given, evaluators, run, breed, size=3)
    # Three generations fit into the budget and more; the same coordinates on two sheets are two designs.
    assert len(kept) == 80 // 3
    assert sum(screened) == 3
    assert all(same(kept[0], generation) for generation in kept)


def test_genetic_search_meets_duplicates_and_does_not_count_them() -> None:
    front, generations = whole("nsga2")
    keys = {
        (int(sheet), point.tobytes())
        for generation in generations
        for sheet, point in zip(generation.sheet, generation.u, strict=True)
    }
    assert len(keys) < sum(len(generation) for generation in generations)
    assert front.evaluations - len(keys) <= 2 * len(front) + 32  # what the delivery evaluates


def test_generations_of_another_seed_method_or_job_are_refused() -> None:
    _, generations = whole("nsga2")
    given = asked("nsga2")
    heavier = replace(given.mechanism, slider_mass=2.5)
    for other in (
        replace(given, settings=replace(given.settings, seed=6)),
        replace(given, settings=replace(given.settings, samples=12)),
        replace(given, settings=replace(given.settings, method="random")),
        replace(given, mechanism=heavier),
        replace(given, offset=given.rod),
    ):
        with pytest.raises(InputError, match=r"goes on only from its own generations.*start the run anew"):
            solve(other, resume=generations)
    damaged = replace(generations[1], values=generations[1].values + 1e-6)
    with pytest.raises(InputError, match="goes on only from its own"):
        solve(given, resume=(generations[0], damaged))
    with pytest.raises(InputError, match="a generation needs one sheet"):
        replace(generations[0], violation=generations[0].violation[1:])
    with pytest.raises(InputError, match=r"only nsga2, .* can go on from where they stopped; got auto"):
        solve(problem({"peak_torque": "minimise"}), resume=generations)


def test_a_raised_budget_only_adds_generations() -> None:
    _, generations = whole("nsga3")
    given = asked("nsga3")
    kept: list[Generation] = []
    solve(replace(given, settings=replace(given.settings, evaluations=112)), resume=generations, keep=kept.append)
    assert len(kept) == 2


def test_what_is_not_finite_is_never_told_as_feasible(monkeypatch: pytest.MonkeyPatch) -> None:
    given = asked("nsga2")
    evaluator = Evaluator(given, sheets(given)[0])
    u = np.array([[0.5, 0.5, 0.5]] * 4)
    wrong = np.array([[np.nan, 1.0], [np.inf, 1.0], [1.0, 1.0], [1.0, 1.0]])
    met = np.array([0.0, 0.0, np.nan, 0.0])
    monkeypatch.setattr(evaluator, "screen", lambda u, *, band: (u, wrong.copy(), met.copy()))
    values, violation = population.screened(evaluator, u)
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
        kept: list[Generation] = []
        settings = replace(given.settings, method=method)
        front = solve(replace(given, settings=settings), keep=kept.append)
        assert front.dimensions.tolist() == [[0.1, 0.3, 0.05]]
        assert len(kept) == 1
        again = solve(replace(given, settings=settings), resume=kept)
        assert again.dimensions.tolist() == [[0.1, 0.3, 0.05]]


def test_reference_directions_are_about_as_many_as_designs() -> None:
    # Das and Dennis: (p + m - 1 over m - 1) directions; 13 divisions of 3 axes give 105, 12 give 91.
    assert evolutionary.divisions(100, 3) == 12
    assert evolutionary.divisions(100, 4) == 6
    assert evolutionary.divisions(100, 2) == 99


def test_a_population_of_one_cannot_breed() -> None:
    given = asked("nsga2")
    with pytest.raises(InputError, match="breeds from two designs or more; got 1"):
        solve(replace(given, settings=replace(given.settings, samples=1)))


def test_the_archive_has_what_no_other_design_dominates() -> None:
    given = asked("random")
    evaluators = [Evaluator(given, sheet) for sheet in sheets(given)]
    kept: list[Generation] = []
    from slidercrank.optimise.methods.sampling import random

    archive: Archive = random(given, evaluators, Run(given, None, None, 1, keep=kept.append))
    values = np.concatenate([generation.values for generation in kept])
    values = values[np.isfinite(values).all(axis=1)]
    best = {row.tobytes() for row in values if not ((values <= row).all(axis=1) & (values < row).any(axis=1)).any()}
    assert {row.tobytes() for row in archive.values} == best
    assert archive.feasible == len(values)
