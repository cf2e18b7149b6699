"""Inverse dynamics against energy, against the equations of motion of each body, and against virtual work."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np
import pytest

from slidercrank.model.cycle.cycle import Cycle, cycle
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.links_and_joints import RigidLink
from slidercrank.model.machine.loads.added_mass import AddedMass
from slidercrank.model.machine.loads.spring import Spring
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.signals.averages import torque_averages
from slidercrank.model.signals.peaks import find_peaks
from slidercrank.model.signals.signals import Signal
from tests.model.bodies import bodies
from tests.model.cases import Array, linkage_of, random_designs, random_machine
from tests.model.contour import distance_to_locking, motion_in_time
from tests.model.virtual_work import added_mass, drive_torque, path, slider_load

MACHINES = 60
# The balances below differentiate positions by a contour or a Fourier series, which lose 1e-16 / reach^2.
DESIGNS = random_designs(MACHINES, seed=31, least_margin=0.05)
ANGLES = 512
THETA = 2.0 * math.pi * np.arange(ANGLES) / ANGLES


def machines(*, loads: bool = True) -> list[Mechanism]:
    random = np.random.default_rng(32)
    drawn = [random_machine(random, loads=loads) for _ in range(MACHINES)]
    masses = random.uniform(0.0, 3.0, MACHINES)
    return [
        dataclasses.replace(machine, loads=(*machine.loads, AddedMass(mass=mass)))
        for machine, mass in zip(drawn, masses, strict=True)
    ]


def curves(machine: Mechanism, design: Array, theta: Any = THETA) -> Cycle:
    return cycle(machine, linkage_of(design, machine.branch), theta)


def test_torque_balances_power_over_the_cycle() -> None:
    """Input power = rate of kinetic and potential energy + work done against the load."""
    step = 1e-30
    wave = 1j * np.fft.fftfreq(ANGLES, 1.0 / ANGLES)
    for machine, design in zip(machines(), DESIGNS, strict=True):
        speed, acceleration = machine.speed, machine.acceleration
        kinetic, potential = np.zeros(ANGLES), np.zeros(ANGLES)
        for part in bodies(machine, design).values():
            x, y, turn = (f(THETA + 1j * step) for f in (part.x, part.y, part.turn))
            v2 = (x.imag / step * speed) ** 2 + (y.imag / step * speed) ** 2
            kinetic += 0.5 * part.mass * v2 + 0.5 * part.inertia * (turn.imag / step * speed) ** 2
            potential -= part.mass * (machine.gravity[0] * x.real + machine.gravity[1] * y.real)
        kinetic += 0.5 * added_mass(machine) * (x.imag / step * speed) ** 2  # of the slider, the last
        # Both energies are periodic in the crank angle: a Fourier series differentiates them.
        slope = np.fft.ifft(wave * np.fft.fft(kinetic + potential)).real
        rate = slope * speed + 2.0 * kinetic / speed * acceleration
        got = curves(machine, design)
        sign = 1.0 if machine.branch == "open" else -1.0
        at = path(design, THETA, sign)
        load = slider_load(machine, design, THETA, at)
        delivered = -load * sign * at.x_1 * speed
        power = got.torque * speed
        np.testing.assert_allclose(got.load, load, rtol=0, atol=1e-11 * np.abs(load).max())
        np.testing.assert_allclose(power, rate + delivered, rtol=0, atol=1e-10 * np.abs(power).max())


def test_reactions_satisfy_the_equations_of_motion_of_every_body() -> None:
    """Crank, rod and slider: two forces and one moment each.

    The slider's moment holds by construction: pin force, guide force and load pass through one point.
    """
    theta = THETA[::8] + 0.01
    for machine, design in zip(machines(), DESIGNS, strict=True):
        r, l, e = design
        sign = 1.0 if machine.branch == "open" else -1.0
        reach = distance_to_locking(r, l, e)
        f = curves(machine, design, theta)
        moved: dict[str, tuple[Array, Array, Array, Array, Array]] = {}
        for name, part in bodies(machine, design).items():
            x, y, turn = (
                motion_in_time(g, theta, speed=machine.speed, acceleration=machine.acceleration, reach=reach)
                for g in (part.x, part.y, part.turn)
            )
            weightless = part.mass * (x[2] - machine.gravity[0]), part.mass * (y[2] - machine.gravity[1])
            moved[name] = (x[0], y[0], *weightless, part.inertia * turn[2])
        accelerated = added_mass(machine) * x[2]  # by the slider, the last
        pin_x, pin_y = r * np.cos(theta), r * np.sin(theta)
        slider_x = moved["slider"][0]
        crank_x, crank_y, crank_fx, crank_fy, crank_spin = moved["crank"]
        weight_x, weight_y, weight_fx, weight_fy, weight_spin = moved["weight"]
        rod_x, rod_y, rod_fx, rod_fy, rod_spin = moved["rod"]
        load = sign * slider_load(machine, design, theta, path(design, theta, sign))
        equations = {
            "crank x": (f.pivot_x, -f.crank_pin_x, -crank_fx, -weight_fx),
            "crank y": (f.pivot_y, -f.crank_pin_y, -crank_fy, -weight_fy),
            "crank moment about the pivot": (
                f.torque,
                -pin_x * f.crank_pin_y + pin_y * f.crank_pin_x,
                -(crank_x * crank_fy - crank_y * crank_fx) - crank_spin,
                -(weight_x * weight_fy - weight_y * weight_fx) - weight_spin,
            ),
            "rod x": (f.crank_pin_x, -f.slider_pin_x, -rod_fx),
            "rod y": (f.crank_pin_y, -f.slider_pin_y, -rod_fy),
            "rod moment about its mass centre": (
                (pin_x - rod_x) * f.crank_pin_y - (pin_y - rod_y) * f.crank_pin_x,
                -(slider_x - rod_x) * f.slider_pin_y + (e - rod_y) * f.slider_pin_x,
                -rod_spin,
            ),
            "slider x": (f.slider_pin_x, load, -moved["slider"][2], -accelerated),
            "slider y": (f.slider_pin_y, f.guide, machine.slider_mass * machine.gravity[1] + 0.0 * theta),
        }
        for name, terms in equations.items():
            size = max(float(np.abs(term).max()) for term in terms)
            np.testing.assert_allclose(np.sum(terms, axis=0), 0.0, rtol=0, atol=1e-10 * size, err_msg=name)


def test_torque_is_that_of_virtual_work() -> None:
    designs = random_designs(MACHINES, seed=33)  # margins from 1e-3
    for machine, design in zip(machines(), designs, strict=True):
        expected = drive_torque(machine, design, THETA)
        # Rounding of 1 - sin(phi)^2, 1e-16 / 2e-3 at the least margin, to the third power in the acceleration.
        got = curves(machine, design).torque
        np.testing.assert_allclose(got, expected, rtol=0, atol=1e-11 * np.abs(expected).max())


def test_mean_torque_without_loads_is_zero() -> None:
    designs = random_designs(1000, seed=34)
    random = np.random.default_rng(35)
    for part in np.split(designs, 50):
        machine = dataclasses.replace(random_machine(random, loads=False), acceleration=0.0)
        peak = find_peaks(machine, Signal.TORQUE, part, limit=1).values[:, 0]
        mean = torque_averages(machine, part).mean
        assert np.max(np.abs(mean) / peak) < 1e-12


def test_mean_torque_against_springs_is_zero() -> None:
    designs = random_designs(100, seed=36)
    machine = Mechanism(
        speed=5.0,
        slider_mass=1.0,
        loads=(Spring(stiffness=900.0), Spring(stiffness=500.0, free_position=0.02, datum="outer dead centre")),
    )
    peak = find_peaks(machine, Signal.TORQUE, designs, limit=1).values[:, 0]
    assert np.max(np.abs(torque_averages(machine, designs).mean) / peak) < 1e-12


def test_static_equilibrium_of_the_centred_linkage() -> None:
    """Statics of the in-line linkage under a slider load P. P / cos(phi) in the rod, P tan(phi) on the guide."""
    machine = Mechanism(loads=(StrokeForce(outward=-100.0, inward=-100.0),))
    f = cycle(machine, Linkage(0.05, 0.2), THETA)
    tilt = np.arcsin(0.05 * np.sin(THETA) / 0.2)
    np.testing.assert_allclose(np.hypot(f.slider_pin_x, f.slider_pin_y), 100.0 / np.cos(tilt), rtol=1e-13)
    np.testing.assert_allclose(f.guide, 100.0 * np.tan(tilt), rtol=0, atol=1e-12)
    expected = -100.0 * 0.05 * (np.sin(THETA) + np.cos(THETA) * np.tan(tilt))
    np.testing.assert_allclose(f.torque, expected, rtol=0, atol=1e-13)


@pytest.mark.parametrize("speed", [3.0, -3.0])
def test_acceleration_alone_needs_torque_of_its_sign_on_a_flywheel(speed: float) -> None:
    flywheel = Mechanism(speed=speed, acceleration=-4.0, crank=RigidLink(mass=2.0, centre=0.0, inertia=0.5))
    np.testing.assert_allclose(cycle(flywheel, Linkage(0.05, 0.2), THETA).torque, -2.0, rtol=1e-15)
