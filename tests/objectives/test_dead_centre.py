"""Speed and dwell near a dead centre, against roots of the motion and sums by hand."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

from slidercrank.model.errors import InputError, JobError
from slidercrank.model.machine.mechanism import Branch, DeadCentre, Mechanism, SliderDistances
from slidercrank.model.machine.speed_profile import Harmonics
from slidercrank.objectives.dead_centre import DWELL_ANGLE, TOUCH_SPEED, angle_and_travel_rate_before_dead_centre
from slidercrank.optimise.job import parse_job
from slidercrank.optimise.solve import solve
from tests.model.cases import Array, linkage_of, random_designs

DESIGNS = random_designs(40, seed=3, least_margin=1e-3)
DISTANCE = 0.004


def passages(machine: Mechanism, design: Array) -> tuple[list[float], Any]:
    """Return the two crank angles at which the slider is at the distance from the dead centre, and its position."""
    linkage, (r, l, e) = linkage_of(design, machine.branch), design
    outer = machine.slider.dead_centre == "outer"
    place = math.sqrt((l + r) ** 2 - e**2) - DISTANCE if outer else math.sqrt((l - r) ** 2 - e**2) + DISTANCE

    def beyond(angle: Any) -> Any:
        return linkage.at(angle).slider_position * machine.sign - place

    grid = np.linspace(0.0, 2.0 * math.pi, 20_001)
    signs = np.sign(beyond(grid))
    ends = np.flatnonzero(signs[1:] != signs[:-1])
    return [brentq(beyond, grid[k], grid[k + 1], xtol=1e-15, rtol=1e-14) for k in ends], beyond


@pytest.mark.parametrize("branch", ["open", "crossed"])
@pytest.mark.parametrize("speed", [5.0, -5.0])
@pytest.mark.parametrize("dead_centre", ["outer", "inner"])
def test_speed_and_dwell_are_those_of_the_motion(dead_centre: DeadCentre, speed: float, branch: Branch) -> None:
    slider = SliderDistances(dead_centre=dead_centre, touch=DISTANCE, dwell=DISTANCE)
    machine = Mechanism(speed=speed, branch=branch, slider=slider)
    speeds, dwells = (of.evaluate(machine, DESIGNS).values for of in (TOUCH_SPEED, DWELL_ANGLE))
    for design, found_speed, found_dwell in zip(DESIGNS, speeds, dwells, strict=True):
        (first, second), beyond = passages(machine, design)
        velocities = [
            float(linkage_of(design, branch).at(angle, speed=speed).slider_velocity) * machine.sign
            for angle in (first, second)
        ]
        towards = max(velocities) if dead_centre == "outer" else -min(velocities)
        assert found_speed == pytest.approx(towards, rel=1e-9)
        within = (beyond(0.5 * (first + second)) > 0.0) == (dead_centre == "outer")
        assert found_dwell == pytest.approx(second - first if within else 2.0 * math.pi - second + first, rel=1e-9)


def test_a_triangle_of_3_4_5_by_hand() -> None:
    """Crank 3 normal to rod 4, at x = 5.

    There alpha = acos(3 / 5) and |x'| = r / cos(phi) = 3 5 / 4.
    """
    machine = Mechanism(speed=2.0, slider=SliderDistances(touch=2.0, dwell=2.0))
    design = np.array([[3.0, 4.0, 0.0]])
    assert TOUCH_SPEED.evaluate(machine, design).values[0] == pytest.approx(7.5, rel=1e-14)
    assert DWELL_ANGLE.evaluate(machine, design).values[0] == pytest.approx(2.0 * math.acos(0.6), rel=1e-14)


def test_a_stroke_that_is_no_longer_than_the_distance_has_neither() -> None:
    machine = Mechanism(speed=2.0, slider=SliderDistances(touch=0.21, dwell=0.21))
    for of in (TOUCH_SPEED, DWELL_ANGLE):
        found = of.evaluate(machine, np.array([[0.1, 0.4, 0.0], [0.11, 0.4, 0.0]]), gradients=True)
        assert np.isnan(found.values).tolist() == [True, False]
        assert found.gradients is not None
        assert np.isnan(found.gradients).all(axis=1).tolist() == [True, False]
        assert of.no_value_reason == "its stroke is not longer than the distance from the dead centre"


def test_a_speed_profile_and_a_distance_left_out_are_refused() -> None:
    touch = SliderDistances(touch=0.01)
    uneven = Mechanism(speed=2.0, slider=touch, speed_profile=Harmonics(cosines=(0.1,)))
    assert "constant speed" in str(TOUCH_SPEED.undefined_because([uneven]))
    assert "touch distance" in str(TOUCH_SPEED.undefined_because([Mechanism(speed=2.0)]))
    assert "dwell distance" in str(DWELL_ANGLE.undefined_because([Mechanism(speed=2.0, slider=touch)]))
    with pytest.raises(InputError, match="the touch distance of the slider must be positive"):
        SliderDistances(touch=-0.01)


JOB: dict[str, Any] = {
    "name": "Press",
    "mechanism": {
        "speed": "60 rpm",
        "slider": {"mass": "80 kg", "touch_distance": "12 mm", "dwell_distance": "0.5 mm", "dead_centre": "inner"},
    },
    "variables": {"crank": ["40 mm", "90 mm"], "rod": ["300 mm", "600 mm"], "offset": ["0 mm", "50 mm"]},
    "constraints": {"touch_speed": {"max": "250 mm/s"}},
    "objectives": {"dwell_angle": "maximise", "peak_torque": "minimise"},
}


def test_a_job_gives_the_distances_with_its_slider() -> None:
    machine = parse_job(JOB).mechanism
    assert machine.slider == SliderDistances(dead_centre="inner", touch=0.012, dwell=0.0005)
    with pytest.raises(JobError, match=r"mechanism\.slider\.touch_distance: .* positive"):
        parse_job(JOB | {"mechanism": {"speed": "60 rpm", "slider": {"mass": "80 kg", "touch_distance": "-1 mm"}}})


@pytest.mark.parametrize("branch", ["open", "crossed"])
@pytest.mark.parametrize("speed", [5.0, -5.0])
@pytest.mark.parametrize("dead_centre", ["outer", "inner"])
@pytest.mark.parametrize("share", [1e-12, 1e-9, 1e-5, 1e-2, 0.5, 0.99])
def test_angle_and_travel_before_a_dead_centre_at_any_distance(
    share: float, dead_centre: DeadCentre, speed: float, branch: Branch
) -> None:
    """By the motion from the angle that was found, with the most digits that numpy has."""
    slider, big = SliderDistances(dead_centre=dead_centre, touch=1.0), np.longdouble
    for crank, rod, offset in DESIGNS.tolist():
        design = np.array([crank, rod, offset])
        linkage = linkage_of(design, branch)
        distance = share * float(linkage.stroke)
        machine = Mechanism(speed=speed, branch=branch, slider=slider)
        (angle,), (travel,) = angle_and_travel_rate_before_dead_centre(machine, design, np.array([distance]))
        r, l, e = map(big, (crank, rod, offset))
        outer, sign = dead_centre == "outer", big(machine.sign)
        dead = np.sqrt((l + r) ** 2 - e * e) if outer else np.sqrt((l - r) ** 2 - e * e)
        along = np.arctan2(e, dead) + (0.0 if outer else big(np.pi))  # of the crank at the dead centre, open branch
        at = along - sign * big(machine.direction) * big(angle)
        sine = (e - r * np.sin(at)) / l
        x = r * np.cos(at) + l * np.sqrt(1.0 - sine * sine)
        rounding = 1e-17 * (crank + rod) / distance
        assert float(abs(dead - x)) == pytest.approx(distance, rel=max(1e-8, rounding))
        slope = -r * np.sin(at) + l * sine * r * np.cos(at) / (l * np.sqrt(1.0 - sine * sine))
        assert travel == pytest.approx(float(abs(slope)), rel=1e-7)


def test_a_distance_that_no_stroke_reaches_is_named_where_no_design_has_a_value() -> None:
    job = {
        "name": "far",
        "mechanism": {"speed": "60 rpm", "slider": {"mass": "1 kg", "touch_distance": "9 m"}},
        "variables": {"crank": ["20 mm", "60 mm"], "rod": ["100 mm", "400 mm"], "offset": ["0 mm", "50 mm"]},
        "objectives": {"touch_speed": "minimise"},
    }
    found = solve(parse_job(job))
    assert not len(found.dimensions)
    assert "touch speed has no value" in found.message
    assert "its stroke is not longer than the distance from the dead centre; change the ranges" in found.message
