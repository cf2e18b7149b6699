"""Jobs of a lever moved by a cylinder that turns: from text to a front, and what is refused."""

from __future__ import annotations

import copy
import re
import tomllib
from typing import Any

import numpy as np
import pytest

import slidercrank as sc
from slidercrank.model.errors import InputError, JobError
from slidercrank.objectives.lever_quantity import LeverQuantity
from slidercrank.objectives.tables.swing_columns import swing_quantity_facts
from slidercrank.optimise.certificate.box_conditions import unbounded_reason
from slidercrank.optimise.problem.constraint_violation import (
    FEASIBLE,
    constraints_with_floors,
    greatest_violation,
    minimised_objectives,
)
from slidercrank.optimise.problem.problem import Problem
from tests.case_count import case_count
from tests.optimise.problems import LEVER, SHAPER

TIPPER = [0.35, 0.9, 0.0]


def lever(**tables: Any) -> dict[str, Any]:
    """Return the tables of a lever with others in place; a table is merged, None leaves one out."""
    found = copy.deepcopy(LEVER)
    for name, table in tables.items():
        if table is None:
            del found[name]
        elif name in ("mechanism", "motion", "cylinder", "constraints", "variables"):
            found[name] = found.get(name, {}) | table
        else:
            found[name] = table
    return found


def test_a_job_has_the_numbers_of_the_law_of_cosines() -> None:
    slow = lever(motion={"law": "slow"}, cylinder=None)
    del slow["motion"]["duration"]
    slow["objectives"] = {"peak_cylinder_force": "minimise"}
    problem = sc.problem(slow)
    names = ["least_cylinder_length", "greatest_cylinder_length", "peak_cylinder_force", "lever_work"]
    found = problem.evaluate([TIPPER, [0.4, 0.6, 0.0]], names)
    assert found[0] == pytest.approx([0.670740, 1.071435, 1710.09, 608.726], rel=5e-6)
    assert found[1, [0, 1, 3]] == pytest.approx([0.390255, 0.827145, 608.726], rel=5e-6)
    analysis = problem.analyse(TIPPER)
    assert [analysis[name] for name in names] == pytest.approx(found[0].tolist(), rel=1e-12)
    asked = problem.ask("lever", TIPPER)
    assert asked["peak_push_N"] == pytest.approx(1710.09, rel=5e-6)
    assert asked["frame_angle_deg"] == pytest.approx(-60.0)


@pytest.mark.slow
@pytest.mark.parametrize("place", [0, 1])
def test_the_jobs_of_the_guide_have_a_front_of_levers(pytestconfig: pytest.Config, place: int) -> None:
    guide = (pytestconfig.rootpath / "docs" / "levers.md").read_text(encoding="utf-8")
    texts = re.findall(r"^```toml\n(.*?)^```$", guide, re.MULTILINE | re.DOTALL)
    tables = tomllib.loads(texts[place])
    shipped = tomllib.loads((pytestconfig.rootpath / "runs" / "tipper.toml").read_text(encoding="utf-8"))
    if place == 0:
        assert tables == {name: part for name, part in shipped.items() if name not in ("description", "optimiser")}
    front = sc.solve(sc.problem(tables | {"optimiser": {"designs": 4, "samples": 200}}))
    assert len(front) == 4
    assert set(re.findall(r"`(\w+)`", guide)) >= {
        of.name for of in swing_quantity_facts() if isinstance(of, LeverQuantity)
    }


def test_a_spring_of_a_job_unloads_the_cylinder() -> None:
    spring = {"frame": "500 mm", "frame_angle": "-90 deg", "lever": "350 mm", "force": "900 N", "length": "600 mm"}
    plain, sprung = sc.problem(lever()), sc.problem(lever(spring=spring | {"stiffness": "0.5 N/mm"}))
    names = ["peak_cylinder_force", "lever_work"]
    assert (sprung.evaluate(TIPPER, names) < plain.evaluate(TIPPER, names)).all()
    assert sprung.ask("lever", TIPPER)["peak_push_N"] == pytest.approx(sprung.evaluate(TIPPER, names[:1])[0], rel=1e-9)
    varying = sc.problem(lever(spring=spring, variables={"spring.force": ["200 N", "1200 N"]}))
    assert "spring.force" in varying.ranges
    assert sc.problem(lever(spring=spring)).ask("lever", TIPPER)["notes"][0] == (
        "with the spring of the job: pins 500 mm at -90 deg on the frame and 350 mm at 0 deg on the lever, "
        "900 N at 600 mm"
    )
    with pytest.raises(JobError, match=r"spring: the pins of a lever's spring must be at different distances"):
        sc.problem(lever(spring=spring | {"lever": "500 mm"}))


