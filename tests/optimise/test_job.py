"""Job files that are right: what becomes of every key, the shipped ones, and the schema."""

import json
import math
import tomllib
from copy import deepcopy
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from slidercrank.model.cycle.cycle import cycle
from slidercrank.model.errors import JobError
from slidercrank.model.linkage.inverse_kinematics import crank_from_stroke
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.links_and_joints import Bar, Counterweight, RigidLink
from slidercrank.model.machine.loads.angle_table import AngleTable
from slidercrank.model.machine.loads.position_table import PositionTable
from slidercrank.model.machine.loads.spring import Spring
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.loads.viscous import Viscous
from slidercrank.model.machine.mechanism import Branch, Tolerance, Window
from slidercrank.objectives.lever_quantity import LeverQuantity
from slidercrank.objectives.quantity import Quantity
from slidercrank.objectives.registry import FACTS, QUANTITIES
from slidercrank.objectives.swing_quantity import SwingQuantity
from slidercrank.optimise.job import Job, job_schema, load_job, parse_job
from slidercrank.optimise.job.problem_of_job import problem_of
from slidercrank.optimise.job.sections_table import EXAMPLE as SECTIONS
from slidercrank.optimise.problem.problem import Settings
from slidercrank.optimise.problem.requirements import Constraint, Objective, Range
from tests.model.cases import with_example
from tests.optimise.problems import LEVER, SHAPER

RUNS = Path(__file__).parents[2] / "runs"
TURNING = Path(__file__).parents[1] / "data" / "turning_support.toml"
SHIPPED = ["feeder", "sieve", "support", "compressor"]

# The smallest job that says something.
SMALL: dict[str, Any] = {
    "name": "Small",
    "mechanism": {"speed": "300 rpm", "slider": {"mass": "2 kg"}},
    "variables": {
        "crank": ["20 mm", "40 mm"],
        "rod": ["100 mm", "200 mm"],
        "offset": ["0 mm", "30 mm"],
    },
    "objectives": {"peak_torque": "minimise"},
}


TARGET = {"crank_angles": ["0 deg", "90 deg", "180 deg"], "positions": ["140 mm", "120 mm", "100 mm"]}


WORN = SECTIONS | {"wear_coefficient": "1e-9 mm^2/N"}
BAR = {"width": "30 mm", "depth": "20 mm", "density": "7850 kg/m^3"}


def small(**parts: Any) -> dict[str, Any]:
    return deepcopy(SMALL) | parts


def test_the_smallest_job_leaves_everything_else_at_its_default() -> None:
    problem = parse_job(SMALL)
    assert problem.name == "Small"
    assert problem.mechanism.speed == pytest.approx(10.0 * math.pi, rel=1e-15)
    assert problem.mechanism.slider_mass == 2.0
    assert problem.mechanism.crank == problem.mechanism.rod == RigidLink(mass=0.0)
    assert problem.mechanism.gravity == (0.0, 0.0)
    assert problem.mechanism.loads == ()
    assert problem.constraints == ()
    assert (problem.crank, problem.rod) == (Range(lower=0.02, upper=0.04), Range(lower=0.1, upper=0.2))
    assert problem.objectives == (Objective(quantity="peak_torque", sense="minimise"),)
    assert problem.settings == Settings()


def test_the_feeder_is_read_in_si() -> None:
    problem = load_job(RUNS / "feeder.toml")
    mechanism = problem.mechanism
    assert mechanism.speed == pytest.approx(-80.0 * math.pi, rel=1e-15)
    assert (mechanism.crank, mechanism.rod) == (RigidLink(mass=0.2), RigidLink(mass=0.5))
    assert (mechanism.slider_mass, mechanism.gravity) == (0.8, (0.0, -9.81))
    assert mechanism.loads == (
        StrokeForce(outward=-2000.0, inward=0.0),
        StrokeForce(outward=-60.0, inward=60.0),
    )
    assert mechanism.tolerances.crank == Tolerance(absolute=2e-5)
    assert mechanism.tolerances.crank_angle.absolute == pytest.approx(math.radians(0.1), rel=1e-15)
    assert problem.offset == Range(lower=0.015, upper=0.08)
    assert {c.quantity: (c.lower, c.upper) for c in problem.constraints} == {
        "stroke": (0.08, 0.09),
        "rod_to_offset": (3.2, 3.2),
        "transmission_angle": (math.radians(25.0), None),
    }
    assert {(o.quantity, o.sense) for o in problem.objectives} == {
        ("time_ratio", "maximise"),
        ("peak_torque", "minimise"),
        ("transmission_angle", "maximise"),
        ("position_error", "minimise"),
    }
    assert problem.settings == Settings(designs=100, seed=1)


