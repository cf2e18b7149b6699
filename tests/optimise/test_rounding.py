"""Designs of round numbers near a design of a front, against every combination judged one by one."""

from __future__ import annotations

import itertools
from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np
import pytest

from slidercrank.model.errors import InputError
from slidercrank.model.machine.varying_numbers import Varying
from slidercrank.optimise.front.front import ParetoFront
from slidercrank.optimise.front.rounded_design import Rounded
from slidercrank.optimise.front.rounding import round_design
from slidercrank.optimise.front.rounding_search import Stage, Steps
from slidercrank.optimise.problem.problem import Problem, Variant
from slidercrank.optimise.problem.requirements import Range
from slidercrank.optimise.problem.robust_problem import Robust, robust_problem
from slidercrank.optimise.solve import solve
from tests.optimise.problems import MACHINE, Bounds, Ends, degrees, problem, search_little

NAMES = ("crank", "rod", "offset", "slider_mass")
WISHES: dict[str, Any] = {
    "time_ratio": "maximise",
    "transmission_angle": "maximise",
    "peak_torque": "minimise",
    "position_error": "minimise",
    "footprint": "minimise",
    "peak_guide_force": "minimise",
    "rms_torque": "minimise",
    "stroke": 0.1503,
}
HELD: dict[str, Bounds] = {"stroke": (0.15, 0.152), "transmission_angle": (degrees(30.0), None)}
PLAIN: dict[str, Any] = {"time_ratio": "maximise", "transmission_angle": "maximise"}


def random_case(seed: int) -> tuple[Problem, dict[str, float]]:
    """Return a small problem and steps for some of its numbers."""
    random = np.random.default_rng([16, seed])
    held: dict[str, Bounds] = {"transmission_angle": (degrees(random.uniform(20.0, 45.0)), None)}
    wished = [name for name in random.permutation(list(WISHES)).tolist() if name != "stroke"]
    stroke = random.choice(["band", "narrow", "equal", "aimed at"])
    if stroke == "aimed at":
        wished.insert(0, "stroke")
    else:
        bands: dict[str, Bounds] = {"band": (0.148, 0.156), "narrow": (0.15, 0.1501), "equal": 0.15}
        held["stroke"] = bands[stroke]
    proportion = random.choice(["none", "equal", "between"])
    if proportion != "none":
        held["rod_to_offset"] = 3.2 if proportion == "equal" else (3.0, 6.0)
    if random.random() < 0.3:
        held["peak_slider_acceleration"] = (None, random.uniform(90.0, 200.0))
    machine = MACHINE
    if random.random() < 0.4:
        machine = replace(
            MACHINE, varying=(Varying(name="slider_mass", sets=(("slider_mass", 1.0),), lower=0.9, upper=2.3),)
        )
    offsets: list[Ends] = [(0.02, 0.2), (-0.2, 0.2), 0.0503]
    offset = offsets[random.choice(3, p=[0.6, 0.25, 0.15])]
    asked = problem(
        {name: WISHES[name] for name in wished[: random.integers(1, 5)]},
        held,
        offset=offset if proportion == "none" else (0.02, 0.2),
        mechanism=machine,
        designs=6,
        samples=256,
    )
    every = [name for name in NAMES[: 3 + len(machine.varying)] if random.random() < 0.85] or ["rod"]
    steps = {name: float(random.choice([0.000125, 0.0005, 0.001, 0.00254 / 4, 0.005])) for name in every}
    if "slider_mass" in steps:
        steps["slider_mass"] = 0.1
    return asked, steps


def random_allowance(asked: Problem, random: np.random.Generator) -> dict[str, float]:
    """Return how far designs may miss some of the requirements, often too little for any."""
    sizes = {item.quantity: abs(item.lower or item.upper or 1.0) for item in asked.constraints}
    return {name: size * 10.0 ** random.uniform(-6.0, -2.0) for name, size in sizes.items() if random.random() < 0.6}


