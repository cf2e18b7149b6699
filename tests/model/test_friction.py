"""Friction against the whole system of equations solved by another method, against energy, and without friction."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy.optimize import root

from slidercrank.model.cycle.cycle import Cycle, breakpoints, cycle, cycle_energies
from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.links_and_joints import Friction, Pin
from slidercrank.model.machine.loads.spring import Spring
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.signals.averages import torque_averages
from slidercrank.model.signals.fast_torque_and_error import supports_screening
from slidercrank.model.signals.peaks import find_peaks
from slidercrank.model.signals.signals import Signal
from tests.model.bodies import bodies
from tests.model.cases import SMOOTH, Array, linkage_of, random_designs, random_friction, random_machine
from tests.model.contour import distance_to_locking, motion_in_time
from tests.model.quadrature import integrals
from tests.model.virtual_work import path, slider_load

# Rods at least 30 % longer than crank + offset: with the friction of `random_friction` none of them locks.
DESIGNS = random_designs(40, seed=81, least_margin=0.3)
FORCES = ("torque", "pivot_x", "pivot_y", "crank_pin_x", "crank_pin_y", "slider_pin_x", "slider_pin_y", "guide")


def machines() -> list[Mechanism]:
    random = np.random.default_rng(82)
    return [dataclasses.replace(random_machine(random), friction=random_friction(random)) for _ in DESIGNS]


def inertia_forces(machine: Mechanism, design: Array, theta: Array) -> dict[str, tuple[Array, Array, Array]]:
    """Return inertia force (x, y) and moment about the crank pivot of every body.

    m (a - G), r x m (a - G) + I turn''.
    """
    reach = distance_to_locking(*design)
    found = {}
    for name, part in bodies(machine, design).items():
        x, y, turn = (
            motion_in_time(f, theta, speed=machine.speed, acceleration=machine.acceleration, reach=reach)
            for f in (part.x, part.y, part.turn)
        )
        fx, fy = part.mass * (x[2] - machine.gravity[0]), part.mass * (y[2] - machine.gravity[1])
        found[name] = (fx, fy, x[0] * fy - y[0] * fx + part.inertia * turn[2])
    return found


def residual(u: Array, machine: Mechanism, at: dict[str, Any]) -> Array:
    """Nine equations: forces and moment about the pivot of crank, rod and slider, and the guide's friction."""
    torque, px, py, ax, ay, bx, by, guide, drag = u
    f = machine.friction
    turn = math.copysign(1.0, machine.speed)
    spin_rod = at["rod_1"] * machine.speed
    spin_pin = (at["rod_1"] - 1.0) * machine.speed
    on_rod_at_a = -f.crank_pin.friction_circle_radius * math.hypot(ax, ay) * np.sign(spin_pin)
    on_rod_at_b = -f.slider_pin.friction_circle_radius * math.hypot(bx, by) * np.sign(spin_rod)
    on_crank_at_o = -f.crank_pivot.friction_circle_radius * math.hypot(px, py) * turn
    (cx, cy, cm), (rx, ry, rm), (sx, sy, _) = at["crank"], at["rod"], at["slider"]
    (kx, ky), (x, e) = at["pin"], at["slider_at"]
    return np.array(
        [
            px - ax - cx,
            py - ay - cy,
            torque - (kx * ay - ky * ax) + on_crank_at_o - on_rod_at_a - cm,
            ax - bx - rx,
            ay - by - ry,
            (kx * ay - ky * ax) - (x * by - e * bx) + on_rod_at_a + on_rod_at_b - rm,
            bx + at["load"] + drag - sx,
            by + guide - sy,
            drag + f.guide * abs(guide) * np.sign(at["x_1"] * machine.speed),
        ]
    )


