"""A slow stroke that is asked for: exact, by the offset's sign; a warning where the fast one is loaded."""

from __future__ import annotations

import math
from copy import deepcopy
from typing import Any

import numpy as np
import pytest

from slidercrank.model.errors import InputError, JobError
from slidercrank.objectives.lengths_and_time_ratio import TIME_RATIO
from slidercrank.optimise.front.front import ParetoFront
from slidercrank.optimise.job import parse_job
from slidercrank.optimise.problem.constraint_violation import constraints_with_floors
from slidercrank.optimise.problem.problem import Variant
from slidercrank.optimise.search.elimination import elimination_branches
from slidercrank.optimise.search.sampling import first_samples
from slidercrank.optimise.search.stroke_warnings import front_stroke_warnings, stroke_warnings
from slidercrank.optimise.solve import solve

pytestmark = pytest.mark.usefixtures("little")

JOB: dict[str, Any] = {
    "name": "Press",
    "mechanism": {"speed": "120 rpm", "slider": {"mass": "4 kg"}},
    "load": [{"force": "900 N", "opposes": "outward stroke"}],
    "variables": {"crank": ["20 mm", "200 mm"], "rod": ["60 mm", "600 mm"], "offset": ["-200 mm", "200 mm"]},
    "constraints": {"stroke": {"equals": "150 mm"}, "transmission_angle": {"min": "30 deg"}},
    "objectives": {"time_ratio": "maximise", "transmission_angle": "maximise"},
    "optimiser": {"designs": 8, "samples": 500},
}


def job(**changes: Any) -> dict[str, Any]:
    """Return the job with keys of its tables changed, those with None left out: constraints={...}."""
    made = deepcopy(JOB)
    for table, keys in changes.items():
        made[table] = {**made[table], **keys} if isinstance(keys, dict) else keys
    for table in made.values():
        if isinstance(table, dict):
            for key in [key for key, value in table.items() if value is None]:
                del table[key]
    return made


def slow_by_positions(designs: Any, branch: str, speed: float) -> list[str]:
    """Return which stroke takes longer, from slider positions at evenly spaced times alone."""
    theta = math.copysign(1.0, speed) * 2.0 * math.pi * np.arange(40_001) / 40_000
    sine, cosine, found = np.sin(theta), np.cos(theta), []
    for crank, rod, offset in np.asarray(designs)[:, :3]:
        along = np.sqrt(rod**2 - (offset - crank * sine) ** 2)
        x = crank * cosine + (along if branch == "open" else -along)
        share = np.mean(np.diff(np.abs(x)) > 0.0)
        found.append("equal" if abs(share - 0.5) < 1e-4 else "outward" if share > 0.5 else "inward")
    return found


@pytest.mark.parametrize("speed", [9.0, -9.0])
@pytest.mark.parametrize("branch", ["open", "crossed"])
@pytest.mark.parametrize("wanted", ["outward", "inward"])
def test_every_design_of_the_sheets_that_are_left_has_the_slow_stroke(wanted: str, branch: str, speed: float) -> None:
    problem = parse_job(
        job(
            mechanism={"speed": speed, "branch": branch}, constraints={"slow_stroke": wanted, "stroke": {"min": "1 mm"}}
        )
    )
    (sheet,) = elimination_branches(problem)
    designs = sheet.designs_at_points(first_samples(128, len(sheet.free), 1, 0))
    designs = designs[(designs[:, 1] > designs[:, 0] + np.abs(designs[:, 2])) & (np.abs(designs[:, 2]) > 1e-3)]
    assert len(designs) > 30
    assert set(slow_by_positions(designs, branch, speed)) == {wanted}
    # What is left out has none: the other sign is all that the range had beside it.
    mirrored = designs * [1.0, 1.0, -1.0]
    assert wanted not in slow_by_positions(mirrored, branch, speed)


@pytest.mark.parametrize("wanted", ["outward", "inward"])
def test_a_front_has_no_design_with_the_other_stroke_slow_or_with_none(wanted: str) -> None:
    """The transmission angle alone would lead to zero offset, where no stroke is slow."""
    front = solve(parse_job(job(constraints={"slow_stroke": wanted}, load=[{"force": "90 N", "opposes": "motion"}])))
    assert len(front) == 8
    assert set(slow_by_positions(front.dimensions, "open", 1.0)) == {wanted}
    assert set(front.designs["slow_stroke"]) == {wanted}
    assert front.designs["time_ratio"].min() == pytest.approx(TIME_RATIO.floor, rel=1e-8)


def test_speeds_of_either_sign_are_chosen_with_the_offset_that_each_needs() -> None:
    choices = {"mechanism": {"speed": {"choices": ["60 rpm", "-60 rpm"]}}}
    problem = parse_job(job(constraints={"slow_stroke": "outward"}, variables=choices))
    assert [(sheet.variant, sheet.sign) for sheet in elimination_branches(problem)] == [(0, -1.0), (1, 1.0)]
    # An offset of one sign leaves one of the two speeds.
    problem = parse_job(
        job(constraints={"slow_stroke": "outward"}, variables={**choices, "offset": ["0 mm", "200 mm"]})
    )
    front = solve(problem)
    assert set(front.designs["choice_speed"]) == {"-60 rpm"}
    assert set(slow_by_positions(front.dimensions, "open", -1.0)) == {"outward"}