def combinations(asked: Problem, given: np.ndarray, steps: dict[str, float], reach: int) -> np.ndarray:
    """Return every combination of the multiples around a design within the ranges, one by one."""
    choices = []
    ranges: list[Range | Varying] = [asked.crank, asked.rod, asked.offset, *asked.mechanism.varying]
    for value, name, ends in zip(given.tolist(), NAMES, ranges, strict=False):
        if name not in steps or ends.lower == ends.upper:
            choices.append([value])
            continue
        step, k = steps[name], round(value / steps[name])
        near = [k * step for k in range(k - reach - 2, k + reach + 3)]
        below = sorted(x for x in near if x < value - 1e-9 * abs(value))[-reach:]
        above = sorted(x for x in near if x > value + 1e-9 * abs(value))[:reach]
        on = [x for x in near if abs(x - value) <= 1e-9 * abs(value)]
        if on:  # the multiple itself is the first on either side
            below, above = below[1:], above[: reach - 1]
        choices.append([x for x in [*below, *on, *above] if ends.lower - 1e-12 <= x <= ends.upper + 1e-12])
    return np.array(list(itertools.product(*choices)))


def brute_force(
    front: ParetoFront, row: int, steps: dict[str, float], reach: int, allow: dict[str, float]
) -> tuple[np.ndarray, ...]:
    """Return designs that turn, their greatest relative miss beyond what is allowed, and their losses.

    From `Problem.evaluate` alone.
    """
    asked = front.problem
    designs = combinations(asked, front.dimensions[row], steps, reach)
    held = {item.quantity: item for item in asked.constraints}
    values = asked.evaluate(designs, [*held, *(item.quantity for item in asked.objectives)])
    before = asked.evaluate(front.dimensions[row])
    turns = ~np.isnan(values).all(axis=1) & (designs[:, 1] - designs[:, 0] - abs(designs[:, 2]) > 1e-9)
    designs, values = designs[turns], values[turns]
    miss = np.zeros(len(designs))
    for column, item in enumerate(held.values()):
        for bound, sign in ((item.lower, 1.0), (item.upper, -1.0)):
            if bound is not None:
                beyond = sign * (bound - values[:, column]) - allow.get(item.quantity, 0.0)
                miss = np.maximum(miss, beyond / abs(bound))
    losses = []
    for column, wanted in enumerate(asked.objectives):
        now, was, over = values[:, len(held) + column], before[column], front.values[:, column]
        if wanted.target is not None:
            now, was = abs(now - wanted.target), abs(was - wanted.target)
        sign = -1.0 if wanted.sense == "maximise" else 1.0
        size = max(abs(over).max(), abs(wanted.target or 0.0))
        span = np.ptp(over)
        span = span if span > 1e-9 * size else max(abs(front.values[row, column]), abs(wanted.target or 0.0))
        losses.append(sign * (now - was) / span)
    return designs, miss, np.stack(losses, axis=1)


def nearest(miss: np.ndarray, losses: np.ndarray) -> list[int]:
    """Return the designs of least miss, each losing a quarter less than the one before, until nothing is lost."""
    found: list[int] = []
    least = np.inf
    while least > 0.0:
        open_ = np.flatnonzero(losses <= 0.75 * least)
        if not len(open_):
            break
        first = open_[miss[open_] <= miss[open_].min() + 1e-9]
        found.append(int(first[np.argmin(losses[first])]))
        least = losses[found[-1]]
    return found


def test_near_designs_follow_the_one_whose_round_numbers_keep_an_exact_stroke_at_a_great_loss() -> None:
    asked = problem(PLAIN, {"stroke": 0.24}, crank=(0.05, 0.2), rod=(0.1, 0.6), offset=(0.05, 0.3), designs=2)
    crank, rod = 0.1, 0.35
    offset = np.sqrt((0.12**2 - crank**2) * (4.0 * rod**2 / 0.24**2 - 1.0))  # the stroke in closed form
    search = round_design(asked, np.array([crank, rod, offset]), np.array([0.5, 0.5]), 0.001, notes=())
    found = end_of(search)
    assert found.is_met
    np.testing.assert_allclose(found.dimensions[0], (0.096, 0.37, 0.21))  # a Pythagorean triple
    assert found.misses(0) == []
    assert found.tightest(0) == "stroke"
    assert len(found) == 5
    lost = found.losses.max(axis=1)
    assert lost[0] > 0.05
    assert (lost[1:] <= 0.75 * lost[:-1]).all()
    assert all(
        miss.quantity == "stroke" and 0.0 < miss.amount < 0.1 for row in range(1, 5) for miss in found.misses(row)
    )
    assert found.message.endswith("keeps every requirement; others lose much less but miss little")
    assert "within 4 steps (not 16, because 3 numbers are rounded together)" in replace(found, steps_tried=4).message


