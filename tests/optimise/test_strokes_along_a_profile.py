"""Time ratio and slow stroke of jobs with a speed profile: by time, not by crank angles."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from slidercrank.model.errors import InputError, JobError
from slidercrank.optimise.certificate.certify import certify_designs
from slidercrank.optimise.front.front import ParetoFront
from slidercrank.optimise.job import parse_job
from slidercrank.optimise.problem.constraint_violation import constraints_with_floors
from slidercrank.optimise.problem.problem import Problem
from slidercrank.optimise.search.elimination import elimination_branches
from slidercrank.optimise.search.stroke_warnings import front_stroke_warnings, stroke_warnings
from slidercrank.optimise.solve import solve
from tests.optimise.test_slow_stroke import job as steady_job

pytestmark = pytest.mark.usefixtures("little")

PROFILE: dict[str, Any] = {"cosines": [0.0], "sines": [0.2]}
"""With b sin(theta) the crank is fast above the slider line, where the inward stroke is of a counter-clockwise one."""


def job(**changes: Any) -> dict[str, Any]:
    """Return the job of a constant speed along the profile, changed as that one is."""
    mechanism = {"speed_profile": PROFILE, **changes.pop("mechanism", {})}
    return steady_job(mechanism=mechanism, **changes)


def outward_to_inward(problem: Problem, designs: Any, count: int = 200_001) -> list[float]:
    """Return the ratio of outward to inward stroke time, counted in even steps of the crank angle.

    A step takes 1 / p; it belongs to the outward stroke if the slider is farther out after it. Accurate to 1e-4.
    """
    profile = problem.mechanism.speed_profile
    assert profile is not None
    ends = problem.mechanism.direction * 2.0 * np.pi * np.arange(count) / (count - 1)
    sign = 1.0 if problem.mechanism.branch == "open" else -1.0
    time, found = 1.0 / profile.speed_ratio(0.5 * (ends[1:] + ends[:-1])), []
    for crank, rod, offset in np.asarray(designs)[:, :3]:
        x = np.abs(crank * np.cos(ends) + sign * np.sqrt(rod**2 - (offset - crank * np.sin(ends)) ** 2))
        out = np.diff(x) > 0.0
        found.append(float(time[out].sum() / time[~out].sum()))
    return found


@pytest.mark.slow
@pytest.mark.parametrize("speed", ["120 rpm", "-120 rpm"])
@pytest.mark.parametrize("wanted", ["outward", "inward"])
def test_every_design_of_a_job_along_a_profile_keeps_the_slow_stroke_that_is_asked(wanted: str, speed: str) -> None:
    problem = parse_job(job(mechanism={"speed": speed}, constraints={"slow_stroke": wanted}))
    front = solve(problem)
    assert front.status == "done"
    assert len(front) == 8
    ratios = np.array(outward_to_inward(problem, front.dimensions))
    slow = ratios if wanted == "outward" else 1.0 / ratios
    assert slow.min() >= 1.01 - 1e-4
    assert set(front.designs["slow_stroke"]) == {wanted}
    np.testing.assert_allclose(front.designs["time_ratio"], slow, rtol=1e-4)


def test_offsets_of_both_signs_are_searched_and_may_both_have_the_slow_stroke() -> None:
    """At constant speed an outward slow stroke needs an offset below 0; along this profile the best has one above."""
    problem = parse_job(job(constraints={"slow_stroke": "outward"}))
    assert [branch.sign for branch in elimination_branches(problem)] == [1.0, -1.0]
    assert problem.slow_side() is None
    above = {"variables": {"offset": ["5 mm", "200 mm"]}, "constraints": {"slow_stroke": "outward"}}
    front = solve(parse_job(job(**above)))
    assert front.status == "done"
    assert min(outward_to_inward(front.problem, front.dimensions)) >= 1.01 - 1e-4
    with pytest.raises(JobError, match="let the offset go below 0"):
        parse_job(job(**above, mechanism={"speed_profile": None}))


def random_designs_of_the_job() -> Any:
    """Return random designs (n, 3) that meet stroke, ranges and transmission angle."""
    random = np.random.default_rng(3)
    rod, offset = random.uniform(0.06, 0.6, 20_000), random.uniform(-0.2, 0.2, 20_000)
    s2 = 0.15**2
    with np.errstate(invalid="ignore"):
        crank = 0.15 * np.sqrt((rod**2 - offset**2 - s2 / 4.0) / (4.0 * rod**2 - s2))
        good = (crank > 0.02) & (crank < 0.2) & (rod > crank + np.abs(offset))
        good &= (crank + np.abs(offset)) / rod <= np.cos(np.radians(30.0))
        good &= np.abs(np.sqrt((rod + crank) ** 2 - offset**2) - np.sqrt((rod - crank) ** 2 - offset**2) - 0.15) < 1e-9
    return np.stack([crank, rod, offset], axis=1)[good][:400]


def best_by_sampling(problem: Problem, stroke: str) -> float:
    """Return the greatest time ratio of such designs with the slow stroke."""
    designs = random_designs_of_the_job()
    ratios = np.array(outward_to_inward(problem, designs, 4001))
    return float((ratios if stroke == "outward" else 1.0 / ratios).max())


@pytest.mark.slow
@pytest.mark.parametrize("stroke", ["outward", "inward"])
def test_the_greatest_time_ratio_is_no_less_than_that_of_random_designs(stroke: str) -> None:
    problem = parse_job(job(constraints={"slow_stroke": stroke}))
    front = solve(problem)
    assert front.designs["time_ratio"].max() >= best_by_sampling(problem, stroke) - 2e-3


@pytest.mark.slow
def test_a_time_ratio_that_is_held_is_one_of_time() -> None:
    held = {"time_ratio": {"equals": 1.3}}
    problem = parse_job(job(constraints=held, objectives={"time_ratio": None, "peak_torque": "minimise"}))
    assert all("time_ratio" not in branch.eliminated for branch in elimination_branches(problem))
    front = solve(problem)
    ratios = np.array(outward_to_inward(problem, front.dimensions))
    np.testing.assert_allclose(np.maximum(ratios, 1.0 / ratios), 1.3, rtol=1e-4)


@pytest.mark.slow
def test_the_ratio_of_crank_angles_is_met_exactly_whatever_the_speed_does() -> None:
    held = {"crank_angle_ratio": {"equals": 1.2}}
    problem = parse_job(job(constraints=held, objectives={"peak_torque": "minimise"}))
    assert all(set(branch.eliminated) == {"stroke", "crank_angle_ratio"} for branch in elimination_branches(problem))
    front = solve(problem)
    r, l, e = front.dimensions.T
    excess = np.abs(np.arcsin(e / (l - r)) - np.arcsin(e / (l + r)))
    np.testing.assert_allclose((np.pi + excess) / (np.pi - excess), 1.2, rtol=1e-12)


@pytest.mark.slow
def test_bounds_of_the_closed_form_refuse_no_time_ratio_that_a_profile_gives() -> None:
    """Short cranks on long rods: at constant speed the ratio is at most 1.07; with this profile 1.3 and more."""
    narrow = {"crank": ["70 mm", "80 mm"], "rod": ["500 mm", "600 mm"], "offset": ["-60 mm", "60 mm"]}
    wanted = {"time_ratio": {"min": 1.25}}
    front = solve(parse_job(job(variables=narrow, constraints=wanted)))
    assert front.status == "done"
    ratios = np.array(outward_to_inward(front.problem, front.dimensions))
    assert np.maximum(ratios, 1.0 / ratios).min() >= 1.25 - 1e-4
    with pytest.raises(JobError, match=r"constraints.time_ratio: .* at most 1.0"):
        parse_job(job(variables=narrow, constraints=wanted, mechanism={"speed_profile": None}))
    with pytest.raises(JobError, match=r"constraints.crank_angle_ratio: .* at most 1.0"):
        parse_job(job(variables=narrow, constraints={"crank_angle_ratio": {"min": 1.25}}))


def test_the_floor_of_a_slow_stroke_is_that_of_its_time_ratio() -> None:
    def bounds(**changes: Any) -> dict[str, Any]:
        return {item.quantity: item for item in constraints_with_floors(parse_job(job(constraints=changes)))}

    assert bounds(slow_stroke="outward")["outward_to_inward_time_ratio"].lower == pytest.approx(1.01, rel=1e-15)
    assert bounds(slow_stroke="inward")["inward_to_outward_time_ratio"].lower == pytest.approx(1.01, rel=1e-15)
    more = bounds(slow_stroke="outward", time_ratio={"min": 1.2})
    assert more["outward_to_inward_time_ratio"].lower == pytest.approx(1.2, rel=1e-15)
    less = bounds(slow_stroke="outward", outward_to_inward_time_ratio={"max": 1.005})["outward_to_inward_time_ratio"]
    assert (less.lower, less.upper) == (pytest.approx(1.0025), pytest.approx(1.005))
    assert "outward_to_inward_time_ratio" not in bounds()


@pytest.mark.parametrize(
    ("constraints", "said"),
    [
        ({"time_ratio": {"max": 1.0}}, "a time ratio above 1; got constraints.time_ratio with max 1"),
        (
            {"outward_to_inward_time_ratio": {"max": 0.9}},
            "must be above 1; got constraints.outward_to_inward_time_ratio with max 0.9",
        ),
        ({"outward_to_inward_time_ratio": {"equals": 0.9}}, "with equals 0.9; leave out one of the two"),
        (
            {"inward_to_outward_time_ratio": {"min": 1.2}},
            "must be below 1; got constraints.inward_to_outward_time_ratio with min 1.2",
        ),
    ],
)
def test_contradictions_with_a_slow_stroke_are_refused(constraints: dict[str, Any], said: str) -> None:
    with pytest.raises(JobError, match=said):
        parse_job(job(constraints={"slow_stroke": "outward", **constraints}))


@pytest.mark.slow
@pytest.mark.parametrize("wanted", ["outward", "inward"])
def test_every_one_of_several_cylinders_has_the_slow_stroke_that_is_asked(wanted: str) -> None:
    """A cylinder equals a single machine whose profile is shifted by its phase."""
    leads = (0.0, 40.0)
    several = {"cylinders": {"phases": [f"{lead:g} deg" for lead in leads]}}
    geometric = {"time_ratio": None, "crank_angle_ratio": "maximise"}
    front = solve(parse_job(job(mechanism=several, objectives=geometric, constraints={"slow_stroke": wanted})))
    assert front.status == "done"
    assert set(front.designs["slow_stroke"]) == {wanted}
    assert front.designs["time_ratio"].isna().all()
    for lead in np.radians(leads):
        # p(theta - lead) = 1 + 0.2 sin(theta - lead)
        turned = {"cosines": [-0.2 * float(np.sin(lead))], "sines": [0.2 * float(np.cos(lead))]}
        ratios = np.array(outward_to_inward(parse_job(job(mechanism={"speed_profile": turned})), front.dimensions))
        assert (ratios if wanted == "outward" else 1.0 / ratios).min() >= 1.01 - 1e-4


def test_several_cylinders_along_a_profile_have_no_one_time_ratio() -> None:
    several = {"cylinders": {"phases": ["0 deg", "120 deg"]}}
    with pytest.raises(JobError, match="it needs a single cylinder, because each has its own stroke times"):
        parse_job(job(mechanism=several))


@pytest.mark.slow
def test_an_infeasible_job_says_that_the_slow_stroke_stands_in_the_way() -> None:
    strong = {"speed_profile": {"cosines": [0.0], "sines": [0.6]}}
    front = solve(parse_job(job(mechanism=strong, constraints={"slow_stroke": "inward"})))
    assert front.status == "infeasible"
    assert (
        "slow stroke inward is required; all other requirements can be met if the outward stroke is slow, or neither"
        in front.message
    )
    assert "outward-to-inward time ratio" not in front.message


def test_a_fast_stroke_that_is_loaded_is_warned_of_by_the_times() -> None:
    """The load opposes the outward stroke; this profile makes it the slow one throughout, its opposite the fast one."""
    small = {"variables": {"offset": ["-30 mm", "30 mm"]}}
    assert stroke_warnings(parse_job(job(**small, mechanism={"speed_profile": {"sines": [0.8]}}))) == []
    problem = parse_job(job(**small, mechanism={"speed_profile": {"sines": [-0.8]}}))
    (before,), (after,) = stroke_warnings(problem), front_stroke_warnings(solve(problem))
    assert before.startswith(
        "in every sampled design the loaded stroke (the outward one, against the load) is the faster one"
    )
    assert after.startswith("in 8 of 8 designs the loaded stroke (the outward one, against the load) is the faster one")


def solved(**changes: Any) -> tuple[Problem, ParetoFront]:
    problem = parse_job(job(**changes))
    return problem, solve(problem)


@pytest.mark.slow
def test_a_certificate_refuses_a_time_ratio_along_a_profile_and_proves_what_follows_from_crank_angles() -> None:
    problem, front = solved(load=[])
    with pytest.raises(InputError, match="time ratio with a speed profile has no bound over a range of designs"):
        certify_designs(problem, front.dimensions, epsilon=0.02)
    geometric = {"time_ratio": None, "crank_angle_ratio": "maximise"}
    problem, front = solved(load=[], objectives=geometric, constraints={"slow_stroke": "outward"})
    found = certify_designs(problem, front.dimensions, epsilon=0.05, seconds=20.0)
    # What the proof says holds for random designs that meet everything by the tests' own counting of time.
    designs = random_designs_of_the_job()
    designs = designs[np.array(outward_to_inward(problem, designs, 4001)) > 1.01 + 2e-3]
    assert len(designs) > 100
    values = [-problem.evaluate(these) for these in (designs, front.dimensions)]
    beyond = ((values[1][None] - values[0][:, None]) / found.span).max(axis=2).min(axis=1)
    assert beyond.max() <= found.delivered + 1e-6