def test_the_cylinder_of_a_job_must_be_long_strong_and_stiff_enough() -> None:
    names = {c.quantity: c.lower for c in constraints_with_floors(sc.problem(lever()))}
    assert names == pytest.approx(
        {
            "lever_transmission_angle": np.radians(10.0),
            **{"cylinder_length_margin": 0.0, "pressure_margin": 1.0, "buckling_margin": 1.0},
        }
    )
    unknown = sc.problem(lever(cylinder=None, motion={"margin": "25 deg"}, tolerances={"crank": "1 mm"}))
    assert {c.quantity: c.lower for c in constraints_with_floors(unknown)} == {
        "lever_transmission_angle": pytest.approx(np.radians(25.0))
    }
    stated = sc.problem(lever(constraints={"buckling_margin": {"min": 3.5}}))
    assert {c.quantity: c.lower for c in constraints_with_floors(stated)}["buckling_margin"] == 3.5


@pytest.mark.slow
def test_numbers_of_the_cylinder_and_the_frame_may_vary_and_be_chosen() -> None:
    variables = {"mechanism.frame_angle": ["-80 deg", "-40 deg"], "cylinder.bore": {"choices": ["32 mm", "40 mm"]}}
    front = sc.solve(sc.problem(lever(variables=variables)))
    assert front.status == "done"
    assert len(front) == 6
    assert set(front.columns) >= {"choice_cylinder_bore", "frame_angle_deg", "peak_cylinder_force_N"}


@pytest.mark.slow
def test_cylinders_are_chosen_from_a_catalogue_by_price() -> None:
    table = "name,cylinder.bore (mm),cylinder.rod (mm),price (EUR)\nA,12,8,100\nB,40,25,140\nC,50,28,200\n"
    goals = {"price": "minimise", "peak_cylinder_force": "minimise"}
    front = sc.solve(sc.problem(lever(choice=[{"name": "cylinder", "table": table}], objectives=goals)))
    assert front.status == "done"
    assert set(front.columns["price_EUR"].tolist()) <= {100.0, 140.0, 200.0}
    assert (front.columns["pressure_margin"] >= 1.0 - 1e-9).all()


def test_a_varying_cylinder_keeps_its_bore_above_the_piston_rod_and_its_stroke_below_the_closed_length() -> None:
    """Without limits the search would take a rod as thick as the bore, which no pressure loads."""
    ranges = {
        "cylinder.bore": ["25 mm", "60 mm"],
        "cylinder.rod": ["12 mm", "36 mm"],
        "cylinder.closed_length": ["500 mm", "800 mm"],
        "cylinder.stroke": ["200 mm", "600 mm"],
    }
    small = {"bore": "40 mm", "rod": "22 mm", "closed_length": "640 mm", "stroke": "300 mm"}
    tables = lever(cylinder=small, variables=ranges, objectives={"peak_cylinder_force": "minimise"})
    problem = sc.problem(tables, require_feasible=False)
    designs = designs_within(problem, np.random.default_rng(7), 4000)
    bore, rod, closed, stroke = (designs[:, list(problem.ranges).index(f"cylinder.{name}")] for name in small)
    rejected = np.isnan(problem.evaluate(designs, ["peak_cylinder_force"])[:, 0])
    can_exist = (bore > rod) & (stroke < closed)
    assert rejected[~can_exist].all()
    assert 400 < (~can_exist).sum() < 3600
    assert not rejected[can_exist].all()


@pytest.mark.parametrize("nominal", [{}, {"bore": "12 mm"}, {"closed_length": "180 mm"}])
def test_ranges_of_a_cylinder_are_refused_only_if_no_design_within_them_can_exist(nominal: dict[str, str]) -> None:
    wide = {
        **{"cylinder.bore": ["10 mm", "60 mm"], "cylinder.rod": ["8 mm", "70 mm"]},
        **{"cylinder.closed_length": ["150 mm", "700 mm"], "cylinder.stroke": ["140 mm", "900 mm"]},
    }
    assert set(wide) < set(sc.problem(lever(cylinder=nominal, variables=wide)).ranges)
    for name, ends, part in (
        ("rod", ["60 mm", "70 mm"], "cylinder: the bore must exceed the piston rod; got a bore of 60 mm and a piston"),
        ("stroke", ["700 mm", "900 mm"], "cylinder: the stroke .* got a stroke of 700 mm and a closed length of 700"),
    ):
        with pytest.raises(JobError, match=part):
            sc.problem(lever(cylinder=nominal, variables=wide | {f"cylinder.{name}": ends}))


