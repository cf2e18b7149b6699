"""Where friction locks: the analytic condition, its margin, and that nothing is returned there."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from slidercrank.model.cycle.cycle import cycle, cycle_energies
from slidercrank.model.cycle.locked_angles import locking_states, locking_verdict
from slidercrank.model.cycle.self_locking import locking_margin
from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.links_and_joints import Friction, Pin
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.mechanism import Branch, Mechanism
from slidercrank.model.signals.averages import torque_averages
from slidercrank.model.signals.peaks import find_peaks
from slidercrank.model.signals.signals import Signal
from tests.model.cases import Array, random_designs, random_friction, random_machine

RESISTS, DRIVES = StrokeForce(outward=-100.0, inward=100.0), StrokeForce(outward=100.0, inward=-100.0)
DESIGN = np.array([0.1, 0.16, 0.05])
PINS = Friction(guide=0.4, crank_pin=Pin(radius=0.02, coefficient=0.2), slider_pin=Pin(radius=0.01, coefficient=0.2))


def margin(friction: Friction, design: Array) -> float:
    return float(locking_margin(friction, design[None])[0][0])


@pytest.mark.parametrize("branch", ["open", "crossed"])
@pytest.mark.parametrize("speed", [4.0, -4.0])
def test_guide_locks_where_the_transmission_angle_is_below_the_angle_of_friction(speed: float, branch: Branch) -> None:
    """Massless, guide alone: locked exactly where the transmission angle is below arctan(mu), if the load resists."""
    random = np.random.default_rng(91)
    theta = np.linspace(0.0, 2.0 * math.pi, 361)
    for r, l, e in random_designs(12, seed=92, greatest_margin=0.5):
        coefficient = random.uniform(0.2, 1.2)
        linkage = Linkage(r, l, e, branch)
        machine = Mechanism(speed=speed, loads=(RESISTS,), friction=Friction(guide=coefficient), branch=branch)
        angle = linkage.at(theta).transmission_angle
        expected = angle <= math.atan(coefficient)
        np.testing.assert_array_equal(locking_states(machine, linkage, theta) == "locks", expected)
        np.testing.assert_array_equal(np.isnan(cycle(machine, linkage, theta).torque), expected)
        found = locking_verdict(machine, linkage)
        assert found.locks == bool(float(linkage.least_transmission_angle) <= math.atan(coefficient))
        for end in (end for span in found.locked for end in span):
            assert float(linkage.at(end).transmission_angle) == pytest.approx(math.atan(coefficient), rel=1e-9)
        assert found.holds == (1.0 if found.locks else None)
        driven = dataclasses.replace(machine, loads=(DRIVES,))
        np.testing.assert_array_equal(locking_states(driven, linkage, theta) == "may jam", expected)


def test_pins_add_the_angle_of_their_friction_circles() -> None:
    """Where pins and guide act together the rod's force leans by asin((rho_A + rho_B) / l) more."""
    r, l, e = DESIGN
    circles = PINS.crank_pin.friction_circle_radius + PINS.slider_pin.friction_circle_radius
    expected = math.acos((r + e) / l) - math.atan(0.4) - math.asin(circles / l)
    assert margin(PINS, DESIGN) == pytest.approx(expected, rel=1e-14)
    machine = Mechanism(speed=1.0, loads=(RESISTS,), friction=PINS)
    (span,) = locking_verdict(machine, Linkage(*DESIGN)).locked
    # Before 270 deg the rod swings one way, after it the other: the slider pin's circle helps, then hinders.
    before, after = (Linkage(*DESIGN).at(end) for end in span)
    lean = math.atan(0.4)
    difference = (PINS.crank_pin.friction_circle_radius - PINS.slider_pin.friction_circle_radius) / l
    assert float(before.transmission_angle) == pytest.approx(lean + math.asin(difference), rel=1e-9)
    assert float(after.transmission_angle) == pytest.approx(lean + math.asin(circles / l), rel=1e-9)


def test_forces_are_determined_all_over_the_cycle_exactly_when_the_margin_is_more_than_zero() -> None:
    random = np.random.default_rng(93)
    theta = np.append(np.linspace(0.0, 2.0 * math.pi, 3600), [0.5 * math.pi, 1.5 * math.pi])
    for design in random_designs(60, seed=94, greatest_margin=1.0):
        machine = dataclasses.replace(random_machine(random), friction=random_friction(random))
        # The rod for which the margin is 1e-6 of its length more or less than none.
        low, high = float(design[0] + abs(design[2])), 100.0
        for _ in range(80):
            middle = 0.5 * (low + high)
            low, high = (
                (low, middle)
                if margin(machine.friction, np.array([design[0], middle, design[2]])) > 0.0
                else (middle, high)
            )
        for rod, drives in ((low * (1.0 - 1e-6), False), (high * (1.0 + 1e-6), True)):
            linkage = Linkage(design[0], rod, design[2], machine.branch)
            finite = np.isfinite(cycle(machine, linkage, theta).torque)
            assert bool(finite.all()) == drives
            assert locking_verdict(machine, linkage).locks != drives


def test_margin_without_friction_is_the_least_transmission_angle() -> None:
    designs = random_designs(100, seed=95)
    values, slopes = locking_margin(Friction(), designs, gradients=True)
    np.testing.assert_allclose(values, Linkage(*designs.T).least_transmission_angle, rtol=1e-14)
    assert slopes is not None
    assert np.all(slopes[:, 1] > 0.0)


def test_pins_greater_than_the_rod_have_no_margin() -> None:
    thick = Friction(crank_pin=Pin(radius=0.2, coefficient=1.0))
    values, slopes = locking_margin(thick, DESIGN[None], gradients=True)
    assert values[0] == -math.inf
    assert slopes is not None
    assert np.all(slopes == 0.0)


def test_nothing_is_returned_of_a_design_that_locks() -> None:
    machine = Mechanism(speed=5.0, slider_mass=1.0, loads=(RESISTS,), friction=PINS)
    for kind in (Signal.TORQUE, Signal.POWER, Signal.GUIDE_FORCE, Signal.PIVOT_FORCE):
        found = find_peaks(machine, kind, DESIGN[None], gradients=True)
        assert found.values[0, 0] == math.inf
        assert np.all(found.values[0, 1:] == -math.inf)
        assert np.all(np.isnan(found.angles))
        assert found.gradients is not None
        assert np.all(found.gradients == 0.0)
    averages = torque_averages(machine, DESIGN[None], gradients=True)
    assert np.isnan(averages.mean[0])
    assert averages.rms[0] == math.inf
    with pytest.raises(InputError, match=r"self-locking margin must be more than zero; got -.* deg; lengthen the rod"):
        cycle_energies(machine, Linkage(*DESIGN))
    theta = np.linspace(0.0, 2.0 * math.pi, 3600)
    curves = cycle(machine, Linkage(*DESIGN), theta)
    held = locking_states(machine, Linkage(*DESIGN), theta) != "drives"
    assert held.any()
    for name in ("torque", "guide", "pivot_x", "crank_pin_y", "slider_pin_x"):
        assert np.all(np.isnan(getattr(curves, name)[held]))
    # What does not depend on friction is given.
    assert np.all(np.isfinite(curves.slider_acceleration))
    assert np.isfinite(find_peaks(machine, Signal.SHAKING_FORCE, DESIGN[None]).values[0, 0])
