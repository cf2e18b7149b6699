"""Steady running and flywheels: what simulations confirm, first-order theory, and what has no steady running."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from slidercrank.model.cycle.cycle import cycle
from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.drive import ConstantTorque, Drive, LinearMotor, TorqueTable
from slidercrank.model.machine.links_and_joints import RigidLink
from slidercrank.model.machine.loads.viscous import Viscous
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.transient.flywheel import design_flywheel
from slidercrank.model.transient.forward_dynamics import State, simulate
from slidercrank.model.transient.steady_running import Runner, SteadyRunning, steady_running
from tests.model.cases import MACHINES, SMOOTH, STROKES, linkage_of, random_designs
from tests.model.virtual_work import drive_torque

DESIGN = np.array([0.05, 0.2, 0.03])
LINKAGE = Linkage(*DESIGN)
MOTOR = Drive(motor=LinearMotor(stall_torque=60.0, no_load_speed=40.0), flywheel=0.2)
# An induction motor: pull-out at 25 rad/s, synchronous speed 32 rad/s.
INDUCTION = TorqueTable(
    speeds=(0.0, 10.0, 20.0, 25.0, 29.0, 32.0, 36.0), torques=(30.0, 26.0, 45.0, 60.0, 38.0, 0.0, -50.0)
)


def on_branch(machine: Mechanism) -> Linkage:
    return replace(LINKAGE, branch=machine.branch)


def start_of(running: SteadyRunning) -> State:
    return State(angle=float(running.crank_angle[0]), speed=float(running.speed[0]))


@pytest.mark.parametrize("motor", [MOTOR, Drive(motor=INDUCTION, flywheel=0.1)], ids=["line", "table"])
@pytest.mark.parametrize("machine", MACHINES.values(), ids=MACHINES)
def test_a_simulation_started_in_steady_running_repeats_it(machine: Mechanism, motor: Drive) -> None:
    running = steady_running(machine, on_branch(machine), motor)
    found = simulate(machine, on_branch(machine), motor, duration=9.0, turns=1, start=start_of(running))
    assert found.verdict == "turns done"
    assert found.time[-1] == pytest.approx(running.period, rel=1e-9)
    assert found.speed[-1] == pytest.approx(running.speed[0], rel=1e-9)
    assert found.motor_work[-1] == pytest.approx(running.work, rel=1e-8)
    at = np.argsort(running.crank_angle)
    speeds = np.interp(found.angle, running.crank_angle[at], running.speed[at])
    # Linear between 600 points of the turn.
    np.testing.assert_allclose(found.speed, speeds, rtol=1e-4)


def test_a_simulation_from_rest_comes_to_steady_running() -> None:
    running = steady_running(STROKES, LINKAGE, MOTOR)
    at = float(running.crank_angle[0])
    found = simulate(STROKES, LINKAGE, MOTOR, duration=60.0, steady=1e-10, start=State(angle=at))
    assert found.verdict == "steady"
    assert found.speed[-1] == pytest.approx(running.speed[0], rel=1e-9)
    # A disturbance dies out as the solution's memory says: from turn to turn by this factor, in w^2.
    turns = (found.angle - at) / (2.0 * math.pi)
    marks = np.flatnonzero(np.abs(turns - np.round(turns)) < 1e-9)[-14:-10]
    away = found.speed[marks] ** 2 - running.speed[0] ** 2
    np.testing.assert_allclose(away[1:] / away[:-1], running.memory, rtol=1e-4)


def test_with_a_growing_flywheel_the_torque_tends_to_that_of_constant_speed_with_its_inverse() -> None:
    for machine in (SMOOTH, STROKES):
        off = []
        for inertia in (10.0, 20.0, 40.0, 80.0):
            running = Runner(machine, LINKAGE).run_under_constant_torque(inertia)
            assert running.mean_speed == pytest.approx(machine.speed, rel=1e-12)
            steady = cycle(replace(machine, acceleration=0.0), LINKAGE, running.crank_angle)
            off.append(np.abs(running.torque - steady.torque).max() / np.abs(steady.torque).max())
        assert off[-1] < 2e-3
        orders = np.log2(np.array(off[:-1]) / off[1:])
        np.testing.assert_allclose(orders, 1.0, atol=0.02)


def test_the_constant_torque_is_the_mean_torque_of_constant_speed_if_no_load_depends_on_speed() -> None:
    for design in random_designs(5, seed=5, least_margin=0.05):
        machine = replace(STROKES, acceleration=0.0)
        running = Runner(machine, linkage_of(design, machine.branch)).run_under_constant_torque(8.0)
        # Kinks at the dead centres only: off by the square of the step.
        mean = drive_torque(machine, design, np.linspace(0.0, 2.0 * math.pi, 400_000, endpoint=False)).mean()
        assert running.motor_torque[0] == pytest.approx(mean, rel=1e-9)
        assert running.memory == pytest.approx(1.0, abs=1e-9)
        assert running.work == pytest.approx(2.0 * math.pi * abs(mean), rel=1e-9)


def test_speed_of_steady_running_is_the_energy_integral() -> None:
    # No load depends on speed: (J + J_drive) w^2 / 2 changes by the work of the surplus torque alone.
    machine = Mechanism(speed=20.0, crank=RigidLink(mass=1.0), slider_mass=2.0, gravity=(-9.81, 0.0))
    running = Runner(machine, LINKAGE).run_under_constant_torque(0.02)
    assert running.fluctuation > 0.1
    still = cycle(replace(machine, speed=0.0), LINKAGE, running.crank_angle)
    inertia = cycle(replace(machine, speed=0.0, acceleration=1.0), LINKAGE, running.crank_angle).torque - still.torque
    energy = 0.5 * (inertia + 0.02) * running.speed**2 + 2.0 * 9.81 * still.slider_position
    rod_free = energy - running.motor_torque[0] * (running.crank_angle - running.crank_angle[0])
    crank = 1.0 * 9.81 * 0.5 * 0.05 * np.cos(running.crank_angle)
    np.testing.assert_allclose(rod_free + crank, (rod_free + crank)[0], rtol=1e-10)


def test_extremes_of_speed_are_among_the_points() -> None:
    running = steady_running(SMOOTH, LINKAGE, MOTOR)
    for i in (int(np.argmax(running.speed)), int(np.argmin(running.speed))):
        assert abs(running.acceleration[i]) < 1e-9 * np.abs(running.acceleration).max()


def test_of_several_operating_points_the_stable_one_next_to_the_speed_is_taken() -> None:
    # Two stable ones under 28 N m: below the saddle of the curve, and beyond the pull-out.
    machine = Mechanism(speed=3.0, crank=RigidLink(mass=1.0), slider_mass=0.1, loads=(Viscous(coefficient=2200.0),))
    slow = steady_running(machine, LINKAGE, Drive(motor=INDUCTION, flywheel=5.0))
    assert slow.memory < 1.0
    assert 0.0 < slow.mean_speed < 32.0


@pytest.mark.parametrize("motor", [None, MOTOR], ids=["constant torque", "line"])
@pytest.mark.parametrize("machine", MACHINES.values(), ids=MACHINES)
def test_a_flywheel_gives_the_wanted_fluctuation_in_a_simulation(machine: Mechanism, motor: Drive | None) -> None:
    found = design_flywheel(machine, on_branch(machine), 0.05, motor)
    assert found.is_needed
    assert found.running.fluctuation == pytest.approx(0.05, rel=1e-10)
    start = start_of(found.running)
    run = simulate(machine, on_branch(machine), found.drive, duration=60.0, turns=1, start=start, samples=3000)
    # The extremes of a simulation are those of 3,000 points: off by (w'' / w) (pi / 3000)^2 / 2 of themselves.
    assert run.fluctuation() == pytest.approx(0.05, rel=1e-6)


def test_the_classical_flywheel_is_exact_to_first_order() -> None:
    # Its relative error falls with the fluctuation itself.
    errors = []
    for wanted in (0.04, 0.02, 0.01):
        found = design_flywheel(SMOOTH, LINKAGE, wanted)
        errors.append(found.estimate / found.inertia - 1.0)
    assert 0.005 < abs(errors[-1]) < 0.02
    np.testing.assert_allclose(np.array(errors[:-1]) / errors[1:], 2.0, rtol=0.1)


def test_no_flywheel_is_designed_where_none_is_needed() -> None:
    heavy = Mechanism(speed=10.0, crank=RigidLink(mass=400.0), slider_mass=0.1)
    found = design_flywheel(heavy, LINKAGE, 0.05)
    assert not found.is_needed
    assert found.inertia == found.drive.flywheel == 0.0
    assert found.running.fluctuation < 0.05


@pytest.mark.parametrize(
    ("machine", "drive", "message"),
    [
        (STROKES, Drive(motor=ConstantTorque(torque=9.0), flywheel=1.0), "torque or a load that changes with speed"),
        (
            STROKES,
            Drive(motor=LinearMotor(stall_torque=1.0, no_load_speed=9.0), flywheel=1.0),
            "choose a stronger motor",
        ),
        (
            STROKES,
            Drive(motor=TorqueTable(speeds=(0.0, 9.0), torques=(90.0, 80.0)), flywheel=1.0),
            "stronger than the loads where its table ends .* extend the torque table",
        ),
        (
            STROKES,
            Drive(motor=TorqueTable(speeds=(0.0, 8.0, 9.0), torques=(8.0, 7.0, 3.0)), flywheel=0.01),
            "completes every turn|beyond the torque table",
        ),
        (STROKES, None, "needs a motor"),
    ],
)
def test_without_steady_running_it_is_said_why(machine: Mechanism, drive: Drive | None, message: str) -> None:
    with pytest.raises(InputError, match=message):
        steady_running(machine, on_branch(machine), drive)


def test_a_constant_viscous_balance_is_steady_under_constant_torque() -> None:
    machine = replace(STROKES, loads=(*STROKES.loads, Viscous(coefficient=300.0)))
    drive = Drive(motor=ConstantTorque(torque=25.0), flywheel=2.0)
    running = steady_running(machine, LINKAGE, drive)
    assert running.work == pytest.approx(2.0 * math.pi * 25.0, rel=1e-12)
    assert running.memory < 1.0


def test_wrong_wishes_are_refused() -> None:
    for wrong in (0.0, 1.0, math.nan):
        with pytest.raises(InputError, match="fluctuation must lie between 0 and 1; got"):
            design_flywheel(SMOOTH, LINKAGE, wrong)
    with pytest.raises(InputError, match="needs the mean speed"):
        Runner(replace(SMOOTH, speed=0.0), LINKAGE).run_under_constant_torque(1.0)
    with pytest.raises(InputError, match="no constant torque was found"):
        Runner(replace(STROKES, speed=0.5), LINKAGE).run_under_constant_torque(0.0)
