"""Motion under a motor with friction in all joints: energies, closed forms, the whole system by another method."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, root

from slidercrank.model.cycle.cycle import breakpoints, cycle
from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.arrangement import Arrangement
from slidercrank.model.machine.drive import ConstantTorque, Drive, LinearMotor
from slidercrank.model.machine.links_and_joints import Friction, Pin, RigidLink
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.transient.crank_equation import CrankEquation
from slidercrank.model.transient.forward_dynamics import State, simulate
from tests.model.cases import MACHINES, Array, linkage_of, random_designs, random_friction, random_machine
from tests.model.test_friction import FORCES, inertia_forces, residual
from tests.model.virtual_work import path, slider_load

DESIGNS = random_designs(10, seed=181, least_margin=0.3)
DRIVE = Drive(motor=LinearMotor(stall_torque=90.0, no_load_speed=60.0), flywheel=0.08, motor_inertia=0.01)
LINKAGE = Linkage(0.05, 0.2, 0.03)
COAST = Drive(motor=ConstantTorque(torque=0.0))
RUBBING = Friction(
    guide=0.15,
    crank_pivot=Pin(radius=0.01, coefficient=0.1),
    crank_pin=Pin(radius=0.008, coefficient=0.1),
    slider_pin=Pin(radius=0.006, coefficient=0.1),
)
DISC = Mechanism(
    speed=1.0,
    crank=RigidLink(mass=2.0, centre=0.0, inertia=0.02),
    gravity=(0.0, -10.0),
    friction=Friction(crank_pivot=Pin(radius=0.01, coefficient=0.2)),
)
HELD = 2.0 * 10.0 * 0.002
"""Friction moment of the disc's weight in its pivot, N m."""


def machines() -> list[Mechanism]:
    random = np.random.default_rng(182)
    return [rubbing_machine(random) for _ in DESIGNS]


def rubbing_machine(random: np.random.Generator) -> Mechanism:
    return replace(random_machine(random), friction=random_friction(random), acceleration=0.0)


@pytest.mark.parametrize("machine", MACHINES.values(), ids=MACHINES)
def test_work_of_the_motor_is_stored_done_on_the_loads_or_heat(machine: Mechanism) -> None:
    """The heat is that of the joints' forces, the energies those of the bodies; neither moves the crank."""
    linkage = replace(LINKAGE, branch=machine.branch)
    found = simulate(replace(machine, friction=RUBBING), linkage, DRIVE, duration=0.5)
    assert found.verdict == "time is up"
    assert abs(found.turns) > 1.0
    assert found.friction_work[-1] > 0.03 * found.motor_work[-1]
    assert np.all(np.diff(found.friction_work) > 0.0)
    assert found.energy_balance_error < 1e-9


@pytest.mark.slow
def test_energies_balance_in_random_machines_also_of_two_cylinders() -> None:
    for machine, design in zip(machines(), DESIGNS, strict=True):
        several = replace(machine, arrangement=Arrangement(phases=(0.0, 2.0))) if machine.speed > 20.0 else machine
        found = simulate(several, linkage_of(design, machine.branch), DRIVE, duration=0.1, tolerance=1e-10)
        assert found.energy_balance_error < 300.0 * 1e-10  # the tolerance
        assert found.friction_work[-1] > 0.0


