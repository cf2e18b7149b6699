"""Numbers that vary and choices in a job file: what they become, and what is refused with which words."""

from __future__ import annotations

import math
import tomllib
from typing import Any

import pytest

from slidercrank.model.errors import JobError
from slidercrank.model.machine.links_and_joints import Bar
from slidercrank.model.machine.varying_numbers import Varying
from slidercrank.objectives.tables.design_input import column_of_variable
from slidercrank.optimise.job import parse_job
from slidercrank.optimise.problem.problem import Problem
from slidercrank.optimise.problem.requirements import Constraint, Range

JOB = """
name = "Variables"
[mechanism]
speed = "-300 rpm"
crank = { mass = "0.4 kg", centre = "20 mm" }
rod = { width = "30 mm", depth = "10 mm", density = "7800 kg/m^3" }
counterweight = { mass = "0.4 kg", radius = "25 mm", angle = "180 deg" }
slider = { mass = "0.8 kg" }
gravity = "9.81 m/s^2"
gravity_direction = "240 deg"
[[load]]
force = "200 N"
opposes = "motion"
[[load]]
stiffness = "20 N/mm"
free_position = "25 mm"
[[load]]
force = "50 N"
direction = "inward"
during = "inward stroke"
[[load]]
viscous = "50 N s/m"
[friction]
guide = 0.1
crank_pin = { radius = "10 mm", coefficient = 0.08 }
[tolerances]
crank = "0.05 mm"
rod = "0.1 %"
crank_angle = "0.1 deg"
[tolerances.clearances]
crank_pin = "0.02 mm"
[variables]
crank = ["20 mm", "40 mm"]
rod = ["100 mm", "200 mm"]
offset = ["0 mm", "30 mm"]
[objectives]
peak_torque = "minimise"
"""


def job(variables: str = "", more: str = "") -> dict[str, Any]:
    return tomllib.loads(JOB.replace("[objectives]", f"{variables}\n[objectives]") + more)


def only(problem: Problem) -> Varying:
    (found,) = problem.mechanism.varying
    return found


DOWN, ASIDE = math.sin(math.radians(240.0)), math.cos(math.radians(240.0))


@pytest.mark.parametrize(
    ("path", "ends", "sets", "column"),
    [
        ("mechanism.slider.mass", ["0.5 kg", "2 kg"], {"slider_mass": 1.0}, "slider_mass_kg"),
        ("mechanism.speed", ["-400 rpm", "-200 rpm"], {"speed": 1.0}, "speed_rpm"),
        ("mechanism.crank.mass", [0.1, 2.0], {"crank.mass": 1.0}, "crank_mass_kg"),
        ("mechanism.crank.centre", ["10 mm", "30 mm"], {"crank.centre": 1.0}, "crank_centre_mm"),
        ("mechanism.rod.width", ["20 mm", "40 mm"], {"rod.width": 1.0}, "rod_width_mm"),
        ("mechanism.rod.density", [2700, 7800], {"rod.density": 1.0}, "rod_density_kg_m3"),
        ("mechanism.counterweight.radius", [0, 0.1], {"counterweight.radius": 1.0}, "counterweight_radius_mm"),
        (
            "mechanism.counterweight.angle",
            ["90 deg", "270 deg"],
            {"counterweight.angle": 1.0},
            "counterweight_angle_deg",
        ),
        ("mechanism.gravity", [5.0, 10.0], {"gravity.0": ASIDE, "gravity.1": DOWN}, "gravity_m_s2"),
        ("load.1.force", ["0.1 kN", "300 N"], {"loads.0.outward": -1.0, "loads.0.inward": 1.0}, "load_1_force_N"),
        ("load.2.stiffness", ["10 N/mm", "30 N/mm"], {"loads.1.stiffness": 1.0}, "load_2_stiffness_N_per_m"),
        ("load.2.free_position", ["-5 mm", "30 mm"], {"loads.1.free_position": 1.0}, "load_2_free_position_mm"),
        ("load.3.force", ["10 N", "80 N"], {"loads.2.inward": -1.0}, "load_3_force_N"),
        ("load.4.viscous", [10.0, 80.0], {"loads.3.coefficient": 1.0}, "load_4_viscous_Ns_per_m"),
        ("friction.guide", [0.0, 0.2], {"friction.guide": 1.0}, "friction_guide"),
        (
            "friction.crank_pin.radius",
            ["5 mm", "15 mm"],
            {"friction.crank_pin.radius": 1.0},
            "friction_crank_pin_radius_mm",
        ),
        ("tolerances.crank", ["0.01 mm", "0.1 mm"], {"tolerances.crank.absolute": 1.0}, "tolerances_crank_mm"),
        ("tolerances.rod", ["0.05 %", "0.2 %"], {"tolerances.rod.fraction": 1.0}, "tolerances_rod"),
        (
            "tolerances.clearances.crank_pin",
            ["0.01 mm", "0.1 mm"],
            {"tolerances.clearances.crank_pin": 1.0},
            "tolerances_clearances_crank_pin_mm",
        ),
    ],
)
def test_a_path_becomes_a_varying_number(path: str, ends: list[Any], sets: dict[str, float], column: str) -> None:
    found = only(parse_job(job(f"{path} = {ends}")))
    assert found == only(parse_job(job(f'"{path}" = {ends}')))
    assert found.name == path
    assert dict(found.sets) == pytest.approx(sets, rel=1e-12)
    assert column_of_variable(found)[0] == column
    assert found.lower < found.upper


