"""Jobs whose crank swings: what is read, what is refused, and a front that nothing dominates."""

from __future__ import annotations

import math
from copy import deepcopy
from typing import Any

import numpy as np
import pytest

from slidercrank.model.errors import AssemblyError, JobError
from slidercrank.optimise.job import parse_job
from slidercrank.optimise.job.job_notes import job_notes
from slidercrank.optimise.problem.problem import Problem
from slidercrank.optimise.search.stroke_warnings import stroke_warnings
from slidercrank.optimise.solve import solve

JOB: dict[str, Any] = {
    "name": "Column",
    "mechanism": {
        "crank": {"mass": "180 kg"},
        "rod": {"mass": "220 kg"},
        "slider": {"mass": "400 kg"},
        "gravity": "9.81 m/s^2",
    },
    "motion": {"kind": "swing", "from": "11 deg", "to": "101 deg", "driver": "slider", "actuator_tolerance": "1 mm"},
    "load": [{"force": "25 kN", "direction": "inward"}],
    "tolerances": {"crank": "0.1 %", "rod": "0.1 %"},
    "variables": {"crank": ["1.2 m", "1.5 m"], "rod": ["0.9 m", "3 m"], "offset": ["-600 mm", "600 mm"]},
    "constraints": {"actuator_travel": {"min": "2 m", "max": "2.5 m"}},
    "objectives": {"peak_actuator_force": "minimise", "swing_angle_error": "minimise"},
    "optimiser": {"designs": 8, "samples": 1024},
}

FITTED = {"crank": "1.4 m", "rod": "1.8 m", "offset": "-50 mm"}


def changed(**tables: Any) -> dict[str, Any]:
    """Return the job with tables changed; a table within [motion] is merged."""
    job = deepcopy(JOB)
    for name, table in tables.items():
        job[name] = {**job[name], **table} if name == "motion" else table
    return job


def test_a_swing_is_read_with_its_margin() -> None:
    problem = parse_job(changed(motion={"margin": "20 deg", "law": "harmonic", "duration": "30 s"}))
    swing = problem.motion
    assert swing is not None
    assert (swing.driver, swing.law, swing.duration, swing.actuator_tolerance) == ("slider", "harmonic", 30.0, 1e-3)
    assert swing.end - swing.start == pytest.approx(0.5 * math.pi)
    (margin,) = (c for c in problem.constraints if c.quantity == "swing_transmission_angle")
    assert margin.lower == pytest.approx(math.radians(20.0))
    assert parse_job(changed(motion={"margin": "20 deg"})).quantity("peak_actuator_force").kind.unit == "N"


PLACES = {"kind": "swing", "slider_from": "3.1 m", "slider_to": "0.8 m", "driver": "slider"}


@pytest.mark.slow
def test_places_of_the_slider_state_a_swing_whose_angle_is_exact() -> None:
    """A law of motion by a table, equalities in closed form, and designs that nothing dominates."""
    motion = {
        **PLACES,
        "law": "table",
        "law_times": [0, 0.3, 0.7, 1],
        "law_shares": [0, 0.2, 0.8, 1],
        "duration": "9 s",
    }
    job = {**changed(constraints={"swing_angle": {"equals": "90 deg"}}), "motion": motion}
    problem = parse_job(job)
    assert problem.motion is not None
    assert len(problem.motion.points) == 4
    front = solve(problem)
    assert len(front) > 4
    angle, error, force = (
        problem.evaluate(front.dimensions, [name]).ravel()
        for name in ("swing_angle", "swing_angle_error", "peak_actuator_force")
    )
    assert np.abs(angle / (0.5 * math.pi) - 1.0).max() < 1e-12
    order = np.argsort(force)
    assert (np.diff(error[order]) < 0.0).all()


