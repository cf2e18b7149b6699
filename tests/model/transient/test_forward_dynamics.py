"""Forward dynamics: energies, closed forms, an independent equation of motion, standstill and reversal."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.special import ellipk

from slidercrank.model.cycle.cycle import cycle
from slidercrank.model.errors import AssemblyError, InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.drive import ConstantTorque, Drive, LinearMotor, TorqueTable
from slidercrank.model.machine.links_and_joints import Bar, Counterweight, RigidLink
from slidercrank.model.machine.loads.spring import Spring
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.transient.forward_dynamics import Progress, State, simulate
from tests.model.cases import MACHINES, SMOOTH, STROKES, TABLES
from tests.model.virtual_work import drive_torque

DESIGN = np.array([0.05, 0.2, 0.03])
LINKAGE = Linkage(*DESIGN)
COAST = Drive(motor=ConstantTorque(torque=0.0))
MOTOR = Drive(
    motor=LinearMotor(stall_torque=60.0, no_load_speed=40.0), flywheel=0.05, motor_inertia=0.002, gear_ratio=2.0
)
BRAKED = Mechanism(
    speed=1.0, slider_mass=2.0, crank=RigidLink(mass=1.0), loads=(StrokeForce(outward=-50.0, inward=50.0),)
)


def on_branch(machine: Mechanism) -> Linkage:
    return replace(LINKAGE, branch=machine.branch)


@pytest.mark.parametrize("machine", MACHINES.values(), ids=MACHINES)
def test_energy_gained_is_the_work_done_over_three_seconds_from_rest_under_constant_torque(machine: Mechanism) -> None:
    found = simulate(machine, on_branch(machine), Drive(motor=ConstantTorque(torque=40.0), flywheel=1.5), duration=3.0)
    assert found.verdict == "time is up"
    assert found.time[-1] == 3.0
    assert abs(found.turns) > 10.0
    assert found.kinetic[-1] > 1000.0
    assert found.energy_balance_error < 1e-8
    # The motor's work has a closed form; the kinetic energy is that of bodies, not of the equation of motion.
    assert found.motor_work[-1] == pytest.approx(40.0 * abs(found.angle[-1] - found.angle[0]), rel=1e-10)


@pytest.mark.parametrize("machine", MACHINES.values(), ids=MACHINES)
def test_acceleration_is_that_of_virtual_work(machine: Mechanism) -> None:
    found = simulate(machine, on_branch(machine), MOTOR, duration=1.0, start=State(angle=0.7, speed=0.0))
    for i in range(1, len(found.time), 7):
        moving = replace(machine, speed=float(found.speed[i]), acceleration=0.0)
        need = drive_torque(moving, DESIGN, found.angle[i])
        inertia = drive_torque(replace(moving, acceleration=1.0), DESIGN, found.angle[i]) - need + MOTOR.inertia
        # Of the size of the accelerations of a turn; the load of a table may be steep where they cross zero.
        size = np.abs(found.acceleration).max()
        assert found.acceleration[i] == pytest.approx((found.motor_torque[i] - need) / inertia, abs=1e-10 * size)


def test_motion_is_that_of_an_independent_integration() -> None:
    def rate(_time: float, y: Any) -> list[float]:
        moving = replace(SMOOTH, speed=float(y[1]), acceleration=0.0)
        need = drive_torque(moving, DESIGN, y[0])
        inertia = drive_torque(replace(moving, acceleration=1.0), DESIGN, y[0]) - need + MOTOR.inertia
        motor = 2.0 * 60.0 * (1.0 - 2.0 * y[1] / 40.0)
        return [y[1], (motor - need) / inertia]

    expected = solve_ivp(rate, (0.0, 0.8), [0.3, 1.0], method="LSODA", rtol=1e-11, atol=1e-12).y[:, -1]
    found = simulate(SMOOTH, LINKAGE, MOTOR, duration=0.8, start=State(angle=0.3, speed=1.0))
    assert found.angle[-1] == pytest.approx(expected[0], rel=1e-8)
    assert found.speed[-1] == pytest.approx(expected[1], rel=1e-7)


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_constant_torque_on_a_pure_inertia_turns_with_the_square_of_time(way: float) -> None:
    disc = Mechanism(speed=way, crank=RigidLink(mass=2.0, centre=0.0, inertia=0.02))
    drive = Drive(motor=ConstantTorque(torque=3.0), flywheel=0.05, motor_inertia=0.001, gear_ratio=4.0)
    found = simulate(disc, LINKAGE, drive, duration=2.0)
    torque, inertia = 12.0, 0.02 + 0.05 + 0.016
    np.testing.assert_allclose(found.angle, way * torque * found.time**2 / (2.0 * inertia), rtol=1e-10, atol=1e-13)
    np.testing.assert_allclose(found.speed, way * torque * found.time / inertia, rtol=1e-10)
    np.testing.assert_allclose(found.power, torque**2 * found.time / inertia, rtol=1e-10)


def test_a_linear_motor_brings_a_pure_inertia_to_speed_exponentially() -> None:
    disc = Mechanism(speed=1.0, crank=RigidLink(mass=2.0, centre=0.0, inertia=0.02))
    found = simulate(disc, LINKAGE, Drive(motor=LinearMotor(stall_torque=5.0, no_load_speed=30.0)), duration=0.5)
    expected = 30.0 * -np.expm1(-found.time * 5.0 / (30.0 * 0.02))
    np.testing.assert_allclose(found.speed, expected, rtol=1e-10)


def test_a_hanging_crank_swings_as_a_pendulum() -> None:
    # Counterweight alone: I = m R^2, released 2 rad off the vertical; period 4 sqrt(R / g) K(sin(amplitude / 2)).
    pendulum = Mechanism(counterweight=Counterweight(mass=1.5, radius=0.3, angle=0.0), gravity=(0.0, -9.81))
    found = simulate(pendulum, LINKAGE, COAST, duration=5.0, start=State(angle=-0.5 * math.pi + 2.0))
    half = 2.0 * math.sqrt(0.3 / 9.81) * float(ellipk(math.sin(1.0) ** 2))
    expected = half * np.arange(1, math.floor(5.0 / half) + 1)
    np.testing.assert_allclose(found.turned_back, expected, rtol=1e-9)
    # It touches the same two angles again and again, one of them across the start of the count of turns.
    assert found.angle.max() == pytest.approx(-0.5 * math.pi + 2.0, abs=1e-9)
    assert found.angle.min() == pytest.approx(-0.5 * math.pi - 2.0, abs=1e-9)


def test_a_conservative_machine_keeps_its_energy_over_many_turns() -> None:
    spring = Spring(stiffness=900.0, free_position=0.05, datum="inner dead centre")
    machine = replace(SMOOTH, loads=(spring,))
    found = simulate(machine, LINKAGE, COAST, duration=100.0, turns=40, start=State(angle=1.0, speed=25.0))
    assert found.verdict == "turns done"
    assert found.turns == pytest.approx(40.0, abs=1e-12)
    stretch = found.slider_position - float(LINKAGE.dead_centres[0]) - 0.05
    total = found.kinetic + found.potential + 0.5 * 900.0 * stretch**2
    assert np.ptp(found.kinetic) > 1.0
    assert np.ptp(total) < 1e-9 * found.kinetic.max()


def test_a_conservative_machine_runs_back_to_where_it_came_from() -> None:
    machine = replace(TABLES, speed=1.0, loads=(*TABLES.loads[1:3],))
    linkage = on_branch(machine)
    there = simulate(machine, linkage, COAST, duration=1.0, start=State(angle=0.4, speed=12.0))
    end = State(angle=float(there.angle[-1]), speed=-float(there.speed[-1]))
    back = simulate(machine, linkage, COAST, duration=1.0, start=end)
    assert back.angle[-1] == pytest.approx(0.4, abs=1e-8)
    assert back.speed[-1] == pytest.approx(-12.0, rel=1e-9)


@pytest.mark.parametrize("machine", [STROKES, TABLES], ids=["strokes", "tables"])
def test_a_mirrored_machine_moves_in_the_mirror(machine: Mechanism) -> None:
    gravity = (machine.gravity[0], -machine.gravity[1])
    loads = machine.loads[:2]  # an angle table would need mirroring
    links = {"crank": Bar(width=0.03, depth=0.02, density=7800.0), "rod": RigidLink(mass=1.0, inertia=0.01)}
    one = replace(machine, loads=loads, speed=1.0, counterweight=SMOOTH.counterweight, **links)  # type: ignore[arg-type]
    weight = replace(SMOOTH.counterweight, angle=-SMOOTH.counterweight.angle)
    other = replace(one, speed=-1.0, gravity=gravity, counterweight=weight)
    found = simulate(one, on_branch(machine), MOTOR, duration=0.6, start=State(angle=0.2))
    mirrored = simulate(other, Linkage(0.05, 0.2, -0.03, machine.branch), MOTOR, duration=0.6, start=State(angle=-0.2))
    assert mirrored.angle[-1] == pytest.approx(-found.angle[-1], rel=1e-9)
    assert mirrored.slider_position[-1] == pytest.approx(found.slider_position[-1], rel=1e-9)
    assert mirrored.motor_work[-1] == pytest.approx(found.motor_work[-1], rel=1e-9)


@pytest.mark.parametrize("speed", [6.0, -6.0])
def test_a_coasting_machine_is_stopped_by_its_load_and_stays(speed: float) -> None:
    found = simulate(BRAKED, LINKAGE, COAST, duration=10.0, start=State(angle=0.3, speed=speed))
    assert found.verdict == "stands still"
    assert "cannot overcome the load" in found.message
    assert found.time[-1] < 1.0
    assert found.speed[-1] == pytest.approx(0.0, abs=1e-12)
    travelled = np.abs(np.diff(found.slider_position)).sum()
    # The way between points that straddle a dead centre is lost: 1e-4 of it.
    assert 50.0 * travelled == pytest.approx(found.kinetic[0], rel=1e-3)
    assert found.load_work[-1] == pytest.approx(found.kinetic[0], rel=1e-9)


def test_a_motor_too_weak_to_start_gives_a_verdict_and_no_motion() -> None:
    drive = Drive(motor=ConstantTorque(torque=0.5))
    stuck = simulate(BRAKED, LINKAGE, drive, duration=10.0, start=State(angle=1.5))
    assert stuck.verdict == "stands still"
    assert stuck.time.tolist() == [0.0]
    assert stuck.speed.tolist() == stuck.acceleration.tolist() == [0.0]
    assert stuck.energy_balance_error == 0.0
    # Beside a dead centre the same motor starts, and gets stuck where the load has its lever.
    away = simulate(BRAKED, LINKAGE, drive, duration=10.0, start=State(angle=float(LINKAGE.dead_centre_angles[1])))
    assert away.verdict == "stands still"
    assert 0.0 < away.turns < 0.5


def test_a_load_stronger_than_the_motor_drives_it_backwards() -> None:
    machine = Mechanism(
        speed=1.0, slider_mass=2.0, crank=RigidLink(mass=1.0), loads=(StrokeForce(outward=-900.0, inward=-900.0),)
    )
    start = State(angle=-1.2, speed=3.0)
    found = simulate(machine, LINKAGE, Drive(motor=ConstantTorque(torque=1.0)), duration=0.02, start=start)
    assert len(found.turned_back) == 1
    assert found.speed[0] == 3.0
    assert found.speed[-1] < 0.0
    assert found.energy_balance_error < 1e-9


def test_speed_beyond_the_torque_table_ends_the_simulation() -> None:
    table = TorqueTable(speeds=(0.0, 10.0, 20.0), torques=(30.0, 28.0, 25.0))
    found = simulate(SMOOTH, LINKAGE, Drive(motor=table, flywheel=0.1), duration=10.0)
    assert found.verdict == "beyond the torque table"
    assert found.speed[-1] == pytest.approx(20.0, rel=1e-9)
    assert np.all(np.isfinite(found.motor_torque))
    with pytest.raises(InputError, match="known at the start; got a crank speed of 25 rad/s"):
        simulate(SMOOTH, LINKAGE, Drive(motor=table), duration=1.0, start=State(speed=25.0))


def test_the_torque_is_that_of_the_inverse_dynamics() -> None:
    found = simulate(TABLES, on_branch(TABLES), MOTOR, duration=0.5)
    curves = cycle(
        TABLES, on_branch(TABLES), found.angle[5:], speed=found.speed[5:], acceleration=found.acceleration[5:]
    )
    size = np.abs(found.torque).max()
    np.testing.assert_allclose(curves.torque, found.torque[5:], rtol=0, atol=1e-9 * size)
    np.testing.assert_allclose(curves.slider_acceleration, found.slider_acceleration[5:], rtol=1e-9, atol=1e-9)
    balance = found.motor_torque - MOTOR.inertia * found.acceleration
    np.testing.assert_allclose(balance, found.torque, rtol=0, atol=1e-10 * size)


def test_progress_is_told_and_a_run_can_be_cancelled() -> None:
    told: list[Progress] = []
    found = simulate(
        STROKES, LINKAGE, MOTOR, duration=50.0, progress=told.append, cancelled=lambda: told[-1].time > 0.5
    )
    assert found.verdict == "cancelled"
    assert found.time[-1] == told[-1].time
    assert 0.5 < told[-1].time < 1.0
    assert all(before.time < after.time for before, after in itertools.pairwise(told))
    assert told[-1].turns == pytest.approx(found.turns, rel=1e-12)


def test_points_are_close_enough_to_draw() -> None:
    found = simulate(SMOOTH, LINKAGE, MOTOR, duration=1.0, samples=120)
    assert np.all(np.diff(found.time) > 0.0)
    assert np.abs(np.diff(found.angle)).max() < 1.1 * 2.0 * math.pi / 120.0


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"duration": 0.0}, "duration must be positive and finite; got 0 s"),
        ({"duration": math.nan}, "duration must be positive and finite; got nan s"),
        ({"turns": 0}, "turns must be a whole number of at least 1; got 0"),
        ({"steady": 2.0}, "steady must be a fraction of the speed"),
        ({"tolerance": 1e-16}, "tolerance must lie between 1e-13 and 1e-3; got 1e-16"),
        ({"samples": 1}, "samples must be at least 8"),
    ],
)
def test_wrong_options_are_refused(options: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        simulate(SMOOTH, LINKAGE, MOTOR, **({"duration": 1.0} | options))


def test_what_cannot_be_simulated_is_refused() -> None:
    with pytest.raises(InputError, match=r"needs a motor; got a mechanism without a drive; add a \[drive\]"):
        simulate(SMOOTH, LINKAGE, duration=1.0)
    with pytest.raises(InputError, match="state must be finite; got angle nan rad"):
        State(angle=math.nan)
    with pytest.raises(InputError, match="the crank needs inertia at every angle, also at the dead centres"):
        simulate(Mechanism(slider_mass=1.0), LINKAGE, COAST, duration=1.0)
    with pytest.raises(AssemblyError, match="for full rotation"):
        simulate(SMOOTH, Linkage(0.25, 0.3, 0.1), MOTOR, duration=1.0)