def test_what_the_job_gives_stays_the_value_of_single_designs() -> None:
    machine = parse_job(job('mechanism.slider.mass = ["1 kg", "2 kg"]')).mechanism
    assert machine.nominal == parse_job(job()).mechanism
    assert machine.with_values([1.5]).slider_mass == 1.5


@pytest.mark.parametrize(
    ("variables", "words"),
    [
        ("mechanism.slidr.mass = [1, 2]", ["variables.mechanism.slidr.mass", "did you mean mechanism.slider.mass"]),
        ("mechanism.slider = [1, 2]", ["number that the job gives", "did you mean mechanism.slider.mass"]),
        ("mechanism.crank.inertia = [1, 2]", ["number that the job gives", "mechanism.crank"]),
        ('mechanism.slider.mass = ["5 mm", "2 kg"]', ["variables.mechanism.slider.mass: must be a mass", '"5 mm"']),
        ("mechanism.slider.mass = [2, 1]", ["from its lower to its upper end", "swap"]),
        ("mechanism.slider.mass = [1, 1]", ["from its lower to its upper end"]),
        ("mechanism.slider.mass = [-1, 1]", ["zero or more", "-1"]),
        ("mechanism.slider.mass = [1, 2, 3]", ["must be a range", "choices"]),
        ('mechanism.slider.mass = "2 kg"', ["must be a range", '"2 kg"', "in its own place"]),
        ("mechanism.slider.mass = { choices = [1] }", ["at least two values"]),
        ("mechanism.slider.mass = { choices = [1, 1] }", ["must differ"]),
        ('mechanism.speed = ["-10 rpm", "10 rpm"]', ["variables", "keep the range on one side of 0"]),
        ('mechanism.gravity_direction = ["0 deg", "20 deg"]', ["linearly", "choice"]),
        ('load.9.force = ["1 N", "2 N"]', ["number that the job gives", "did you mean load."]),
        ('mechanism.slider.mass = [1, 2]\n"mechanism.slider.mass" = [1, 3]', ["given twice"]),
        ("speed = [1, 2]", ["variables.speed", "unknown key"]),
        ("mechanism = 3", ["variables.mechanism", "table"]),
    ],
)
def test_what_cannot_vary_is_refused_with_rule_value_and_remedy(variables: str, words: list[str]) -> None:
    with pytest.raises(JobError) as caught:
        parse_job(job(variables))
    assert [word for word in words if word not in str(caught.value)] == []


CHOICE = """
[[choice]]
name = "rod section"
[[choice.option]]
name = "30 x 10"
values = { "mechanism.rod.width" = "30 mm", mechanism.rod.depth = "10 mm" }
[[choice.option]]
name = "25 x 12"
values = { mechanism.rod.width = "25 mm", mechanism.rod.depth = "12 mm" }
[[choice]]
name = "gearmotor"
[[choice.option]]
name = "GM 40"
constraints = { peak_torque = { max = "40 N m" }, rms_torque = { max = "20 N m" } }
[[choice.option]]
name = "GM 90"
constraints = { peak_torque = { max = "90 N m" } }
values = { crank = ["25 mm", "30 mm"], mechanism.counterweight.angle = "190 deg" }
"""


def test_choices_become_every_combination() -> None:
    data = job('mechanism.slider.mass = { choices = ["1 kg", "2 kg"] }\nload.1.force = [100, 300]', CHOICE)
    data["variables"]["rod"] = {"choices": ["125 mm", "100 mm"]}
    problem = parse_job(data)
    assert problem.choices == ("slider.mass", "rod section", "gearmotor")
    assert len(problem.variants) == 16
    assert problem.rod == Range(lower=0.1, upper=0.125)
    last = problem.variants[-1]
    assert last.labels == ("2 kg", "25 x 12", "GM 90")
    assert last.rod == Range(lower=0.125, upper=0.125)
    assert last.crank == Range(lower=0.025, upper=0.03)
    assert last.mechanism.slider_mass == 2.0
    assert last.mechanism.rod == Bar(width=0.025, depth=0.012, density=7800.0)
    assert last.mechanism.counterweight.angle == pytest.approx(math.radians(190.0))
    assert [item.name for item in last.mechanism.varying] == ["load.1.force"]
    assert last.limits == (Constraint(quantity="peak_torque", upper=90.0),)
    assert problem.part(0).constraints[-1] == Constraint(quantity="rms_torque", upper=20.0)


@pytest.mark.parametrize(
    ("variables", "more", "words"),
    [
        ("", CHOICE.replace("25 x 12", "30 x 10"), ["different names", "30 x 10"]),
        (
            "",
            CHOICE.replace("rod.depth", "rod.deepth"),
            ["option", "must name a number", "did you mean mechanism.rod.depth"],
        ),
        ("", CHOICE.replace('"12 mm"', '"12 kg"'), ["choice", "must be a length"]),
        ("mechanism.rod.width = [0.02, 0.03]", CHOICE, ["mechanism.rod.width may be set only once"]),
        ("", CHOICE.replace("40 N m", "40 N"), ["constraints.peak_torque.max", "must be a torque"]),
        (f"load.1.force = {{ choices = {list(range(1, 60))} }}", CHOICE, ["at most 200", "59 x 2 x 2 = 236"]),
    ],
)
def test_impossible_choices_are_refused(variables: str, more: str, words: list[str]) -> None:
    with pytest.raises(JobError) as caught:
        parse_job(job(variables, more))
    assert [word for word in words if word not in str(caught.value)] == []