def end_of(search: Steps[Rounded]) -> Rounded:
    """Return the final value of a generator."""
    while True:
        try:
            next(search)
        except StopIteration as end:
            found: Rounded = end.value
            return found


def require_best(front: ParetoFront, row: int, steps: dict[str, float], allow: dict[str, float]) -> str:
    """Check that no combination beats what is found; return in a word what that is."""
    found = front.rounded(row, steps, count=4, allow=allow)
    designs, miss, losses = brute_force(front, row, steps, found.steps_tried, allow)
    assert len(designs) == found.judged
    kept = miss <= 1e-9
    assert found.is_met == kept.any()
    assert found.feasible_count == kept.sum()
    for design in found.dimensions:  # each is one of the combinations
        assert np.abs(designs - design).max(axis=1).min() <= 1e-12
    require_misses(front, found, allow)
    own = found.losses.max(axis=1)
    if not found.is_met:
        expected = nearest(miss, losses.max(axis=1))[:4]
        for place, other in enumerate(expected):
            beyond = [(item.amount - item.allowed) / item.amount for item in found.misses(place)]
            assert max(beyond) > 0.0
            assert own[place] == pytest.approx(losses[other].max(), rel=1e-6, abs=1e-8)
            same = np.flatnonzero(np.abs(designs - found.dimensions[place]).max(axis=1) <= 1e-12)
            assert miss[same[0]] == pytest.approx(miss[other], rel=1e-6, abs=2e-9)
        assert len(found) == len(expected)
        return "missed"
    clear = sum(
        all(item.amount <= item.allowed * (1.0 + 1e-9) for item in found.misses(place)) for place in range(len(found))
    )
    little = ~kept & (miss <= 0.01) & (losses.max(axis=1) <= 0.75 * own[0])
    expected = nearest(miss[little], losses[little].max(axis=1))[: 4 - clear] if own[0] > 0.01 else []
    assert own[clear:] == pytest.approx(losses[little].max(axis=1)[expected], rel=1e-6, abs=1e-8)
    own, losses = own[:clear], losses[kept]
    assert own[0] == pytest.approx(losses.max(axis=1).min(), rel=1e-6, abs=1e-8)
    assert (np.diff(own) >= -1e-8).all()
    if not allow:
        assert (found.violations[:clear] <= 1e-9).all()
    if len(front.objectives) == 1:
        assert own == pytest.approx(np.sort(losses[:, 0])[: len(own)], rel=1e-6, abs=1e-8)
        return "kept"
    for lost in found.losses[:clear]:
        assert not ((losses <= lost).all(axis=1) & (losses < lost - 1e-8).any(axis=1)).any()
    # None that nothing dominates and that loses less than the last one is left out.
    for lost in losses[losses.max(axis=1) < own[-1] - 1e-8]:
        beaten = (losses <= lost).all(axis=1) & (losses < lost).any(axis=1)
        assert beaten.any() or np.abs(found.losses - lost).max(axis=1).min() <= 1e-8
    return "kept"


def require_misses(front: ParetoFront, found: Rounded, allow: dict[str, float]) -> None:
    """Check the amounts of all misses, in the units of the columns, against the values of the designs."""
    asked = front.problem
    for row, design in enumerate(found.dimensions):
        misses = {item.quantity: item for item in found.misses(row)}
        assert list(misses) == found.missed(row)
        for constraint in asked.constraints:
            of = asked.quantity(constraint.quantity)
            value = asked.evaluate(design[None], [constraint.quantity])[0, 0]
            below, above = (constraint.lower or -np.inf) - value, value - (constraint.upper or np.inf)
            miss = misses.pop(constraint.quantity, None)
            if miss is None:
                bound = constraint.lower if below > above else constraint.upper
                assert max(below, above) <= 2e-9 * abs(bound or 0.0)
                continue
            assert miss.amount == pytest.approx(max(below, above) * of.unit.factor, rel=1e-6)
            assert miss.side == ("below" if below > above else "above")
            assert (miss.kind, miss.unit) == (of.kind.name_without_article, of.unit.symbol)
            assert miss.allowed == pytest.approx(allow.get(constraint.quantity, 0.0) * of.unit.factor)
            if found.is_met:
                assert miss.amount <= miss.allowed * (1.0 + 1e-6) + 2e-9 * abs(value) * of.unit.factor
        assert not misses  # no floor is missed here