def solved(machine: Mechanism, design: Array, theta: Array, speed: float) -> Array:
    """Return the ten unknowns at a crank angle (1,): torque, joint forces, guide, its friction, and acceleration."""
    linkage, sign = linkage_of(design, machine.branch), 1.0 if machine.branch == "open" else -1.0
    moving, way = replace(machine, speed=speed), path(design, theta, sign)
    still, pushed = (inertia_forces(replace(moving, acceleration=a), design, theta) for a in (0.0, 1.0))
    motor = float(DRIVE.torque_on_crank(speed, machine.direction))
    at: dict[str, Any] = {
        "pin": (design[0] * math.cos(theta[0]), design[0] * math.sin(theta[0])),
        "slider_at": (way.x[0], design[2]),
        "rod_1": way.rod_1[0],
        "x_1": way.x_1[0],
        "load": sign * slider_load(moving, design, theta, way)[0],
    }

    def equations(u: Array) -> Array:
        of = {
            name: np.array([a[0] + u[9] * (b[0] - a[0]) for a, b in zip(still[name], pushed[name], strict=True)])
            for name in still
        }
        bodies = {"crank": of["crank"] + of["weight"], "rod": of["rod"], "slider": of["slider"]}
        return np.append(residual(u[:9], moving, at | bodies), motor - DRIVE.inertia * u[9] - u[0])

    start = cycle(replace(machine, friction=Friction()), linkage, theta, speed=speed, acceleration=0.0)
    guess = np.array([*(float(getattr(start, name)[0]) for name in FORCES), 0.0, 0.0])
    return np.asarray(root(equations, guess, options={"xtol": 1e-14}).x)


