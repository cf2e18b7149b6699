"""Steady running and flywheel with friction in all joints: inverse dynamics, energies, forward motion, no friction."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline

from slidercrank.model.cycle.cycle import breakpoints, cycle
from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.arrangement import Arrangement
from slidercrank.model.machine.drive import ConstantTorque, Drive, LinearMotor, TorqueTable
from slidercrank.model.machine.links_and_joints import Friction, Pin, RigidLink
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.signals.averages import torque_averages
from slidercrank.model.transient.flywheel import design_flywheel
from slidercrank.model.transient.forward_dynamics import State, simulate
from slidercrank.model.transient.steady_running import Runner, SteadyRunning, steady_running
from tests.model.cases import MACHINES, linkage_of, random_designs, random_friction, random_machine

LINKAGE = Linkage(0.05, 0.2, 0.03)
RUBBING = Friction(
    guide=0.15,
    crank_pivot=Pin(radius=0.01, coefficient=0.1),
    crank_pin=Pin(radius=0.008, coefficient=0.1),
    slider_pin=Pin(radius=0.006, coefficient=0.1),
)
MOTOR = Drive(motor=LinearMotor(stall_torque=120.0, no_load_speed=40.0), flywheel=0.1)
RUBBED = {name: replace(machine, friction=RUBBING, acceleration=0.0) for name, machine in MACHINES.items()}
DESIGNS = random_designs(12, seed=281, least_margin=0.3)


def on_branch(machine: Mechanism) -> Linkage:
    return replace(LINKAGE, branch=machine.branch)


def machines() -> list[Mechanism]:
    random = np.random.default_rng(282)
    found = [replace(random_machine(random), friction=random_friction(random), acceleration=0.0) for _ in DESIGNS]
    return [replace(machine, speed=math.copysign(max(5.0, abs(machine.speed)), machine.speed)) for machine in found]


def error(machine: Mechanism, linkage: Linkage, running: SteadyRunning) -> float:
    """Return by how much the torque differs from that of inverse dynamics, over the greatest, away from jumps."""
    needed = cycle(machine, linkage, running.crank_angle, speed=running.speed, acceleration=running.acceleration).torque
    own = replace(machine, friction=Friction(guide=machine.friction.guide, slider_pin=machine.friction.slider_pin))
    away = np.sin(0.5 * (running.crank_angle[:, None] - breakpoints(own, linkage)))
    between = np.abs(away).min(axis=1) > 1e-9
    return float(np.abs(running.torque - needed)[between].max() / np.abs(needed).max())


@pytest.mark.slow
def test_torque_of_the_motion_is_that_of_inverse_dynamics_in_random_machines() -> None:
    """Under the constant torque that keeps the speed, with little besides the mechanism that keeps it even."""
    guides, fluctuations = 0, []
    for machine, design in zip(machines(), DESIGNS, strict=True):
        linkage = linkage_of(design, machine.branch)
        running = Runner(machine, linkage).run_under_constant_torque(3.0)
        assert running.mean_speed == pytest.approx(machine.speed, rel=1e-11)
        assert error(machine, linkage, running) < 1e-9
        assert np.ptp(running.motor_torque) == 0.0
        found = cycle(machine, linkage, running.crank_angle, speed=running.speed, acceleration=running.acceleration)
        guides += int((np.diff(np.sign(found.guide)) != 0.0).sum())
        fluctuations.append(running.fluctuation)
    assert guides > 30
    assert max(fluctuations) > 0.3


@pytest.mark.parametrize("machine", RUBBED.values(), ids=RUBBED)
def test_a_motion_that_starts_in_steady_running_stays_in_it(machine: Mechanism) -> None:
    """Integrated over time by another method: speed at every angle, after a turn, and the work of the motor."""
    linkage = on_branch(machine)
    running = steady_running(machine, linkage, MOTOR)
    assert running.fluctuation > 0.01
    assert running.memory < 1.0
    start = State(angle=float(running.crank_angle[0]), speed=float(running.speed[0]))
    found = simulate(machine, linkage, MOTOR, duration=9.0, turns=1, start=start)
    assert found.speed[-1] == pytest.approx(start.speed, rel=1e-9)
    assert found.time[-1] == pytest.approx(running.period, rel=1e-9)
    assert found.motor_work[-1] == pytest.approx(running.work, rel=1e-8)
    way = np.sign(machine.speed)
    energies = CubicHermiteSpline(way * running.crank_angle, 0.5 * running.speed**2, way * running.acceleration)
    np.testing.assert_allclose(0.5 * found.speed**2, energies(way * found.angle), rtol=1e-6)


@pytest.mark.parametrize("machine", RUBBED.values(), ids=RUBBED)
def test_the_energy_integral_holds_over_the_turn(machine: Mechanism) -> None:
    """The work of the motor is that on the loads plus the heat in the joints, by the trapezoidal rule."""
    linkage = on_branch(machine)
    running, count = Runner(machine, linkage).run_under_constant_torque(0.3), 60_000
    way = float(np.sign(machine.speed))
    energies = CubicHermiteSpline(way * running.crank_angle, 0.5 * running.speed**2, way * running.acceleration)
    at = float(way * running.crank_angle[0]) + 2.0 * math.pi * (np.arange(count) + 0.5) / count
    speed, acceleration = way * np.sqrt(2.0 * energies(at)), way * energies(at, 1)
    found = cycle(machine, linkage, way * at, speed=speed, acceleration=acceleration)
    motion = linkage.at(way * at, speed=1.0)
    heat = RUBBING.guide * np.abs(found.guide * motion.slider_velocity)
    heat += RUBBING.crank_pivot.friction_circle_radius * np.hypot(found.pivot_x, found.pivot_y)
    heat += (
        RUBBING.crank_pin.friction_circle_radius
        * np.hypot(found.crank_pin_x, found.crank_pin_y)
        * (1.0 - motion.rod_velocity)
    )
    heat += (
        RUBBING.slider_pin.friction_circle_radius
        * np.hypot(found.slider_pin_x, found.slider_pin_y)
        * np.abs(motion.rod_velocity)
    )
    useful = -way * (linkage.sign * found.load * motion.slider_velocity + found.crank_load)
    spent = float((heat + useful).mean()) * 2.0 * math.pi
    size = float((heat + np.abs(useful)).mean()) * 2.0 * math.pi
    assert running.work == pytest.approx(spent, abs=1e-6 * size)
    assert float(heat.mean()) * 2.0 * math.pi > 0.05 * size


def test_with_a_heavy_flywheel_the_torque_is_the_mean_one_of_constant_speed() -> None:
    for machine, design in zip(machines(), DESIGNS, strict=True):
        running = Runner(machine, linkage_of(design, machine.branch)).run_under_constant_torque(1e7)
        expected = torque_averages(machine, design[None])
        assert running.motor_torque[0] == pytest.approx(expected.mean[0], abs=1e-6 * expected.rms[0])


def test_friction_of_next_to_nothing_is_no_friction() -> None:
    nothing = Pin(radius=1e-150, coefficient=1e-150)
    nearly = Friction(guide=1e-300, crank_pivot=nothing, crank_pin=nothing, slider_pin=nothing)
    for machine in RUBBED.values():
        both = (replace(machine, friction=friction) for friction in (Friction(), nearly))
        runners = [Runner(each, on_branch(each)) for each in both]
        for one, other in zip(
            *((each.run_under_constant_torque(0.3), each.run_under_drive(MOTOR)) for each in runners), strict=True
        ):
            for name in ("mean_speed", "fluctuation", "work"):
                assert getattr(other, name) == pytest.approx(getattr(one, name), rel=1e-10)
            assert other.memory == pytest.approx(one.memory, abs=1e-9)
    pair = (replace(RUBBED["strokes"], friction=friction) for friction in (Friction(), nearly))
    plain, rubbed = (design_flywheel(machine, LINKAGE, 0.02, MOTOR) for machine in pair)
    assert rubbed.inertia == pytest.approx(plain.inertia, rel=1e-9)
    # The estimate takes the range of energy at the nodes alone, which are others where panels end at contacts.
    assert rubbed.estimate == pytest.approx(plain.estimate, rel=1e-4)


def test_two_cylinders_at_one_phase_are_one_with_half_the_flywheel() -> None:
    pair = replace(RUBBED["strokes"], arrangement=Arrangement(phases=(0.0, 0.0), places=(0.0, 0.1)))
    one, two = (
        Runner(machine, LINKAGE).run_under_constant_torque(inertia)
        for machine, inertia in ((replace(pair, arrangement=None), 0.3), (pair, 0.6))
    )
    assert two.fluctuation == pytest.approx(one.fluctuation, rel=1e-10)
    assert two.motor_torque[0] == pytest.approx(2.0 * one.motor_torque[0], rel=1e-10)


@pytest.mark.slow
@pytest.mark.parametrize("drive", [None, MOTOR], ids=["constant torque", "motor"])
def test_a_flywheel_keeps_the_fluctuation_that_is_wanted(drive: Drive | None) -> None:
    machine = RUBBED["strokes"]
    found = design_flywheel(machine, LINKAGE, 0.04, drive)
    assert found.running.fluctuation == pytest.approx(0.04, rel=1e-9)
    assert found.estimate == pytest.approx(found.inertia + found.drive.motor_inertia, rel=0.3)
    assert error(machine, LINKAGE, found.running) < 1e-8
    plain = design_flywheel(replace(machine, friction=Friction()), LINKAGE, 0.04, drive)
    assert found.inertia != pytest.approx(plain.inertia, rel=1e-3)


def fast(mass: float) -> Mechanism:
    return Mechanism(
        speed=1.0, crank=RigidLink(mass=1.0), slider_mass=mass, gravity=(0.0, -9.81), friction=Friction(guide=0.2)
    )


def test_friction_that_grows_with_the_speed_limits_a_constant_motor_torque() -> None:
    """The guide's force, and the heat of a turn, grow proportional to the square of the speed."""
    runs = [
        steady_running(fast(2.0), LINKAGE, Drive(motor=ConstantTorque(torque=torque), flywheel=5.0))
        for torque in (20.0, 80.0)
    ]
    assert runs[1].mean_speed == pytest.approx(2.0 * runs[0].mean_speed, rel=0.02)
    with pytest.raises(InputError, match="torque or a load that changes with speed; got a constant motor torque"):
        steady_running(fast(0.0), LINKAGE, Drive(motor=ConstantTorque(torque=20.0), flywheel=5.0))


def test_a_motor_weaker_than_friction_and_a_table_that_ends_too_soon_are_refused() -> None:
    held = replace(fast(2.0), friction=Friction(crank_pivot=Pin(radius=0.05, coefficient=0.5)))
    with pytest.raises(InputError, match=r"weaker than the mean load and friction at every speed \(0\.24"):
        steady_running(held, LINKAGE, Drive(motor=LinearMotor(stall_torque=0.2, no_load_speed=40.0), flywheel=1.0))
    table = TorqueTable(speeds=(0.0, 5.0), torques=(20.0, 19.0))
    with pytest.raises(InputError, match="stronger than the loads where its table ends"):
        steady_running(fast(2.0), LINKAGE, Drive(motor=table, flywheel=1.0))


def test_what_friction_locks_is_refused() -> None:
    with pytest.raises(InputError, match="self-locking margin must be more than zero; got -"):
        Runner(replace(fast(1.0), friction=Friction(guide=3.0)), LINKAGE)