@pytest.mark.parametrize("seed", range(8))
def test_no_combination_beats_the_answer(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    search_little(monkeypatch)
    monkeypatch.setattr("slidercrank.optimise.front.rounding_search.REACHES", (3, 6))
    asked, steps = random_case(seed)
    front = solve(asked)
    assert len(front)
    row, random = len(front) // 2, np.random.default_rng([17, seed])
    require_best(front, row, steps, {})
    for _ in range(3):
        require_best(front, row, steps, random_allowance(asked, random))


@lru_cache(maxsize=1)
def plain_front() -> ParetoFront:
    """Return a front of closed forms within a band of strokes."""
    return solve(problem(PLAIN, HELD, designs=8, samples=256))


@pytest.mark.parametrize(
    ("to", "words"),
    [
        (0.0, "the step of crank must be above zero and finite; got 0.0"),
        (-0.001, "must be above zero and finite; got -0.001"),
        (float("nan"), "must be above zero and finite; got nan"),
        (float("inf"), "must be above zero and finite; got inf"),
        (True, "must be above zero and finite; got True"),
        ("1 mm", "must be above zero and finite; got '1 mm'"),
        (
            1e-13,
            "step of crank must be at least 2e-07 mm, 1e-09 of 200 mm, the greatest in its range; got 1e-10 mm",
        ),
        ({"rod": 0.7}, "the step of rod must have a multiple within its range, 60 mm to 600 mm; got 700 mm"),
        ({"rods": 0.001}, "a step must be for one of crank, rod, offset; got 'rods'"),
        ({}, "rounding needs a step"),
    ],
)
def test_a_wrong_step_is_refused(to: Any, words: str) -> None:
    with pytest.raises(InputError, match=words.replace("(", r"\(")):
        plain_front().rounded(0, to)


@pytest.mark.parametrize("count", [0, -1, 1.5, True])
def test_a_wrong_count_is_refused(count: Any) -> None:
    with pytest.raises(InputError, match="count must be a whole number of 1 or more"):
        plain_front().rounded(0, 0.001, count=count)


def test_a_row_that_is_none_of_the_front_is_refused() -> None:
    with pytest.raises(InputError, match="a row must be one of the front"):
        plain_front().rounded(99, 0.001)


def test_multiples_are_the_numbers_that_a_drawing_has() -> None:
    found = plain_front().rounded(3, {"crank": 0.0001, "rod": 0.0003, "offset": 0.0254 / 32})
    for name, step in (("crank", 0.1), ("rod", 0.3), ("offset", 0.79375)):
        for value in found.designs[f"{name}_mm"]:
            assert value == float(f"{round(value / step) * step:.12g}")
    assert found.designs["crank_mm"].tolist() == pytest.approx((1e3 * found.dimensions[:, 0]).tolist(), rel=1e-14)


def test_a_design_that_is_round_already_is_its_own_best_neighbour() -> None:
    front = plain_front()
    first = front.rounded(3, 0.001, count=1)
    assert first.is_met
    there = replace(front, dimensions=np.repeat(first.dimensions, len(front), axis=0))
    again = there.rounded(3, 0.001)
    assert again.dimensions[0].tolist() == first.dimensions[0].tolist() or again.losses[0].max() < 0.0
    assert (again.losses.max(axis=1) >= again.losses[0].max()).all()


def test_an_equality_that_no_round_numbers_meet_gives_the_nearest_and_the_miss() -> None:
    front = solve(problem(PLAIN, {"stroke": 0.15, "rod_to_offset": 3.2}, offset=(0.01, 0.2), designs=6, samples=256))
    found = front.rounded(2, 0.0005)
    assert not found.is_met
    assert found.steps_tried == 32
    row = found.designs.iloc[0]
    miss = front.problem.evaluate(found.dimensions[0], ["stroke", "rod_to_offset"]) - [0.15, 3.2]
    assert row["slack_stroke_mm"] == pytest.approx(-1e3 * abs(miss[0]), abs=1e-9)
    assert row["slack_rod_to_offset"] == pytest.approx(-abs(miss[1]), abs=1e-12)
    assert found.missed(0) == [
        name for name, by in zip(("stroke", "rod_to_offset"), abs(miss), strict=True) if by > 1e-8
    ]
    assert 0.0 < max(abs(miss) / [0.15, 3.2]) < 1e-3
    assert "none of" in found.message
    assert "allow a miss of stroke" in found.message


def test_a_stroke_that_may_be_missed_a_little_is_met() -> None:
    front = solve(problem(PLAIN, {"stroke": 0.1503}, offset=(0.01, 0.2), designs=6, samples=256))
    exact = front.rounded(2, 0.0005)
    assert not exact.is_met
    for allow in ({"stroke": "0.1 mm"}, {"stroke": 1e-4}, {"stroke_mm": "0.1 mm"}):
        found = front.rounded(2, 0.0005, allow=allow)
        assert found.is_met
        assert found.allowed == {"stroke": 1e-4}
        assert "within 0.1 mm of stroke" in found.message
        strokes = front.problem.evaluate(found.dimensions, ["stroke"])[:, 0]
        assert (abs(strokes - 0.1503) <= 1.0001e-4).all()
        assert [found.misses(row)[0].amount for row in range(len(found))] == pytest.approx(
            (1e3 * abs(strokes - 0.1503)).tolist(), rel=1e-6
        )
    little = front.rounded(2, 0.0005, allow={"stroke": 1e-12})
    assert not little.is_met
    assert "allow a greater miss of stroke" in little.message


@pytest.mark.parametrize(
    ("allow", "words"),
    [
        ({"strok": "0.1 mm"}, 'may be missed: stroke, transmission_angle; got "strok"; name one of them'),
        ({"stroke": "0.1"}, "the allowed deviation of stroke must be a length with its unit"),
        ({"stroke": "1 deg"}, "the allowed deviation of stroke must be a length"),
        ({"stroke": 0.0}, "the allowed deviation of stroke must be positive; got 0.0"),
        ({"stroke": "-1 mm"}, "the allowed deviation of stroke must be positive"),
        ({"stroke": float("nan")}, "the allowed deviation of stroke must be a finite number"),
        ({"stroke": True}, "the allowed deviation of stroke must be a length; got true"),
        ({"stroke": 1e-4, "stroke_mm": 1e-4}, "got two for stroke"),
        ("stroke=0.1 mm", "allowed deviations must be a dict by quantity"),
    ],
)
def test_a_wrong_allowance_is_refused(allow: Any, words: str) -> None:
    with pytest.raises(InputError, match=words):
        plain_front().rounded(0, 0.001, allow=allow)


def test_progress_is_reported_in_stages_and_what_it_raises_ends_the_search() -> None:
    front = solve(problem(PLAIN, {"stroke": 0.15, "rod_to_offset": 3.2}, offset=(0.01, 0.2), designs=6, samples=256))
    stages: list[Stage] = []
    front.rounded(2, 0.0005, progress=stages.append)
    assert stages[0].stage == "screening combinations"
    assert stages[-1].stage == "searching for the nearest"
    assert all(0 <= one.step < one.steps for one in stages)

    def end(at: Stage) -> None:
        if at.step:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        front.rounded(2, 0.0005, progress=end)


def test_what_is_fixed_or_has_no_step_stays_and_is_told() -> None:
    front = solve(problem(PLAIN, HELD, offset=0.0503, designs=6, samples=256))
    found = front.rounded(1, 0.0005)
    assert set(found.dimensions[:, 2]) == {0.0503}
    assert found.notes == (
        "offset is fixed in this job and stays unchanged, although it is not a multiple of the step",
    )
    assert front.rounded(1, 0.0001).notes == ()
    alone = front.rounded(1, {"rod": 0.001})
    assert set(alone.dimensions[:, 0]) == {front.dimensions[1, 0]}
    assert alone.notes == ("crank has no step and stays unchanged", "offset has no step and stays unchanged")
    with pytest.raises(InputError, match="got offset, fixed or with discrete values in this job;"):
        front.rounded(1, {"offset": 0.001})


def test_the_options_of_choices_stay() -> None:
    front = plain_front()
    given = front.problem
    ends: dict[str, Any] = {"crank": given.crank, "rod": given.rod, "offset": given.offset}
    short = Variant(labels=("short",), mechanism=MACHINE, **ends | {"rod": Range(lower=0.06, upper=0.2002)})
    whole = Variant(labels=("long",), mechanism=MACHINE, **ends)
    chosen = replace(
        front, problem=replace(given, choices=("frame",), variants=(short, whole)), variants=(0,) * len(front)
    )
    row = int(np.argmin(abs(front.dimensions[:, 1] - 0.2)))
    found = chosen.rounded(row, 0.0005)
    assert found.notes == ("frame stays short",)
    assert (found.dimensions[:, 1] <= 0.2).all()
    assert (front.rounded(row, 0.0005).dimensions[:, 1]).max() >= found.dimensions[:, 1].max()


def test_a_slow_stroke_keeps_its_side_of_the_offset() -> None:
    asked = replace(problem(PLAIN, HELD, offset=(-0.1, 0.1), designs=6, samples=256), slow_stroke="outward")
    front = solve(asked)
    for row in range(len(front)):
        found = front.rounded(row, 0.02)
        assert (found.dimensions[:, 2] * front.dimensions[row, 2] > 0.0).all()


def test_objectives_without_an_end_are_answered() -> None:
    """The rod to an offset of zero is infinite, of the design or of those around it."""
    asked = problem(
        {"rod_to_offset": "minimise", "footprint": "minimise"}, HELD, offset=(-0.02, 0.02), designs=6, samples=256
    )
    front = solve(asked)
    found = front.rounded(0, 0.001)
    assert found.is_met
    assert not np.isnan(found.losses).any()
    away = replace(front, dimensions=front.dimensions * [1.0, 1.0, 0.0], values=front.values * [np.inf, 1.0])
    found = away.rounded(0, 0.001)
    assert found.is_met
    assert not np.isnan(found.losses).any()
    assert np.isneginf(found.losses).any()  # better by more than any number


def test_nothing_that_turns_is_said() -> None:
    """The only rod is 110 mm, the only crank 99.6 mm, the only offset 18 mm."""
    sizes: dict[str, Any] = {"crank": (0.099, 0.1), "rod": (0.11, 0.13), "offset": (0.015, 0.02)}
    front = solve(problem(PLAIN, {"transmission_angle": (0.02, None)}, **sizes, designs=4, samples=128))
    found = front.rounded(0, {"rod": 0.055, "offset": 0.018, "crank": 0.0332})
    assert (found.judged, len(found), found.is_met) == (0, 0, False)
    assert "rotates fully; give smaller steps" in found.message
    assert len(found.designs) == 0


def test_robust_requirements_are_kept_by_the_rounded_designs() -> None:
    asked = robust_problem(problem({"time_ratio": "maximise"}, HELD, designs=4, samples=128), Robust(kind="worst case"))
    front = solve(asked)
    found = front.rounded(0, 0.0005)
    assert found.is_met
    values = asked.evaluate(found.dimensions, [item.quantity for item in asked.constraints])
    for column, item in enumerate(asked.constraints):
        assert item.lower is None or (values[:, column] >= item.lower * (1.0 - 1e-9)).all()
        assert item.upper is None or (values[:, column] <= item.upper * (1.0 + 1e-9)).all()


def test_very_many_numbers_are_refused_and_many_looked_at_nearby() -> None:
    paths = ("slider_mass", "crank.width", "crank.depth", "rod.width", "rod.depth", "crank.density", "rod.density")
    sizes = (
        dict.fromkeys(paths, (0.01, 0.03)) | dict.fromkeys(paths[5:], (7000.0, 8000.0)) | {"slider_mass": (1.0, 2.0)}
    )
    varying = tuple(Varying(name=path, sets=((path, 1.0),), lower=a, upper=b) for path, (a, b) in sizes.items())
    machine = replace(MACHINE, varying=varying)
    front = plain_front()
    middle = [0.5 * (a + b) for a, b in sizes.values()]
    wide = replace(
        front,
        problem=replace(front.problem, mechanism=machine),
        dimensions=np.array([[*design, *middle] for design in front.dimensions.tolist()]),
    )
    steps = {"crank": 0.0005, "rod": 0.0005, "offset": 0.0005} | {
        name: (b - a) / 17.3 for name, (a, b) in sizes.items()
    }
    found = wide.rounded(3, steps)
    assert found.steps_tried < 16
    assert found.judged <= 1 << 18
    rounding = "slidercrank.optimise.front.rounding_search._MOST"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(rounding, 1 << 9)
        with pytest.raises(InputError, match="at most 9 numbers may be rounded together; got 10"):
            wide.rounded(3, steps)
