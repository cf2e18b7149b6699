"""A crank speed that a job states directly, by the cycle time or by strokes per minute."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad

import slidercrank as sc
from slidercrank.model.errors import JobError
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.transient.speed_profile_cycle import speed_profile_cycle
from slidercrank.optimise.job import parse_job
from slidercrank.optimise.job.job_notes import job_notes

FOUR_STROKE = {"torque_angles": ["0 deg", "300 deg", "600 deg"], "torques": [0.0, -20.0, 0.0], "cycle": "720 deg"}
POINTS = ["0 deg", "90 deg", "180 deg", "270 deg"]


def job(mechanism: dict[str, Any], *, load: list[Any] | None = None, **variables: Any) -> dict[str, Any]:
    """Return a job whose crank turns as stated. variables: besides the lengths, paths without "mechanism."."""
    lengths = {"crank": ["20 mm", "40 mm"], "rod": ["100 mm", "200 mm"], "offset": "10 mm"}
    return {
        "name": "Press",
        "mechanism": {"slider": {"mass": "1 kg"}, **mechanism},
        "load": load or [],
        "variables": lengths | {f"mechanism.{path}": given for path, given in variables.items()},
        "objectives": {"peak_torque": "minimise"},
    }


def machine(mechanism: dict[str, Any], *, load: list[Any] | None = None) -> Mechanism:
    return parse_job(job(mechanism, load=load)).mechanism


def turn_seconds(machine: Mechanism) -> float:
    """Return the time of a turn: the integral of one over the speed, by adaptive quadrature between the knots."""
    profile = machine.speed_profile
    if profile is None:
        return 2.0 * math.pi / abs(machine.speed)

    def slowness(theta: float) -> float:
        return 1.0 / abs(machine.speed * float(profile.speed_ratio(np.array([theta]))[0]))

    knots = [0.0, *profile.knots, 2.0 * math.pi]
    return sum(quad(slowness, low, high, epsabs=0.0, epsrel=1e-12)[0] for low, high in pairwise(knots))


@pytest.mark.parametrize(
    "profile",
    [
        None,
        {"cosines": [0.0, 0.5]},
        {"cosines": [-0.3], "sines": [0.0, 0.2]},
        {"crank_angles": POINTS, "speeds": ["3 rpm", "2 rpm", "5 rpm", "4 rpm"]},
    ],
)
@pytest.mark.parametrize("way", [1.0, -1.0])
def test_a_profile_is_scaled_to_the_time_of_a_cycle(profile: dict[str, Any] | None, way: float) -> None:
    shape = dict(profile or {})
    if "speeds" in shape and way < 0.0:
        shape["speeds"] = [f"-{speed}" for speed in shape["speeds"]]
    more: dict[str, Any] = {"speed_profile": shape} if profile else {}
    more |= {"direction": "clockwise"} if way < 0.0 else {}
    for stated, seconds in (
        ({"cycle_time": "2 s"}, 2.0),
        ({"cycle_time": "25 ms"}, 0.025),
        ({"strokes_per_minute": 30}, 2.0),
        ({"strokes_per_minute": 2400.0}, 0.025),
    ):
        found = machine({**stated, **more})
        assert turn_seconds(found) == pytest.approx(seconds, rel=1e-11), stated
        assert math.copysign(1.0, found.speed) == way
        if profile:
            assert speed_profile_cycle(found, sc.Linkage(0.03, 0.1, 0.01)).period == pytest.approx(seconds, rel=1e-9)


def test_speeds_without_a_profile_are_the_same_to_rounding_however_they_are_stated() -> None:
    for rpm in (30, 60, 120, 300):
        speed = machine({"speed": f"{rpm} rpm"}).speed
        assert machine({"strokes_per_minute": rpm}).speed == pytest.approx(speed, rel=1e-15)
        assert machine({"cycle_time": f"{60 / rpm!r} s"}).speed == pytest.approx(speed, rel=1e-15)
    assert machine({"speed": "-30 rpm", "direction": "clockwise"}) == machine({"speed": "-30 rpm"})


def test_a_cycle_of_720_deg_takes_two_turns_and_a_stroke_a_minute_is_a_turn() -> None:
    load = [FOUR_STROKE]
    assert machine({"cycle_time": "0.1 s"}, load=load).speed == pytest.approx(2.0 * 2.0 * math.pi / 0.1, rel=1e-15)
    assert machine({"strokes_per_minute": 600}, load=load).speed == pytest.approx(20.0 * math.pi, rel=1e-15)


@pytest.mark.parametrize(
    ("mechanism", "said"),
    [
        ({}, r"mechanism\.speed: is missing, but required unless cycle_time or strokes_per_minute"),
        ({"speed": 3.0, "cycle_time": 2.0}, "got speed and cycle_time; leave out all but one"),
        ({"cycle_time": 2.0, "strokes_per_minute": 30}, "got cycle_time and strokes_per_minute; leave out all"),
        (
            {"speed": "30 rpm", "direction": "clockwise"},
            r'got 30 rpm and direction = "clockwise"; give speed = "-30 rpm"',
        ),
        ({"speed": "-30 rpm", "direction": "counter-clockwise"}, r'give speed = "30 rpm", or leave out direction'),
        ({"cycle_time": "0 s"}, "cycle_time: must be positive"),
        ({"cycle_time": "1 us"}, r"cycle_time: must be a time from 20 us to 1e9 s; got \"1 us\""),
        ({"cycle_time": "2e9 s"}, r"must be a time of at most 1e\+09 s"),
        (
            {"strokes_per_minute": 5e-8},
            r"strokes_per_minute: must be a number from 6e-8 to 3e6; got 5e-08; .* the unit",
        ),
        ({"strokes_per_minute": 4e6}, "strokes_per_minute: must be a number from 6e-8 to 3e6; got 4000000"),
        (
            {"speed": "5e-8 rpm"},
            r"speed: must be a speed from 6e-8 to 3e6 rpm, either way; got \"5e-8 rpm\"; .* the unit",
        ),
        ({"speed": "-4e6 rpm"}, r"speed: must be a speed from 6e-8 to 3e6 rpm, either way; got \"-4e6 rpm\""),
        ({"strokes_per_minute": -30}, "strokes_per_minute: must be positive; got -30"),
        ({"strokes_per_minute": "30 rpm"}, 'must be a number of strokes per minute; got "30 rpm"'),
        ({"cycle_time": 2.0, "direction": "left"}, 'must be "counter-clockwise" or "clockwise"; got "left"'),
        (
            {"cycle_time": 2.0, "acceleration": 1.0},
            "needs a cycle that repeats; got an acceleration .*; give speed",
        ),
        (
            {"cycle_time": 2.0, "speed_profile": {"crank_angles": POINTS, "speeds": [-3.0, -2.0, -3.0, -4.0]}},
            'direction = "counter-clockwise"; give direction = "clockwise"',
        ),
        (
            {
                "cycle_time": 2.0,
                "direction": "clockwise",
                "speed_profile": {"crank_angles": POINTS, "speeds": [3.0, 2.0, 3.0, 4.0]},
            },
            'with direction = "clockwise"; give direction = "counter-clockwise", or correct the signs',
        ),
    ],
)
def test_what_contradicts_itself_is_refused_with_what_to_do(mechanism: dict[str, Any], said: str) -> None:
    with pytest.raises(JobError, match=said):
        parse_job(job(mechanism))


def test_a_time_may_be_chosen_and_a_range_is_refused_with_that_of_the_speed() -> None:
    chosen = parse_job(job({"cycle_time": "2 s"}, cycle_time={"choices": ["1 s", "2 s", "4 s"]}))
    speeds = [part.mechanism.speed * 30.0 / math.pi for part in chosen.parts()]
    assert speeds == pytest.approx([60.0, 30.0, 15.0], rel=1e-15)
    ways = parse_job(
        job(
            {"strokes_per_minute": 30, "direction": "clockwise"},
            direction={"choices": ["clockwise", "counter-clockwise"]},
        )
    )
    assert [part.mechanism.direction for part in ways.parts()] == [-1.0, 1.0]
    said = r'got a range of cycle_time; .* variables.mechanism.speed = \["-60 rpm", "-30 rpm"\], or make'
    for given in (["1 s", "2 s"], {"values": ["1 s", "2 s"]}):
        with pytest.raises(JobError, match=said):
            parse_job(job({"cycle_time": "2 s", "direction": "clockwise"}, cycle_time=given))
    said = "got mechanism.speed, but the job gives mechanism.cycle_time; give speed in .mechanism. in place of cycle"
    with pytest.raises(JobError, match=said):
        parse_job(job({"cycle_time": "2 s"}, speed=["30 rpm", "60 rpm"]))
    assert parse_job(job({"cycle_time": "2 s"}), {"mechanism.cycle_time": "1 s"}).mechanism.speed == pytest.approx(
        2.0 * math.pi, rel=1e-15
    )


def test_the_slowest_and_the_fastest_crank_are_accepted_however_they_are_stated() -> None:
    for least in ({"speed": "6e-8 rpm"}, {"strokes_per_minute": 6e-8}, {"cycle_time": "1e9 s"}):
        assert machine(least).speed == pytest.approx(2e-9 * math.pi, rel=1e-14)
    for most in ({"speed": "3e6 rpm"}, {"strokes_per_minute": 3e6}, {"cycle_time": "20 us"}):
        assert machine(most).speed == pytest.approx(1e5 * math.pi, rel=1e-14)


def test_a_catalogue_of_a_speed_that_is_stated_otherwise_says_what_to_give(tmp_path: Path) -> None:
    stated = job({"cycle_time": "2 s"}) | {"choice": [{"name": "gearmotor", "file": "motors.csv"}]}
    (tmp_path / "motors.csv").write_text("name,mechanism.strokes_per_minute\na,10\nb,20\n", encoding="utf-8")
    said = "the job gives mechanism.cycle_time; give strokes_per_minute in .mechanism. in place of cycle_time"
    with pytest.raises(JobError, match=said):
        sc.problem(stated, folder=tmp_path)


def test_a_front_is_that_of_the_same_speed() -> None:
    stated = job({"cycle_time": "0.2 s"}) | {"optimiser": {"designs": 5, "seed": 2, "samples": 256}}
    front = sc.solve(sc.problem(stated))
    other = sc.solve(sc.problem({**stated, "mechanism": {**stated["mechanism"], "cycle_time": "0.4 s"}}))
    assert front.values[:, 0].min() == pytest.approx(4.0 * other.values[:, 0].min(), rel=1e-9)  # inertia: speed squared


def test_a_swing_is_told_that_it_has_no_time_of_a_cycle() -> None:
    swing = job({"cycle_time": "2 s", "direction": "clockwise"})
    swing |= {"motion": {"kind": "swing", "from": "0 deg", "to": "60 deg"}, "objectives": {"rod_to_crank": "minimise"}}
    notes = job_notes(swing)
    assert "mechanism.cycle_time: a swing is set by [motion] instead; leave out the time" in notes
    assert any(note.startswith("mechanism.direction: a swing") for note in notes)