def test_a_choice_of_a_bore_below_its_piston_rod_is_left_out() -> None:
    choices = {"cylinder.bore": {"choices": ["20 mm", "40 mm"]}, "cylinder.rod": {"choices": ["15 mm", "25 mm"]}}
    problem = sc.problem(lever(variables=choices))
    assert problem.left_out == (("20 mm, 25 mm", "a bore of 20 mm and a piston rod of 25 mm"),)
    assert [variant.labels for variant in problem.variants] == [
        ("20 mm", "15 mm"),
        ("40 mm", "15 mm"),
        ("40 mm", "25 mm"),
    ]


def test_a_number_of_a_cylinder_that_varies_is_given_first() -> None:
    given = lever(variables={"cylinder.bore": ["40 mm", "50 mm"]})
    del given["cylinder"]["bore"]
    with pytest.raises(JobError, match=r"got cylinder\.bore; give it in \[cylinder\] first"):
        sc.problem(given)


def random_job(random: np.random.Generator) -> Problem:
    """Return a random job of a lever that some design meets."""
    while True:
        start = float(random.uniform(-90.0, 60.0))
        frame = start + float(random.choice([-1.0, 1.0]) * random.uniform(30.0, 110.0))
        tables = lever(
            mechanism={"frame_angle": f"{frame} deg", "pin_angle": f"{random.uniform(-20.0, 20.0)} deg"},
            motion={"from": f"{start} deg", "to": f"{start + random.uniform(20.0, 80.0)} deg"},
            cylinder=None,
            tolerances={"crank": "0.5 mm", "rod": "1 mm"},
            constraints={"extension_ratio": {"max": 1.7}, "dead_point_margin": {"min": "15 deg"}},
            variables={"mechanism.frame_angle": [f"{frame - 10.0} deg", f"{frame + 10.0} deg"]},
        )
        wishes = ("peak_cylinder_force", "cylinder_travel", "lever_angle_error", "peak_cylinder_power")
        tables["objectives"] = dict.fromkeys(random.choice(wishes, 2, replace=False).tolist(), "minimise")
        tables["cylinder"] = {"seal_friction": f"{random.uniform(0.0, 60.0)} N"}
        problem = sc.problem(tables, require_feasible=False)
        some = designs_within(problem, random, 400)
        if (greatest_violation(problem, some, constraints_with_floors(problem)) <= FEASIBLE).any():
            return problem


def designs_within(problem: Problem, random: np.random.Generator, count: int) -> np.ndarray:
    """Return random designs within the ranges."""
    ends = list(problem.ranges.values())
    return random.uniform([end.lower for end in ends], [end.upper for end in ends], (count, len(ends)))


def assert_unbeaten(problem: Problem, random: np.random.Generator, count: int) -> None:
    """Check that no random design is better than one of the front in all objectives."""
    front = sc.solve(problem)
    assert front.status == "done", front.message
    designs = designs_within(problem, random, count)
    met = designs[greatest_violation(problem, designs, constraints_with_floors(problem)) <= FEASIBLE]
    found, own = minimised_objectives(problem, problem.evaluate(met)), front.values
    beaten = (found[:, None] < own[None] - 1e-6 * np.abs(own)[None]).all(axis=2)
    assert not beaten.any()


def random_job_of_a_turning_crank(random: np.random.Generator) -> Problem:
    """Return a random job of a crank that turns an arm, which some design meets."""
    middle = float(random.uniform(100.0, 160.0))
    tables = SHAPER | {
        "mechanism": SHAPER["mechanism"] | {"frame_angle": f"{random.uniform(-180.0, 180.0)} deg"},
        "arm": SHAPER["arm"]
        | {"torque": f"{random.uniform(0.0, 50.0)} N m", "ram_mass": f"{random.uniform(5, 50)} kg"},
        "variables": {
            "crank": [f"{middle - 60.0} mm", f"{middle + 60.0} mm"],
            "rod": ["40 mm", "400 mm"],  # both shapes
            "offset": ["-15 mm", "15 mm"],
            "arm.ram": ["300 mm", "600 mm"],
        },
        "constraints": {"arm_speed_ratio": {"max": 3.0}, "ram_stroke": {"min": "250 mm"}},
        "optimiser": LEVER["optimiser"],  # with 64 samples, one of 15 fronts misses the best arms
    }
    wishes = ("peak_crank_torque", "rms_crank_torque", "arm_acceleration_ratio", "peak_ram_speed", "lever_pin_force")
    tables["objectives"] = dict.fromkeys(random.choice(wishes, 2, replace=False).tolist(), "minimise")
    return sc.problem(tables)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(case_count(2, 30)))
def test_no_design_of_a_front_is_beaten_by_random_designs(seed: int) -> None:
    random = np.random.default_rng(100 + seed)
    problem = (random_job_of_a_turning_crank if seed % 2 else random_job)(random)
    assert_unbeaten(problem, random, case_count(10_000, 50_000))


def test_a_certificate_says_that_a_lever_has_none() -> None:
    problem = sc.problem(lever())
    for objective in problem.objectives:
        assert "has no bound over a range of designs of a lever or an arm" in unbounded_reason(problem, objective)


