"""The flywheel against an energy integral of moving mass points, which knows nothing of the equation of motion."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from numpy.polynomial import legendre
from scipy.optimize import brentq, minimize_scalar

from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.links_and_joints import RigidLink
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.transient.flywheel import design_flywheel
from slidercrank.model.transient.steady_running import Runner
from tests.model.bodies import bodies
from tests.model.cases import Array

STEP = 1e-30
_FINE: Any = {"xatol": 1e-12}


class Energies:
    """Moving inertia and work over a turn of a machine without viscous loads, from the positions of its bodies."""

    def __init__(self, machine: Mechanism, design: Array) -> None:
        self.machine, self.parts = machine, bodies(machine, design).values()
        self.x = bodies(machine, design)["slider"].x
        r, l, e = design
        outer, inner = math.asin(e / (l + r)), math.pi + math.asin(e / (l - r))
        way = math.copysign(1.0, machine.speed)
        # In the order of time: a stroke inward and one outward; clockwise the other way round.
        self.starts = (outer, inner, outer + 2.0 * math.pi) if way > 0.0 else (inner, outer, inner - 2.0 * math.pi)
        (load,) = machine.loads
        assert isinstance(load, StrokeForce)
        self.forces = (load.inward, load.outward) if way > 0.0 else (load.outward, load.inward)
        self.speed = abs(machine.speed)
        self.torque = -self.gain(0, self.starts[0], self.starts[1]) - self.gain(1, self.starts[1], self.starts[2])
        self.torque /= self.starts[2] - self.starts[0]
        nodes, weights = legendre.leggauss(20)
        self.angle: list[Array] = []
        self.share: list[Array] = []
        for n in range(2):
            ends = np.linspace(self.starts[n], self.starts[n + 1], 301)
            self.angle.append((ends[:-1, None] + np.diff(ends)[:, None] * 0.5 * (1.0 + nodes)).ravel())
            self.share.append((np.abs(np.diff(ends))[:, None] * 0.5 * weights).ravel())
        self.inertias = [self.inertia(angle) for angle in self.angle]
        self.works = [self.work(n, angle) for n, angle in enumerate(self.angle)]

    def inertia(self, theta: Array) -> Array:
        t = theta + 1j * STEP
        found = 0.0
        for part in self.parts:
            x, y, turn = (np.imag(of(t)) / STEP for of in (part.x, part.y, part.turn))
            found = found + part.mass * (x**2 + y**2) + part.inertia * turn**2
        return np.asarray(found)

    def gain(self, n: int, start: float, theta: Any) -> Any:
        """Return the work of gravity and of the load of stroke n from one angle to another."""
        work = self.forces[n] * (self.x(theta) - self.x(start))
        for part in self.parts:
            for pull, of in zip(self.machine.gravity, (part.x, part.y), strict=True):
                work = work + part.mass * pull * (of(theta) - of(start))
        return work

    def work(self, n: int, theta: Array) -> Array:
        """Return the work of motor, gravity and load from the start of the turn to angles in stroke n."""
        before = self.gain(0, self.starts[0], self.starts[1]) if n else 0.0
        return np.asarray(self.torque * (theta - self.starts[0]) + before + self.gain(n, self.starts[n], theta))

    def fluctuation(self, flywheel: float, *, between_nodes: bool = True) -> float:
        """Return (greatest - least speed) / (2 pi / period), infinite where the last bit of energy is too much.

        Without what lies between the nodes it is the same or less.
        """
        lows = [float(work.min()) for work in self.works]

        def excess(log: float) -> float:
            energies = [math.exp(log) - min(lows) + work for work in self.works]
            time = sum(
                float(share @ np.sqrt(0.5 * (inertia + flywheel) / energy))
                for share, inertia, energy in zip(self.share, self.inertias, energies, strict=True)
            )
            return time * self.speed / (2.0 * math.pi) - 1.0

        spread = max(float(work.max()) for work in self.works) - min(lows)
        size = spread + 0.5 * self.speed**2 * (max(float(each.max()) for each in self.inertias) + flywheel)
        if excess(math.log(1e-4 * size)) < 0.0:
            return math.inf
        least = math.exp(brentq(excess, math.log(1e-4 * size), math.log(20.0 * size), xtol=1e-15, rtol=1e-14))

        def energy(theta: float, n: int, sign: float) -> float:
            held = least - min(lows) + self.work(n, np.array([theta]))
            return sign * float((held / (self.inertia(np.array([theta])) + flywheel))[0])

        extremes = []
        for sign in (1.0, -1.0):
            best = math.inf
            for n, angle in enumerate(self.angle):
                values = sign * (least - min(lows) + self.works[n]) / (self.inertias[n] + flywheel)
                i = int(np.argmin(values))
                best = min(best, float(values[i]))
                if not between_nodes:
                    continue
                around: Any = sorted((float(angle[max(i - 1, 0)]), float(angle[min(i + 1, len(angle) - 1)])))
                found = minimize_scalar(energy, args=(n, sign), bounds=around, method="bounded", options=_FINE)
                ends = [energy(end, n, sign) for end in self.starts[n : n + 2]]
                best = min(best, float(found.fun), *ends)
            extremes.append(sign * best)
        slow, fast = (math.sqrt(2.0 * value) for value in extremes)
        return (fast - slow) / self.speed


def random_machine(rng: np.random.Generator) -> tuple[Mechanism, Array]:
    crank = rng.uniform(0.03, 0.08)
    rod = crank * rng.uniform(1.6, 5.0)
    design = np.array([crank, rod, rng.uniform(-0.8, 0.8) * (rod - crank)])
    push = rng.uniform(-400.0, 400.0)
    machine = Mechanism(
        speed=rng.choice([-1.0, 1.0]) * rng.uniform(3.0, 40.0),
        crank=RigidLink(mass=rng.uniform(0.3, 3.0)),
        rod=RigidLink(mass=rng.uniform(0.2, 2.0), centre=0.4 * rod, centre_across=0.01),
        slider_mass=rng.uniform(0.5, 4.0),
        gravity=(0.0, -9.81) if rng.random() < 0.5 else (-9.81, 0.0),
        # Half of the loads push one way all the time: they take no work over a turn.
        loads=(StrokeForce(outward=push, inward=push if rng.random() < 0.5 else 0.0),),
    )
    return machine, design


def test_a_load_that_always_pushes_inward_needs_the_flywheel_of_the_energy_integral() -> None:
    design = np.array([0.05, 0.16, 0.05])
    machine = Mechanism(
        speed=10.0 * math.pi,
        crank=RigidLink(mass=0.5),
        rod=RigidLink(mass=0.8),
        slider_mass=2.0,
        gravity=(0.0, -9.81),
        loads=(StrokeForce(outward=-200.0, inward=-200.0),),
    )
    found = design_flywheel(machine, Linkage(*design), 0.02)
    assert found.inertia == pytest.approx(1.0843122364653, rel=1e-10)
    assert Energies(machine, design).fluctuation(found.inertia) == pytest.approx(0.02, rel=1e-9)


@pytest.mark.slow
def test_flywheels_are_those_of_the_energy_integral_and_no_smaller_one_serves() -> None:
    rng = np.random.default_rng(12)
    for _ in range(20):
        machine, design = random_machine(rng)
        wanted = float(rng.choice([0.01, 0.02, 0.1, 0.5]))
        found = design_flywheel(machine, Linkage(*design), wanted)
        energies = Energies(machine, design)
        if found.inertia == 0.0:
            assert energies.fluctuation(0.0) <= wanted
            continue
        assert energies.fluctuation(found.inertia) == pytest.approx(wanted, rel=1e-8)
        for share in (0.0, 0.3, 0.7, 0.99):
            assert energies.fluctuation(share * found.inertia, between_nodes=False) > wanted


def test_a_crank_that_nearly_stops_has_a_fluctuation_without_bound() -> None:
    design = np.array([0.05, 0.16, 0.05])
    machine = Mechanism(
        speed=10.0 * math.pi,
        crank=RigidLink(mass=0.5),
        rod=RigidLink(mass=0.8),
        slider_mass=2.0,
        gravity=(0.0, -9.81),
        loads=(StrokeForce(outward=-200.0, inward=-200.0),),
    )
    energies = Energies(machine, design)
    greatest = 0.0
    for flywheel in (0.02, 0.008, 0.005):
        running = Runner(machine, Linkage(*design)).run_under_constant_torque(flywheel)
        assert running.fluctuation == pytest.approx(energies.fluctuation(flywheel), rel=1e-8)
        assert np.isfinite(running.speed).all()
        greatest = max(greatest, running.fluctuation)
    assert greatest > 2.0
