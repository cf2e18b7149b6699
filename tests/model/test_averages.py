"""Mean and RMS torque against adaptive quadrature of the torque by virtual work, breakpoints given."""

from __future__ import annotations

import dataclasses
import math
from fractions import Fraction

import numpy as np
import pytest

from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.links_and_joints import RigidLink
from slidercrank.model.machine.loads.angle_table import AngleTable
from slidercrank.model.machine.loads.position_table import PositionTable
from slidercrank.model.machine.loads.spring import Spring
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.signals.averages import signal_averages, torque_averages
from slidercrank.model.signals.signals import Signal
from tests.model.cases import MACHINES, SMOOTH, Array, linkage_of, random_designs, random_machine
from tests.model.quadrature import integrals
from tests.model.virtual_work import drive_torque

DESIGNS = random_designs(25, seed=61)
HEAVY = Mechanism(
    speed=20.0,
    rod=RigidLink(mass=0.8, centre=0.07, centre_across=0.01, inertia=3e-3),
    slider_mass=2.0,
    gravity=(1.0, -9.81),
    loads=(StrokeForce(outward=-100.0, inward=-100.0), Spring(stiffness=500.0, free_position=0.1)),
)


def breakpoints(machine: Mechanism, design: Array) -> list[float]:
    """Return the crank angles at which the torque may have a kink, and those next to which it is steep."""
    linkage = linkage_of(design, machine.branch)
    inner, outer = (abs(float(end)) for end in linkage.dead_centres)
    found = [0.0, 0.5 * math.pi, math.pi, 1.5 * math.pi, *map(float, linkage.dead_centre_angles)]
    for load in machine.loads:
        if isinstance(load, AngleTable):
            found += load.angles
        elif isinstance(load, PositionTable):
            for at in load.positions:
                x = {"crank pivot": at, "inner dead centre": inner + at, "outer dead centre": outer - at}[load.datum]
                found += angles_at(x if machine.branch == "open" else -x, design)
    return sorted({angle % (2.0 * math.pi) for angle in found} | {2.0 * math.pi})


def angles_at(x: float, design: Array) -> list[float]:
    """Return the crank angles at which crank pin and slider pin at x are a rod apart."""
    r, l, e = (float(value) for value in design)
    distance = math.hypot(x, e)
    cosine = (r**2 + distance**2 - l**2) / (2.0 * r * distance)
    if abs(cosine) > 1.0:
        return []
    return [math.atan2(e, x) + math.acos(cosine), math.atan2(e, x) - math.acos(cosine)]


def by_quadrature(machine: Mechanism, design: Array) -> tuple[float, float]:
    points = breakpoints(machine, design)

    def powers(theta: Array) -> Array:
        torque = drive_torque(machine, design, theta)
        return np.stack([torque, torque**2])

    first, second = integrals(powers, points) / (2.0 * math.pi)
    return float(first), math.sqrt(second)


@pytest.mark.parametrize("name", MACHINES)
def test_averages_are_those_of_adaptive_quadrature(name: str) -> None:
    averages = torque_averages(MACHINES[name], DESIGNS)
    for design, mean, rms in zip(DESIGNS, averages.mean, averages.rms, strict=True):
        expected_mean, expected_rms = by_quadrature(MACHINES[name], design)
        # The adaptive rule stops at 1e-11 N m an interval; the mean may cancel to far below the RMS value.
        assert mean == pytest.approx(expected_mean, rel=0.0, abs=1e-10 * expected_rms + 1e-10)
        assert rms == pytest.approx(expected_rms, rel=1e-10)


def test_averages_hold_for_random_machines() -> None:
    random = np.random.default_rng(62)
    for design in random_designs(12, seed=63, least_margin=0.01):
        machine = random_machine(random)
        averages = torque_averages(machine, design[None])
        expected_mean, expected_rms = by_quadrature(machine, design)
        assert averages.mean[0] == pytest.approx(expected_mean, rel=0.0, abs=1e-10 * expected_rms)
        assert averages.rms[0] == pytest.approx(expected_rms, rel=1e-10)


def test_mean_torque_of_a_constant_force_against_one_stroke_is_its_work() -> None:
    # F S over 2 pi, whatever masses and gravity do.
    machine = dataclasses.replace(SMOOTH, acceleration=0.0, loads=(StrokeForce(outward=-120.0, inward=0.0),))
    designs = random_designs(500, seed=64)
    work = 120.0 * Linkage(*designs.T).stroke
    averages = torque_averages(machine, designs)
    error = np.abs(averages.mean - work / (2.0 * math.pi)) / averages.rms
    assert error.max() < 1e-11


def test_mechanism_at_rest_has_averages_and_gradients_of_zero() -> None:
    averages = torque_averages(Mechanism(), DESIGNS, gradients=True)
    for values in (averages.mean, averages.rms, averages.mean_gradients, averages.rms_gradients):
        assert values is not None
        assert np.all(values == 0.0)


def test_no_designs_have_no_averages() -> None:
    assert torque_averages(SMOOTH, np.empty((0, 3))).mean.shape == (0,)