@pytest.mark.usefixtures("little")
def test_a_free_start_finds_what_the_best_of_many_fixed_ones_does() -> None:
    """The swing and the travel are exact; the best start is found among the others."""
    constraints = {"actuator_travel": {"equals": "2.3 m"}}
    objectives = {"peak_actuator_force": "minimise"}
    motion = {"kind": "swing", "from": "11 deg", "swing": "90 deg", "driver": "slider"}
    few = {**JOB["optimiser"], "samples": 256}
    job = {**changed(constraints=constraints, objectives=objectives, optimiser=few), "motion": motion}
    free = {**job, "variables": {**JOB["variables"], "motion": {"from": ["5 deg", "40 deg"]}}}
    problem = parse_job(free)
    front = solve(problem)
    design = front.dimensions[0]
    assert problem.evaluate(design, ["actuator_travel"])[0] == pytest.approx(2.3, rel=1e-12)
    least = problem.evaluate(design, ["peak_actuator_force"])[0]
    fixed = {}
    for start in (math.degrees(design[3]), 5.0, 20.0, 35.0):
        own = parse_job({**job, "motion": {**motion, "from": f"{start!r} deg"}})
        fixed[start] = own.evaluate(solve(own).dimensions[0], ["peak_actuator_force"])[0]
    assert least == pytest.approx(min(fixed.values()), rel=1e-6)
    assert fixed[math.degrees(design[3])] == pytest.approx(least, rel=1e-6)


@pytest.mark.parametrize(
    ("job", "words"),
    [
        ({"slider_from": "9 m"}, "no design within the ranges reaches the swing from 9000 to 800 mm of the slider"),
        ({"slider_to": "3.1 m"}, "two different slider positions; got 3100 mm twice"),
        ({"slider_to": None, "slider_travel": "-2 m", "from": "10 deg"}, "leave out those of one"),
    ],
)
def test_places_that_are_no_swing_are_refused(job: dict[str, Any], words: str) -> None:
    motion = {name: value for name, value in {**PLACES, **job}.items() if value is not None}
    with pytest.raises(JobError, match=words):
        parse_job({**changed(constraints={}), "motion": motion})