def test_a_speed_that_varies_has_the_sign_of_its_range() -> None:
    varying = {"mechanism": {"speed": ["-90 rpm", "-60 rpm"]}}
    front = solve(parse_job(job(constraints={"slow_stroke": "outward"}, variables=varying)))
    assert (front.dimensions[:, 2] > 0.0).all()
    assert set(front.designs["slow_stroke"]) == {"outward"}


def test_an_option_of_a_choice_may_ask_for_its_slow_stroke() -> None:
    options = [
        {"name": "press", "constraints": {"slow_stroke": "outward"}},
        {"name": "pull", "constraints": {"slow_stroke": "inward"}},
    ]
    choice = [{"name": "tool", "option": options}]
    problem = parse_job(job(choice=choice))
    assert [(sheet.variant, sheet.sign) for sheet in elimination_branches(problem)] == [(0, -1.0), (1, 1.0)]
    with pytest.raises(JobError, match="slow stroke must be either the outward or the inward one"):
        parse_job(job(choice=choice, constraints={"slow_stroke": "inward"}))
    with pytest.raises(JobError, match="choice: options that are chosen together must have the same slow stroke"):
        parse_job(job(choice=[*choice, {"name": "other", "option": options[::-1]}]))


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        (
            {"variables": {"offset": ["0 mm", "200 mm"]}},
            "below 0; got an offset from 0 to 200 mm; let the offset go",
        ),
        (
            {"variables": {"offset": "0 mm"}, "objectives": {"time_ratio": None}},
            "got an offset from 0 to 0 mm; let the offset go below 0$",
        ),
        ({"variables": {"offset": {"choices": ["10 mm", "20 mm"]}}}, "below 0; got an offset from 10 to 20 mm"),
        (
            {"constraints": {"time_ratio": {"equals": 1.0}}, "objectives": {"time_ratio": None}},
            "time ratio above 1; got constraints.time_ratio with equals 1;",
        ),
        ({"constraints": {"time_ratio": {"max": 1.0}}}, "got constraints.time_ratio with max 1; raise it"),
        (
            {
                "variables": {"crank": ["60 mm", "80 mm"], "rod": ["300 mm", "600 mm"], "offset": ["-20 mm", "200 mm"]},
                "constraints": {"time_ratio": {"min": 1.3}},
            },
            "constraints.time_ratio: .* or leave out constraints.slow_stroke, which keeps the offset below 0",
        ),
        (
            {"variables": {"crank": ["60 mm", "80 mm"], "rod": ["300 mm", "600 mm"], "offset": ["-5 mm", "200 mm"]}},
            r"slow from a time ratio of 1.01 unless .* allow at most 1.00\d+; .*time_ratio = \{ min = 1.00\d+ \}",
        ),
        ({"constraints": {"slow_stroke": "outwards"}}, 'must be "outward" or "inward"; got "outwards"; did you mean'),
        ({"objectives": {"slow_stroke": "minimise"}}, "objectives.slow_stroke: unknown key"),
    ],
)
def test_contradictions_are_refused_with_what_to_do(changes: dict[str, Any], said: str) -> None:
    asked = {"slow_stroke": "outward", **changes.get("constraints", {})}
    with pytest.raises(JobError, match=said):
        parse_job(job(**{**changes, "constraints": asked}))


def test_what_the_refusals_tell_to_do_is_accepted() -> None:
    for changes in ({"variables": {"offset": ["-1 mm", "200 mm"]}}, {"mechanism": {"speed": "-120 rpm"}}):
        variables = {"offset": ["0 mm", "200 mm"], **changes.get("variables", {})}
        parse_job(job(**{**changes, "variables": variables, "constraints": {"slow_stroke": "outward"}}))
    narrow = {"crank": ["60 mm", "80 mm"], "rod": ["300 mm", "600 mm"], "offset": ["-5 mm", "200 mm"]}
    with pytest.raises(JobError) as refused:
        parse_job(job(variables=narrow, constraints={"slow_stroke": "outward"}))
    least = float(str(refused.value).split("min = ")[1].split(" ")[0])
    front = solve(
        parse_job(job(variables=narrow, constraints={"slow_stroke": "outward", "time_ratio": {"min": least}}))
    )
    assert set(front.designs["slow_stroke"]) == {"outward"}


def test_a_problem_in_python_refuses_what_has_no_side() -> None:
    problem = parse_job(job(variables={"offset": ["0 mm", "200 mm"]}))
    with pytest.raises(InputError, match="slow_stroke must be 'outward' or 'inward'; got 'out'"):
        type(problem)(**{**vars(problem), "slow_stroke": "out"})
    with pytest.raises(InputError, match="slow_stroke must be"):
        Variant(
            **{
                **{name: getattr(problem, name) for name in ("mechanism", "crank", "rod", "offset")},
                "labels": (),
                "slow_stroke": "equal",
            }
        )
    with pytest.raises(InputError, match="let the offset go below 0, or let the crank turn clockwise"):
        solve(type(problem)(**{**vars(problem), "slow_stroke": "outward"}))


