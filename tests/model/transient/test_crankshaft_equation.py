"""Steady running and flywheel of several cylinders and of two turns: against inverse dynamics, and each other."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from slidercrank.model.cycle.cycle import cycle
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.arrangement import Arrangement
from slidercrank.model.machine.cylinders_and_turns import machines_of_arrangement
from slidercrank.model.machine.drive import ConstantTorque, Drive, LinearMotor
from slidercrank.model.machine.links_and_joints import Friction, Pin, RigidLink
from slidercrank.model.machine.loads.angle_table import AngleTable
from slidercrank.model.machine.loads.compressor import Compressor
from slidercrank.model.machine.loads.crank_torque import CrankTorque
from slidercrank.model.machine.loads.engine import FourStroke
from slidercrank.model.machine.loads.viscous import Viscous
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.signals.averages import torque_averages
from slidercrank.model.transient.flywheel import design_flywheel
from slidercrank.model.transient.forward_dynamics import State, simulate
from slidercrank.model.transient.steady_running import Runner, SteadyRunning, steady_running

LINKAGE = Linkage(0.043, 0.15, 0.005)
ENGINE = FourStroke(
    bore=0.086,
    low=0.9e5,
    high=60e5,
    exhaust=1.1e5,
    clearance=1.0 / 9.0,
    compression_exponent=1.3,
    expansion_exponent=1.3,
)
AIR = Compressor(bore=0.07, low=1e5, high=8e5, clearance=0.05, compression_exponent=1.3, expansion_exponent=1.2)
BARE = Mechanism(speed=200.0, slider_mass=0.5, rod=RigidLink(mass=0.6), crank=RigidLink(mass=1.0), gravity=(0.0, -9.81))
FOUR = Arrangement(phases=(0.0, math.pi, 3.0 * math.pi, 2.0 * math.pi), places=(0.0, 0.1, 0.2, 0.3))
VEE = Arrangement(phases=(0.0, 0.0), banks=(-0.7, 0.7))
MACHINES = {
    "one of four strokes": replace(BARE, loads=(ENGINE, CrankTorque(resistance=20.0))),
    "clockwise, head at the inner dead centre": replace(
        BARE, speed=-200.0, loads=(replace(ENGINE, head="inner dead centre"),)
    ),
    "four in line": replace(BARE, loads=(ENGINE,), arrangement=FOUR),
    "a V of compressors": replace(BARE, speed=-90.0, loads=(AIR,), arrangement=VEE),
    "a table of two turns": replace(
        BARE,
        branch="crossed",
        loads=(AngleTable(angles=(0.3, 4.0, 7.0, 9.0), forces=(0.0, -900.0, 400.0, -100.0), cycle="720 deg"),),
    ),
}


def needed(machine: Mechanism, running: SteadyRunning) -> np.ndarray:
    """Return the torque that the inverse dynamics of each cylinder needs for the motion, N m."""
    own = machine if machine.arrangement is not None else replace(machine, arrangement=Arrangement(phases=(0.0,)))
    linkage, total = replace(LINKAGE, branch=machine.branch), np.zeros(len(running.time))
    for member in machines_of_arrangement(own):
        at = running.crank_angle + member.lead
        found = cycle(member.mechanism, linkage, at, speed=running.speed, acceleration=running.acceleration)
        total += found.torque
    return total


@pytest.mark.parametrize("machine", MACHINES.values(), ids=MACHINES)
def test_the_torque_of_the_motion_is_that_of_inverse_dynamics(machine: Mechanism) -> None:
    linkage = replace(LINKAGE, branch=machine.branch)
    running = Runner(machine, linkage).run_under_constant_torque(0.4)
    assert running.mean_speed == pytest.approx(machine.speed, rel=1e-11)
    span = np.ptp(running.crank_angle)
    assert span == pytest.approx(running.turns * 2.0 * math.pi, rel=1e-14)
    wanted = needed(machine, running)
    # At breakpoints a force may jump, but not the torque; ends of panels are next to them.
    assert np.abs(running.torque - wanted).max() <= 1e-7 * np.abs(wanted).max()
    cylinders = 1 if machine.arrangement is None else len(machine.arrangement.phases)
    design = np.array([[0.043, 0.15, 0.005]])
    mean = torque_averages(replace(machine, arrangement=None), design).mean[0] * cylinders
    assert running.motor_torque[0] == pytest.approx(mean, rel=1e-9)


def test_two_cylinders_at_one_phase_are_one_with_half_the_flywheel() -> None:
    pair = replace(BARE, loads=(ENGINE,), arrangement=Arrangement(phases=(0.0, 0.0), places=(0.0, 0.1)))
    one, two = (
        Runner(machine, LINKAGE).run_under_constant_torque(inertia)
        for machine, inertia in ((replace(pair, arrangement=None), 0.3), (pair, 0.6))
    )
    assert two.fluctuation == pytest.approx(one.fluctuation, rel=1e-10)
    assert two.motor_torque[0] == pytest.approx(2.0 * one.motor_torque[0], rel=1e-10)


def test_a_table_of_two_turns_that_repeats_runs_as_that_of_one() -> None:
    table = AngleTable(angles=(0.3, 2.0, 4.0), forces=(0.0, -900.0, 400.0))
    angles = (*table.angles, *(angle + 2.0 * math.pi for angle in table.angles))
    twice = AngleTable(angles=angles, forces=2 * table.forces, cycle="720 deg")
    motor = Drive(motor=LinearMotor(stall_torque=80.0, no_load_speed=220.0), flywheel=0.2)
    one, two = (steady_running(replace(BARE, loads=(load,)), LINKAGE, motor) for load in (table, twice))
    assert (one.turns, two.turns) == (1, 2)
    assert two.mean_speed == pytest.approx(one.mean_speed, rel=1e-11)
    assert two.fluctuation == pytest.approx(one.fluctuation, rel=1e-9)
    assert two.work == pytest.approx(one.work, rel=1e-9)


def test_a_flywheel_of_four_cylinders_keeps_what_is_wanted_and_is_smaller_than_that_of_one() -> None:
    four, one = MACHINES["four in line"], replace(BARE, loads=(ENGINE,))
    found, alone = (design_flywheel(machine, LINKAGE, 0.05) for machine in (four, one))
    assert found.running.fluctuation == pytest.approx(0.05, rel=1e-9)
    assert 0.0 < found.inertia < alone.inertia
    assert found.estimate == pytest.approx(found.inertia, rel=0.3)


@pytest.mark.parametrize("name", ["one of four strokes", "a V of compressors"])
def test_friction_in_every_cylinder_counts(name: str) -> None:
    """With a motor that it slows; the torque is that of the inverse dynamics of each cylinder, friction included."""
    rubbing = replace(MACHINES[name], friction=Friction(guide=0.1, crank_pivot=Pin(radius=0.02, coefficient=0.05)))
    motor = Drive(motor=LinearMotor(stall_torque=80.0, no_load_speed=220.0), flywheel=0.2)
    plain, found = (steady_running(machine, LINKAGE, motor) for machine in (MACHINES[name], rubbing))
    assert abs(found.mean_speed) < abs(plain.mean_speed)
    off = np.sort(np.abs(found.torque - needed(rubbing, found)))
    assert off[: int(0.98 * len(off))].max() < 1e-9 * np.abs(found.torque).max()  # the others are at jumps


@pytest.mark.parametrize("name", ["one of four strokes", "a V of compressors"])
def test_a_motion_under_a_motor_settles_into_steady_running(name: str) -> None:
    """Energy balances on the way; a cycle of two turns, also of a V, repeats after two."""
    machine = MACHINES[name]
    motor = Drive(motor=LinearMotor(stall_torque=900.0, no_load_speed=1.05 * abs(machine.speed)), flywheel=0.6)
    start = State(speed=0.98 * machine.speed)
    run = simulate(machine, LINKAGE, motor, duration=20.0, steady=1e-7, tolerance=1e-9, start=start)
    assert run.verdict == "steady"
    assert run.energy_balance_error < 1e-7
    running = steady_running(machine, LINKAGE, motor)
    period = 2.0 * math.pi * running.turns
    ends = np.mod(run.angle[-200:], period), np.mod(running.crank_angle, period)
    order = np.argsort(ends[1])
    wanted = np.interp(ends[0], ends[1][order], running.speed[order], period=period)
    assert run.speed[-200:] == pytest.approx(wanted, rel=1e-5)


def test_two_cylinders_that_stand_alike_start_as_one_with_half_the_drive() -> None:
    one = replace(BARE, speed=90.0, loads=(AIR,))
    two = replace(one, arrangement=Arrangement(phases=(0.0, 0.0), places=(0.0, 0.1)))
    runs = []
    for machine, share in ((one, 1.0), (two, 2.0)):
        motor = Drive(motor=LinearMotor(stall_torque=share * 90.0, no_load_speed=95.0), flywheel=share * 0.3)
        runs.append(simulate(machine, LINKAGE, motor, duration=5.0, turns=2, tolerance=1e-10))
    first, second = runs
    assert second.time[-1] == pytest.approx(first.time[-1], rel=1e-9)
    assert second.speed[-1] == pytest.approx(first.speed[-1], rel=1e-9)
    assert second.motor_work[-1] == pytest.approx(2.0 * first.motor_work[-1], rel=1e-8)


def test_an_engine_drives_its_load_without_a_motor() -> None:
    """A motor torque of zero: gas against a viscous load, in the forward motion as in steady running."""
    machine = replace(BARE, loads=(ENGINE, Viscous(coefficient=40.0)))
    idle = Drive(motor=ConstantTorque(torque=0.0), flywheel=0.5)
    running = steady_running(machine, LINKAGE, idle)
    assert running.work == 0.0
    angle, speed = float(running.crank_angle[0]), float(running.speed[0])
    run = simulate(
        machine, LINKAGE, idle, duration=5.0, turns=2, tolerance=1e-11, start=State(angle=angle, speed=speed)
    )
    assert run.speed[-1] == pytest.approx(speed, rel=1e-7)
    assert float(run.motor_work[-1]) == 0.0
