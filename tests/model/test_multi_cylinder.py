"""Several cylinders on one crankshaft: sums of single runs, engines that balance by the textbook, refusals."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from slidercrank.model.cycle.cycle import cycle
from slidercrank.model.cycle.multi_cylinder import multi_cylinder_curves, multi_cylinder_cycle, shaking_curves
from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.arrangement import Arrangement
from slidercrank.model.machine.cylinders_and_turns import machines_of_arrangement, single_cylinder_machine
from slidercrank.model.machine.links_and_joints import Friction
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.signals.averages import signal_averages, torque_averages
from slidercrank.model.signals.peaks import find_peaks
from slidercrank.model.signals.signals import Signal
from tests.model.cases import linkage_of, random_designs, random_friction, random_machine
from tests.model.test_cylinder import random_case

TURN = 2.0 * math.pi
DENSE = np.linspace(0.0, TURN, 40_000, endpoint=False)
PISTONS = Mechanism(speed=100.0, slider_mass=0.4, crank=random_machine(np.random.default_rng(1)).crank)
INLINE = Linkage(0.04, 0.13, 0.0, "open")


def degrees(*angles: float) -> tuple[float, ...]:
    """Return angles in rad."""
    return tuple(math.radians(angle) for angle in angles)


def random_whole(seed: int) -> tuple[Mechanism, Linkage]:
    """Return a machine of two to six cylinders in random banks; every third one has friction."""
    random = np.random.default_rng(seed)
    machine = random_machine(random) if seed % 2 else random_case(seed)[0]
    count = int(random.integers(2, 7))
    phases, banks, places = random.uniform(-7.0, 7.0, (3, count))
    arrangement = Arrangement(phases=tuple(phases), banks=tuple(banks), places=tuple(0.1 * places))
    machine = replace(machine, gravity=(3.0, -9.0), arrangement=arrangement, slider_mass=1.0)
    machine = replace(machine, friction=random_friction(random)) if seed % 3 == 0 else machine
    design = random_designs(1, seed=seed, least_margin=0.5 if machine.friction != Friction() else 0.01)[0]
    return machine, linkage_of(design, machine.branch)


@pytest.mark.parametrize("seed", range(12))
def test_the_whole_is_the_sum_of_single_runs(seed: int) -> None:
    """Torque at random angles; means exactly; peaks and mean squares against a dense sweep."""
    machine, linkage = random_whole(seed)
    theta = np.random.default_rng(seed).uniform(0.0, TURN, 50)
    torque = np.zeros((2, len(DENSE)))
    force = np.zeros((2, len(DENSE)))
    at, mean = np.zeros(len(theta)), 0.0
    assert machine.arrangement is not None
    for phase, bank in zip(machine.arrangement.phases, machine.arrangement.banks, strict=True):
        gx, gy = machine.gravity
        pull = complex(gx, gy) * np.exp(-1j * bank)
        alone = replace(machine, arrangement=None, gravity=(pull.real, pull.imag))
        at += cycle(alone, linkage, theta + phase - bank).torque
        torque[0] += cycle(alone, linkage, DENSE + phase - bank).torque
        own = shaking_curves(alone, linkage, DENSE + phase - bank)
        turned = (own.force_x + 1j * own.force_y) * np.exp(1j * bank)
        force += np.stack([turned.real, turned.imag])
        torque[1] += own.moment
        mean += torque_averages(alone, np.array([[linkage.crank, linkage.rod, linkage.offset]])).mean[0]
    size = np.abs(torque[0]).max()
    assert multi_cylinder_curves(machine, linkage, theta).torque == pytest.approx(at, rel=1e-12, abs=1e-12 * size)
    found = multi_cylinder_cycle(machine, linkage)
    assert found.mean == pytest.approx(mean, rel=1e-10, abs=1e-10 * size)
    for extreme, sign in (
        (found.greatest, 1.0),
        (found.least, -1.0),
    ):  # none beyond, and one of its two limits is there
        assert sign * extreme.value >= (sign * torque[0]).max() - 1e-10 * size
        near = multi_cylinder_curves(machine, linkage, extreme.angle + np.array([-1e-10, 1e-10])).torque
        assert np.abs(near - extreme.value).min() < 1e-7 * size
    assert found.rms == pytest.approx(math.sqrt(np.mean(torque[0] ** 2)), rel=1e-5)
    assert found.fluctuation == pytest.approx(math.sqrt(np.mean((torque[0] - mean) ** 2)), rel=1e-4)
    assert found.energy_change == pytest.approx(np.ptp(np.cumsum(torque[0] - mean)) * TURN / len(DENSE), rel=1e-3)
    assert found.shaking_force.value == pytest.approx(np.hypot(*force).max(), rel=1e-6)
    assert found.rms_shaking_force == pytest.approx(math.sqrt(np.mean(force**2) * 2.0), rel=1e-9)
    assert found.shaking_moment.value == pytest.approx(np.abs(torque[1]).max(), rel=1e-6)


@pytest.mark.parametrize("seed", range(6))
def test_one_cylinder_is_the_machine_alone(seed: int) -> None:
    """To 1e-10, from other formulas: those of the quantities."""
    machine, linkage = random_whole(3 * seed + 1)
    design = np.array([[linkage.crank, linkage.rod, linkage.offset]])
    found = multi_cylinder_cycle(replace(machine, arrangement=Arrangement(phases=(0.7,))), linkage)
    machine = single_cylinder_machine(machine)
    peak = find_peaks(machine, Signal.TORQUE, design, limit=1)
    averages = torque_averages(machine, design)
    assert abs(found.peak.value) == pytest.approx(peak.values[0, 0], rel=1e-10)
    assert math.remainder(found.peak.angle + 0.7 - peak.angles[0, 0], TURN) == pytest.approx(0.0, abs=1e-6)
    assert found.mean == pytest.approx(averages.mean[0], rel=1e-10, abs=1e-10 * averages.rms[0])
    assert found.rms == pytest.approx(averages.rms[0], rel=1e-10)
    for kind, value, rms in (
        (Signal.SHAKING_FORCE, found.shaking_force.value, found.rms_shaking_force),
        (Signal.SHAKING_MOMENT, found.shaking_moment.value, found.rms_shaking_moment),
    ):
        assert value == pytest.approx(find_peaks(machine, kind, design, limit=1).values[0, 0], rel=1e-10)
        assert rms == pytest.approx(signal_averages(machine, kind, design).rms[0], rel=1e-10)


def test_textbook_engines_balance() -> None:
    """In line four: second order of all adds up. In line six: nothing is left. Boxer of two: a couple alone.

    Norton, Design of Machinery, chapter 14: a four-cylinder in line shakes with twice the crank's speed.
    """
    four = Arrangement(phases=degrees(0, 180, 180, 0), places=(-0.15, -0.05, 0.05, 0.15))
    curves = multi_cylinder_curves(replace(PISTONS, arrangement=four), INLINE, DENSE)
    spectrum = np.abs(np.fft.rfft(curves.force_x)) / len(DENSE)
    assert spectrum[[1, 3]] == pytest.approx([0.0, 0.0], abs=1e-12 * spectrum[2])
    # Second harmonic of the piston's acceleration, r w^2 (A - A^3 / 4 ...): to the first term A = r / l, 5 %.
    assert 2.0 * spectrum[2] == pytest.approx(4 * 0.4 * 0.04 * 100.0**2 * 0.04 / 0.13, rel=0.05)
    assert multi_cylinder_cycle(replace(PISTONS, arrangement=four), INLINE).couple.value == 0.0
    six = Arrangement(phases=degrees(0, 120, 240, 240, 120, 0), places=(-0.25, -0.15, -0.05, 0.05, 0.15, 0.25))
    found = multi_cylinder_cycle(replace(PISTONS, arrangement=six), INLINE)
    one = multi_cylinder_cycle(replace(PISTONS, arrangement=Arrangement(phases=(0.0,))), INLINE)
    assert found.couple.value == 0.0
    assert found.shaking_force.value < 2e-3 * one.shaking_force.value  # the sixth harmonic is left
    boxer = Arrangement(phases=degrees(0, 180), banks=degrees(0, 180), places=(-0.02, 0.02))
    found = multi_cylinder_cycle(replace(PISTONS, arrangement=boxer), INLINE)
    assert found.shaking_force.value == 0.0
    assert found.couple.value == pytest.approx(0.04 * one.shaking_force.value, rel=1e-12)


def test_a_cylinder_turned_with_its_bank_gives_the_same_power_to_gravity() -> None:
    """Torque of the masses' weight is the slope of their height, found from turned positions of the bodies."""
    machine = Mechanism(speed=1e-9, slider_mass=2.0, gravity=(1.5, -9.0))
    linkage = Linkage(0.05, 0.17, 0.02, "open")
    arrangement = Arrangement(phases=(0.4, 2.0), banks=(0.9, -2.1))

    def energy(theta: float) -> float:
        total = 0.0
        for phase, bank in zip(arrangement.phases, arrangement.banks, strict=True):
            x = float(linkage.at(theta + phase - bank).slider_position)
            place = complex(x, linkage.offset) * np.exp(1j * bank)
            total -= 2.0 * (1.5 * place.real - 9.0 * place.imag)
        return total

    for theta in (0.1, 1.7, 4.4):
        slope = (energy(theta + 1e-5) - energy(theta - 1e-5)) / 2e-5
        found = multi_cylinder_curves(replace(machine, arrangement=arrangement), linkage, theta).torque[0]
        assert found == pytest.approx(slope, rel=1e-6)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"phases": ()}, "1 to 24; got 0 phases"),
        ({"phases": tuple(0.1 * k for k in range(25))}, "got 25 phases"),
        ({"phases": (0.0, math.nan)}, "must be finite"),
        ({"phases": (0.0, TURN)}, "got 0 deg for cylinder 1 and 360 deg for cylinder 2; change one of them"),
        ({"phases": (0.0, 0.0), "banks": (0.5, 0.5)}, "both in the bank at 28.6479 deg"),
        ({"phases": (0.0, 1.0), "banks": (0.5,)}, "got 1 banks and 2 phases"),
    ],
)
def test_impossible_cylinders_are_refused(given: dict[str, tuple[float, ...]], said: str) -> None:
    with pytest.raises(InputError, match=said):
        Arrangement(**given)


def test_without_cylinders_there_is_no_whole() -> None:
    with pytest.raises(InputError, match=r"cylinders = \{ phases"):
        machines_of_arrangement(PISTONS)
