"""Certificates: what they prove holds for random designs, holes are found, what is not proven is said."""

from __future__ import annotations

import tomllib
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from slidercrank.model.arrays import Array
from slidercrank.model.errors import InputError
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.machine.speed_profile import Harmonics
from slidercrank.model.machine.varying_numbers import Varying
from slidercrank.optimise.certificate.certificate import Certificate, Step
from slidercrank.optimise.certificate.certify import certify_designs
from slidercrank.optimise.certificate.covering_designs import (
    choose_covering_designs,
    excess_over_designs,
    greedy_cover,
    hypervolume_gap_bound,
)
from slidercrank.optimise.discrete.combinations import designs_meeting_requirements
from slidercrank.optimise.front.front import ParetoFront
from slidercrank.optimise.front.hypervolume import hypervolume
from slidercrank.optimise.job import parse_job
from slidercrank.optimise.problem.constraint_violation import FEASIBLE
from slidercrank.optimise.problem.problem import Problem
from slidercrank.optimise.search.elimination import elimination_branches
from slidercrank.optimise.search.evaluation import Evaluator
from slidercrank.optimise.solve import solve
from tests.optimise.certificate.test_box_bounds import MACHINES, V
from tests.optimise.problems import degrees, problem, shipped_front

pytestmark = pytest.mark.usefixtures("little")

HELD = {"stroke": 0.2, "transmission_angle": (degrees(35.0), None)}
ROUNDED = 1e-9


@cache
def two() -> ParetoFront:
    """Return a front of two objectives over two free unknowns."""
    return solve(problem({"peak_torque": "minimise", "time_ratio": "maximise"}, HELD, designs=30))  # type: ignore[arg-type]


@cache
def certificate(epsilon: float = 0.02) -> Certificate:
    return certify_designs(two().problem, two().dimensions, epsilon=epsilon, seconds=60.0)


def feasible(given: Problem, count: int, seed: int = 9) -> Array:
    """Return the objectives of random feasible designs (count, m)."""
    random, found, total = np.random.default_rng(seed), [], 0
    evaluators = [Evaluator(given, branch) for branch in elimination_branches(given)]
    while total < count:
        for evaluator in evaluators:
            for part in np.array_split(random.random((60_000, evaluator.dimension)), 20):
                if total < count:
                    _, values, violation = evaluator.screen_designs_objectives_violation(part)
                    found.append(values[violation <= FEASIBLE])
                    total += len(found[-1])
    return np.concatenate(found)[:count]


