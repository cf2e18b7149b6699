"""Friction in job files, and designs that lock in the search."""

from __future__ import annotations

import math
import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from slidercrank.model.errors import JobError
from slidercrank.model.machine.links_and_joints import Friction, Pin
from slidercrank.objectives.force_transmission import SELF_LOCKING_MARGIN
from slidercrank.objectives.registry import QUANTITIES
from slidercrank.optimise.job import Job, parse_job
from slidercrank.optimise.job.job_notes import job_notes
from slidercrank.optimise.job.problem_of_job import problem_of
from slidercrank.optimise.job.sections_table import EXAMPLE
from slidercrank.optimise.problem.constraint_violation import constraints_with_floors
from slidercrank.optimise.problem.problem import Problem
from slidercrank.optimise.problem.requirements import Constraint, Objective
from slidercrank.optimise.search.elimination import elimination_branches
from slidercrank.optimise.search.evaluation import Evaluator
from slidercrank.optimise.solve import solve
from slidercrank.service.text.job_in_words import problem_in_words

FEEDER = tomllib.loads((Path(__file__).parents[2] / "runs/feeder.toml").read_text(encoding="utf-8"))
TABLE = {"guide": 0.1, "crank_pin": {"radius": "10 mm", "coefficient": 0.08}}


def job(friction: Any = TABLE, **changes: Any) -> Problem:
    return parse_job({**FEEDER, **({"friction": friction} if friction is not None else {}), **changes})


def test_friction_is_read_in_si() -> None:
    assert job().mechanism.friction == Friction(guide=0.1, crank_pin=Pin(radius=0.01, coefficient=0.08))
    assert job(None).mechanism.friction == Friction()
    assert not job({"guide": 0.0}).mechanism.friction.acts


def test_a_job_with_friction_that_was_read_is_a_job_again() -> None:
    read = Job.model_validate({**FEEDER, "friction": TABLE})
    assert problem_of(Job.model_validate(read.model_dump(exclude_none=True))) == problem_of(read)


@pytest.mark.parametrize(
    ("friction", "words"),
    [
        ({"guide": -0.1}, ["friction.guide", "zero or more", "-0.1"]),
        ({"guide": math.nan}, ["friction.guide", "finite"]),
        ({"guide": "0.1 mm"}, ["friction.guide", "a ratio", "0.1 mm"]),
        ({"guide": 8}, ["friction.guide", "at most 2", "got 8", "about 0.1"]),
        ({"guides": 0.1}, ["friction.guides", "unknown key", "did you mean guide?"]),
        ({"crank_pin": 0.1}, ["friction.crank_pin", "must be a table"]),
        ({"crank_pin": {"radius": "10 mm"}}, ["friction.crank_pin.coefficient: is missing"]),
        ({"slider_pin": {"radius": "0 mm", "coefficient": 0.1}}, ["friction.slider_pin.radius", "positive"]),
        ({"crank_pivot": {"radius": 0.1, "coefficient": -1}}, ["friction.crank_pivot.coefficient", "zero or more"]),
    ],
)
def test_bad_friction_is_refused_with_the_reason(friction: Any, words: list[str]) -> None:
    with pytest.raises(JobError) as refused:
        job(friction)
    for word in words:
        assert word in str(refused.value)


@pytest.mark.parametrize(
    ("part", "friction", "words"),
    [
        ({"objectives": {"self_locking_margin": "maximise"}}, None, ["needs friction", "guide = 0.1"]),
        ({"constraints": {"self_locking_margin": {"min": "-5 deg"}}}, TABLE, ["between 0", "where friction locks"]),
        ({"constraints": {"self_locking_margin": {"min": "90 deg"}}}, TABLE, ["between 0", "90 deg"]),
    ],
)
def test_impossible_margins_are_refused(part: dict[str, Any], friction: Any, words: list[str]) -> None:
    with pytest.raises(JobError) as refused:
        job(friction, **part)
    for word in words:
        assert word in str(refused.value)


def test_shaking_without_masses_is_refused() -> None:
    with pytest.raises(JobError, match="it needs masses; got none"):
        job(mechanism={"speed": "60 rpm"}, objectives={"peak_shaking_force": "minimise"})


def test_self_locking_margin_has_a_floor_with_friction_unless_the_job_sets_one() -> None:
    def floors(problem: Problem) -> list[Constraint]:
        return [c for c in constraints_with_floors(problem) if c.quantity == "self_locking_margin"]

    assert floors(job(None)) == []
    assert floors(job()) == [Constraint(quantity="self_locking_margin", lower=SELF_LOCKING_MARGIN.floor)]
    own = job(constraints={"self_locking_margin": {"min": "12 deg"}})
    assert floors(own) == [Constraint(quantity="self_locking_margin", lower=math.radians(12.0))]
    low = job(constraints={"self_locking_margin": {"max": "4 deg"}})
    assert floors(low)[0].lower == pytest.approx(math.radians(2.0))
    rules = problem_in_words(job())["rules"]
    assert "self-locking margin at least 5 deg (default, as the job sets none)" in rules
    assert any(
        "friction in the crank pin: radius 10 mm, coefficient 0.08" in line for line in problem_in_words(job())["given"]
    )