def test_acceleration_solves_the_nine_equations_of_the_bodies_and_the_motor() -> None:
    """By Powell's method from the frictionless forces at rest; no joint force eliminated."""
    sides = set()
    for machine, design in zip(machines(), DESIGNS, strict=True):
        linkage = linkage_of(design, machine.branch)
        options: dict[str, Any] = {"duration": 0.1, "tolerance": 1e-9, "start": State(angle=0.4), "samples": 24}
        found = simulate(machine, linkage, DRIVE, **options)
        size = np.abs(found.acceleration).max()
        for i in range(1, len(found.time), max(1, len(found.time) // 12)):
            theta, speed = found.angle[i : i + 1], float(found.speed[i])
            unknowns, way = solved(machine, design, theta, speed), linkage.at(theta, speed=speed)
            on_dead_centre = abs(float(way.slider_velocity[0])) < 1e-9 * abs(speed) * design[0]
            if on_dead_centre or abs(float(way.rod_velocity[0])) < 1e-9 * abs(speed):
                continue  # there rounding decides which way friction acts in the guide or in the slider pin
            assert found.acceleration[i] == pytest.approx(unknowns[9], abs=1e-9 * size)
            sides.add((unknowns[7] > 0.0, bool(way.slider_velocity[0] > 0.0), bool(way.rod_velocity[0] > 0.0)))
    assert len(sides) == 8  # every combination of signs occurred


def test_motion_is_that_of_an_independent_integration() -> None:
    """Accelerations by bracketing the inverse dynamics, steps by another integrator, no breakpoint told."""
    for machine in (replace(machine, friction=RUBBING) for machine in MACHINES.values()):
        linkage, way = replace(LINKAGE, branch=machine.branch), machine.direction

        def rate(_time: float, y: Array, machine: Mechanism = machine, linkage: Linkage = linkage) -> list[float]:
            motor = float(DRIVE.torque_on_crank(y[1], machine.direction))

            def surplus(a: float) -> float:
                needed = float(cycle(machine, linkage, y[0], speed=y[1], acceleration=a).torque[0])
                return motor - DRIVE.inertia * a - needed

            return [y[1], float(brentq(surplus, -5e3, 5e3, xtol=1e-11, rtol=1e-14))]

        expected = solve_ivp(rate, (0.0, 0.1), [0.3, way], method="LSODA", rtol=1e-9, atol=1e-10).y[:, -1]
        found = simulate(machine, linkage, DRIVE, duration=0.1, start=State(angle=0.3, speed=way))
        assert found.angle[-1] == pytest.approx(expected[0], rel=1e-7)
        assert found.speed[-1] == pytest.approx(expected[1], rel=1e-7)


def test_torque_is_that_of_the_inverse_dynamics_and_with_a_heavy_flywheel_that_of_constant_speed() -> None:
    heavy = replace(DRIVE, flywheel=1e9)
    for machine, design in zip(machines(), DESIGNS, strict=True):
        linkage = linkage_of(design, machine.branch)
        for drive, start in ((DRIVE, State(angle=0.4)), (heavy, State(angle=0.4, speed=machine.speed))):
            found = simulate(machine, linkage, drive, duration=0.1, start=start)
            at = {"speed": found.speed, "acceleration": found.acceleration}
            given: dict[str, Any] = at if drive is DRIVE else {}
            expected = cycle(machine, linkage, found.angle[1:], **{key: of[1:] for key, of in given.items()}).torque
            between = np.abs(np.sin(0.5 * (found.angle[1:, None] - breakpoints(machine, linkage)))).min(axis=1) > 1e-9
            size = np.abs(expected).max()
            # Of the heavy flywheel the torque is the difference of two of its size.
            off = (found.torque[1:] - expected)[between]
            assert np.abs(off).max() < (1e-9 if drive is DRIVE else 1e-5) * size


def test_friction_of_next_to_nothing_is_no_friction() -> None:
    nothing = Pin(radius=1e-150, coefficient=1e-150)
    nearly = Friction(guide=1e-300, crank_pivot=nothing, crank_pin=nothing, slider_pin=nothing)
    for machine in MACHINES.values():
        linkage = replace(LINKAGE, branch=machine.branch)
        plain, rubbed = (
            simulate(replace(machine, friction=friction), linkage, DRIVE, duration=0.3)
            for friction in (Friction(), nearly)
        )
        assert rubbed.speed[-1] == pytest.approx(plain.speed[-1], rel=1e-10)
        assert rubbed.angle[-1] == pytest.approx(plain.angle[-1], rel=1e-10)
        assert rubbed.load_work[-1] == pytest.approx(plain.load_work[-1], rel=1e-10)
        assert rubbed.friction_work[-1] < 1e-100
        assert not plain.friction_work.any()


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_a_disc_is_slowed_by_its_pivot_and_stands(way: float) -> None:
    """The moment of the pivot is radius times coefficient times weight: the speed falls on a straight line."""
    found = simulate(DISC, LINKAGE, COAST, duration=20.0, start=State(speed=way * 5.0))
    assert found.verdict == "stands still"
    assert found.time[-1] == pytest.approx(5.0 * 0.02 / HELD, rel=1e-10)
    np.testing.assert_allclose(found.speed, way * (5.0 - found.time * HELD / 0.02), rtol=0, atol=1e-9)
    assert found.friction_work[-1] == pytest.approx(0.5 * 0.02 * 25.0, rel=1e-10)
    assert found.turned_back == ()


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_a_disc_starts_once_the_motor_is_stronger_than_its_pivot(way: float) -> None:
    machine = replace(DISC, speed=way)
    weak, strong = (Drive(motor=ConstantTorque(torque=share * HELD)) for share in (0.999, 1.001))
    stuck = simulate(machine, LINKAGE, weak, duration=1.0)
    assert stuck.verdict == "stands still"
    assert stuck.acceleration.tolist() == [0.0]
    assert stuck.torque.tolist() == pytest.approx([way * 0.999 * HELD])  # friction holds it
    started = simulate(machine, LINKAGE, strong, duration=1.0)
    assert started.speed[-1] == pytest.approx(way * 0.001 * HELD / 0.02, rel=1e-9)


def test_a_linkage_starts_from_rest_where_no_force_acts_yet() -> None:
    """Forces of zero have sizes of zero, with no derivative: at rest the motor has nothing but inertia to overcome."""
    for machine in MACHINES.values():
        bare = replace(machine, gravity=(0.0, 0.0), loads=(), friction=RUBBING)
        linkage = replace(LINKAGE, branch=machine.branch)
        start = float(linkage.dead_centre_angles[0]) + 0.7
        found = simulate(bare, linkage, DRIVE, duration=0.02, start=State(angle=start))
        assert found.verdict == "time is up"
        assert found.energy_balance_error < 1e-9
        first = cycle(bare, linkage, start, speed=machine.direction * 1e-12, acceleration=found.acceleration[0]).torque
        assert found.torque[0] == pytest.approx(first[0], rel=1e-9)
        assert found.torque[0] + DRIVE.inertia * found.acceleration[0] == pytest.approx(90.0 * machine.direction)


def test_a_load_turns_a_crank_back_only_if_it_overcomes_the_friction() -> None:
    """Pushed by 60 N against its start it runs back; where its weight holds it in the pivot it stays."""
    wheel = RigidLink(mass=20.0, centre=0.0, inertia=0.02)
    push = (StrokeForce(outward=-60.0, inward=-60.0),)
    base = Mechanism(speed=1.0, crank=wheel, slider_mass=1.0, gravity=(0.0, -10.0), loads=push)
    stay = Friction(crank_pivot=Pin(radius=0.1, coefficient=0.2))
    found = {
        friction: simulate(
            replace(base, friction=friction), LINKAGE, COAST, duration=0.2, start=State(angle=-1.2, speed=2.0)
        )
        for friction in (Friction(), Friction(guide=0.1), stay)
    }
    assert [len(run.turned_back) for run in found.values()] == [1, 1, 0]
    assert found[stay].verdict == "stands still"
    for way in (1e-9, -1e-9):  # neither way does what is left push it on
        held = cycle(replace(base, friction=stay), LINKAGE, found[stay].angle[-1], speed=way, acceleration=0.0)
        assert way * held.torque[0] > 0.0


def test_torque_rises_with_the_acceleration_by_no_less_than_the_bound() -> None:
    """Between any two accelerations, also on either side of a guide that changes sides."""
    random, closest = np.random.default_rng(183), math.inf
    for machine, design in zip(machines(), DESIGNS, strict=True):
        equation = CrankEquation(machine, linkage_of(design, machine.branch))
        for way in (1.0, -1.0):
            for span in equation.spans_in_passing_order(way):
                angle = random.uniform(span.low, span.high, 20)
                speed, size = way * random.uniform(0.0, 30.0, 20), 10.0 ** random.uniform(0.0, 4.0, 20)
                low, high = np.sort(random.normal(size=(2, 20)), axis=0) * size
                one, other = span.friction_state(angle, speed, low), span.friction_state(angle, speed, high)
                rise = (other.torque - one.torque) / (high - low)
                scale = equation.moving_inertia(angle)
                assert np.all(rise >= one.least - 1e-9 * scale)
                assert np.all(one.by_acceleration >= one.least - 1e-9 * scale)
                closest = min(closest, float(((rise - one.least) / scale).min()))
    assert closest < 0.05  # the bound is near what occurs


def test_what_friction_locks_or_may_jam_is_refused() -> None:
    steep = Mechanism(speed=1.0, crank=RigidLink(mass=1.0), slider_mass=1.0, friction=Friction(guide=3.0))
    with pytest.raises(InputError, match="self-locking margin must be more than zero; got -"):
        simulate(steep, LINKAGE, DRIVE, duration=0.1)
    # A heavy slider on a crank of next to no inertia: near a dead centre the crank pin's friction is the stronger.
    heavy = Mechanism(
        speed=1.0,
        crank=RigidLink(mass=0.0, inertia=1e-4),
        slider_mass=50.0,
        friction=Friction(crank_pin=Pin(radius=0.02, coefficient=0.3)),
    )
    with pytest.raises(InputError, match=r"exceed the part that friction cancels at every crank angle.*a flywheel"):
        simulate(heavy, LINKAGE, COAST, duration=0.1)
    assert simulate(heavy, LINKAGE, DRIVE, duration=0.05).energy_balance_error < 1e-8