def beats(values: Array, designs: Array, span: Array) -> float:
    """Return the least epsilon to which some design covers each of the values, the greatest of them; by brute force."""
    worst = 0.0
    for part in np.array_split(values, max(1, len(values) // 500)):
        short = ((designs[None] - part[:, None]) / span).max(axis=2).min(axis=1)
        worst = max(worst, float(short.max()))
    return worst


@pytest.mark.parametrize("of", ["two", "feeder"])
def test_10_000_random_feasible_designs_do_not_beat_the_bound(of: str) -> None:
    front = two() if of == "two" else shipped_front("feeder")
    found = certificate() if of == "two" else certify_designs(front.problem, front.dimensions)
    assert found.status == "proven"
    assert found.proven
    assert found.epsilon <= (0.02 if of == "two" else 0.01)
    values = feasible(front.problem, 10_000)
    assert beats(values, np.concatenate([front.values, found.added_values]), found.span) <= found.epsilon + ROUNDED
    assert beats(values, front.values, found.span) <= found.delivered + ROUNDED
    assert found.gap <= found.delivered <= found.gap + found.epsilon + ROUNDED


@pytest.mark.parametrize(
    ("machine", "force"),
    [
        (replace(MACHINES["four strokes"], slider_mass=0.5), "peak_torque"),
        (replace(MACHINES["bars"], arrangement=V), "peak_guide_force"),
    ],
    ids=["four strokes", "three cylinders"],
)
def test_two_turns_and_several_cylinders_are_proven_too(machine: Mechanism, force: str) -> None:
    given = problem({force: "minimise", "footprint": "minimise"}, HELD, mechanism=machine, designs=12, samples=512)  # type: ignore[arg-type]
    front = solve(given)
    found = certify_designs(given, front.dimensions, epsilon=0.2, seconds=60.0)
    assert found.proven
    values = feasible(given, 2000)
    assert beats(values, np.concatenate([front.values, found.added_values]), found.span) <= found.epsilon + ROUNDED


UNEVEN = Harmonics(cosines=(0.0, 0.1))
WIDTH = Varying(name="mechanism.rod.width", sets=(("rod.width", 1.0),), lower=0.02, upper=0.04)
SHAFTS: dict[str, Mechanism] = {
    "profile": replace(MACHINES["bars"], speed_profile=UNEVEN),
    "three cylinders": replace(MACHINES["bars"], arrangement=V),
    "both": replace(MACHINES["bars"], arrangement=V, speed_profile=UNEVEN),
    "a width": replace(MACHINES["bars"], varying=(WIDTH,)),
}


@pytest.mark.slow
@pytest.mark.parametrize("shaft", SHAFTS)
def test_profiles_sums_over_cylinders_and_widths_are_proven(shaft: str) -> None:
    wishes: Any = {"peak_torque": "minimise", "footprint": "minimise"}
    given = problem(wishes, HELD, mechanism=SHAFTS[shaft], designs=12, samples=512)  # type: ignore[arg-type]
    front = solve(given)
    found = certify_designs(front.problem, front.dimensions, epsilon=0.2, seconds=120.0)
    assert found.proven, found.message
    values = feasible(front.problem, 2000)
    assert beats(values, np.concatenate([front.values, found.added_values]), found.span) <= found.epsilon + ROUNDED


@pytest.mark.slow
def test_a_swing_is_proven() -> None:
    job = tomllib.loads(Path("runs/support.toml").read_text(encoding="utf-8"))
    job["optimiser"] = {"designs": 20, "samples": 256, "seed": 1}
    job["variables"] = {"crank": ["1.35 m", "1.4 m"], "rod": ["2.0 m", "2.2 m"], "offset": ["-100 mm", "100 mm"]}
    front = solve(parse_job(job))
    found = certify_designs(front.problem, front.dimensions, epsilon=0.1, seconds=120.0)
    assert found.proven, found.message
    values = feasible(front.problem, 2000)
    assert beats(values, np.concatenate([front.values, found.added_values]), found.span) <= found.epsilon + ROUNDED


@pytest.mark.slow
def test_a_choice_is_proven_over_all_of_its_options() -> None:
    """Each of two masses of the slider is the better one in one objective."""
    job = tomllib.loads(Path("runs/sieve.toml").read_text(encoding="utf-8"))
    job["variables"]["mechanism.slider.mass"] = {"choices": ["1.5 kg", "3 kg"]}
    job["objectives"] = {"peak_torque": "minimise", "moving_mass": "maximise"}
    job["optimiser"] = {"designs": 20, "samples": 256, "seed": 1}
    front = solve(parse_job(job))
    assert len(set(front.variants)) == 2
    found = certify_designs(front.problem, front.dimensions, variants=front.variants, epsilon=0.1, seconds=120.0)
    assert found.proven, found.message
    values = feasible(front.problem, 2000)
    assert beats(values, np.concatenate([front.values, found.added_values]), found.span) <= found.epsilon + ROUNDED


def test_listed_values_are_proven_over_every_combination() -> None:
    job = tomllib.loads(Path("runs/sieve.toml").read_text(encoding="utf-8"))
    job["constraints"] = {"transmission_angle": {"min": "40 deg"}}
    listed = {"crank": {"values": ["80 mm", "120 mm", "150 mm"]}, "offset": {"values": ["0 mm", "40 mm", "100 mm"]}}
    job["variables"] |= listed
    job["objectives"] = {"peak_torque": "minimise", "stroke": "maximise"}
    job["optimiser"] = {"designs": 12, "samples": 256, "seed": 1}
    front = solve(parse_job(job))
    found = certify_designs(front.problem, front.dimensions, epsilon=0.05, seconds=60.0)
    assert found.proven, found.message
    assert set(np.round(1e3 * found.added[:, 0], 9)) <= {80.0, 120.0, 150.0}
    random, (cranks, offsets) = np.random.default_rng(3), front.problem.discrete
    columns = random.choice(cranks.values, 3000), random.uniform(0.2, 0.6, 3000), random.choice(offsets.values, 3000)
    values = designs_meeting_requirements(front.problem, np.stack(columns, axis=1)).values
    assert len(values) > 1000
    assert beats(values, np.concatenate([front.values, found.added_values]), found.span) <= found.epsilon + ROUNDED


def test_too_many_combinations_of_listed_values_are_refused() -> None:
    job = tomllib.loads(Path("runs/sieve.toml").read_text(encoding="utf-8"))
    job["variables"] |= {name: {"min": "80 mm", "max": "300 mm", "step": "1 mm"} for name in ("crank", "rod")}
    given = parse_job(job, require_feasible=False)
    with pytest.raises(InputError, match=r"at most 1,000 combinations of listed values; got [\d,]+ of crank, rod"):
        certify_designs(given, np.zeros((1, 3)))


def test_added_designs_are_feasible_and_have_the_values_told() -> None:
    front, found = two(), certificate()
    assert len(found.added) == len(found.added_values) == len(found.table) > 0
    assert found.table["stroke_mm"].to_numpy() == pytest.approx(200.0, rel=1e-9)
    assert found.table["least_transmission_angle_deg"].min() >= 35.0 * (1.0 - 1e-9)
    assert found.table["peak_torque_Nm"].to_numpy() == pytest.approx(found.added_values[:, 0], rel=1e-12)
    assert found.table["time_ratio"].to_numpy() == pytest.approx(-found.added_values[:, 1], rel=1e-12)
    assert found.span == pytest.approx(np.ptp(front.values, axis=0))


def test_a_planted_hole_is_found_and_its_size_told() -> None:
    front = two()
    order = np.argsort(front.values[:, 1])
    cut = order[20:35]
    left = np.delete(np.arange(len(front)), cut)
    found = certify_designs(front.problem, front.dimensions[left], epsilon=0.02)
    assert found.proven
    assert found.hole is not None
    size = beats(front.values[cut], front.values[left], found.span)
    assert size > 0.1
    # Nothing that was removed lies farther beyond what is left than the hole found, to the epsilon of the proof.
    assert size - 0.02 <= found.gap <= found.delivered <= size + 0.06
    ratio = -found.added_values[:, 1]
    assert ((ratio > -front.values[cut[-1], 1]) & (ratio < -front.values[cut[0], 1])).any()


def test_a_hole_at_the_end_of_the_front_is_found_too() -> None:
    front = two()
    left = np.argsort(front.values[:, 0])[12:]
    found = certify_designs(front.problem, front.dimensions[left], epsilon=0.05)
    missing = (front.values[left, 0].min() - front.values[:, 0].min()) / found.span[0]
    assert found.proven
    assert found.gap >= missing - 0.05 > 0.0


def test_a_design_that_is_dominated_does_not_pass_for_the_front() -> None:
    given = two().problem
    evaluator = Evaluator(given, elimination_branches(given)[0])
    u = np.random.default_rng(2).random((20_000, 2))
    dimensions, values, violation = evaluator.screen_designs_objectives_violation(u)
    good = np.flatnonzero(violation <= FEASIBLE)
    poor = good[np.argsort(values[good, 0])[len(good) // 2 :][:5]]
    found = certify_designs(given, dimensions[poor], epsilon=0.5, seconds=0.5)
    assert found.gap > 0.2


def test_what_a_small_budget_leaves_open_is_told() -> None:
    front = shipped_front("feeder")
    found = certify_designs(front.problem, front.dimensions, epsilon=0.002, seconds=0.3)
    assert found.status == "out of budget"
    assert not found.proven
    assert found.epsilon > 0.002
    assert found.open > 0
    assert 0.0 < found.remaining <= 1.0
    assert found.worst_open_box is not None
    assert (found.worst_open_box[:, 0] <= found.worst_open_box[:, 1]).all()
    if np.isfinite(found.epsilon):
        values = feasible(front.problem, 10_000)
        assert beats(values, np.concatenate([front.values, found.added_values]), found.span) <= found.epsilon + ROUNDED


def test_a_cancelled_proof_keeps_what_is_proven() -> None:
    steps: list[Step] = []
    found = certify_designs(
        two().problem, two().dimensions, epsilon=1e-4, progress=steps.append, cancelled=lambda: len(steps) >= 6
    )
    assert found.status == "cancelled"
    assert len(steps) == 6
    assert [step.boxes for step in steps] == sorted(step.boxes for step in steps)
    assert found.epsilon <= steps[-1].epsilon
    assert "interrupted" in found.message


def test_a_single_objective_is_proven_to_a_share_of_its_value() -> None:
    front = solve(problem({"peak_torque": "minimise"}, HELD))  # type: ignore[arg-type]
    found = certify_designs(front.problem, front.dimensions, epsilon=1e-4)
    assert found.proven
    assert found.delivered <= 1e-4
    best = feasible(front.problem, 10_000).min()
    assert best >= front.values[0, 0] * (1.0 - found.delivered)


def test_a_target_that_is_met_is_proven_best() -> None:
    front = solve(problem({"time_ratio": 1.15}, HELD))  # type: ignore[arg-type]
    assert certify_designs(front.problem, front.dimensions, epsilon=1e-3).proven


def test_a_job_that_leaves_one_design_is_certified() -> None:
    front = solve(problem({"peak_torque": "minimise", "time_ratio": "maximise"}, crank=0.1, rod=0.3, offset=0.05))
    found = certify_designs(front.problem, front.dimensions)
    assert found.proven
    assert len(found.added) == 0


def test_the_hypervolume_gap_holds_for_a_fuller_front() -> None:
    front, found = two(), certificate()
    fuller = solve(problem({"peak_torque": "minimise", "time_ratio": "maximise"}, HELD, designs=50))  # type: ignore[arg-type]
    ideal = front.values.min(axis=0)
    more = hypervolume(fuller.values, ideal, found.span) - hypervolume(front.values, ideal, found.span)
    assert 0.0 < more <= found.hypervolume_gap
    assert found.hypervolume_gap < 0.08


@pytest.mark.parametrize(
    ("options", "reason"), [({"epsilon": 0.0}, "epsilon must be a fraction"), ({"seconds": 0.0}, "above zero")]
)
def test_senseless_options_are_refused(options: dict[str, float], reason: str) -> None:
    with pytest.raises(InputError, match=reason):
        certify_designs(two().problem, two().dimensions, **options)  # type: ignore[arg-type]
    with pytest.raises(InputError, match="needs a front with designs"):
        certify_designs(two().problem, np.zeros((0, 3)))


def test_excess_is_the_least_epsilon_that_covers() -> None:
    random = np.random.default_rng(1)
    points, designs = random.random((500, 3)), random.random((40, 3))
    expected = (designs[None] - points[:, None]).max(axis=2).min(axis=1)
    assert excess_over_designs(points, designs) == pytest.approx(expected, abs=0.0)
    assert np.isposinf(excess_over_designs(points, designs[:0])).all()
    first = np.full(500, 20)
    part = excess_over_designs(points, designs, earlier_excess=excess_over_designs(points, designs[:20]), first=first)
    assert part == pytest.approx(expected, abs=0.0)


def test_thinned_designs_cover_what_all_of_them_cover() -> None:
    random = np.random.default_rng(1)
    points = random.random((400, 2))
    values = points + 0.05 * random.random((400, 2))
    chosen = choose_covering_designs(points, values, 0.1)
    assert excess_over_designs(points, values[chosen]).max() <= 0.1
    few = greedy_cover(points, values[chosen], 0.1)
    assert excess_over_designs(points, values[chosen][few]).max() <= 0.1
    assert 0 < len(few) <= len(chosen) < 400


def test_the_gap_of_a_front_that_is_the_true_one_is_what_epsilon_leaves() -> None:
    line = np.linspace(0.0, 1.0, 201)
    front = np.stack([line, 1.0 - line], axis=1)
    # Translated by e the line gains a strip of width e along each side: (1.1 + e)^2 - 1/2 less 1.1^2 - 1/2.
    strip = ((1.1 + 0.01) ** 2 - 1.1**2) / 1.21
    assert hypervolume_gap_bound(front, front, 0.01, np.zeros((0, 2))) == pytest.approx(strip, rel=0.02)
    assert hypervolume_gap_bound(front, front, 0.0, front) == 0.0
    assert hypervolume_gap_bound(front, front, float("inf"), front) == float("inf")
