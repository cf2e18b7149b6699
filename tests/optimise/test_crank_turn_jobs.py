"""Jobs for a rotating crank that turns an arm: front, exact ratios and refusals."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import slidercrank as sc
from slidercrank.model.errors import InfeasibleError, InputError, JobError
from slidercrank.optimise.search.elimination import elimination_branches
from tests.case_count import case_count
from tests.optimise.problems import SHAPER
from tests.optimise.test_lever_jobs import assert_unbeaten

PLAIN = {"inversion": None, "frame_angle": None}


def shaper(**tables: Any) -> dict[str, Any]:
    """Return the tables of a shaper with others in place; those of a machine are merged, None leaves one out."""
    merged = ("mechanism", "arm", "variables")
    found = SHAPER | {name: SHAPER[name] | table if name in merged else table for name, table in tables.items()}
    return {name: table for name, table in found.items() if table is not None}


def test_a_job_without_motion_has_a_crank_that_rotates_fully() -> None:
    problem = sc.problem(shaper())
    analysis = problem.analyse([0.12, 0.24, 0.0])
    assert analysis["arm_time_ratio"] == pytest.approx(2.0, rel=1e-12)
    assert analysis["ram_stroke"] == pytest.approx(0.5, rel=1e-12)
    assert analysis["turn_work"] == pytest.approx(2000.0 * 0.5, rel=1e-12)
    assert analysis["peak_arm_speed"] == pytest.approx(2.0 * np.pi, rel=1e-12)
    assert "arm_transmission_angle" in {item.quantity for item in sc.problem(shaper()).every_constraint} or (
        analysis["arm_transmission_angle"] == pytest.approx(0.5 * np.pi)
    )


def test_the_moving_mass_includes_arm_and_ram() -> None:
    problem = sc.problem(shaper(variables={"arm.ram_mass": ["30 kg", "50 kg"]}, mechanism={"crank": {"mass": "5 kg"}}))
    designs = [[0.12, 0.24, 0.0, 30.0], [0.12, 0.24, 0.0, 50.0]]
    values, gradients = problem.evaluate(designs, ["moving_mass"], gradients=True)
    assert values[:, 0] == pytest.approx([20.0 + 5.0 + 30.0, 20.0 + 5.0 + 50.0])
    assert gradients[:, 0].tolist() == [[0.0, 0.0, 0.0, 1.0]] * 2
    assert sc.problem(shaper(objectives={"moving_mass": "minimise"})).evaluate(designs[0][:3], ["moving_mass"]) == 60.0


@pytest.mark.slow
def test_no_design_of_a_front_is_beaten_by_random_designs() -> None:
    random = np.random.default_rng(71)
    wide = {"crank": ["60 mm", "180 mm"], "rod": ["40 mm", "300 mm"]}  # both shapes
    problem = sc.problem(shaper(variables=wide, constraints={"arm_speed_ratio": {"max": 2.5}}))
    assert_unbeaten(problem, random, case_count(500, 2000))


@pytest.mark.parametrize(("name", "value"), [("arm_time_ratio", 1.7), ("arm_swing", np.radians(50.0))])
def test_time_ratio_and_swing_that_are_required_hold_exactly(name: str, value: float) -> None:
    wanted = {name: {"equals": value if name == "arm_time_ratio" else "50 deg"}}
    wide = {"crank": ["60 mm", "400 mm"], "rod": ["60 mm", "400 mm"], "offset": ["-20 mm", "20 mm"]}
    objectives = {"peak_crank_torque": "minimise"}
    problem = sc.problem(shaper(constraints=wanted, variables=wide, objectives=objectives))
    random, shapes = np.random.default_rng(72), set()
    for branch in elimination_branches(problem):
        assert branch.eliminated == (name,)
        designs = branch.designs_at_points(random.random((200, len(branch.free))))
        found = problem.evaluate(designs[np.isfinite(designs).all(axis=1)], [name])[:, 0]
        assert found[np.isfinite(found)] == pytest.approx(value, rel=1e-12)
        shapes |= set((designs[:, 0] < designs[:, 1]).tolist())
    assert shapes == ({True, False} if name == "arm_time_ratio" else {True})


@pytest.mark.parametrize(
    ("tables", "part"),
    [
        (
            shaper(objectives={"cylinder_flow": "minimise"}),
            'swings; got a crank that rotates fully; add .motion. kind = "',
        ),
        (shaper(objectives={"stroke": "minimise"}), "stroke needs a crank with rod and slider; got a lever; use a"),
        (
            shaper(objectives={"ram_stroke": "maximise"}, arm=dict.fromkeys(SHAPER["arm"])),
            "ram_stroke: it needs the ram of",
        ),
        (shaper(arm={"ram": None}), "arm: mass and force of a ram need the distance of its pin"),
        (shaper(robust={}), "robust: needs tolerances of crank, rod or offset; got none"),
        (
            shaper(cylinder={"supply_pressure": "9 bar"}),
            "cylinder.supply_pressure: is for a lever that",
        ),
        (shaper(arm={"torque": "-2 N m"}), "arm.torque: must be zero or more"),
        (
            shaper(mechanism={"speed": None}, objectives={"peak_arm_speed": "minimise"}),
            "it needs a crank speed; got none",
        ),
        (shaper(mechanism={"acceleration": "2 rad/s^2"}), "got mechanism.acceleration; leave it out"),
        (shaper(motion={"driver": "crank"}), "motion.driver: the cylinder drives the lever; got crank; leave it out"),
        (shaper(mechanism=PLAIN), "got a crank with rod and slider; set .mechanism. inversion"),
        (shaper(mechanism=PLAIN, objectives={"stroke": "minimise"}), "arm: is for a lever moved by a cylinder"),
        (
            shaper(objectives={"arm_swing": "maximise"}, motion={"kind": "swing", "from": 0, "to": 1}),
            "leave out .motion.",
        ),
    ],
)
def test_what_a_turning_crank_does_not_have_is_refused_in_one_sentence(tables: dict[str, Any], part: str) -> None:
    for name in ("arm", "mechanism"):
        tables = tables | {name: {key: value for key, value in tables[name].items() if value is not None}}
    with pytest.raises((JobError, InputError), match=part):
        sc.problem(tables)


def test_ranges_in_which_every_crank_locks_are_refused() -> None:
    locked = {"crank": ["100 mm", "110 mm"], "rod": ["105 mm", "115 mm"], "offset": ["20 mm", "30 mm"]}
    with pytest.raises((InfeasibleError, InputError), match="frame - crank"):
        sc.solve(sc.problem(shaper(variables=locked)))
    with pytest.raises(InputError, match=r"\|frame - crank\|"):
        sc.problem(shaper()).analyse([0.12, 0.13, 0.02])