@pytest.mark.parametrize(
    ("tables", "words"),
    [
        ({"motion": {"kind": "turn"}}, "keys of a swing must not be given for a rotating crank; got"),
        ({"motion": {"to": None}}, "motion.to: must have a value"),
        ({"motion": {"swing": "90 deg"}}, "to is where swing leads from from; got all three"),
        ({"motion": {"slider_from": "3 m"}}, "by two crank angles or by two slider positions; got from"),
        ({"motion": {"crank_side": "right"}}, "may only be given with slider positions; got right"),
        ({"motion": {"law": "table", "duration": "3 s"}}, "got no law_times; for example, add law_times"),
        (
            {"motion": {"law": "table", "duration": "3 s", "law_times": [0, 0.5, 1], "law_shares": [0, 1]}},
            "must have the same number of values; got 3 and 2",
        ),
        ({"constraints": {"swing_angle": {"equals": "90 deg"}}}, "fixes it by from and to for all designs"),
        (
            {"variables": {**FITTED, "motion": {"to": ["90 deg", "110 deg"]}}},
            "may vary; got to as a variable",
        ),
        ({"variables": {**FITTED, "motion": {"from": {"choices": ["9 deg", "11 deg"]}}}}, "got a choice"),
        ({"motion": {"to": "11 deg"}}, "two different crank angles"),
        ({"motion": {"to": "400 deg"}}, "less than a turn apart"),
        ({"motion": {"duration": "0 s", "law": "harmonic"}}, "motion.duration: must be positive"),
        ({"motion": {"law": "harmonic"}}, "any other swing must have one"),
        ({"motion": {"from": "101 deg", "to": "290 deg"}, "variables": FITTED}, "passes a dead point"),
        ({"motion": {"from": "-170 deg"}}, "passes a dead point"),
        (
            {"variables": {"crank": "1.4 m", "rod": "0.5 m", "offset": "0 mm"}},
            "no design within the ranges can be assembled",
        ),
        ({"motion": {"driver": "crank", "actuator_tolerance": 0}}, "it needs a swing driven by the slider"),
        ({"motion": {"margin": "100 deg"}}, "motion.margin: must be more than 0 and less than 90 deg"),
        (
            {"variables": JOB["variables"] | {"motion.from": ["0 deg", "120 deg"]}},
            r"motion\.from: .* one side of the end .*; got 0 to 120 deg with an end at 101 deg; .* give swing",
        ),
        ({"motion": {"margin": "-5 deg"}}, "motion.margin: must be more than 0 and less than 90 deg; got -5 deg"),
        (
            {"motion": {"margin": "20 deg"}, "constraints": {"swing_transmission_angle": {"min": "30 deg"}}},
            "motion.margin: same as the min of",
        ),
        ({"objectives": {"time_ratio": "maximise"}}, "time_ratio needs a crank that rotates fully"),
        ({"objectives": {"peak_torque / 2": "minimise"}}, "peak_torque needs a crank that rotates fully"),
        ({"constraints": {"slow_stroke": "inward"}}, "slow_stroke: needs a rotating crank"),
        ({"objectives": {"peak_actuator_power": "minimise"}}, "give .motion. a law and a duration"),
        ({"robust": {}}, "robust: needs a rotating crank, or a lever; got a crank that swings"),
        ({"friction": {"crank_pin": {"radius": "1 m", "coefficient": 1.5}}}, "friction may lock every design"),
        (
            {"load": [{"positions": ["0 mm", "9 mm"], "forces": ["1 N", "0 N"], "measured_from": "inner dead centre"}]},
            "measure it from the crank pivot",
        ),
        (
            {"load": [{"torque_angles": ["0 deg", "9 deg"], "torques": ["1 N m", "0 N m"], "cycle": "720 deg"}]},
            "a cycle of 720 deg needs a crank that rotates fully",
        ),
        (
            {
                "load": [
                    {
                        "crank_angles": ["0 deg", "9 deg"],
                        "forces": ["1 N", "0 N"],
                        "measured_from": "outer dead centre",
                    }
                ]
            },
            "measure it from zero crank angle",
        ),
        ({"load": [{"bore": "50 mm", "suction": "1 bar", "discharge": "5 bar"}]}, "needs a crank that rotates fully"),
        (
            {"mechanism": JOB["mechanism"] | {"cylinders": {"phases": ["0 deg", "180 deg"]}}},
            "mechanism.cylinders: it needs a crank that rotates fully",
        ),
        (
            {"mechanism": JOB["mechanism"] | {"speed_profile": {"cosines": [0.1]}}},
            "mechanism.speed_profile: it needs a crank that rotates fully",
        ),
        (
            {"mechanism": JOB["mechanism"] | {"acceleration": "2 rad/s^2"}},
            "mechanism.acceleration: it needs a crank that rotates fully",
        ),
        (
            {"variables": JOB["variables"] | {"mechanism.speed": ["1 rpm", "2 rpm"]}},
            "mechanism.speed: a swing is set by .motion. instead",
        ),
    ],
)
def test_what_cannot_be_is_refused_in_a_sentence(tables: dict[str, Any], words: str) -> None:
    with pytest.raises(JobError, match=words):
        parse_job(changed(**tables))


def test_tables_of_a_full_turn_are_told_to_say_nothing_of_a_swing() -> None:
    loose = {"joint": "crank pin", "radial_clearance": "0.1 mm", "journal_radius": "10 mm"}
    given = changed(drive={"motor": {"torque": "10 N m"}}, clearance=loose)
    told = "only applies to a rotating crank and is ignored for a swing; leave it out"
    assert [note for note in job_notes(given) if "ignored for a swing" in note] == [
        f"drive: {told}",
        f"clearance: {told}",
    ]