def test_the_sieve_is_read_in_si() -> None:
    problem = load_job(RUNS / "sieve.toml")
    bar = Bar(width=0.03, depth=0.02, density=7800.0)
    assert (problem.mechanism.crank, problem.mechanism.rod) == (bar, bar)
    assert problem.mechanism.slider_mass == 1.95
    assert problem.mechanism.loads == (
        StrokeForce(outward=-60.0, inward=60.0),
        Viscous(coefficient=15.0),
    )
    assert Constraint(quantity="stroke", lower=0.28, upper=0.28) in problem.constraints
    assert problem.rod == Range(lower=0.2, upper=0.6)


def test_the_turning_support_is_read_in_si() -> None:
    problem = load_job(TURNING)
    mechanism = problem.mechanism
    assert mechanism.speed == pytest.approx(math.pi / 300.0, rel=1e-15)
    assert mechanism.loads == (
        StrokeForce(outward=-25e3, inward=-25e3),
        PositionTable(positions=(0.0, 0.3), forces=(8e3, 0.0), datum="inner dead centre"),
    )
    tolerances = mechanism.tolerances
    assert tolerances.crank == tolerances.rod == tolerances.offset == Tolerance(fraction=0.001)
    assert tolerances.window == Window(during="inward stroke", start=0.15, end=1.0)
    assert problem.offset == Range(lower=-0.6, upper=-0.02)
    assert Objective(quantity="time_ratio", sense="target", target=1.1) in problem.objectives
    assert Constraint(quantity="peak_torque", upper=46e3) in problem.constraints


@pytest.mark.parametrize("name", SHIPPED)
def test_a_shipped_job_means_the_same_as_json(name: str, tmp_path: Path) -> None:
    source = RUNS / f"{name}.toml"
    copy = tmp_path / f"{name}.json"
    copy.write_text(json.dumps(tomllib.loads(source.read_text(encoding="utf-8"))), encoding="utf-8")
    assert load_job(copy) == load_job(str(source))


@pytest.mark.parametrize("name", SHIPPED)
def test_a_job_that_was_read_is_a_job_again(name: str) -> None:
    job = Job.model_validate(tomllib.loads((RUNS / f"{name}.toml").read_text(encoding="utf-8")))
    again = Job.model_validate(json.loads(job.model_dump_json(exclude_none=True)))
    assert problem_of(again) == problem_of(job)
    assert problem_of(Job.model_validate(job.model_dump(exclude_none=True))) == problem_of(job)


def test_figures_in_the_comments_of_the_shipped_jobs_are_right() -> None:
    """The design of the sieve's report, the fit to the support's table, the feeder's own design."""
    sieve, support = Linkage(0.14, 0.31, 0.06), Linkage(1.4, 1.8, -0.05)
    assert float(sieve.stroke) == pytest.approx(0.287, abs=5e-4)
    assert float(sieve.time_ratio) == pytest.approx(1.16, abs=5e-3)
    assert math.degrees(sieve.least_transmission_angle) == pytest.approx(49.8, abs=0.05)
    assert float(support.stroke) == pytest.approx(2.803, abs=5e-4)
    assert float(support.time_ratio) == pytest.approx(1.07, abs=5e-3)
    assert math.degrees(support.least_transmission_angle) == pytest.approx(36.3, abs=0.05)
    assert support.slow_stroke(direction=load_job(TURNING).mechanism.speed) == "outward"
    feeder = Linkage(0.04, 0.064, 0.02)
    assert math.degrees(feeder.least_transmission_angle) == pytest.approx(20.4, abs=0.05)
    assert feeder.slow_stroke(direction=load_job(RUNS / "feeder.toml").mechanism.speed) == "outward"


