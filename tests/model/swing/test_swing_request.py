"""A swing that is asked for: by angles or places, over that of a job."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from slidercrank.model.errors import InputError
from slidercrank.model.machine.mechanism import Mechanism, Start
from slidercrank.model.swing.request_and_summary import SwingRequest, resolve_swing, summarise_swing
from slidercrank.model.swing.swing import Swing
from slidercrank.optimise.job import load_job, parse_job
from slidercrank.optimise.problem.problem import Problem
from tests.model.swing.swings import random_swings

JOB = Swing(start=0.2, end=1.7, driver="slider", law="harmonic", duration=3.0, actuator_tolerance=1e-3)
DESIGN = [1.4, 1.8, -0.05]


def free(job: dict[str, object]) -> Problem:
    return parse_job(
        {
            "name": "free",
            "mechanism": {"slider": {"mass": "400 kg"}, "crank": {"mass": "1200 kg"}, "gravity": "9.81 m/s^2"},
            "motion": {"kind": "swing", "driver": "slider", **job},
            "variables": {
                "crank": "1.4 m",
                "rod": ["1.2 m", "3 m"],
                "offset": "-50 mm",
                "motion.from": ["0 deg", "40 deg"],
            },
            "objectives": {"peak_actuator_force": "minimise"},
        }
    )


def test_two_places_are_the_swing_between_the_angles_that_reach_them() -> None:
    sides = set()
    for mechanism, linkage, swing in random_swings(30, seed=91, driver="slider"):
        expected = summarise_swing(mechanism, linkage, swing)
        ways = expected.slider_positions
        asked = SwingRequest(
            slider_start=ways[0], slider_end=ways[1], driver="slider", law=swing.law, duration=swing.duration
        )
        if swing.law == "table":
            continue
        matches = []
        for side in ("left", "right"):
            machine, found = resolve_swing(mechanism, None, replace(asked, side=side))
            try:
                made = summarise_swing(machine, linkage, found)
            except InputError:  # not on this branch with the crank pin there
                continue
            turned = (made.crank_angles[0] - expected.crank_angles[0]) / (2.0 * np.pi)
            if abs(turned - round(turned)) < 1e-6:
                matches.append((made, round(turned)))
                sides.add(side)
        ((made, turns),) = matches
        assert made.swing_angle == pytest.approx(expected.swing_angle, rel=1e-6)
        if turns:  # a spring on the crank is wound by them
            continue
        assert made.peak_drive.value == pytest.approx(expected.peak_drive.value, rel=1e-5, abs=1e-9)
        assert made.energy_forward == pytest.approx(expected.energy_forward, rel=1e-5, abs=1e-9)
    assert sides == {"left", "right"}


def test_what_is_not_asked_stays_as_the_job_has_it() -> None:
    machine = Mechanism()
    assert resolve_swing(machine, JOB, SwingRequest()) == (machine, JOB)
    assert resolve_swing(machine, JOB, SwingRequest(end=1.0))[1] == replace(JOB, end=1.0)
    crank = resolve_swing(machine, JOB, SwingRequest(driver="crank"))[1]
    assert (crank.driver, crank.actuator_tolerance, crank.duration) == ("crank", 0.0, 3.0)
    slow = resolve_swing(machine, JOB, SwingRequest(law="slow"))[1]
    assert (slow.law, slow.duration, slow.driver) == ("slow", None, "slider")
    places = resolve_swing(machine, JOB, SwingRequest(slider_start=3.0, slider_end=1.0, side="right"))[1]
    assert (places.stated_for, places.side, places.law, places.driver) == ("slider", "right", "harmonic", "slider")
    table = replace(JOB, law="table", points=((0.0, 0.0), (0.5, 0.4), (1.0, 1.0)))
    assert resolve_swing(machine, table, SwingRequest(law="table"))[1] == table
    assert resolve_swing(machine, table, SwingRequest(law="cycloidal"))[1].points == ()
    assert resolve_swing(machine, None, SwingRequest(start=0.1, end=0.4))[1] == Swing(start=0.1, end=0.4)


def test_a_start_takes_the_end_along_where_the_job_states_the_angle() -> None:
    follows = replace(JOB, follows=True)
    own = replace(Mechanism(), start=Start(angle=0.5))
    machine, found = resolve_swing(own, follows, SwingRequest())
    assert (found.start, found.end, machine.start) == (0.5, 2.0, Start())
    assert resolve_swing(own, follows, SwingRequest(start=0.6))[1].end == pytest.approx(2.1)
    assert resolve_swing(own, follows, SwingRequest(start=0.6, end=1.0))[1].end == 1.0
    assert resolve_swing(own, JOB, SwingRequest(start=0.6))[1].end == JOB.end


def test_the_swing_of_a_problem_is_that_of_its_quantities() -> None:
    for problem, design in (
        (load_job("runs/support.toml"), DESIGN),
        (free({"from": "11 deg", "swing": "90 deg"}), [*DESIGN, 0.4]),
        (free({"from": "11 deg", "to": "100 deg"}), [*DESIGN, 0.3]),
    ):
        found = problem.swing(design)
        force, angle = problem.evaluate([design], ["peak_actuator_force", "swing_transmission_angle"])[0]
        assert abs(found.peak_drive.value) == pytest.approx(force, rel=1e-9)
        assert found.least_transmission.value == pytest.approx(angle, rel=1e-9)
        ways = found.slider_positions
        again = problem.swing(design, slider_start=ways[0], slider_end=ways[1])
        assert again.crank_angles == pytest.approx(found.crank_angles, abs=1e-7)
        assert again.peak_drive.value == pytest.approx(found.peak_drive.value, rel=1e-6)


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        (SwingRequest(start=0.1), "got no end; give both, or use a job"),
        (SwingRequest(slider_end=0.1), "from one slider position to another; got no slider_start"),
        (SwingRequest(start=0.1, slider_end=0.3), "got start, slider_end; give only one of these pairs"),
        (SwingRequest(), "got no start"),
        (SwingRequest(start=0.1, end=0.4, law="table"), "got law table; write its points as law_times"),
        (SwingRequest(slider_start=0.1, slider_end=0.1), "needs two different slider positions"),
    ],
)
def test_what_is_missing_is_a_sentence(asked: SwingRequest, words: str) -> None:
    with pytest.raises(InputError, match=words):
        resolve_swing(Mechanism(), None, asked)