def test_a_least_margin_of_zero_switches_the_floor_off_and_a_summary_says_which_holds() -> None:
    off = job(constraints={"self_locking_margin": {"min": "0 deg"}})
    assert [c for c in constraints_with_floors(off) if c.quantity == "self_locking_margin"] == list(off.constraints)
    assert off.constraints[0].lower == 0.0
    told = problem_in_words(off)
    assert "self-locking margin at least 0 deg (replaces the default of 5 deg)" in told["rules"]
    floors = {item["quantity"]: item for item in told["floors"]}
    assert floors["self_locking_margin"] == {
        "quantity": "self_locking_margin",
        "least": 0.0,
        "unit": "deg",
        "is_default": False,
    }
    assert floors["transmission_angle"]["is_default"]
    held = {item["quantity"]: item for item in problem_in_words(job())["floors"]}
    assert (held["self_locking_margin"]["least"], held["self_locking_margin"]["is_default"]) == (
        pytest.approx(5.0),
        True,
    )


def test_with_the_floor_off_a_front_has_designs_nearer_to_self_locking_and_none_that_lock() -> None:
    wanted: dict[str, Any] = {"objectives": {"time_ratio": "maximise"}, "optimiser": {"designs": 4, "samples": 512}}
    free = {"crank": ["30 mm", "60 mm"], "rod": ["80 mm", "150 mm"], "offset": ["0 mm", "80 mm"]}
    margins = {}
    for name, bounds in (("floor", {}), ("off", {"self_locking_margin": {"min": "0 deg"}})):
        front = solve(job({"guide": 0.47}, variables=free, constraints=bounds, **wanted))
        margins[name] = float(front.designs["self_locking_margin_deg"][0])
    assert margins["floor"] == pytest.approx(5.0, abs=1e-6)
    assert 0.0 < margins["off"] < 1e-6


def test_designs_that_lock_are_infeasible_even_without_the_floor() -> None:
    """A margin's bound as low as can be. Designs that lock have no finite torque, and count as out of reach."""
    problem = job({"guide": 0.9}, constraints={"self_locking_margin": {"min": "1e-9 deg"}})
    wanted = tuple(Objective(quantity=name, sense="minimise") for name in ("peak_torque", "rms_torque", "mean_torque"))
    evaluator = Evaluator(replace(problem, objectives=wanted, constraints=()), elimination_branches(problem)[0])
    evaluator.constraints = ()
    u = np.random.default_rng(3).random((400, evaluator.dimension))
    dimensions, objectives, violation = evaluator.screen_designs_objectives_violation(u)
    turns = np.isfinite(evaluator._geometry_violation(dimensions))
    margin = np.full(len(u), np.nan)
    margin[turns] = QUANTITIES["self_locking_margin"].evaluate(problem.mechanism, dimensions[turns]).values
    locks = turns & (margin <= 0.0)
    assert locks.sum() > 20
    assert np.all(violation[locks] == np.inf)
    assert np.all(np.isnan(objectives[locks]))
    drives = turns & (margin > 0.0)
    assert drives.sum() > 20
    assert np.all(np.isfinite(objectives[drives & (violation <= 0.0)]))
    goals, _ = evaluator.objective_and_constraint_rows(u[locks])
    assert np.all(goals.values.max(axis=1) == np.inf)
    assert np.all(goals.gradients == 0.0)


SIZED = {
    "mechanism": {
        "speed": "60 rpm",
        "slider": {"mass": "5 kg"},
        **{name: {"width": "40 mm", "depth": "20 mm", "density": "7850 kg/m^3"} for name in ("crank", "rod")},
    },
    "sections": EXAMPLE | {"pins": {"crank_pivot": "15 mm", "crank_pin": "12 mm", "slider_pin": "10 mm"}},
}


def test_a_pin_without_a_radius_rubs_at_half_its_diameter_in_sections_and_follows_it() -> None:
    varies = FEEDER["variables"] | {"sections": {"pins": {"crank_pin": ["10 mm", "30 mm"]}}}
    problem = job({"crank_pin": {"coefficient": 0.1}}, **SIZED, variables=varies)
    assert problem.mechanism.friction.crank_pin == Pin(radius=0.006, coefficient=0.1)
    design = np.array([0.04, 0.15, 0.03])
    values, slopes = problem.evaluate([[*design, 0.02]], gradients=True)
    fixed = job({"crank_pin": {"radius": "10 mm", "coefficient": 0.1}}, **SIZED)
    assert values.tolist() == fixed.evaluate([design]).tolist()
    step = 1e-6
    around = problem.evaluate([[*design, 0.02 + step], [*design, 0.02 - step]])
    assert slopes[0, :, 3] == pytest.approx((around[0] - around[1]) / (2.0 * step), rel=1e-6, abs=1e-9)
    assert slopes[0, [of.quantity for of in problem.objectives].index("peak_torque"), 3] > 0.0


def test_a_radius_that_does_not_follow_its_pin_is_told() -> None:
    rubs = {"crank_pin": {"radius": "6 mm", "coefficient": 0.1}, "slider_pin": {"radius": "8 mm", "coefficient": 0.1}}
    tables = FEEDER | SIZED | {"friction": rubs}
    (note,) = [note for note in job_notes(tables) if note.startswith("friction")]
    assert note == (
        "friction.slider_pin.radius: stays 8 mm, while sections.pins.slider_pin is a diameter of 10 mm; leave the "
        "radius out, and it is half of that"
    )
    varies = FEEDER["variables"] | {"sections": {"pins": {"crank_pin": ["10 mm", "30 mm"]}}}
    told = [
        note for note in job_notes(tables | {"variables": varies}) if "while sections.pins.crank_pin varies" in note
    ]
    assert len(told) == 1
    with pytest.raises(JobError, match=r"friction\.crank_pin\.radius: is missing, but required without \[sections\]"):
        job({"crank_pin": {"coefficient": 0.1}})