def test_exponents_of_a_liquid_are_told_to_have_no_use() -> None:
    pump = {"bore": "50 mm", "suction": "1 bar", "discharge": "5 bar", "medium": "liquid", "clearance": 0.1}
    turning = changed(mechanism={"speed": "60 rpm"}, objectives={"peak_torque": "minimise"}, constraints={})
    turning = {key: value for key, value in turning.items() if key != "motion"}
    told = "load #1: a liquid is not compressed, so it has no expansion_exponent; leave it out"
    assert job_notes(turning | {"load": [pump | {"expansion_exponent": 1.2}]}) == [told]
    assert job_notes(turning | {"load": [pump]}) == []


def test_a_swing_needs_no_speed_and_one_that_is_given_is_told_and_changes_nothing() -> None:
    given = changed(mechanism=JOB["mechanism"] | {"speed": "-2 rpm"})
    designs = np.array([[1.4, 1.8, -0.05], [1.3, 2.1, 0.2]])
    names = ["peak_actuator_force", "swing_energy"]
    values = [parse_job(job).evaluate(designs, names) for job in (changed(), given)]
    assert np.isfinite(values[0]).all()
    assert np.array_equal(values[0], values[1])
    assert not any("speed" in note for note in job_notes(changed()))
    assert "mechanism.speed: a swing is set by [motion] instead" in job_notes(given)[-1]
    job = changed()
    del job["motion"]
    with pytest.raises(JobError, match=r"mechanism\.speed: is missing, but required"):
        parse_job(job | {"objectives": {"peak_torque": "minimise"}, "constraints": {}})


def test_quantities_of_a_swing_are_refused_without_one() -> None:
    job = changed(mechanism={"speed": "0.1 rpm"})
    del job["motion"]
    with pytest.raises(JobError, match="peak_actuator_force: needs a swinging crank; this crank rotates fully"):
        parse_job(job)


def test_a_load_along_the_line_is_no_reason_for_warnings() -> None:
    for load in ({"force": "300 N", "direction": "inward"}, {"force": "300 N", "opposes": "outward stroke"}):
        assert stroke_warnings(parse_job(changed(load=[load]))) == []


def random_designs(problem: Problem, count: int) -> np.ndarray[Any, np.dtype[np.float64]]:
    random = np.random.default_rng(3)
    ends = (problem.crank, problem.rod, problem.offset)
    return np.stack([random.uniform(end.lower, end.upper, count) for end in ends], axis=1)


@pytest.mark.slow
@pytest.mark.usefixtures("little")
def test_nothing_dominates_the_front_of_a_swing_and_all_of_it_is_stationary() -> None:
    limits = {"actuator_travel": {"min": "1.7 m", "max": "2.5 m"}, "rod / crank": {"max": 1.2}}
    problem = parse_job(changed(constraints=limits))
    front = solve(problem)
    assert front.status == "done"
    assert set(front.columns["status"]) == {"stationary"}
    turning = front.dimensions[:, 1] > front.dimensions[:, 0] + np.abs(front.dimensions[:, 2])
    assert not turning.all()  # designs that cannot turn through are among the best
    designs = random_designs(problem, 20_000)
    names = ["actuator_travel", "swing_transmission_angle", "rod_to_crank", "peak_actuator_force", "swing_angle_error"]
    values = problem.evaluate(designs, names)
    with np.errstate(invalid="ignore"):
        feasible = (values[:, 0] >= 1.7) & (values[:, 0] <= 2.5) & (values[:, 1] >= math.radians(10.0))
        feasible &= values[:, 2] <= 1.2
    assert feasible.sum() > 500
    for own in front.values:
        assert not (values[feasible][:, 3:] < own * (1.0 - 1e-9)).all(axis=1).any()
    again = solve(problem)
    assert np.array_equal(front.dimensions, again.dimensions)
    one = problem.analyse(front.dimensions[0])
    assert one["peak_actuator_force"] == pytest.approx(front.values[0, 0], rel=1e-12)
    assert "peak_torque" not in one
    with pytest.raises(AssemblyError, match="must close over the whole swing"):
        problem.analyse([1.4, 0.5, 0.0])
