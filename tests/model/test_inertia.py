"""Reflected inertia, shaking force and shaking moment against energy, momentum and reactions."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from slidercrank.model.cycle.cycle import cycle
from slidercrank.model.cycle.multi_cylinder import ShakingCurves, shaking_curves
from slidercrank.model.machine.links_and_joints import Counterweight, Friction, RigidLink
from slidercrank.model.machine.loads.added_mass import AddedMass
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.signals.averages import signal_averages
from slidercrank.model.signals.peaks import find_peaks
from slidercrank.model.signals.signals import Signal
from tests.model.bodies import bodies
from tests.model.cases import Array, linkage_of, random_designs, random_machine
from tests.model.contour import distance_to_locking, motion_in_time
from tests.model.virtual_work import added_mass

DESIGNS = random_designs(30, seed=101, least_margin=0.05)
THETA = 2.0 * math.pi * np.arange(120) / 120 + 0.004


def machines() -> list[Mechanism]:
    random = np.random.default_rng(102)
    drawn = [random_machine(random) for _ in DESIGNS]
    return [dataclasses.replace(each, loads=(*each.loads, AddedMass(mass=random.uniform(0.0, 3.0)))) for each in drawn]


def curves(machine: Mechanism, design: Array) -> ShakingCurves:
    return shaking_curves(machine, linkage_of(design, machine.branch), THETA)


def test_shaking_is_minus_the_rate_of_change_of_momentum_and_angular_momentum() -> None:
    """Accelerations of every mass centre from its position alone, by a contour integral in complex time."""
    for machine, design in zip(machines(), DESIGNS, strict=True):
        force_x, force_y, moment = np.zeros(120), np.zeros(120), np.zeros(120)
        for part in bodies(machine, design).values():
            x, y, turn = (
                motion_in_time(
                    f,
                    THETA,
                    speed=machine.speed,
                    acceleration=machine.acceleration,
                    reach=distance_to_locking(*design),
                )
                for f in (part.x, part.y, part.turn)
            )
            force_x -= part.mass * x[2]
            force_y -= part.mass * y[2]
            moment -= part.mass * (x[0] * y[2] - y[0] * x[2]) + part.inertia * turn[2]
        got = curves(machine, design)
        for value, expected in ((got.force_x, force_x), (got.force_y, force_y), (got.moment, moment)):
            np.testing.assert_allclose(value, expected, rtol=0, atol=1e-10 * np.abs(expected).max())


def test_shaking_force_is_what_pivot_and_guide_give_back_without_gravity_and_load() -> None:
    """And the moment what guide and motor give back, about the pivot."""
    for machine, design in zip(machines(), DESIGNS, strict=True):
        free = dataclasses.replace(machine, gravity=(0.0, 0.0), loads=())
        got, joints = curves(free, design), cycle(free, linkage_of(design, machine.branch), THETA)
        size = np.abs(joints.pivot_x).max() + np.abs(joints.pivot_y).max()
        np.testing.assert_allclose(got.force_x, -joints.pivot_x, rtol=0, atol=1e-12 * size)
        np.testing.assert_allclose(got.force_y, -joints.pivot_y - joints.guide, rtol=0, atol=1e-12 * size)
        moment = -joints.torque - joints.slider_position * joints.guide
        np.testing.assert_allclose(got.moment, moment, rtol=0, atol=1e-11 * np.abs(moment).max())


def test_gravity_loads_and_friction_do_not_shake_the_frame() -> None:
    machine, design = machines()[0], DESIGNS[:1]
    other = dataclasses.replace(
        machine,
        gravity=(1.0, 2.0),
        loads=(StrokeForce(outward=5.0, inward=1.0), AddedMass(mass=added_mass(machine))),
        friction=Friction(guide=0.1),
    )
    for kind in (Signal.SHAKING_FORCE, Signal.SHAKING_MOMENT, Signal.REFLECTED_INERTIA):
        one, two = (find_peaks(each, kind, design, limit=1).values[0, 0] for each in (machine, other))
        assert one == two


def test_peaks_and_root_mean_squares_are_those_of_the_curves() -> None:
    for machine, design in zip(machines(), DESIGNS, strict=True):
        got = shaking_curves(machine, linkage_of(design, machine.branch), np.linspace(0.0, 2.0 * math.pi, 20_001)[:-1])
        for kind, curve in (
            (Signal.SHAKING_FORCE, np.hypot(got.force_x, got.force_y)),
            (Signal.SHAKING_MOMENT, np.abs(got.moment)),
        ):
            peak = find_peaks(machine, kind, design[None], limit=1).values[0, 0]
            # A sample is at most 1.6e-4 rad from the peak; margins from 5 % curve by less than 1e2 of the peak.
            assert curve.max() * (1.0 - 1e-12) <= peak <= curve.max() * (1.0 + 1e-5)
            rms = signal_averages(machine, kind, design[None]).rms[0]
            assert rms == pytest.approx(math.sqrt(np.mean(curve**2)), rel=1e-11)


def test_counterweight_balances_a_crank_in_full() -> None:
    crank = RigidLink(mass=2.0, centre=0.03, inertia=1e-3)
    weight = Counterweight(mass=0.6, radius=0.1, angle=math.pi)
    design = np.array([[0.05, 0.2, 0.01]])
    turning = Mechanism(speed=20.0, crank=crank)
    alone = find_peaks(turning, Signal.SHAKING_FORCE, design, limit=1).values[0, 0]
    balanced = find_peaks(dataclasses.replace(turning, counterweight=weight), Signal.SHAKING_FORCE, design, limit=1)
    assert alone == pytest.approx(2.0 * 0.03 * 400.0, rel=1e-13)
    assert balanced.values[0, 0] < 1e-13 * alone


def test_half_the_reciprocating_mass_as_counterweight_halves_the_peak_shaking_force() -> None:
    """The textbook compromise. With a long rod m r w^2 cos(theta) along the line becomes m r w^2 / 2 all round."""
    machine = Mechanism(speed=10.0, slider_mass=3.0)
    half = dataclasses.replace(machine, counterweight=Counterweight(mass=1.5, radius=0.05, angle=math.pi))
    design = np.array([[0.05, 5.0, 0.0]])
    whole, halved = (find_peaks(each, Signal.SHAKING_FORCE, design, limit=1).values[0, 0] for each in (machine, half))
    # The slider's second harmonic is r / l = 0.01 of the first.
    assert whole == pytest.approx(3.0 * 0.05 * 100.0 * 1.01, rel=1e-12)
    assert halved == pytest.approx(0.5 * 3.0 * 0.05 * 100.0, rel=0.021)


def test_reflected_inertia_is_twice_the_kinetic_energy_at_unit_speed() -> None:
    step = 1e-30
    for machine, design in zip(machines(), DESIGNS, strict=True):
        expected = np.zeros(120)
        for part in bodies(machine, design).values():
            x, y, turn = (f(THETA + 1j * step).imag / step for f in (part.x, part.y, part.turn))
            expected += part.mass * (x**2 + y**2) + part.inertia * turn**2
        expected += added_mass(machine) * x**2  # of the slider, the last
        linkage = linkage_of(design, machine.branch)
        got = shaking_curves(machine, linkage, THETA).reflected_inertia
        np.testing.assert_allclose(got, expected, rtol=1e-12)
        dense = shaking_curves(machine, linkage, np.linspace(0.0, 2.0 * math.pi, 20_001)[:-1])
        peak = find_peaks(machine, Signal.REFLECTED_INERTIA, design[None], limit=1).values[0, 0]
        assert peak == pytest.approx(dense.reflected_inertia.max(), rel=1e-6)
        mean = signal_averages(machine, Signal.REFLECTED_INERTIA, design[None]).mean[0]
        assert mean == pytest.approx(dense.reflected_inertia.mean(), rel=1e-12)