def test_forces_solve_the_nine_equations_of_the_three_bodies() -> None:
    """By Powell's method from the frictionless forces, the system as a textbook draws it; no joint force eliminated."""
    theta = 2.0 * math.pi * np.arange(12) / 12 + 0.013
    sides = set()
    for machine, design in zip(machines(), DESIGNS, strict=True):
        r, _, e = design
        sign = 1.0 if machine.branch == "open" else -1.0
        way = path(design, theta, sign)
        inertia = inertia_forces(machine, design, theta)
        load = sign * slider_load(machine, design, theta, way)
        got = cycle(machine, linkage_of(design, machine.branch), theta)
        start = cycle(dataclasses.replace(machine, friction=Friction()), linkage_of(design, machine.branch), theta)
        for i, angle in enumerate(theta):
            at: dict[str, Any] = {
                "crank": [a[i] + b[i] for a, b in zip(inertia["crank"], inertia["weight"], strict=True)],
                "rod": [a[i] for a in inertia["rod"]],
                "slider": [a[i] for a in inertia["slider"]],
                "pin": (r * math.cos(angle), r * math.sin(angle)),
                "slider_at": (way.x[i], e),
                "rod_1": way.rod_1[i],
                "x_1": way.x_1[i],
                "load": load[i],
            }
            guess = np.array([getattr(start, name)[i] for name in FORCES] + [0.0])
            found = root(residual, guess, args=(machine, at), options={"xtol": 1e-13})
            values = np.array([getattr(got, name)[i] for name in FORCES])
            size = np.abs(values[1:]).max()
            # The forces first, over the greatest; the torque over force times crank, its own scale.
            np.testing.assert_allclose(found.x[1:8], values[1:], rtol=0, atol=1e-9 * size)
            assert abs(found.x[0] - values[0]) < 1e-9 * size * (r + abs(e))
            sides.add((values[7] > 0.0, at["x_1"] * machine.speed > 0.0, way.rod_1[i] * machine.speed > 0.0))
    assert len(sides) == 8  # every combination of signs occurred


def textbook_rod_force(theta: Array, *, friction: float) -> tuple[Array, Array]:
    """Return rod force and its angle for a resisting slider load of 100 N. S = P / (cos(phi) - mu sin(|phi|))."""
    tilt = np.arcsin((0.03 - 0.05 * np.sin(theta)) / 0.2)
    return 100.0 / (np.cos(tilt) - friction * np.abs(np.sin(tilt))), tilt


@pytest.mark.parametrize("speed", [2.0, -2.0])
def test_massless_linkage_has_the_rod_force_of_statics(speed: float) -> None:
    """S cos(phi) = P + mu N with N = S sin(|phi|), whichever way the slider moves. T = S r sin(theta - phi)."""
    machine = Mechanism(speed=speed, loads=(StrokeForce(outward=-100.0, inward=100.0),), friction=Friction(guide=0.35))
    theta = np.linspace(0.0, 2.0 * math.pi, 500) + 1e-3
    found = cycle(machine, Linkage(0.05, 0.2, 0.03), theta)
    force, tilt = textbook_rod_force(theta, friction=0.35)
    np.testing.assert_allclose(np.hypot(found.slider_pin_x, found.slider_pin_y), force, rtol=1e-13)
    expected = np.sign(speed) * np.abs(force * 0.05 * np.sin(theta - tilt))
    np.testing.assert_allclose(found.torque, expected, rtol=1e-12, atol=1e-12)


