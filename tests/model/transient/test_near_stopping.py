"""Constant torque without a flywheel: a forward simulation by virtual work, up to a crank that all but stops."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.links_and_joints import RigidLink
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.loads.viscous import Viscous
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.transient.steady_running import Runner, SteadyRunning
from tests.model.cases import Array
from tests.model.transient.test_flywheel import Energies, random_machine
from tests.model.virtual_work import drive_torque

TURN = 2.0 * math.pi
DESIGN = np.array([0.05, 0.16, 0.05])
INWARD = Mechanism(
    speed=10.0 * math.pi,
    crank=RigidLink(mass=0.5),
    rod=RigidLink(mass=0.8),
    slider_mass=2.0,
    gravity=(0.0, -9.81),
    loads=(StrokeForce(outward=-200.0, inward=-200.0),),
)


def simulated_turn(machine: Mechanism, design: Array, running: SteadyRunning) -> tuple[float, float, float]:
    """Return period, least speed and speed after a turn, from the greatest speed on, under the running's torque.

    d(w^2 / 2) / d(theta) = (T - torque that w needs) / J, from dead centre to dead centre.
    """
    way, torque = math.copysign(1.0, machine.speed), float(running.motor_torque[0])

    def rates(theta: float, state: Array) -> list[float]:
        speed = way * math.sqrt(max(2.0 * state[0], 1e-6))  # a step that is tried, not taken, may fall below 0
        needed = drive_torque(replace(machine, speed=speed, acceleration=0.0), design, np.array([theta]))
        inertia = drive_torque(replace(machine, speed=speed, acceleration=1.0), design, np.array([theta])) - needed
        return [float(((torque - needed) / inertia)[0]), 1.0 / speed]

    first = int(np.argmax(np.abs(running.speed)))
    start, fastest = float(running.crank_angle[first]), float(running.speed[first])
    dead = way * (np.array(Linkage(*design).dead_centre_angles) - start) % TURN
    ends = [start, *(start + way * np.sort(dead)), start + way * TURN]
    state, least = np.array([0.5 * fastest**2, 0.0]), math.inf
    for low, high in itertools.pairwise(ends):
        angles = np.linspace(low, high, 40_001)
        tolerances: Any = {"rtol": 1e-11, "atol": 1e-14 * fastest**2}
        found = solve_ivp(rates, (low, high), state, "DOP853", angles, **tolerances)
        state, least = found.y[:, -1], min(least, float(found.y[0].min()))
    return float(state[1]), math.sqrt(2.0 * least), math.sqrt(2.0 * float(state[0]))


def matches(machine: Mechanism, design: Array, running: SteadyRunning) -> None:
    speed = np.abs(running.speed)
    period, least, after = simulated_turn(machine, design, running)
    # Over a crank that nearly stops, errors of the simulation's energy grow in the time that it takes.
    assert period == pytest.approx(TURN / abs(machine.speed), rel=1e-6)
    assert running.period == pytest.approx(TURN / abs(machine.speed), rel=1e-10)
    assert after == pytest.approx(speed.max(), rel=1e-9)
    # The simulation's errors in w^2 are shares of the greatest; between its points the least may be missed.
    assert least**2 == pytest.approx(speed.min() ** 2, rel=1e-4, abs=1e-10 * speed.max() ** 2)


@pytest.mark.slow
def test_machines_without_a_flywheel_run_as_a_forward_simulation_does_also_above_a_fluctuation_of_two() -> None:
    rng = np.random.default_rng(20)
    found: list[float] = []
    while len(found) < 6:
        machine, design = random_machine(rng)
        least, greatest = Runner(machine, Linkage(*design)).least_and_greatest_speed(0.0)
        if least > 1e-3 * greatest:  # slower, a simulation turns back on its own errors
            running = Runner(machine, Linkage(*design)).run_under_constant_torque(0.0)
            matches(machine, design, running)
            found.append(running.fluctuation)
    assert sum(each > 2.0 for each in found) >= 3
    assert min(found) < 2.0


def test_a_load_that_always_pushes_inward_leaves_a_running_of_three_turns_a_minute_at_least() -> None:
    running = Runner(INWARD, Linkage(*DESIGN)).run_under_constant_torque(0.0)
    assert running.fluctuation == pytest.approx(6.3286, abs=5e-5)
    assert running.speed.min() * 30.0 / math.pi == pytest.approx(3.0164, abs=5e-5)
    matches(INWARD, DESIGN, running)


def test_with_viscous_loads_the_running_near_stopping_is_that_of_the_simulation() -> None:
    machine = replace(INWARD, loads=(*INWARD.loads, Viscous(coefficient=60.0)))
    running = Runner(machine, Linkage(*DESIGN)).run_under_constant_torque(0.0)
    assert running.fluctuation > 2.0
    assert running.memory < 1.0
    matches(machine, DESIGN, running)


def test_ever_slower_the_crank_all_but_stops_and_its_greatest_speed_is_that_of_the_work() -> None:
    rng = np.random.default_rng(21)
    stopping = 0
    for _ in range(30):
        machine, design = random_machine(rng)
        machine = replace(machine, speed=0.5 * machine.speed)
        least, greatest = Runner(machine, Linkage(*design)).least_and_greatest_speed(0.0)
        if least > 0.0:
            running = Runner(machine, Linkage(*design)).run_under_constant_torque(0.0)
            assert (least, greatest) == (np.abs(running.speed).min(), np.abs(running.speed).max())
            continue
        stopping += 1
        energies = Energies(machine, design)
        low = min(float(work.min()) for work in energies.works)
        squares = [
            2.0 * (work - low) / inertia for work, inertia in zip(energies.works, energies.inertias, strict=True)
        ]
        assert greatest == pytest.approx(math.sqrt(max(float(square.max()) for square in squares)), rel=1e-6)
        with pytest.raises(InputError, match="no constant torque was found"):
            Runner(machine, Linkage(*design)).run_under_constant_torque(0.0)
    assert 10 < stopping < 30
