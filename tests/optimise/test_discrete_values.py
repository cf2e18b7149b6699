"""Variables of some values only: against enumeration that shares no search code, and what is told of the answer."""

from __future__ import annotations

import copy
import itertools
import math
import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from slidercrank.model.errors import InputError, JobError
from slidercrank.optimise.adapters.standard_form import standard_form
from slidercrank.optimise.discrete import combinations
from slidercrank.optimise.discrete import discrete_front as discrete
from slidercrank.optimise.discrete.combinations import (
    Axes,
    best_near_designs,
    best_of_all_combinations,
    combinations_around,
    designs_meeting_requirements,
    has_judged_neighbours,
)
from slidercrank.optimise.front.progress import Progress
from slidercrank.optimise.job import parse_job
from slidercrank.optimise.job.value_grids import SERIES
from slidercrank.optimise.problem.requirements import Discrete
from slidercrank.optimise.search.checkpoints import Record
from slidercrank.optimise.solve import solve
from tests.case_count import case_count
from tests.optimise.catalogues import brute_force, distance, random_job

pytestmark = pytest.mark.usefixtures("little")

JOBS = case_count(16, 40)
QUICK = {"method": "sobol", "evaluations": 64, "designs": 1000, "seed": 1}
"""Of the continuous front, which an exact answer does not follow from."""
RANGES: dict[str, Any] = {
    "crank": {"min": "40 mm", "max": "60 mm", "step": "0.5 mm"},
    "rod": {"min": "90 mm", "max": "250 mm", "series": "R20"},
    "offset": {"values": ["10 mm", "20 mm", "30 mm"]},
}


def job(variables: dict[str, Any] | None = None, **tables: Any) -> dict[str, Any]:
    """Return a small job; variables: in place of those of `RANGES`; tables: in place of its own."""
    found: dict[str, Any] = {
        "name": "values",
        "mechanism": {"speed": "240 rpm", "slider": {"mass": "2 kg"}},
        "load": [{"force": "150 N", "opposes": "motion"}],
        "variables": RANGES | (variables or {}),
        "constraints": {"stroke": {"min": "90 mm", "max": "101 mm"}},
        "objectives": {"peak_torque": "minimise", "time_ratio": "maximise"},
        "optimiser": QUICK,
    }
    return found | tables


def with_lists(given: dict[str, Any]) -> dict[str, Any]:
    """Return a job whose choices between numbers are values of variables."""
    found = copy.deepcopy(given)
    for name, of in found["variables"].items():
        if isinstance(of, dict):
            found["variables"][name] = {"values": of["choices"]}
    return found | {"optimiser": QUICK}


