"""Optimal motion laws against closed forms, random laws, their limits on a dense grid, and their bounds."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

from slidercrank.model.cycle.cycle import cycle
from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.drive import ConstantTorque, Drive
from slidercrank.model.machine.links_and_joints import RigidLink
from slidercrank.model.machine.loads.position_table import PositionTable
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.motion_law.law_turn import LawTurn
from slidercrank.model.motion_law.motion_law import MotionLaw
from slidercrank.model.transient.speed_profile_cycle import speed_profile_cycle
from slidercrank.optimise.motion_law.input_words import LawObjective
from slidercrank.optimise.motion_law.law_limits import LawRequest, Reachable, resolve_limits
from slidercrank.optimise.motion_law.optimal_law import GAP, LIMIT_TOLERANCE, OptimalLaw, optimal_law
from tests.case_count import case_count
from tests.model.law_cases import random_case

pytest.importorskip("cvxpy")

TURN = 2.0 * math.pi
TORQUES: tuple[LawObjective, ...] = ("peak torque", "rms torque")
RPM = math.pi / 30.0
FEEDER = Mechanism(
    speed=-2400.0 * RPM,
    crank=RigidLink(mass=0.2),
    rod=RigidLink(mass=0.5),
    slider_mass=0.8,
    gravity=(0.0, -9.81),
    loads=(StrokeForce(outward=-2060.0, inward=60.0),),
)
LINKAGE = Linkage(0.04, 0.1, 0.02)
NARROW: dict[str, Any] = {"least_speed": 1920.0 * RPM, "greatest_speed": 2880.0 * RPM}


def require_within_limits(found: OptimalLaw) -> None:
    """Check the limits of a law at 20,000 angles by the inverse dynamics of any speed."""
    law, limits, request = found.law, found.limits, found.limits.request
    angle = np.linspace(0.0, TURN, 20_000)
    speed, acceleration = law.speed_at(angle), law.acceleration_at(angle)
    curves = cycle(law.turn.machine, law.turn.linkage, angle, speed=speed, acceleration=acceleration)
    assert np.all(speed * law.turn.way >= limits.least_speed * (1.0 - LIMIT_TOLERANCE))
    assert np.all(speed * law.turn.way <= limits.greatest_speed * (1.0 + LIMIT_TOLERANCE))
    if request.torque_limit is not None:
        assert np.abs(curves.torque).max() <= request.torque_limit * (1.0 + LIMIT_TOLERANCE)
    if request.slider_speed is not None:
        assert np.abs(curves.slider_velocity).max() <= request.slider_speed * (1.0 + LIMIT_TOLERANCE)
    if request.crank_acceleration is not None:
        assert np.abs(acceleration).max() <= request.crank_acceleration * (1.0 + LIMIT_TOLERANCE)
    if request.window is not None and request.window_speed is not None:
        dead = law.turn.linkage.dead_centres[1]
        towards = curves.slider_velocity * law.turn.linkage.sign > 0.0
        inside = towards & (np.abs(curves.slider_position - dead) <= request.window * (1.0 - 1e-9))
        assert inside.sum() > 100
        assert np.abs(curves.slider_velocity[inside]).max() <= request.window_speed * (1.0 + LIMIT_TOLERANCE)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(case_count(4, 12)))
def test_laws_of_random_machines_keep_their_limits_and_are_near_their_bound(seed: int) -> None:
    machine, linkage = random_case(seed)
    random = np.random.default_rng([412, seed])
    mean = abs(machine.speed)
    request = LawRequest(
        objective=TORQUES[seed % 2],
        least_speed=mean * (1.0 - random.uniform(0.1, 0.4)),
        greatest_speed=mean * (1.0 + random.uniform(0.1, 0.6)),
    )
    found = optimal_law(machine, linkage, request)
    require_within_limits(found)
    judged = speed_profile_cycle(found.law.turn.machine, linkage, found.law.crank_motion)
    assert judged.period == pytest.approx(TURN / mean, rel=1e-9)
    assert found.proven or found.relaxed
    assert found.bound <= found.value * (1.0 + 1e-9)
    value = judged.peaks["torque"].value if request.objective == "peak torque" else judged.rms_torque
    assert value == pytest.approx(found.value, rel=1e-7)
    even = speed_profile_cycle(found.law.turn.machine, linkage)
    constant = even.peaks["torque"].value if request.objective == "peak torque" else even.rms_torque
    assert value <= constant * (1.0 + 1e-3)


def test_without_limits_the_least_peak_is_the_work_of_a_turn_over_its_angle() -> None:
    heavy = replace(FEEDER, drive=Drive(motor=ConstantTorque(torque=0.0), flywheel=0.02))
    found = optimal_law(heavy, LINKAGE, LawRequest())
    work = 2000.0 * float(LINKAGE.stroke) + 2.0 * 60.0 * float(LINKAGE.stroke)
    assert found.bound == pytest.approx(work / TURN, rel=1e-9)
    assert found.value == pytest.approx(work / TURN, rel=2e-4)
    assert found.law.period == pytest.approx(0.025, rel=1e-9)


def test_a_law_without_loads_needs_no_torque() -> None:
    free = replace(FEEDER, loads=(), gravity=(0.0, 0.0))
    found = optimal_law(free, LINKAGE, LawRequest())
    constant = speed_profile_cycle(found.law.turn.machine, LINKAGE).peaks["torque"].value
    assert found.value < 1e-6 * constant
    assert found.gap == 0.0
    energy = found.law.node_energies
    assert np.ptp(energy) < 1e-6 * energy.mean()


@pytest.mark.parametrize(
    "limits",
    [
        {"timing": "at most"},
        {"slider_speed": 9.7},
        {"window": 0.01, "window_speed": 6.5},
        pytest.param({"crank_acceleration": 12_000.0}, marks=pytest.mark.slow),
    ],
)
def test_the_feeder_keeps_each_limit_and_its_law_is_proven(limits: dict[str, Any]) -> None:
    found = optimal_law(FEEDER, LINKAGE, LawRequest(**NARROW, **limits))
    require_within_limits(found)
    assert found.gap <= GAP
    free = optimal_law(FEEDER, LINKAGE, LawRequest(**NARROW)).value
    assert found.value >= free * (1.0 - 1e-3)


def test_the_bound_of_least_rms_torque_is_near_within_a_working_window() -> None:
    limits = {"window": 0.01, "window_speed": 6.5, **NARROW}
    found = optimal_law(FEEDER, LINKAGE, LawRequest(objective="rms torque", **limits))
    require_within_limits(found)
    assert not found.relaxed
    assert found.gap < 5e-3


def test_the_shortest_cycle_and_the_least_peak_answer_each_other() -> None:
    shortest = optimal_law(
        FEEDER, LINKAGE, LawRequest(objective="cycle time", torque_limit=90.0, least_speed=NARROW["least_speed"])
    )
    require_within_limits(shortest)
    assert shortest.gap <= GAP
    limits: dict[str, Any] = {"timing": "at most", "least_speed": NARROW["least_speed"]}
    limits |= {"greatest_speed": shortest.limits.greatest_speed}
    same = optimal_law(FEEDER, LINKAGE, LawRequest(cycle_time=shortest.value, **limits))
    assert same.bound <= 90.0 * (1.0 + 1e-9)
    shorter = LawRequest(cycle_time=shortest.bound * (1.0 - 1e-6), **limits)
    assert optimal_law(FEEDER, LINKAGE, shorter).value >= 90.0


def test_no_random_law_is_better_than_the_bound() -> None:
    random = np.random.default_rng(7)
    wide: dict[str, Any] = {"least_speed": 1000.0 * RPM, "greatest_speed": 4000.0 * RPM}
    limits = resolve_limits(FEEDER, LINKAGE, LawRequest(**wide))
    turn = LawTurn(FEEDER, LINKAGE)
    found = {name: optimal_law(FEEDER, LINKAGE, LawRequest(objective=name, **wide)) for name in TORQUES}
    reachable = Reachable(turn, limits)
    low, high = limits.energy_limits(turn.angle, turn.terms.inertia, turn.terms.travel)
    steady = turn.end_terms.load[0] + 0.5 * FEEDER.speed**2 * turn.end_terms.inertia_slope[0]
    tried = 0
    for _ in range(200):
        phases = np.arange(1, 5)[:, None] * turn.passed
        waves = random.normal(size=(2, 4)) * random.uniform(0.0, 20.0)
        law = MotionLaw.from_torque_made_periodic(
            turn, steady + waves[0] @ np.cos(phases) + waves[1] @ np.sin(phases), 0.0
        )
        floor = -float(law.node_energies.min())

        def late(energy: float, law: MotionLaw = law) -> float:
            return replace(law, start_energy=energy).period - limits.cycle_time

        law = replace(law, start_energy=float(brentq(late, floor + 1e-6, floor + 1e6, xtol=1e-12)))
        energy, peak = law.node_energies, float(np.abs(law.torque).max())
        if np.all((energy > low) & (energy < high)):
            tried += 1
            reach = reachable.laws_within(peak)
            assert reach.exists
            assert np.all(energy >= reach.slowest * (1.0 - 1e-9))
            assert np.all(energy <= reach.fastest * (1.0 + 1e-9))
            assert reach.shortest <= law.period * (1.0 + 1e-9)
            assert law.period <= reach.longest * (1.0 + 1e-9)
            assert peak >= found["peak torque"].bound * (1.0 - 1e-9)
            assert law.rms_torque >= found["rms torque"].bound * (1.0 - 1e-9)
            assert law.rms_torque >= found["rms torque"].value * (1.0 - 1e-3)
    assert tried > 50


REFUSALS: list[tuple[dict[str, Any], str]] = [
    (
        {"torque_limit": 20.0},
        r"the loads absorb 173\.\d+ J in a turn, a mean torque of 27\.\d+ N m; torque_limit is 20 N m; raise it",
    ),
    (
        {"torque_limit": 60.0, **NARROW},
        r"a law within these limits needs a torque of at least 7\d\.\d+ N m; torque_limit is 60 N m; raise it",
    ),
    ({"torque_limit": 60.0, **NARROW}, r"needs a torque of at least 74\.\d+ N m"),
    ({"cycle_time": 0.01, **NARROW}, "needs a mean crank speed of 6000 rpm; greatest_speed is 2880 rpm"),
    ({"cycle_time": 0.1, **NARROW}, "needs a mean crank speed of 600 rpm; least_speed is 1920 rpm"),
    ({"slider_speed": 7.0, **NARROW}, r"the slider's speed limit allows \d+.* rpm, and least_speed is 1920 rpm"),
    (
        {"slider_speed": 5.0, "least_speed": 100.0},
        r"speed limits allow no cycle shorter than 0\.03\d+ s",
    ),
    (
        {"crank_acceleration": 100.0, "slider_speed": 9.7, **NARROW},
        r"needs a crank acceleration of at least \d+",
    ),
    ({"window": 1.0, "window_speed": 1.0}, "window must be less than the stroke, 81.9955 mm; got 1000 mm"),
    ({"window": 0.01}, "a working window needs its distance and its slider speed; got only one; give window_speed"),
    ({"window_speed": 1.0}, "got only one; give window"),
    ({"least_speed": 300.0, "greatest_speed": 200.0}, "least_speed must not exceed greatest_speed"),
    ({"objective": "cycle time"}, "the shortest cycle needs a torque limit; got none; give torque_limit"),
    (
        {"objective": "cycle time", "torque_limit": 10.0},
        r"a mean torque of 27\.\d+ N m; torque_limit is 10 N m; raise it",
    ),
    ({"objective": "rms torque", "timing": "at most"}, "the RMS torque needs an exact cycle time"),
]


@pytest.mark.parametrize(("limits", "message"), REFUSALS)
def test_limits_that_leave_no_law_are_refused_with_the_amount(limits: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        optimal_law(FEEDER, LINKAGE, LawRequest(**limits))


PRESS = Mechanism(
    speed=-45.0 * RPM,
    slider_mass=8.0,
    loads=(
        PositionTable(
            positions=(0.0, 0.01, 0.012), forces=(-2e4, -2e4, 0.0), datum="outer dead centre", during="outward stroke"
        ),
    ),
    drive=Drive(gear_ratio=40.0, motor_inertia=8e-4, flywheel=0.2),
)


@pytest.mark.slow
def test_a_press_that_may_run_faster_needs_no_more_torque() -> None:
    """The best law within the widest limit is far too fast: no law with the cycle time is near."""
    requests = (
        LawRequest(greatest_speed=150.0 * RPM),
        LawRequest(greatest_speed=200.0 * RPM, torque_limit=100.0),
    )
    found = [optimal_law(PRESS, Linkage(0.03, 0.3, 0.0), request) for request in requests]
    assert all(law.proven for law in found)
    assert found[1].value <= found[0].value * (1.0 + GAP)
    for law in found:
        require_within_limits(law)
        assert law.law.period == pytest.approx(4.0 / 3.0, rel=1e-6)


def test_a_crank_turns_no_faster_than_its_motor_allows() -> None:
    assert PRESS.drive is not None
    drive = replace(PRESS.drive, greatest_speed=4000.0 * RPM)
    machine, linkage = replace(PRESS, drive=drive), Linkage(0.03, 0.3, 0.0)
    for asked, greatest in ((None, 100.0), (150.0, 100.0), (90.0, 90.0)):
        request = LawRequest(greatest_speed=None if asked is None else asked * RPM)
        assert resolve_limits(machine, linkage, request).greatest_speed == pytest.approx(greatest * RPM, rel=1e-12)
    slow = replace(machine, drive=replace(drive, greatest_speed=1600.0 * RPM))
    with pytest.raises(InputError, match="the motor's greatest speed over the gear ratio is 40 rpm; raise it"):
        resolve_limits(slow, linkage, LawRequest())


def test_a_machine_without_speed_needs_a_cycle_time() -> None:
    still = replace(FEEDER, speed=0.0)
    with pytest.raises(InputError, match="needs a cycle time; got a machine without speed; give --cycle-time"):
        optimal_law(still, LINKAGE, LawRequest(), names={"cycle_time": "--cycle-time"})
    assert optimal_law(still, LINKAGE, LawRequest(cycle_time=0.025)).law.period == pytest.approx(0.025)


@pytest.mark.parametrize("value", [math.nan, math.inf, 0.0, -1.0])
def test_numbers_that_are_not_positive_are_refused(value: float) -> None:
    with pytest.raises(InputError, match="cycle_time of a motion law must be positive and finite"):
        LawRequest(cycle_time=value)
