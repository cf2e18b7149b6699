"""Jobs that leave nothing free against enumeration by brute force."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from slidercrank.model.errors import JobError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.optimise.job import parse_job
from slidercrank.optimise.methods.registry import methods_by_name
from slidercrank.optimise.problem.problem import Problem, Variant
from slidercrank.optimise.search.checkpoints import Record
from slidercrank.optimise.search.sample_and_zoom import Archive
from slidercrank.optimise.solve import solve
from tests.case_count import case_count
from tests.optimise.catalogues import brute_force, distance, pairs, random_job
from tests.optimise.problems import MACHINE, problem

pytestmark = pytest.mark.usefixtures("little")

JOBS, AT_ONCE = case_count(20, 40), 10


def listed(**changes: Any) -> dict[str, Any]:
    """Return a job with lists of lengths; changes: of its tables."""
    job: dict[str, Any] = {
        "name": "listed",
        "mechanism": {
            "speed": "300 rpm",
            "crank": {"width": "30 mm", "depth": "20 mm", "density": "7800 kg/m^3"},
            "rod": {"width": "30 mm", "depth": "20 mm", "density": "7800 kg/m^3"},
            "slider": {"mass": "2 kg"},
        },
        "variables": {
            "crank": {"choices": ["60 mm", "65 mm", "70 mm"]},
            "rod": {"choices": ["140 mm", "150 mm", "160 mm"]},
            "offset": {"choices": ["60 mm", "65 mm", "70 mm"]},
        },
        "constraints": {"stroke": {"min": "140 mm", "max": "155 mm"}},
        "objectives": {"peak_torque": "minimise", "transmission_angle": "maximise"},
    }
    return job | changes


@pytest.mark.parametrize("first", range(0, JOBS, AT_ONCE))
def test_random_catalogue_jobs_give_the_front_of_brute_force(first: int) -> None:
    wrong = []
    for seed in range(first, first + AT_ONCE):
        given = parse_job(random_job(seed))
        found, expected = solve(given).values, brute_force(given)
        assert len(expected)
        if len(found) != len(expected) or distance(found, expected) > 1e-9 or pairs(found):
            wrong.append((seed, len(found), len(expected), distance(found, expected)))
    assert wrong == []


def machines() -> Iterator[dict[str, Any]]:
    """Yield jobs with few feasible combinations among many that just miss the stroke."""
    yield listed()
    for load in ("motion", "outward stroke"):
        yield listed(
            load=[{"force": "200 N", "opposes": load}], mechanism=listed()["mechanism"] | {"gravity": "9.81 m/s^2"}
        )
    lists = listed()["variables"] | {"offset": ["0 mm", "75 mm"]}
    exact = {"stroke": {"equals": "150 mm"}}
    yield listed(variables=lists, constraints=exact)
    yield listed(variables=lists, constraints=exact, friction={"guide": 0.1})


@pytest.mark.parametrize("job", list(machines()))
def test_designs_that_just_miss_displace_none_that_meet_the_requirements(job: dict[str, Any]) -> None:
    given = parse_job(job)
    front = solve(given)
    expected = brute_force(given)
    assert len(front) == len(expected)
    assert distance(front.values, expected) <= 1e-9
    assert front.evaluations <= 2 * len(given.variants) + 2 * len(front)


@pytest.mark.parametrize("method", [name for name, method in methods_by_name().items() if method.objectives != "one"])
def test_every_method_gives_all_of_a_catalogue(method: str) -> None:
    job = listed(optimiser={"method": method})
    assert solve(parse_job(job)).values.tolist() == solve(parse_job(listed())).values.tolist()


@pytest.mark.parametrize(
    "method", [name for name, method in methods_by_name().items() if method.objectives != "several"]
)
def test_every_method_gives_the_best_of_a_catalogue(method: str) -> None:
    """Also with an equality that no formula eliminates, met by some combinations alone."""
    exact = {"stroke": {"equals": "140 mm"}, "peak_slider_speed": {"max": "10 m/s"}}
    lists = listed()["variables"] | {"offset": {"choices": ["0 mm", "20 mm"]}}
    job = listed(objectives={"peak_torque": "minimise"}, variables=lists, constraints=exact)
    front = solve(parse_job(job | {"optimiser": {"method": method}}))
    assert distance(front.values, brute_force(parse_job(job))) <= 1e-9
    assert front.dimensions[0, 2] == 0.0


def test_an_offset_of_zero_is_found_where_the_stroke_is_twice_the_crank() -> None:
    for crank in np.random.default_rng(5).uniform(0.05, 0.09, 8):
        given = problem(
            {"peak_torque": "minimise"}, {"stroke": 2.0 * crank}, crank=float(crank), rod=0.3, offset=(0.0, 0.1)
        )
        front = solve(given)
        assert front.dimensions.tolist() == [[crank, 0.3, 0.0]]


def test_a_method_searches_what_is_free_beside_what_is_enumerated() -> None:
    """Of two variants one is a single design, better than anything that the other one has."""
    given = problem({"transmission_angle": "maximise"}, {"stroke": (0.1, 0.3)}, offset=(0.02, 0.1), rod=(0.2, 0.3))
    free = Variant(labels=("free",), mechanism=MACHINE, crank=given.crank, rod=given.rod, offset=given.offset)
    point = problem({"transmission_angle": "maximise"}, crank=0.05, rod=0.6, offset=0.0)
    fixed = Variant(labels=("fixed",), mechanism=MACHINE, crank=point.crank, rod=point.rod, offset=point.offset)
    both = replace(given, choices=("which",), variants=(fixed, free))
    for method in ("auto", "sobol", "slsqp", "differential_evolution"):
        front = solve(replace(both, settings=replace(given.settings, method=method)))
        assert front.dimensions.tolist() == [[0.05, 0.6, 0.0]]
        assert front.designs["choice_which"].tolist() == ["fixed"]


def test_a_thousand_combinations_are_all_tried() -> None:
    random = np.random.default_rng(8)
    lengths = random.uniform((0.05, 0.2, 0.0), (0.1, 0.4, 0.05), (1000, 3))
    parts = [problem({"footprint": "minimise", "stroke": "maximise"}, crank=r, rod=l, offset=e) for r, l, e in lengths]
    variants = tuple(
        Variant(labels=(str(n),), mechanism=MACHINE, crank=part.crank, rod=part.rod, offset=part.offset)
        for n, part in enumerate(parts)
    )
    given: Problem = replace(parts[0], choices=("number",), variants=variants)
    front = solve(replace(given, settings=replace(given.settings, designs=1000)))
    assert front.evaluations < 2 * len(lengths)
    assert distance(front.values, brute_force(given)) <= 1e-9


def test_fewer_designs_than_there_are_keep_the_best_of_each_objective() -> None:
    given = parse_job(random_job(26))
    all_of_them = brute_force(given)
    assert len(all_of_them) > 5
    few = solve(replace(given, settings=replace(given.settings, designs=4)))
    assert len(few) == 4
    assert few.values.min(axis=0) == pytest.approx(all_of_them.min(axis=0), rel=1e-12)


def test_a_catalogue_without_a_feasible_design_says_so() -> None:
    given = parse_job(listed(constraints={"peak_torque": {"max": "1 N m"}}))
    assert not len(brute_force(given))
    assert solve(given).status == "infeasible"


def test_a_catalogue_of_which_no_option_has_the_stroke_is_refused() -> None:
    choices = itertools.product((60.0, 65.0, 70.0), (140.0, 150.0, 160.0), (60.0, 65.0, 70.0))
    strokes = sorted(float(Linkage(r, l, e).stroke) for r, l, e in choices if l > r + e)
    below, above = max(itertools.pairwise(strokes), key=lambda pair: pair[1] - pair[0])
    inside = {"min": f"{below + 0.01} mm", "max": f"{above - 0.01} mm"}
    with pytest.raises(JobError, match="at least one option must have a design within the ranges; none has"):
        parse_job(listed(constraints={"stroke": inside}))


@pytest.mark.parametrize("kept", [0, 1, 2])
def test_an_enumeration_goes_on_where_it_was_stopped_bit_for_bit(kept: int) -> None:
    given = parse_job(random_job(0))
    records: list[Record] = []
    front = solve(given, keep=records.append)
    again = solve(given, resume=records[:kept])
    assert len(records) > 1
    assert again.values.tobytes() == front.values.tobytes()
    assert again.dimensions.tobytes() == front.dimensions.tobytes()
    assert again.evaluations == front.evaluations


def test_an_enumeration_that_is_stopped_gives_what_it_has() -> None:
    given = parse_job(listed(constraints={}))
    asked = 0

    def cancelled() -> bool:
        nonlocal asked
        asked += 1
        return asked > 40

    front = solve(given, cancelled=cancelled)
    assert front.status == "cancelled"
    assert 0 < len(front) <= len(brute_force(given))


def test_an_archive_keeps_what_is_feasible_whatever_nearly_is() -> None:
    archive = Archive.empty(2)
    archive.add_points(0, np.zeros((3, 1)), np.array([[1.0, 1.0], [2.0, 0.5], [2.0, 2.0]]))
    near = np.array([[0.0, 0.0], [5.0, 5.0]])
    archive.add_points(1, np.zeros((2, 1)), near, np.zeros(2, dtype=bool))
    assert archive.values[archive.is_feasible].tolist() == [[1.0, 1.0], [2.0, 0.5]]
    assert archive.values[~archive.is_feasible].tolist() == [[0.0, 0.0]]