@pytest.mark.parametrize("at_once", [1, 7, 35, 36, 100])
def test_every_combination_is_judged_once_however_many_at_once(at_once: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(combinations, "_BATCH", at_once)
    values = {"crank": (40, 50, 60), "rod": (80, 90, 120, 150), "offset": (10, 20, 30)}
    given = {name: {"values": [f"{value} mm" for value in each]} for name, each in values.items()}
    axes = Axes.of_problem(parse_job(job(given, constraints={"stroke": {"min": "90 mm"}})))
    asked: list[tuple[int, int]] = []
    found = combinations.best_of_all_combinations(axes, lambda begun, of: asked.append((begun, of)))
    expected = [
        (crank, rod, offset)
        for crank, rod, offset in itertools.product(*values.values())
        if rod > crank + offset
        and math.sqrt((rod + crank) ** 2 - offset**2) - math.sqrt((rod - crank) ** 2 - offset**2) >= 90.0
    ]
    assert found.judged == axes.combination_count == 36
    np.testing.assert_allclose(found.dimensions, 1e-3 * np.array(expected), rtol=1e-15)
    assert asked == [(begun, 36) for begun in range(0, 36, at_once)]


@pytest.mark.slow
def test_random_small_jobs_give_the_front_of_enumeration() -> None:
    wrong = []
    for seed in range(JOBS):
        given = random_job(seed)
        front, expected = solve(parse_job(with_lists(given))), brute_force(parse_job(given))
        assert front.discrete is not None
        assert front.discrete.exact
        if len(front) != len(expected) or distance(front.values, expected) > 1e-9:
            wrong.append((seed, len(front), len(expected), distance(front.values, expected)))
    assert wrong == []


def test_what_is_left_free_is_polished_for_every_combination() -> None:
    """The best of each combination, solved alone, is the best of all."""
    cranks, rods = ["45 mm", "48 mm"], ["120 mm", "150 mm"]
    variables: dict[str, Any] = {
        "crank": {"values": cranks},
        "rod": {"values": rods},
        "offset": ["5 mm", "60 mm"],
    }
    wanted = {"objectives": {"peak_torque": "minimise"}, "optimiser": {"samples": 512}}
    wanted |= {"constraints": {"time_ratio": {"min": 1.08}}}
    front = solve(parse_job(job(variables, **wanted)))
    alone = []
    for crank in cranks:
        for rod in rods:
            one = solve(parse_job(job({"crank": crank, "rod": rod, "offset": variables["offset"]}, **wanted)))
            alone += one.values[:, 0].tolist()
    assert front.discrete is not None
    assert (front.discrete.exact, front.discrete.combinations) == (True, 4)
    assert front.values[0, 0] == pytest.approx(min(alone), rel=1e-9)
    assert front.columns["status"][0] == "stationary"
    assert front.discrete.continuous[0] <= front.values[0, 0] * (1.0 + 1e-9)


def test_designs_have_the_values_as_they_are_written() -> None:
    problem = parse_job(job())
    front = solve(problem)
    assert front.problem is problem
    assert set(front.columns["crank_mm"]) <= {40.0 + 0.5 * k for k in range(41)}
    assert set(front.columns["rod_mm"]) <= {90.0, *(float(10 * number) for number in SERIES["R20"])} | {
        float(100 * number) for number in SERIES["R20"]
    }
    assert set(front.columns["offset_mm"]) <= {10.0, 20.0, 30.0}
    assert front.part(0).discrete == problem.discrete
    assert re.fullmatch(
        r"\d+ designs, exact: all 1230 combinations of crank \(multiples of 0.5 mm\), rod \(R20 in mm\), "
        r"offset \(one of 3 values\) judged; with continuous values the best would be "
        r"(peak torque [\d.]+ N m|time ratio [\d.]+) \(here [\d.]+\), (peak torque|time ratio) [^;]*",
        front.message,
    )
    with pytest.raises(InputError, match="fixed or with discrete values in this job"):
        front.rounded(0, 1e-3)


def test_of_too_many_combinations_neighbours_of_the_continuous_front_are_judged(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Where the search may look at fewer, it says so; none of its designs beats one of the exact front."""
    given = parse_job(job(optimiser={"designs": 20, "samples": 512}))
    exact = solve(given)
    monkeypatch.setattr(discrete, "MOST", 800)
    near = solve(given)
    assert near.discrete is not None
    assert (near.discrete.exact, near.discrete.extent_text) == (False, "neighbours of the continuous front")
    assert re.search(
        r"neighbours of the continuous front: \d+ of 1230 combinations .* evaluated, the other \d+ not", near.message
    )
    for values in near.values:
        assert not ((values <= exact.values) & (values < exact.values - 1e-9)).all(axis=1).any()
    assert distance(near.values[:1], exact.values[:1]) < 0.02


def test_designs_whose_neighbours_were_not_judged_are_not_called_stationary(monkeypatch: pytest.MonkeyPatch) -> None:
    """A search that ends early proves nothing about designs at its edge; a completed one proves all."""
    given = parse_job(job(optimiser={"designs": 20, "samples": 512}))
    monkeypatch.setattr(discrete, "MOST", 40)
    monkeypatch.setattr(discrete, "_WINDOW", 20)
    few = solve(given)
    assert few.discrete is not None
    assert few.discrete.judged <= 40
    assert "best found" in few.columns["status"]
    monkeypatch.setattr(discrete, "MOST", 1200)
    many = solve(given)
    assert many.discrete is not None
    assert not many.discrete.exact
    assert set(many.columns["status"]) == {"stationary"}


def test_a_search_around_the_best_combinations_ends_where_none_next_to_them_is_better() -> None:
    part = parse_job(job())
    axes = Axes.of_problem(part)
    exact = best_of_all_combinations(axes)
    found, seen = best_near_designs(axes, exact.dimensions[:1], 30, 10_000)
    assert len(seen) == found.judged < axes.combination_count
    assert has_judged_neighbours(axes, found.dimensions, seen).all()
    around = designs_meeting_requirements(
        part, axes.combinations_at_indices(np.unique(axes.indices_of_neighbours(found.dimensions)))
    )
    for values in around.values:
        assert not ((values <= found.values).all(axis=1) & (values < found.values).any(axis=1)).any()


def test_all_combinations_are_judged_in_parts_of_which_the_best_are_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    """Parts of any size give what one part gives, and no more is held than the best."""
    axes = Axes.of_problem(parse_job(job()))
    whole = designs_meeting_requirements(axes.part, axes.combinations_between(0, axes.combination_count)).nondominated()
    sizes: list[int] = []
    monkeypatch.setattr(combinations, "_BATCH", 100)
    monkeypatch.setattr(combinations, "_HELD", 20)
    found = best_of_all_combinations(axes, lambda done, of: sizes.append(done))
    assert sizes == list(range(0, axes.combination_count, 100))
    assert found.judged == axes.combination_count
    assert len(found.values) <= 120
    found = found.nondominated()
    assert found.values.tolist() == whole.values.tolist()
    assert found.dimensions.tolist() == whole.dimensions.tolist()
    assert axes.indices_of_combinations(axes.combinations_between(0, axes.combination_count)).tolist() == list(
        range(axes.combination_count)
    )


def test_five_million_combinations_are_judged_one_by_one() -> None:
    assert discrete.MOST == 5_000_000


def test_neighbours_are_those_on_either_side_the_nearest_first() -> None:
    problem = parse_job(job({"offset": ["0 mm", "40 mm"]}))
    assert (
        "crank has discrete values in the job, multiples of 0.5 mm, and stays unchanged"
        in solve(problem).rounded(0, 1e-3).notes
    )
    found = combinations_around(Axes.of_problem(problem), np.array([[0.0503, 0.123, 0.012]]), 4)
    assert found[:, :2].tolist() == [[0.0505, 0.125], [0.05, 0.125], [0.0505, 0.112], [0.05, 0.112]]
    assert np.isnan(found[:, 2]).all()


@pytest.mark.parametrize("stop", [1, 3])
def test_a_search_that_was_stopped_ends_with_the_same_designs(stop: int) -> None:
    given = parse_job(job({"offset": ["5 mm", "40 mm"], "rod": {"values": ["140 mm", "150 mm"]}}))
    given = replace(given, settings=replace(given.settings, method="auto", designs=8, samples=256, evaluations=None))
    given = replace(given, discrete=(Discrete(name="crank", values=(0.046, 0.048), rule="two"), *given.discrete[1:]))
    records: list[Record] = []
    whole = solve(given, keep=records.append)
    again = solve(given, resume=records[: len(records) * stop // 4])
    assert again.dimensions.tobytes() == whole.dimensions.tobytes()
    assert again.message == whole.message


def test_progress_of_both_searches_goes_on() -> None:
    told: list[Progress] = []
    given = parse_job(job({"offset": ["5 mm", "40 mm"], "rod": {"values": ["140 mm", "150 mm"]}, "crank": "48 mm"}))
    front = solve(given, progress=told.append)
    assert [entry.round for entry in told] == list(range(1, len(told) + 1))
    assert len(told) > len(front.history) > 0
    assert (np.diff([entry.hypervolume for entry in told]) >= 0.0).all()


def test_other_optimisers_are_refused() -> None:
    with pytest.raises(InputError, match="other optimisers need ranges; got discrete values of crank, rod, offset"):
        standard_form(parse_job(job()))


def test_a_cancelled_search_gives_no_designs_of_other_values() -> None:
    front = solve(parse_job(job()), cancelled=lambda: True)
    assert (front.status, len(front)) == ("cancelled", 0)


def test_series_are_those_of_the_standard() -> None:
    """ISO 3: preferred numbers are within -1.01 % and +1.26 % of the powers of the series."""
    for name, numbers in SERIES.items():
        count = int(name[1:])
        assert len(numbers) == count
        for place, number in enumerate(numbers):
            assert -0.0102 <= float(number) / 10.0 ** (place / count) - 1.0 <= 0.0127
    assert [float(x) for x in SERIES["R10"]] == [1.0, 1.25, 1.6, 2.0, 2.5, 3.15, 4.0, 5.0, 6.3, 8.0]


@pytest.mark.parametrize(
    ("given", "values"),
    [
        ({"min": "4.5 mm", "max": "0.0112 m", "series": "R20"}, [4.5, 5.0, 5.6, 6.3, 7.1, 8.0, 9.0, 10.0, 11.2]),
        ({"min": "1 in", "max": "2 in", "series": "R5"}, [25.4, 40.64]),
        ({"min": "0.1 in", "max": "0.3 in", "step": "0.0625 in"}, [3.175, 4.7625, 6.35]),
        ({"min": 0.02, "max": 0.03, "step": 0.005}, [20.0, 25.0, 30.0]),
        ({"values": ["30 mm", "2 cm"]}, [20.0, 30.0]),
        ({"min": "0.3 mm", "max": "0.9 mm", "step": "0.3 mm"}, [0.3, 0.6, 0.9]),
    ],
)
def test_values_are_read_in_the_units_that_they_are_written_in(given: dict[str, Any], values: list[float]) -> None:
    problem = parse_job(job({"offset": given}, constraints={}))
    assert [1e3 * value for value in problem.discrete[-1].values] == pytest.approx(values, rel=1e-15)
    assert (problem.offset.lower, problem.offset.upper) == (
        problem.discrete[-1].values[0],
        problem.discrete[-1].values[-1],
    )


def test_numbers_that_vary_have_values_too() -> None:
    mass = {"min": "1 kg", "max": "2 kg", "step": "0.25 kg"}
    problem = parse_job(job({"mechanism.slider.mass": mass, "offset": "10 mm"}))
    front = solve(problem)
    assert problem.discrete[-1].values == (1.0, 1.25, 1.5, 1.75, 2.0)
    assert set(front.columns["slider_mass_kg"]) <= {1.0, 1.25, 1.5, 1.75, 2.0}
    assert front.discrete is not None
    assert front.discrete.exact


def test_an_equality_that_no_combination_has_is_told_before_the_search_with_the_nearest() -> None:
    with pytest.raises(JobError) as told:
        parse_job(job(constraints={"stroke": {"equals": "100 mm"}}))
    words = re.search(
        r"the nearest, crank ([\d.]+) mm, rod ([\d.]+) mm, offset ([\d.]+) mm, has stroke ([\d.]+) mm", str(told.value)
    )
    assert words
    r, l, e, said = map(float, words.groups())
    stroke = math.sqrt((l + r) ** 2 - e * e) - math.sqrt((l - r) ** 2 - e * e)
    assert said == pytest.approx(stroke, abs=1e-4)
    best = min(
        abs(s - 0.1)
        for crank in np.arange(0.04, 0.0601, 0.0005)
        for rod in [0.09, *(float(x) / 10.0 for x in SERIES["R20"]), *(float(x) / 100.0 for x in SERIES["R20"])]
        if 0.0899 < rod < 0.2501
        for offset in (0.01, 0.02, 0.03)
        for s in [math.sqrt((rod + crank) ** 2 - offset**2) - math.sqrt(max((rod - crank) ** 2 - offset**2, 0.0))]
        if (crank + offset) / rod <= math.cos(math.radians(10.0))
    )
    assert abs(stroke - 100.0) == pytest.approx(1e3 * best, abs=1e-6)
    assert str(told.value).endswith("ask for a range instead of one value, or give smaller steps or other ranges")


def test_requirements_over_the_cycle_that_no_combination_meets_are_told_with_the_nearest() -> None:
    front = solve(parse_job(job(constraints={"peak_torque": {"max": "0.5 N m"}})))
    assert (front.status, len(front)) == ("infeasible", 0)
    assert re.search(
        r"has peak torque [\d.]+ N m, [\d.]+ N m above the required value; relax it, or give", front.message
    )


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"min": "20 mm", "max": "60 mm"}, "must have one of step, series and values; got none"),
        ({"min": "20 mm", "step": "1 mm"}, "must have min and max with step; max"),
        ({"min": "60 mm", "max": "20 mm", "step": "1 mm"}, "must run from min to max"),
        ({"min": "20 mm", "max": "60 mm", "step": "0 mm"}, "must be positive"),
        ({"min": "20 mm", "max": "60 mm", "step": "-1 mm"}, "must be positive"),
        ({"min": "20 mm", "max": "60 mm", "step": "1 nm"}, "got"),
        ({"min": "20 mm", "max": "60 mm", "step": "70 mm"}, "multiples of 70 mm has none; widen the range"),
        ({"min": "20 mm", "max": "60 mm", "step": "1 kg"}, "kg"),
        ({"min": "20 mm", "max": "60 mm", "series": "R7"}, 'series must be one of R5, R10, R20, R40; got "R7"'),
        ({"min": "20.1 mm", "max": "22 mm", "series": "R5"}, "R5 in mm has none; widen the range"),
        ({"min": "20 mm", "max": "60 mm", "series": "R5", "step": "1 mm"}, "got step and series"),
        ({"values": ["20 mm"]}, 'got ["20 mm"]; give a single value without a list'),
        ({"min": "20 mm", "max": "60 mm", "steps": "1 mm"}, 'got "steps"; correct or remove it'),
        ({"values": ["20 mm", "2 cm"]}, "values must differ"),
        ({"values": ["20 mm", "25 mm"], "min": "1 mm"}, "leave min and max out"),
        ({"min": "20 mm", "max": "nan mm", "step": "1 mm"}, "finite"),
    ],
)
def test_what_cannot_be_is_refused_in_a_sentence(given: dict[str, Any], words: str) -> None:
    with pytest.raises(JobError, match=re.escape(words)) as told:
        parse_job(job({"crank": given}))
    assert str(told.value).startswith("variables.crank")
    assert "\n" not in str(told.value)


def test_offsets_from_zero_have_no_series_and_options_set_no_values() -> None:
    with pytest.raises(JobError, match="preferred numbers must be above zero"):
        parse_job(job({"offset": {"min": "0 mm", "max": "20 mm", "series": "R5"}}))
    option = [{"name": name, "values": {"crank": size}} for name, size in (("a", "50 mm"), ("b", "55 mm"))]
    with pytest.raises(JobError, match="set by options of the choice"):
        parse_job(job(choice=[{"name": "crank size", "option": option}]))
    with pytest.raises(InputError, match="ascending"):
        Discrete(name="crank", values=(0.2, 0.1), rule="")


def test_a_step_may_be_a_fraction_of_a_unit_in_lengths_and_in_other_numbers() -> None:
    wheel = {"min": "20 mm", "max": "60 mm"}
    for text, same in (("1/32 in", "0.03125 in"), (" 3 / 16in", "0.1875 in"), ("1/2 mm", "0.5 mm")):
        one, other = (parse_job(job({"crank": {**wheel, "step": step}})).discrete[0] for step in (text, same))
        assert one.values == other.values
        assert one.rule == f"multiples of {text.strip()}"
    masses = {"mechanism": {"slider": {"mass": {"min": "1 kg", "max": "3 kg", "step": "1/4 kg"}}}}
    slider = next(item for item in parse_job(job(masses)).discrete if "mass" in item.name)
    assert slider.values == tuple(0.25 * k for k in range(4, 13))
    for wrong in ("1/0 in", "1/32", "1/32 kg", "1/x in", "-1/32 in", "0/4 in"):
        with pytest.raises(JobError, match=r"^variables.crank: step ") as error:
            parse_job(job({"crank": {**wheel, "step": wrong}}))
        assert wrong in str(error.value)