@pytest.mark.parametrize(
    ("tables", "part"),
    [
        (lever(motion={"driver": "slider"}), "motion.driver: the cylinder drives the lever; got slider; leave it out"),
        (lever(motion={"kind": "turn"}), "keys of a swing must not be given for a rotating crank"),
        (
            lever(motion=None),
            "peak_cylinder_force: it needs a lever that its cylinder swings; got a crank that",
        ),
        (lever(motion={"to": "175 deg"}), "must swing its lever less than 180 deg"),
        (lever(motion={"from": "340 deg"}), "without wrapping at a full turn: write -20 deg for 340 deg"),
        (lever(motion={"actuator_tolerance": "1 mm"}), r"a cylinder that turns has length_tolerance in \[cylinder\]"),
        (lever(objectives={"peak_actuator_force": "minimise"}), "use peak_cylinder_force"),
        (
            lever(costs={"crank": {"at": "0.05 mm", "cost": 8.0, "min": "0.005 mm"}}),
            "costs: is for a crank with rod and slider; got it for a lever",
        ),
        (
            lever(target_motion={"crank_angles": ["0 deg", "10 deg", "20 deg"], "positions": ["1 mm", "2 mm", "3 mm"]}),
            "target_motion: is for a crank with rod and slider; got it for a lever",
        ),
        (lever(mechanism={"speed": "300 rpm"}), "mechanism.speed: is for a crank that rotates fully; got it with a"),
        (lever(arm={"torque": "2 N m"}), "arm: is for a crank that rotates fully; got it with a lever that its"),
        (lever(mechanism={"slider": {"mass": "2 kg"}, "rod": {"mass": "1 kg"}}), "got mechanism.rod, mechanism.slider"),
        (lever(load=[{"force": "20 N", "opposes": "motion"}]), r"got \[\[load\]\]; leave it out"),
        (
            lever(cylinder={"rod_mass": "3 kg"}),
            'cylinder.rod_mass: unknown key "rod_mass"; did you mean piston_rod_mass?',
        ),
        (lever(friction={"guide": 0.1}), r"got \[friction\]; leave it out"),
        (lever(mechanism={"inversion": None}), "mechanism.inversion: "),
        (lever(objectives={"peak_torque": "minimise"}), "peak_torque needs a crank that rotates fully"),
        (lever(objectives={"holding_force": "minimise"}), "holding_force: it needs a crank with rod and slider"),
        (lever(cylinder={"bore": "20 mm"}), "cylinder: the bore must exceed the piston rod; got a bore of 20 mm"),
        (lever(cylinder={"stroke": "700 mm"}), "cylinder: the stroke of a single-stage cylinder must be less than"),
        (
            lever(mechanism={"frame_angle": "20 deg"}),
            "motion: no design within the ranges swings the lever from -20 to 50 deg",
        ),
    ],
)
def test_what_a_lever_does_not_have_is_refused_in_one_sentence(tables: dict[str, Any], part: str) -> None:
    with pytest.raises((JobError, InputError), match=part):
        sc.problem(tables)


@pytest.mark.slow
def test_a_cylinder_that_is_too_weak_for_every_design_is_said_to_be() -> None:
    front = sc.solve(sc.problem(lever(cylinder={"supply_pressure": "2 bar"})))
    assert front.status == "infeasible"
    assert re.search("supply pressure over the needed one at least 1 .* at most 0.16.* is possible", front.message)


def test_keys_of_a_lever_are_refused_for_a_slider_crank() -> None:
    plain = {"mechanism": {"speed": "300 rpm"}, "objectives": {"stroke": "minimise"}, "variables": LEVER["variables"]}
    for key, tables in (
        ("mechanism.frame_angle", {"mechanism": {"speed": "300 rpm", "frame_angle": "-60 deg"}}),
        ("cylinder", {"cylinder": {"bore": "40 mm"}}),
    ):
        with pytest.raises(JobError, match=f"{key}: is for a lever moved by a cylinder that turns; got it for a crank"):
            sc.problem({"name": "Plain", **plain, **tables})
    found = lever()
    del found["mechanism"]["frame_angle"]
    with pytest.raises(JobError, match=r"mechanism.frame_angle: is missing"):
        sc.problem(found)


def test_curves_and_pictures_of_a_slider_crank_are_not_those_of_a_lever() -> None:
    problem = sc.problem(lever())
    analysis = problem.analyse(TIPPER)
    assert "<svg" not in problem._repr_html_() + analysis._repr_html_()
    for ask in (analysis.cycle, analysis.plot, lambda: analysis["stroke"]):
        with pytest.raises(InputError, match=r"crank with rod and slider|rotating crank|rotates fully"):
            ask()