@pytest.mark.parametrize(
    ("ratio", "lower"), [({}, 1.01), ({"min": 1.0}, 1.01), ({"max": 1.005}, 1.0025), ({"min": 1.001}, 1.001)]
)
def test_the_time_ratio_has_a_floor_above_one_unless_the_job_sets_one(ratio: dict[str, float], lower: float) -> None:
    asked = {"slow_stroke": "outward", **({"time_ratio": ratio} if ratio else {})}
    found = {
        constraint.quantity: constraint for constraint in constraints_with_floors(parse_job(job(constraints=asked)))
    }
    assert found["time_ratio"].lower == pytest.approx(lower, rel=1e-12)
    assert "time_ratio" not in {c.quantity for c in constraints_with_floors(parse_job(job()))}


def test_infeasibility_names_the_slow_stroke_that_stands_in_the_way() -> None:
    """With the outward stroke slow 55.5 N m is the least peak torque, with the inward one 82.9 N m."""
    asked = {"time_ratio": {"min": 1.3}, "peak_torque": {"max": "65 N m"}}
    front = solve(parse_job(job(constraints={**asked, "slow_stroke": "inward"}, objectives={"time_ratio": None})))
    assert front.status == "infeasible"
    assert (
        "slow stroke inward is required; all other requirements can be met if the outward stroke is slow, or neither"
        in front.message
    )
    front = solve(parse_job(job(constraints={**asked, "slow_stroke": "outward"}, objectives={"time_ratio": None})))
    assert front.status == "done"


def _front(**changes: Any) -> ParetoFront:
    return solve(parse_job(job(**changes)))


def test_a_fast_stroke_that_is_loaded_is_warned_of_before_and_after_the_search() -> None:
    one_side = {"variables": {"offset": ["10 mm", "200 mm"]}}
    (before,), (after,) = stroke_warnings(parse_job(job(**one_side))), front_stroke_warnings(_front(**one_side))
    assert before.startswith(
        "in every sampled design the loaded stroke (the outward one, against the load) is the faster one"
    )
    assert after.startswith("in 8 of 8 designs the loaded stroke (the outward one, against the load) is the faster one")
    for sentence in (before, after):
        assert 'require slow_stroke = "outward" among the constraints, with the opposite sign of the offset' in sentence
    (before,) = stroke_warnings(parse_job(job()))
    assert before.startswith("in some sampled designs")
    assert "opposite sign" not in before


@pytest.mark.parametrize(
    "changes",
    [
        {"variables": {"offset": ["-200 mm", "-10 mm"]}},
        {"variables": {"offset": ["10 mm", "200 mm"]}, "mechanism": {"speed": "-120 rpm"}},
        {"variables": {"offset": ["10 mm", "200 mm"]}, "load": [{"force": "900 N", "opposes": "motion"}]},
        {"variables": {"offset": ["10 mm", "200 mm"]}, "load": []},
        {"variables": {"offset": ["10 mm", "200 mm"]}, "constraints": {"slow_stroke": "inward"}},
        {"constraints": {"slow_stroke": "outward"}},
        {"variables": {"offset": "0 mm"}, "objectives": {"peak_torque": "minimise", "time_ratio": None}},
    ],
)
def test_nothing_is_warned_of_where_the_slow_stroke_is_the_loaded_one_or_meant(changes: dict[str, Any]) -> None:
    assert stroke_warnings(parse_job(job(**changes))) == []


@pytest.mark.parametrize(
    ("changes", "ends", "remedy"),
    [
        ({"variables": {"offset": ["-1 mm", "200 mm"]}, "constraints": {"slow_stroke": "outward"}}, "-1 to 0 mm", True),
        ({"variables": {"offset": ["-200 mm", "1 mm"]}, "constraints": {"slow_stroke": "inward"}}, "0 to 1 mm", True),
        ({"variables": {"offset": ["-1 mm", "200 mm"]}, "constraints": {"slow_stroke": "inward"}}, "", False),
        ({"constraints": {"slow_stroke": "inward"}}, "", False),
    ],
)
def test_a_slow_stroke_that_leaves_the_lesser_part_of_the_offsets_is_warned_of(
    changes: dict[str, Any], ends: str, remedy: bool
) -> None:
    problem = parse_job(job(**changes))
    warnings = stroke_warnings(problem)
    assert len(warnings) == remedy
    if not remedy:
        return
    assert f"leaves only offsets from {ends} of the range" in warnings[0]
    assert "let it turn clockwise" in warnings[0]
    other = deepcopy(changes) | {"mechanism": {"speed": "-120 rpm"}}
    assert stroke_warnings(parse_job(job(**other))) == []
    front = solve(problem)
    assert front_stroke_warnings(front) == (warnings if len(front) else [])
    sizes = [float(end) * 1e-3 for end in ends.removesuffix(" mm").split(" to ")]
    assert ((front.dimensions[:, 2] >= sizes[0]) & (front.dimensions[:, 2] <= sizes[1])).all()
