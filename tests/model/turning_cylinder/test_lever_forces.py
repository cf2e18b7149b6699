"""Forces of a lever and its turning cylinder against free bodies with constraints, virtual work and given numbers."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from slidercrank.model.errors import InputError
from slidercrank.model.machine.lever_spring import LeverSpring
from slidercrank.model.quadrature import gauss_nodes_and_weights
from slidercrank.model.swing.law import travel_speed_acceleration
from slidercrank.model.turning_cylinder.cylinder_and_pin_forces import (
    LeverBody,
    LeverMachine,
    LeverSwing,
    UniformBar,
    lever_curves,
)
from slidercrank.model.turning_cylinder.lever_geometry import TurningCylinder
from tests.model.turning_cylinder.constrained_bodies import Bodies
from tests.model.turning_cylinder.machines import some_machine, some_spring

LIFT = math.radians(-20.0), math.radians(50.0)


def carrying_80_kg(crank: float, frame: float) -> LeverMachine:
    """Return a lever that carries 80 kg at 0.70 m, its cylinder on a frame at -60 deg."""
    sizes = TurningCylinder(crank=crank, frame=frame, frame_angle=math.radians(-60.0))
    return LeverMachine(sizes=sizes, lever=LeverBody().with_point_mass(80.0, 0.7))


@pytest.mark.parametrize("sprung", [False, True])
def test_forces_of_random_machines_are_those_of_free_bodies_with_constraints(sprung: bool) -> None:
    random = np.random.default_rng(42)
    for _ in range(60 if sprung else 300):
        machine, swing = some_machine(random)
        if sprung:
            machine = replace(machine, spring=some_spring(random))
        share = random.uniform(0.05, 0.95, 1)
        curves = lever_curves(machine, swing, share)
        rate = 0.0 if swing.duration is None else 1.0 / swing.duration
        first, last = (float(machine.sizes.cylinder_length(angle)) for angle in (swing.start, swing.end))
        s, s_1, s_2 = (float(part[0]) for part in travel_speed_acceleration(swing.law, share))
        angle, gamma = float(curves.lever_angle[0]), float(curves.cylinder_angle[0])
        guess = np.array([0.0, 0.0, angle, 0.0, 0.0, gamma, 0.0, 0.0, gamma]) + random.normal(0.0, 0.01, 9)
        travel = last - first
        found = Bodies(machine).joint_forces(guess, first + travel * s, travel * s_1 * rate, travel * s_2 * rate**2)
        assert found.coordinates[2] == pytest.approx(angle, abs=1e-9)
        assert math.cos(found.coordinates[5] - gamma) == pytest.approx(1.0, abs=1e-12)
        size = abs(found.push) + abs(found.pin) + abs(found.pivot) + abs(found.cylinder_pivot)
        assert curves.push[0] == pytest.approx(found.push, abs=1e-8 * size)
        assert curves.pin[0] == pytest.approx(found.pin, abs=1e-8 * size)
        assert curves.pivot[0] == pytest.approx(found.pivot, abs=1e-8 * size)
        assert curves.cylinder_pivot[0] == pytest.approx(found.cylinder_pivot, abs=1e-8 * size)


def test_the_work_of_the_slow_cylinder_lifts_the_weights_and_loads_the_spring() -> None:
    """Integral of P dL against the rise of all mass centres, with 40 Gauss points."""
    random = np.random.default_rng(7)
    share, weight = gauss_nodes_and_weights(40)
    for index in range(60):
        machine, swing = some_machine(random)
        if index % 2:
            machine = replace(machine, spring=some_spring(random))
        slow = replace(swing, law="slow", duration=None)
        curves = lever_curves(machine, slow, share)
        first, last = (float(machine.sizes.cylinder_length(angle)) for angle in (slow.start, slow.end))
        parts = (last - first) * weight * curves.push
        work = machine.energy_to_lift(slow.start, slow.end)
        assert float(parts.sum()) == pytest.approx(work, abs=2e-6 * float(np.abs(parts).sum()))


def test_power_of_the_cylinder_is_the_rate_of_kinetic_and_potential_energy() -> None:
    """At rest at both ends, the work over a smooth law is that of the slow swing."""
    random = np.random.default_rng(8)
    share, weight = gauss_nodes_and_weights(60)
    for _ in range(40):
        machine, swing = some_machine(random)
        timed = LeverSwing(swing.start, swing.end, "polynomial", 0.7)
        curves = lever_curves(machine, timed, share)
        parts = 0.7 * weight * curves.push * curves.speed
        work = machine.energy_to_lift(timed.start, timed.end)
        assert float(parts.sum()) == pytest.approx(work, abs=1e-5 * float(np.abs(parts).sum()))


def test_every_force_balances_the_weight_of_the_whole_at_rest() -> None:
    random = np.random.default_rng(9)
    for _ in range(50):
        machine, swing = some_machine(random)
        curves = lever_curves(machine, replace(swing, law="slow", duration=None), np.array([0.3]))
        mass = machine.lever.mass + machine.barrel.mass + machine.piston_rod.mass
        held = complex(curves.pivot[0] + curves.cylinder_pivot[0])
        assert held == pytest.approx(-mass * complex(*machine.gravity), rel=1e-9)


@pytest.mark.parametrize(
    ("crank", "frame", "lengths", "forces"),
    [
        (0.40, 0.60, (390.255, 827.145), (1305.907, 1295.118)),
        (0.35, 0.90, (670.740, 1071.435), (1710.09, 1278.19)),
    ],
)
def test_a_lever_that_lifts_80_kg_has_the_lengths_and_forces_of_the_law_of_cosines(
    crank: float, frame: float, lengths: tuple[float, float], forces: tuple[float, float]
) -> None:
    machine = carrying_80_kg(crank, frame)
    curves = lever_curves(machine, LeverSwing(*LIFT), np.array([0.0, 1.0]))
    assert 1e3 * curves.length == pytest.approx(lengths, abs=5e-4)
    assert curves.push == pytest.approx(forces, abs=5e-3)
    assert machine.energy_to_lift(*LIFT) == pytest.approx(608.726, abs=5e-4)


def test_a_cylinder_without_mass_pushes_along_the_line_of_its_pins() -> None:
    machine = replace(carrying_80_kg(0.35, 0.9), piston_rod=UniformBar(length=0.4))
    curves = lever_curves(machine, LeverSwing(*LIFT), np.linspace(0.0, 1.0, 9))
    span = machine.sizes.motion_at(curves.lever_angle).span
    assert np.allclose(np.angle(curves.pin / span), 0.0, atol=1e-12)
    assert np.allclose(np.abs(curves.pin), curves.push, rtol=1e-12)


@pytest.mark.parametrize(
    ("law", "duration", "part"),
    [
        ("table", 1.0, "law must be 'slow' or .* 'polynomial'; got 'table'"),
        (
            "slow",
            2.0,
            "a slow swing must not have a duration, .*; got 2 s; name a motion law such as cycloidal, or leave",
        ),
        ("harmonic", None, "got the law harmonic and no duration; give the time of one stroke, or leave out the law"),
        ("harmonic", math.inf, "the duration of a swing must be positive and finite; got inf s"),
        ("harmonic", 0.0, "the duration of a swing must be positive and finite; got 0 s"),
    ],
)
def test_a_law_without_its_duration_is_refused(law: str, duration: float | None, part: str) -> None:
    with pytest.raises(InputError, match=part):
        LeverSwing(0.0, 1.0, law, duration)  # type: ignore[arg-type]


def test_bodies_with_negative_or_undefined_masses_are_refused() -> None:
    with pytest.raises(InputError, match="the mass of a lever must be zero or more and finite; got -1"):
        LeverBody(mass=-1.0)
    with pytest.raises(InputError, match=r"the length of barrel and piston rod must be .*; got nan"):
        UniformBar(length=math.nan)
    with pytest.raises(InputError, match="gravity must be finite; got inf"):
        replace(carrying_80_kg(0.4, 0.6), gravity=(0.0, math.inf))


def test_a_spring_that_carries_the_lever_leaves_its_cylinder_idle() -> None:
    """80 kg on a level lever, carried by a vertical spring: F x = m g 0.7 m."""
    spring = LeverSpring(frame=1.0, frame_angle=-math.pi / 3.0, lever=0.5, force=80.0 * 9.81 * 1.4, length=3.0**0.5 / 2)
    machine = replace(carrying_80_kg(0.35, 0.9), spring=spring)
    found = lever_curves(machine, LeverSwing(0.0, 0.5), np.array([0.0, 1.0]))
    assert found.push[0] == pytest.approx(0.0, abs=1e-9)
    assert found.pivot[0] == pytest.approx(complex(0.0, 80.0 * 9.81 * (1.0 - 1.4)), abs=1e-9)
    with pytest.raises(InputError, match=r"at different distances from the lever's pivot.*; got 500 mm for both"):
        replace(spring, frame=0.5)