def test_friction_of_next_to_nothing_is_no_friction() -> None:
    """The kernels with friction, at a coefficient that vanishes next to one, against those without."""
    nearly = Friction(
        guide=1e-300,
        crank_pin=Pin(radius=1e-150, coefficient=1e-150),
        slider_pin=Pin(radius=1e-150, coefficient=1e-150),
    )
    assert nearly.acts
    assert not Friction(crank_pin=Pin(radius=0.01), slider_pin=Pin(coefficient=0.1)).acts
    theta = np.linspace(0.0, 2.0 * math.pi, 300) + 1e-3
    for machine, design in zip(machines()[:10], DESIGNS, strict=False):
        plain, rubbed = (dataclasses.replace(machine, friction=friction) for friction in (Friction(), nearly))
        one, other = (cycle(each, linkage_of(design, machine.branch), theta) for each in (plain, rubbed))
        for name in FORCES:
            size = np.abs(getattr(one, name)).max()
            np.testing.assert_allclose(getattr(other, name), getattr(one, name), rtol=0, atol=1e-12 * size)
        for kind in (Signal.TORQUE, Signal.GUIDE_FORCE, Signal.PIVOT_FORCE, Signal.POWER):
            peaks = [find_peaks(each, kind, design[None], limit=1, gradients=True) for each in (plain, rubbed)]
            np.testing.assert_allclose(peaks[1].values, peaks[0].values, rtol=1e-12)
            assert peaks[0].gradients is not None
            assert peaks[1].gradients is not None
            size = np.abs(peaks[0].gradients).max()
            np.testing.assert_allclose(peaks[1].gradients, peaks[0].gradients, rtol=0, atol=1e-9 * size)
        averages = [torque_averages(each, design[None]) for each in (plain, rubbed)]
        np.testing.assert_allclose(averages[1].mean, averages[0].mean, rtol=0, atol=1e-12 * averages[0].rms[0])
        np.testing.assert_allclose(averages[1].rms, averages[0].rms, rtol=1e-12)


SIZES: dict[Signal, Callable[[Cycle], Array]] = {
    Signal.TORQUE: lambda c: np.abs(c.torque),
    Signal.PIVOT_FORCE: lambda c: np.hypot(c.pivot_x, c.pivot_y),
    Signal.CRANK_PIN_FORCE: lambda c: np.hypot(c.crank_pin_x, c.crank_pin_y),
    Signal.SLIDER_PIN_FORCE: lambda c: np.hypot(c.slider_pin_x, c.slider_pin_y),
    Signal.GUIDE_FORCE: lambda c: np.abs(c.guide),
}


def test_peaks_are_those_of_a_dense_sweep() -> None:
    """Also where they sit on a jump or on a kink, where the guide's force changes sides."""
    on_breakpoints = 0
    spacing = 2.0 * math.pi / 20_000
    for machine, design in zip(machines(), DESIGNS, strict=True):
        linkage = linkage_of(design, machine.branch)
        cuts = breakpoints(machine, linkage)
        swept = cycle(machine, linkage, spacing * np.arange(20_000))
        for kind, size in SIZES.items():
            peak = find_peaks(machine, kind, design[None], limit=1)
            best = float(size(swept).max())
            half = spacing
            for _ in range(4):  # around the peak found too: both must agree on what is highest
                at = peak.angles[0, 0] + half * np.linspace(-1.0, 1.0, 401)
                best = max(best, float(size(cycle(machine, linkage, at)).max()))
                half /= 100.0
            assert peak.values[0, 0] == pytest.approx(best, rel=1e-9)
            on_breakpoints += bool(np.abs(np.angle(np.exp(1j * (cuts - peak.angles[0, 0])))).min() < 1e-9)
    assert on_breakpoints > 10


def test_dead_centre_belongs_to_the_inward_stroke_however_its_angle_is_rounded() -> None:
    """Loads and friction alike: never the load of one stroke with the friction of the other."""
    ulps = np.arange(-4, 5)
    for machine, design in zip(machines(), DESIGNS, strict=True):
        linkage = linkage_of(design, machine.branch)
        inner, outer = linkage.dead_centre_angles
        ends = np.array([outer, inner])
        angles = ends[:, None] + ulps * np.spacing(ends)[:, None]
        step = 1e-9 * (1.0 if machine.speed >= 0.0 else -1.0)
        inward = np.array([ends[0] + step, ends[1] - step])  # after the outer dead centre, before the inner one
        for kind, size in SIZES.items():
            there = size(cycle(machine, linkage, inward))
            at = size(cycle(machine, linkage, angles.ravel())).reshape(angles.shape)
            np.testing.assert_allclose(
                at, np.broadcast_to(there[:, None], at.shape), rtol=1e-5, atol=1e-6, err_msg=kind
            )