def test_the_torques_that_the_comments_of_the_shipped_jobs_speak_of_are_right() -> None:
    torque = QUANTITIES["peak_torque"]
    support = load_job(TURNING).mechanism
    fitted = torque.evaluate(support, np.array([[1.4, 1.8, -0.05]])).values
    assert fitted[0] == pytest.approx(46.6e3, abs=50.0)
    # The feeder with 80 mm of stroke: the shortest rod that is allowed, one in between, the longest.
    rods = np.array([0.062, 0.1, 0.25])
    cranks = crank_from_stroke(0.08, rod=rods, offset=rods / 3.2)
    feeder = load_job(RUNS / "feeder.toml").mechanism
    short, between, long = torque.evaluate(feeder, np.stack([cranks, rods, rods / 3.2], axis=1)).values
    assert between < long < short


LOADS: list[tuple[dict[str, Any], Any]] = [
    ({"force": "5 N", "opposes": "outward stroke"}, StrokeForce(outward=-5.0, inward=0.0)),
    ({"force": "5 N", "opposes": "inward stroke"}, StrokeForce(outward=0.0, inward=5.0)),
    ({"force": "5 N", "opposes": "motion"}, StrokeForce(outward=-5.0, inward=5.0)),
    ({"force": "5 N", "direction": "outward"}, StrokeForce(outward=5.0, inward=5.0)),
    (
        {"force": "5 N", "direction": "inward", "during": "outward stroke"},
        StrokeForce(outward=-5.0, inward=0.0),
    ),
    (
        {"force": 5, "direction": "outward", "during": "inward stroke"},
        StrokeForce(outward=0.0, inward=5.0),
    ),
    (
        {"stiffness": "20 N/mm", "free_position": "25 mm", "measured_from": "outer dead centre"},
        Spring(stiffness=20e3, free_position=0.025, datum="outer dead centre"),
    ),
    ({"viscous": "50 N s/m"}, Viscous(coefficient=50.0)),
    (
        {"positions": ["0 mm", "20 mm"], "forces": ["-2 kN", 0], "during": "outward stroke"},
        PositionTable(positions=(0.0, 0.02), forces=(-2e3, 0.0), during="outward stroke"),
    ),
    (
        {"crank_angles": ["0 deg", "180 deg"], "forces": ["1 N", "2 N"]},
        AngleTable(angles=(0.0, math.pi), forces=(1.0, 2.0)),
    ),
]


@pytest.mark.parametrize(("load", "expected"), LOADS)
def test_a_load_becomes_the_load_of_the_model(load: dict[str, Any], expected: Any) -> None:
    assert parse_job(small(load=[load])).mechanism.loads == (expected,)


def test_links_come_by_section_or_by_mass() -> None:
    mechanism = {
        "speed": "-10 rad/s",
        "acceleration": "20 rad/s^2",
        "crank": {"width": "30 mm", "depth": "20 mm", "density": "7800 kg/m^3"},
        "rod": {"mass": 1, "inertia": 0.01, "centre": "40 mm", "centre_across": "-2 mm"},
        "counterweight": {"mass": "0.4 kg", "radius": "25 mm", "angle": "170 deg", "inertia": 1e-4},
        "branch": "crossed",
    }
    model = parse_job(small(mechanism=mechanism)).mechanism
    assert (model.speed, model.acceleration, model.branch) == (-10.0, 20.0, "crossed")
    assert model.crank == Bar(width=0.03, depth=0.02, density=7800.0)
    assert model.rod == RigidLink(mass=1.0, inertia=0.01, centre=0.04, centre_across=-0.002)
    weight = Counterweight(mass=0.4, radius=0.025, angle=math.radians(170.0), inertia=1e-4)
    assert model.counterweight == weight


@pytest.mark.parametrize(
    ("direction", "expected"),
    [
        (None, (0.0, -9.81)),
        ("0 deg", (9.81, 0.0)),
        ("180 deg", (-9.81, 0.0)),
        ("-90 deg", (0.0, -9.81)),
        ("240 deg", (-9.81 * 0.5, -9.81 * math.sqrt(0.75))),
    ],
)
def test_gravity_points_where_things_fall(direction: str | None, expected: tuple[float, float]) -> None:
    mechanism = SMALL["mechanism"] | {"gravity": "9.81 m/s^2"}
    if direction:
        mechanism |= {"gravity_direction": direction}
    gravity = parse_job(small(mechanism=mechanism)).mechanism.gravity
    assert gravity == pytest.approx(expected, rel=1e-14, abs=0.0)


