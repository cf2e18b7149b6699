"""Added masses act as a heavier slider does that has no weight and does not shake the frame."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from slidercrank.model.clearance.run import simulate
from slidercrank.model.errors import InputError
from slidercrank.model.machine.arrangement import Arrangement
from slidercrank.model.machine.links_and_joints import Clearance
from slidercrank.model.machine.loads.added_mass import AddedMass
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.signals.averages import signal_averages
from slidercrank.model.signals.peaks import find_peaks
from slidercrank.model.signals.signals import Signal
from slidercrank.model.swing.peaks import swing_peaks
from slidercrank.model.swing.swing_states import DRIVE, POWER
from slidercrank.model.transient.crank_equation import CrankEquation
from tests.model.cases import Array, linkage_of, random_designs, random_friction, random_machine
from tests.model.swing.swings import random_swings
from tests.model.varying_machines import vary

CLEARANCE = Clearance(joint="crank pin", radius=1e-4, journal_radius=0.01)
OF_THE_FRAME = {Signal.SHAKING_FORCE, Signal.SHAKING_MOMENT, Signal.ROCKING_COUPLE}


def pairs(count: int, *, friction: bool = True) -> list[tuple[Mechanism, Mechanism]]:
    """Return random machines without gravity: with an added mass, and with as much more on the slider."""
    random = np.random.default_rng(71)
    found = []
    for n in range(count):
        machine = replace(random_machine(random), gravity=(0.0, 0.0))
        if friction and n % 2:
            machine = replace(machine, friction=random_friction(random))
        mass, loads = random.uniform(0.2, 5.0), machine.loads
        found.append(
            (
                replace(machine, loads=(*loads, AddedMass(mass=mass))),
                replace(machine, loads=loads, slider_mass=machine.slider_mass + mass),
            )
        )
    return found


def agree(one: Array | None, other: Array | None, *, rtol: float, atol: float = 0.0) -> Array:
    """Assert that two arrays are equal; return the first."""
    assert one is not None
    assert other is not None
    np.testing.assert_allclose(one, other, rtol=rtol, atol=atol)
    return one


@pytest.mark.parametrize("signal", [each for each in Signal if each is not Signal.ROCKING_COUPLE])
def test_peaks_and_means_are_those_of_a_heavier_slider_but_for_the_frame(signal: Signal) -> None:
    designs, differing = random_designs(20, seed=3), 0
    for added, heavier in pairs(4):
        if signal in OF_THE_FRAME:
            heavier = replace(heavier, slider_mass=added.slider_mass)
        one, other = (find_peaks(machine, signal, designs, gradients=True) for machine in (added, heavier))
        agree(one.values, other.values, rtol=1e-10, atol=1e-12)
        highest = np.abs(one.values[np.isfinite(one.values)]).max()
        agree(one.gradients, other.gradients, rtol=1e-7, atol=1e-7 * highest)
        means = [signal_averages(machine, signal, designs).mean for machine in (added, heavier)]
        agree(means[0], means[1], rtol=1e-9, atol=1e-10)
        without = find_peaks(replace(added, loads=added.loads[:-1]), signal, designs)
        differing += int(not np.allclose(one.values, without.values, rtol=1e-6))
    kinematic = {Signal.SLIDER_SPEED, Signal.SLIDER_ACCELERATION, Signal.SLIDER_JERK}
    ignored = OF_THE_FRAME | kinematic | {Signal.POSITION_ERROR, Signal.POSITION_ERROR_RSS}
    assert differing == (0 if signal in ignored else 4)


@pytest.mark.parametrize("signal", [Signal.TORQUE, Signal.REFLECTED_INERTIA])
def test_an_added_mass_of_two_cylinders_counts_in_each(signal: Signal) -> None:
    designs = random_designs(8, seed=5)
    for added, heavier in pairs(2, friction=False):
        machines = [
            replace(each, arrangement=Arrangement(phases=(0.0, 2.0), places=(-0.05, 0.06))) for each in (added, heavier)
        ]
        one, other = (find_peaks(machine, signal, designs).values for machine in machines)
        agree(one, other, rtol=1e-9)


def test_a_varying_added_mass_has_the_derivative_of_a_varying_slider_mass() -> None:
    designs = random_designs(10, seed=9)
    added, heavier = pairs(1, friction=False)[0]
    mass = added.loads[-1].numbers_for_kernel()[2]
    one = replace(added, varying=(vary(f"loads.{len(added.loads) - 1}.mass", 0.0, 9.0),))
    other = replace(heavier, varying=(vary("slider_mass", 0.0, 9.0),))
    for signal in (Signal.TORQUE, Signal.GUIDE_FORCE, Signal.REFLECTED_INERTIA):
        rows = [
            find_peaks(machine, signal, np.column_stack([designs, np.full(10, value)]), gradients=True)
            for machine, value in ((one, mass), (other, heavier.slider_mass))
        ]
        slopes = agree(rows[0].gradients, rows[1].gradients, rtol=1e-8, atol=1e-9)
        assert np.abs(slopes[:, 0, 3]).min() > 0.0


def test_the_equation_of_motion_has_the_added_mass_in_its_inertia_and_in_no_load() -> None:
    """As a force of mass times acceleration it would be missing from the inertia that a motor starts."""
    angles = np.linspace(0.1, 6.0, 50)
    (design,) = random_designs(1, seed=2, least_margin=0.2)
    for added, heavier in pairs(3):
        equations = [CrankEquation(machine, linkage_of(design, machine.branch)) for machine in (added, heavier)]
        for way in (1.0, -1.0):
            one, other = (equation.stretch_from_breakpoint(0, way).terms_at(angles) for equation in equations)
            for name in ("inertia", "spin", "static", "drag", "square", "load"):
                agree(getattr(one, name), getattr(other, name), rtol=1e-11, atol=1e-12)
        agree(equations[0].moving_inertia(angles), equations[1].moving_inertia(angles), rtol=1e-13)


@pytest.mark.parametrize("signal", [DRIVE, POWER])
def test_in_a_swing_it_is_a_heavier_slider(signal: int) -> None:
    for machine, linkage, swing in random_swings(12, seed=4, friction=True):
        light = replace(machine, gravity=(0.0, 0.0), loads=())
        design = np.array([[float(linkage.crank), float(linkage.rod), float(linkage.offset)]])
        added, heavier, without = (
            swing_peaks(each, swing, signal, design, gradients=True)
            for each in (
                replace(light, loads=(AddedMass(mass=3.0),)),
                replace(light, slider_mass=light.slider_mass + 3.0),
                light,
            )
        )
        agree(added.values, heavier.values, rtol=1e-9, atol=1e-12)
        agree(added.gradients, heavier.gradients, rtol=1e-6, atol=1e-6)
        steady = swing.duration is None or (swing.driver == "slider" and swing.law == "constant")
        assert np.allclose(added.values, without.values, rtol=1e-6) == steady


def test_weight_is_that_of_the_slider_alone() -> None:
    machine = Mechanism(gravity=(0.0, -9.81), slider_mass=1.0, loads=(AddedMass(mass=50.0),), speed=1e-6)
    guide = find_peaks(machine, Signal.GUIDE_FORCE, np.array([[0.05, 0.2, 0.0]])).values[0, 0]
    assert guide == pytest.approx(9.81, rel=1e-9)


def test_water_in_a_suction_pipe_needs_the_torque_of_its_kinetic_energy() -> None:
    """A 100 mm piston on a 50 mm pipe, 6 m long: 11.781 kg of water act as 188.5 kg."""
    area, pipe = np.pi * 0.05**2, np.pi * 0.025**2
    mass = 1000.0 * 6.0 * area**2 / pipe
    assert mass == pytest.approx(188.496, abs=1e-3)
    machine, design = Mechanism(speed=10.0, loads=(AddedMass(mass=mass),)), np.array([[0.05, 0.25, 0.0]])
    theta = np.linspace(0.0, 2.0 * np.pi, 20001)
    position = 0.05 * np.cos(theta) + np.sqrt(0.25**2 - (0.05 * np.sin(theta)) ** 2)
    flow = area * np.gradient(position, theta, edge_order=2) * 10.0
    energy = 0.5 * 1000.0 * 6.0 * pipe * (flow / pipe) ** 2
    torque = np.abs(np.gradient(energy, theta, edge_order=2)).max()
    assert find_peaks(machine, Signal.TORQUE, design).values[0, 0] == pytest.approx(torque, rel=1e-6)


def test_a_simulation_of_clearance_refuses_an_added_mass() -> None:
    added, _ = pairs(1, friction=False)[0]
    with pytest.raises(
        InputError, match=r"accepts only forces on the slider; got added mass, .* add that mass to the slider's"
    ):
        simulate(Mechanism(speed=5.0, loads=added.loads[-1:]), linkage_of(random_designs(1, seed=1)[0]), CLEARANCE)


@pytest.mark.parametrize("mass", [-1.0, np.nan, np.inf])
def test_an_added_mass_is_zero_or_more_and_finite(mass: float) -> None:
    with pytest.raises(InputError, match="must be zero or more and finite"):
        AddedMass(mass=mass)