def test_breakpoints_are_where_the_curves_jump_or_the_guide_force_changes_sides() -> None:
    found = 0
    for machine, design in zip(machines(), DESIGNS, strict=True):
        linkage = linkage_of(design, machine.branch)
        theta = np.linspace(0.0, 2.0 * math.pi, 40_001)
        guide = cycle(machine, linkage, theta).guide
        changes = theta[:-1][np.sign(guide[1:]) != np.sign(guide[:-1])]
        away = np.angle(np.exp(1j * (breakpoints(machine, linkage)[:, None] - changes)))
        assert np.abs(away).min(axis=0).max(initial=0.0) < 2e-4
        found += len(changes)
    assert found > 100


def test_input_less_useful_work_is_the_friction_heat() -> None:
    for machine, design in zip(machines(), DESIGNS, strict=True):
        e = cycle_energies(machine, linkage_of(design, machine.branch))
        size = max(abs(e.input), abs(e.useful), abs(e.stored), e.heat)
        assert abs(e.input - e.useful - e.stored - e.heat) < 1e-12 * size
        assert min(e.guide_heat, e.crank_pivot_heat, e.crank_pin_heat, e.slider_pin_heat) > 0.0
        # The mean torque comes from other panels and with signs held within segments.
        mean = float(torque_averages(machine, design[None]).mean[0])
        assert 2.0 * math.pi * mean * math.copysign(1.0, machine.speed) == pytest.approx(
            e.input, rel=0, abs=1e-10 * size
        )


def test_efficiency_is_below_one_with_friction_one_without_and_undefined_without_net_work() -> None:
    push = (StrokeForce(outward=-100.0, inward=0.0),)
    machine = Mechanism(speed=3.0, slider_mass=1.0, loads=push, friction=Friction(guide=0.2))
    linkage = Linkage(0.05, 0.2, 0.02)
    efficiency = cycle_energies(machine, linkage).efficiency
    assert efficiency is not None
    assert 0.8 < efficiency < 1.0
    assert cycle_energies(dataclasses.replace(machine, friction=Friction()), linkage).efficiency == 1.0
    assert cycle_energies(dataclasses.replace(machine, loads=(Spring(stiffness=500.0),)), linkage).efficiency is None
    driving = dataclasses.replace(machine, loads=(StrokeForce(outward=100.0, inward=0.0),))
    given = cycle_energies(driving, linkage)
    assert given.efficiency == pytest.approx(-given.input / -given.useful, rel=1e-10)


def test_rms_torque_is_that_of_adaptive_quadrature() -> None:
    for machine, design in zip(machines()[:3], DESIGNS, strict=False):
        linkage = linkage_of(design, machine.branch)
        cuts = [*breakpoints(machine, linkage), breakpoints(machine, linkage)[0] + 2.0 * math.pi]

        def square(theta: Array, machine: Mechanism = machine, linkage: Linkage = linkage) -> Array:
            return np.asarray(cycle(machine, linkage, theta).torque[None] ** 2)

        expected = math.sqrt(integrals(square, cuts)[0] / (2.0 * math.pi))
        assert torque_averages(machine, design[None]).rms[0] == pytest.approx(expected, rel=1e-10)


def test_machine_with_friction_is_not_screened() -> None:
    rubbing = dataclasses.replace(SMOOTH, friction=Friction(guide=0.1))
    assert supports_screening(SMOOTH, Signal.TORQUE)
    assert not supports_screening(rubbing, Signal.TORQUE)
    assert supports_screening(rubbing, Signal.POSITION_ERROR)


@pytest.mark.parametrize("value", [-0.1, math.nan, math.inf])
def test_impossible_friction_is_refused(value: float) -> None:
    with pytest.raises(InputError, match="coefficient of friction must be zero or more and finite"):
        Friction(guide=value)
    with pytest.raises(InputError, match="the radius of a pin must be zero or more and finite"):
        Pin(radius=value, coefficient=0.1)
    with pytest.raises(InputError, match="the coefficient of a pin must be zero or more and finite"):
        Pin(radius=0.01, coefficient=value)