def near_locking(design: Array, column: int | None = None) -> Array:
    """Return mean torque, RMS torque and RMS shaking force of `HEAVY`, (3,), or one column of their gradients.

    By energies, over the crank angle psi from where the rod stands most across, psi = w sinh(u): the integrand's poles
    at +-i w are then half a turn of u away. No digits are lost, since l - |across| = gap + 2 r sin^2(psi / 2).
    """
    step = np.zeros(3, complex)
    if column is not None:
        step[column] = 1e-30j
    r, l, _ = design + step
    side = 1.0 if design[2] >= 0.0 else -1.0
    exact = Fraction(design[1]) - Fraction(design[0]) - abs(Fraction(design[2]))
    gap = float(exact) + (step[1] - step[0] - side * step[2])
    w = math.sqrt(2.0 * float(exact) / design[0])
    nodes, weights = np.polynomial.legendre.leggauss(20)
    ends = np.linspace(-math.asinh(math.pi / w), math.asinh(math.pi / w), 121)
    u = ends[:-1, None] + np.diff(ends)[:, None] * 0.5 * (1.0 + nodes)
    psi, share = w * np.sinh(u), 0.5 * weights * np.diff(ends)[:, None] * w * np.cosh(u) / (2.0 * math.pi)
    s, c = -side * np.cos(psi), side * np.sin(psi)
    near = gap + 2.0 * r * np.sin(0.5 * psi) ** 2
    across, along = side * (l - near), np.sqrt(near * (2.0 * l - near))
    turn = -r * c / along
    bend = (r * s + across * turn**2) / along
    x, x_1, x_2 = r * c + along, -r * s - across * turn, -r * c - along * turn**2 - across * bend
    assert isinstance(HEAVY.rod, RigidLink)
    assert HEAVY.rod.centre is not None
    sx = (HEAVY.rod.centre * along - HEAVY.rod.centre_across * across) / l
    sy = (HEAVY.rod.centre * across + HEAVY.rod.centre_across * along) / l
    g1, g2 = (
        (-r * s - sy * turn, r * c + sx * turn),
        (
            -r * c - sx * turn**2 - sy * bend,
            -r * s - sy * turn**2 + sx * bend,
        ),
    )
    rod, slider, inertia = HEAVY.rod.mass, HEAVY.slider_mass, HEAVY.rod.inertia
    spin = rod * (g1[0] * g2[0] + g1[1] * g2[1]) + inertia * turn * bend + slider * x_1 * x_2
    pull = HEAVY.gravity[0] * (rod * g1[0] + slider * x_1) + HEAVY.gravity[1] * rod * g1[1]
    torque = HEAVY.speed**2 * spin - pull - (-100.0 - 500.0 * (x - 0.1)) * x_1
    push = [HEAVY.speed**2 * (rod * g2[0] + slider * x_2), HEAVY.speed**2 * rod * g2[1]]
    sums = [np.sum(share * part) for part in (torque, torque**2, push[0] ** 2 + push[1] ** 2)]
    found = np.array([sums[0], np.sqrt(sums[1]), np.sqrt(sums[2])])
    return found.real if column is None else found.imag / 1e-30


@pytest.mark.parametrize("margin", [3.0, 0.3, 0.1, 0.03, 0.001])
def test_averages_hold_however_near_to_locking(margin: float) -> None:
    for crank, offset in ((0.05, 0.03), (0.06, -0.02), (0.05, 0.0005), (0.02, 0.2)):
        rod = (crank + abs(offset)) / math.cos(math.radians(margin))
        design = np.array([crank, rod, offset])
        torque = torque_averages(HEAVY, design[None], gradients=True)
        push = signal_averages(HEAVY, Signal.SHAKING_FORCE, design[None], gradients=True)
        _, rms, shaking = near_locking(design)
        assert torque.rms[0] == pytest.approx(rms, rel=1e-10)
        assert push.rms[0] == pytest.approx(shaking, rel=1e-10)
        # No load here takes work over a turn.
        assert abs(torque.mean[0]) < 1e-11 * rms
        slopes = np.array([near_locking(design, column) for column in range(3)])
        assert torque.rms_gradients is not None
        assert push.rms_gradients is not None
        np.testing.assert_allclose(torque.rms_gradients[0], slopes[:, 1], rtol=1e-9)
        np.testing.assert_allclose(push.rms_gradients[0], slopes[:, 2], rtol=1e-9)


def test_piecewise_averages_hold_however_near_to_locking() -> None:
    machine = dataclasses.replace(SMOOTH, acceleration=0.0, loads=(StrokeForce(outward=-120.0, inward=0.0),))
    for margin in (0.3, 0.03, 0.001):
        for offset in (0.03, -0.02, 0.0):
            design = np.array([0.05, (0.05 + abs(offset)) / math.cos(math.radians(margin)), offset])
            averages = torque_averages(machine, design[None])
            work = 120.0 * float(Linkage(*design).stroke)
            assert averages.mean[0] == pytest.approx(work / (2.0 * math.pi), abs=1e-10 * averages.rms[0])