@pytest.mark.parametrize(("branch", "side", "fall"), [("open", "left", "outward"), ("crossed", "right", "inward")])
def test_the_words_of_the_schema_on_each_branch_are_true(branch: Branch, side: str, fall: str) -> None:
    """Where the slider is, on which side of the outward direction the offset, and which way gravity along +x pulls."""
    mechanism = SMALL["mechanism"] | {"branch": branch, "gravity": "9.81 m/s^2", "gravity_direction": "0 deg"}
    problem = parse_job(small(mechanism=mechanism | {"speed": "0.001 rpm"}))
    linkage, angles = Linkage(0.03, 0.15, 0.02, branch), np.array([0.4, 1.9, 3.3, 5.0])
    at = linkage.at(angles)
    outward = np.sign(at.slider_position[0])
    assert (outward > 0.0) == (branch == "open")
    left = np.array([0.0, outward])  # the outward direction turned counter-clockwise by 90 deg
    assert (left @ [0.0, linkage.offset] > 0.0) == (side == "left")
    # The drive holds the falling slider: its torque against the slope of the distance from the crank pivot tells
    # whether things fall outward or inward.
    found = cycle(problem.mechanism, linkage, angles)
    pull = -found.torque / (outward * linkage.at(angles, speed=1.0).slider_velocity)
    np.testing.assert_allclose(pull, 2.0 * 9.81 * (1.0 if fall == "outward" else -1.0), rtol=1e-6)
    keys = job_schema()["$defs"]
    words = " ".join(keys["VariablesPart"]["properties"]["offset"]["description"].split())
    assert {"left": "left of the outward direction on the open branch", "right": "right on the crossed one"}[
        side
    ] in words
    words = keys["MechanismPart"]["properties"]["gravity_direction"]["description"]
    assert "+x (outward on the open branch, inward on the crossed branch); default" in words
    sign = "+x" if outward > 0.0 else "-x"
    words = keys["MechanismPart"]["properties"]["branch"]["description"]
    assert f"{branch}: the slider is on the side of {sign}, and outward is {sign}" in words


def test_a_single_value_fixes_a_dimension() -> None:
    variables = SMALL["variables"] | {"rod": "150 mm"}
    assert parse_job(small(variables=variables)).rod == Range(lower=0.15, upper=0.15)


def test_both_spellings_of_an_objective_mean_the_same() -> None:
    wishes = {"peak_torque": "minimize", "stroke": "maximize"}
    senses = {o.quantity: o.sense for o in parse_job(small(objectives=wishes)).objectives}
    assert senses == {"peak_torque": "minimise", "stroke": "maximise"}


def meeting(quantity: Quantity, job: dict[str, Any]) -> dict[str, Any]:
    """Return a job with the examples that messages give for the needs of a quantity that it does not meet."""
    for need in quantity.needs:
        if not need.is_met(parse_job(job).mechanism):
            job = with_example(job, need)
    return job


@pytest.mark.parametrize("name", QUANTITIES)
def test_every_quantity_can_be_a_constraint_and_an_objective(name: str) -> None:
    job = small(sections=WORN, friction={"guide": 0.1})
    job["mechanism"] = job["mechanism"] | {"crank": BAR, "rod": BAR}
    job = meeting(QUANTITIES[name], job)
    value = float(QUANTITIES[name].evaluate(parse_job(job).mechanism, np.array([[0.03, 0.15, 0.015]])).values[0])
    job |= {"constraints": {name: {"min": value}}, "objectives": {name: "minimise"}}
    problem = parse_job(job)
    assert problem.constraints == (Constraint(quantity=name, lower=value),)
    assert problem.objectives == (Objective(quantity=name, sense="minimise"),)


