"""Press and pump against calculation by hand: separate formulas, bisection, integrals, energy."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any, Literal

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.arrangement import Arrangement
from slidercrank.model.machine.links_and_joints import RigidLink
from slidercrank.model.machine.loads.compressor import Compressor
from slidercrank.model.machine.mechanism import Branch, Mechanism, SliderDistances
from slidercrank.model.machine.speed_profile import Harmonics
from slidercrank.objectives.dead_centre import TOUCH_SPEED
from slidercrank.service.questions.press import analysis as press
from slidercrank.service.questions.pump import analysis as pump
from tests.model.cases import linkage_of, random_designs
from tests.service.conftest import Command

DESIGNS = random_designs(6, seed=11, least_margin=0.02)
PUMP = Compressor(bore=0.05, low=1e5, high=6e5, compression_exponent=0.0, expansion_exponent=0.0)
AIR = Compressor(bore=0.07, low=1e5, high=8e5, clearance=0.05, compression_exponent=1.3, expansion_exponent=1.2)
TURN = 2.0 * math.pi
GRID = np.linspace(0.0, TURN, 721)


def root(of: Callable[[float], float], low: float, high: float) -> float:
    return float(brentq(of, low, high, xtol=1e-15, rtol=1e-15))


class Slider:
    """The slider of a linkage by its closing triangle, and its travel per crank angle by a complex step."""

    def __init__(self, lengths: np.ndarray, branch: Branch) -> None:
        self.lengths, self.branch = lengths, branch

    def position(self, theta: complex) -> complex:
        crank, rod, offset = self.lengths
        along = np.sqrt(rod**2 - (offset - crank * np.sin(theta)) ** 2)
        return complex(crank * np.cos(theta) + (along if self.branch == "open" else -along))

    def travel(self, theta: float) -> float:
        return self.position(theta + 1e-30j).imag / 1e-30

    def dead_centres(self) -> list[float]:
        """Return the crank angles of the outer and the inner dead centre, that is, the farther and the nearer one."""
        signs = np.sign([self.travel(at) for at in GRID])
        found = [root(self.travel, GRID[k], GRID[k + 1]) for k in np.flatnonzero(np.diff(signs))]
        return sorted(found, key=lambda at: -abs(self.position(at)))

    def reached(self, dead: float, distance: float, way: float, most: float = 1.0) -> float:
        """Return the crank angle from a dead centre, on one side of it, to a distance."""
        there = self.position(dead).real
        return root(lambda by: abs(self.position(dead + way * by).real - there) - distance, 0.0, most)


@pytest.mark.parametrize("where", ["outer", "inner"])
@pytest.mark.parametrize("branch", ["open", "crossed"])
@pytest.mark.parametrize("speed", [5.0, -5.0])
def test_force_speed_work_and_dwell_are_those_by_hand(
    where: Literal["outer", "inner"], branch: Branch, speed: float
) -> None:
    machine = Mechanism(speed=speed, branch=branch, slider=SliderDistances(dead_centre=where, dwell=1e-3))
    way = math.copysign(1.0, speed)
    for lengths in DESIGNS:
        linkage, slider = linkage_of(lengths, branch), Slider(lengths, branch)
        touch = 0.3 * float(linkage.stroke)
        found: Any = press.numbers(machine, linkage, touch_distance=touch, rated_torque=80.0)
        dead, other = slider.dead_centres() if where == "outer" else reversed(slider.dead_centres())
        columns = (found[key] for key in ("distances_mm", "angles_deg", "forces_N", "speeds_m_s"))
        for distance, angle, force, pace in zip(*columns, strict=True):
            before = slider.reached(dead, distance / 1e3, -way, (way * (dead - other)) % TURN)
            slope = abs(slider.travel(dead - way * before))
            assert math.radians(angle) == pytest.approx(before, rel=1e-9)
            assert force == pytest.approx(80.0 / slope, rel=1e-9)
            assert pace == pytest.approx(slope * abs(speed), rel=1e-9)
            assert force * pace == pytest.approx(80.0 * abs(speed), rel=1e-12)  # power
        sides = sum(slider.reached(dead, 1e-3, side) for side in (1.0, -1.0))
        assert math.radians(found["dwell_angle_deg"]) == pytest.approx(sides, rel=1e-9)
        assert found["dwell_time_s"] == pytest.approx(sides / abs(speed), rel=1e-9)
        assert found["touch_force_N"] == found["forces_N"][-1]

    reach = (way * (dead - other)) % TURN

    def force_at(distance: float) -> float:
        return 80.0 / abs(slider.travel(dead - way * slider.reached(dead, distance, -way, reach)))

    work, _ = quad(force_at, 0.1 * touch, touch, epsrel=1e-10)  # nearer, the force goes to infinity
    assert found["work_J"] - 80.0 * math.radians(found["angles_deg"][0]) == pytest.approx(work, rel=1e-9)


def test_a_press_takes_distances_of_its_job_and_the_peak_torque_of_its_design() -> None:
    linkage = Linkage(0.05, 0.3, 0.01)
    machine = Mechanism(speed=5.0, slider_mass=4.0, crank=RigidLink(mass=1.0), slider=SliderDistances(touch=0.012))
    own: Any = press.numbers(machine, linkage)
    given: Any = press.numbers(machine, linkage, touch_distance=0.012, rated_torque=own["rated_torque_Nm"])
    assert own["torque_is_peak_of_design"]
    assert own == given | {"torque_is_peak_of_design": True}
    speed = TOUCH_SPEED.evaluate(machine, np.array([[0.05, 0.3, 0.01]])).values[0]
    assert own["touch_speed_m_s"] == pytest.approx(speed, rel=1e-12)
    still: Any = press.numbers(replace(machine, speed=0.0), linkage, rated_torque=1.0)
    assert still["touch_speed_m_s"] is still["speeds_m_s"] is still["dwell_angle_deg"] is None


def test_along_a_speed_profile_a_press_has_forces_and_angles_but_no_speeds_and_times() -> None:
    linkage = Linkage(0.05, 0.3, 0.01)
    even = Mechanism(speed=5.0, slider=SliderDistances(touch=0.012, dwell=1e-3))
    uneven = replace(even, speed_profile=Harmonics(cosines=(0.2,), sines=(0.1,)))
    given, found = (press.numbers(machine, linkage, rated_torque=80.0) for machine in (even, uneven))
    lacking = dict.fromkeys(("touch_speed_m_s", "speeds_m_s", "dwell_time_s"))
    assert found == given | lacking
    panels = [len(press.figure(machine, linkage, rated_torque=80.0).panels) for machine in (even, uneven)]
    assert panels == [2, 1]


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        ({}, "a touch distance is missing; give it as an input"),
        ({"touch_distance": 0.01}, "the peak torque of this design is zero; give a rated torque"),
        ({"touch_distance": 0.2, "rated_torque": 1.0}, "less than the stroke, 100 mm; got 200 mm"),
        ({"touch_distance": 0.01, "rated_torque": 1.0, "dwell_distance": 0.1}, "less than the stroke, 100 mm; got 100"),
    ],
)
def test_what_a_press_cannot_be_told_is_said(given: dict[str, float], sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        press.numbers(Mechanism(speed=5.0), Linkage(0.05, 0.3, 0.0), **given)


@pytest.mark.parametrize("speed", [7.0, -7.0])
@pytest.mark.parametrize("branch", ["open", "crossed"])
@pytest.mark.parametrize("phases", [(0.0,), (0.0, 2.0, 4.0)])
def test_flow_and_torque_of_a_pump_are_those_by_hand(phases: tuple[float, ...], branch: Branch, speed: float) -> None:
    machine = Mechanism(
        speed=speed,
        branch=branch,
        slider_mass=3.0,  # which counts for nothing here
        loads=(PUMP,),
        arrangement=Arrangement(phases=phases) if len(phases) > 1 else None,
    )
    for lengths in DESIGNS:
        linkage = linkage_of(lengths, branch)
        found: Any = pump.numbers(machine, linkage)
        swept = len(phases) * 0.25 * math.pi * PUMP.bore**2 * float(linkage.stroke)
        assert found["flow_L_min"] == pytest.approx(6e4 * swept * abs(speed) / TURN, rel=1e-9)
        assert abs(found["mean_torque_Nm"]) == pytest.approx((PUMP.high - PUMP.low) * swept / TURN, rel=1e-9)
        together = pump.figure(machine, linkage).panels[0].lines[-1]
        mean = np.trapezoid(together.y, together.x) / (together.x[-1] - together.x[0])
        assert together.y.min() >= 0.0
        assert 6e4 * mean == pytest.approx(found["flow_L_min"], rel=1e-4)
        assert (together.y.max() - together.y.min()) / mean == pytest.approx(found["flow_ripple"], rel=2e-3)


def test_gas_has_no_ripple_and_a_machine_without_cylinders_no_flow() -> None:
    linkage = Linkage(0.05, 0.2, 0.01)
    found: Any = pump.numbers(Mechanism(speed=20.0, loads=(AIR,)), linkage)
    assert found["flow_ripple"] is None
    assert len(pump.figure(Mechanism(speed=20.0, loads=(AIR,)), linkage).panels) == 1
    with pytest.raises(InputError, match="it needs a compressor or pump; got none"):
        pump.numbers(Mechanism(speed=20.0), linkage)


def test_a_press_without_a_job_needs_its_distance_and_its_torque(command: Command) -> None:
    linkage = Linkage(0.03, 0.16, 0.01)
    asked = ("analyse", "--crank", "30 mm", "--rod", "160 mm", "--offset", "10 mm", "--show", "press")
    given = ("--touch-distance", "5 mm", "--rated-torque", "50 N m")
    found = json.loads(command(*asked, *given, "--json").stdout)["press"]
    expected = press.numbers(Mechanism(), linkage, touch_distance=0.005, rated_torque=50.0)
    assert found == expected
    assert (found["touch_speed_m_s"], found["touch_force_N"] > 0.0) == (None, True)
    for few, reason in ((given[:2], "give a rated torque, such as 50 N m"), (given[2:], "a touch distance is missing")):
        refused = command(*asked, *few)
        assert (refused.exit_code, refused.stderr.count(reason)) == (2, 1)