def test_a_bar_of_another_density_than_its_material_is_refused() -> None:
    job = small(sections=SECTIONS)
    job["mechanism"] = job["mechanism"] | {"crank": BAR, "rod": BAR | {"density": "7400 kg/m^3"}}
    with pytest.raises(JobError, match=r"mechanism\.rod\.density: .* got 7400 kg/m\^3 and sections\.material\.density"):
        parse_job(job)
    job["mechanism"]["rod"] = BAR | {"density": "7800 kg/m^3"}
    assert parse_job(job).mechanism.strength is not None
    job["variables"] = job["variables"] | {"mechanism": {"rod": {"density": ["2700 kg/m^3", "7850 kg/m^3"]}}}
    assert parse_job(job).mechanism.strength is not None


def test_a_file_with_a_byte_order_mark_or_windows_line_ends_is_read(tmp_path: Path) -> None:
    content = (RUNS / "sieve.toml").read_bytes().replace(b"\n", b"\r\n")
    (tmp_path / "sieve.TOML").write_bytes(b"\xef\xbb\xbf" + content)
    assert load_job(tmp_path / "sieve.TOML") == load_job(RUNS / "sieve.toml")


def _nodes(node: Any) -> list[dict[str, Any]]:
    if isinstance(node, list):
        return [found for item in node for found in _nodes(item)]
    if not isinstance(node, dict):
        return []
    return [node, *(found for item in node.values() for found in _nodes(item))]


def test_the_schema_describes_every_key_with_an_example() -> None:
    schema = job_schema()
    assert schema["$schema"].endswith("2020-12/schema")
    assert json.loads(json.dumps(schema, allow_nan=False)) == schema
    tables = [node for node in [schema, *schema["$defs"].values()] if "properties" in node]
    assert len(tables) > 20
    for table in tables:
        assert table["additionalProperties"] is False
        for key, node in table["properties"].items():
            assert node.get("description"), key
            assert node.get("examples"), key
    assert not [node for node in _nodes(schema) if node.get("type") == "null"]
    refs = {node["$ref"].removeprefix("#/$defs/") for node in _nodes(schema) if "$ref" in node}
    assert refs == set(schema["$defs"])


def test_the_examples_of_the_schema_are_valid() -> None:
    properties = job_schema()["properties"]
    for key, node in properties.items():
        for example in node["examples"]:
            others = {"cylinder": LEVER, "arm": SHAPER, "spring": LEVER}
            given = deepcopy(others[key]) if key in others else small(tolerances={"crank": "0.05 mm"})
            parse_job(given | {key: example})
    for name, node in job_schema()["$defs"]["Objectives"]["properties"].items():
        for example in node["examples"]:
            given = {"tolerances": {"crank": "0.05 mm"}, "friction": {"guide": 0.1}, "target_motion": TARGET}
            fact = FACTS[name]
            if isinstance(fact, LeverQuantity):
                parse_job((LEVER if "cylinder" in fact.moved_by else SHAPER) | {"objectives": {name: example}})
            elif isinstance(fact, SwingQuantity):
                ends = {"from": "20 deg", "to": "80 deg"}
                if name == "swing_angle":
                    ends = {"slider_from": "130 mm", "slider_to": "100 mm"}
                swing = {"kind": "swing", **ends, "driver": fact.driver or "slider"}
                swing |= {"law": "harmonic", "duration": "2 s"}
                rubs = {key: given[key] for key in ("tolerances", "friction")}
                parse_job(small(**rubs, motion=swing, objectives={name: example}))
            else:
                given |= {
                    "sections": SECTIONS | {"wear_coefficient": "1e-9 mm^2/N"},
                    "mechanism": SMALL["mechanism"] | {"crank": BAR, "rod": BAR},
                }
                parse_job(meeting(fact, small(**given)) | {"objectives": {name: example}})


def test_the_schema_cannot_be_changed_from_outside() -> None:
    job_schema()["properties"].clear()
    assert job_schema()["properties"]


def test_a_job_cannot_be_changed_after_reading() -> None:
    job = Job.model_validate(SMALL)
    with pytest.raises(ValueError, match="frozen"):
        job.name = "other"  # type: ignore[misc]


def test_the_data_of_the_caller_stays_as_it_is() -> None:
    data = small(load=[{"force": "5 N", "opposes": "motion"}])
    before = deepcopy(data)
    parse_job(data)
    assert data == before


def test_a_job_error_is_a_value_error() -> None:
    with pytest.raises(ValueError, match="name: is missing"):
        parse_job({key: value for key, value in SMALL.items() if key != "name"})
    assert issubclass(JobError, ValueError)
