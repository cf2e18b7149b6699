"""Stress of crank and rod over place and cycle: against integrated section forces, dense samples, differences."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from slidercrank.model.cycle.cycle import breakpoints
from slidercrank.model.machine.links_and_joints import Counterweight
from slidercrank.model.machine.loads.angle_table import AngleTable
from slidercrank.model.machine.loads.engine import FourStroke
from slidercrank.model.machine.loads.load import AngleDatum
from slidercrank.model.strength.section_forces import CRANK, ROD
from slidercrank.model.strength.stress_cycle import stress_peaks
from slidercrank.model.strength.stress_locations import LinkBody
from tests.model.cases import Array, random_designs
from tests.model.strength.sections import linkage_with, random_bars, section_stress, stress_rows

STATIC = np.array([[1.0, 0.0], [0.0, 1.0]])
PARTS = {"rod": (LinkBody(ROD),), "crank": (LinkBody(CRANK),)}


@pytest.mark.parametrize("part", PARTS)
def test_stress_is_that_of_what_lies_beyond_the_section(part: str) -> None:
    random = np.random.default_rng(61)
    compared = 0
    for design in random_designs(40, seed=62, least_margin=3e-2):
        machine = replace(random_bars(random), counterweight=Counterweight(mass=0.0, radius=0.0))
        linkage = linkage_with(machine, design)
        found = stress_peaks(machine, PARTS[part], design[None], STATIC)[0]
        cuts = breakpoints(machine, linkage)
        for value, (share, face, angle, _) in zip(found.values[0], found.places[0], strict=True):
            if not np.isfinite(value) or np.abs(np.angle(np.exp(1j * (angle - cuts)))).min() < 1e-6:
                continue  # at a jump, on one side of it
            stress = section_stress(machine, part, linkage, np.array([angle]), share, face)[0]
            assert abs(stress) == pytest.approx(value, rel=1e-10)
            compared += 1
    assert compared > 20


@pytest.mark.parametrize("part", PARTS)
@pytest.mark.parametrize("pulls", [STATIC, np.array([[4.3e-9, 2.4e-9], [3.3e-9, 3.3e-9]])], ids=["static", "fatigue"])
def test_no_place_or_crank_angle_is_worse_than_the_peak(part: str, pulls: Array) -> None:
    random = np.random.default_rng(63)
    shares = np.linspace(0.0, 1.0, 101)
    for design in random_designs(20, seed=64, least_margin=3e-2):
        machine = random_bars(random)
        linkage = linkage_with(machine, design)
        cuts = breakpoints(machine, linkage)
        theta = np.concatenate([np.arange(1440) * (np.pi / 720.0), cuts - 1e-9, cuts + 1e-9])
        axial, bending = stress_rows(machine, part, linkage, theta, shares)
        worst = max(
            (p * stress.max(axis=0) - q * stress.min(axis=0)).max()
            for stress in (axial + bending, axial - bending)
            for p, q in pulls
        )
        peak = stress_peaks(machine, PARTS[part], design[None], pulls)[0].values[0, 0]
        assert worst * (1.0 - 1e-7) <= peak <= worst * (1.0 + 1e-3)


@pytest.mark.parametrize("part", PARTS)
def test_a_cycle_of_two_turns_has_the_greatest_stress_and_the_widest_swing_of_both(part: str) -> None:
    """Tables over 720 deg: the worst of a dense sweep, whichever turns have the angles."""
    random, turns = np.random.default_rng(65), set()
    fatigue = np.array([[4.3e-9, 2.4e-9], [3.3e-9, 3.3e-9]])
    datums: list[AngleDatum] = ["zero crank angle", "inner dead centre", "outer dead centre"]
    shares = np.linspace(0.0, 1.0, 101)
    for number, design in enumerate(random_designs(12, seed=66, least_margin=3e-2)):
        angles = np.sort(random.uniform(0.0, 4.0 * np.pi, 9))
        forces = random.normal(0.0, 1500.0, 9)
        table = AngleTable(
            angles=tuple(angles.tolist()), forces=tuple(forces.tolist()), cycle="720 deg", datum=datums[number % 3]
        )
        machine = replace(random_bars(random), loads=(table,))
        linkage = linkage_with(machine, design)
        cuts = breakpoints(machine, linkage)
        theta = np.concatenate([np.arange(4320) * (np.pi / 1080.0), cuts - 1e-9, cuts + 1e-9])
        axial, bending = stress_rows(machine, part, linkage, theta, shares)
        faces = np.abs([axial + bending, axial - bending]).max(axis=0)
        found = stress_peaks(machine, PARTS[part], design[None], STATIC, gradients=True)[0]
        worst, top = faces.max(), found.values[0, 0]
        assert worst * (1.0 - 1e-7) <= top <= worst * (1.0 + 1e-3)
        assert (np.diff(found.values[0][np.isfinite(found.values[0])]) <= 0.0).all()
        share, face, *at = found.places[0, 0]
        sides = np.array([-1e-7, 0.0, 1e-7])  # of a jump
        stress = [stress_rows(machine, part, linkage, angle + sides, np.array([share])) for angle in at]
        seen = max(np.abs(axial + face * bending).max() for axial, bending in stress)
        assert seen == pytest.approx(top, rel=1e-5)
        worst = max(
            (p * stress.max(axis=0) - q * stress.min(axis=0)).max()
            for stress in (axial + bending, axial - bending)
            for p, q in fatigue
        )
        swing = stress_peaks(machine, PARTS[part], design[None], fatigue)[0]
        assert worst * (1.0 - 1e-7) <= swing.values[0, 0] <= worst * (1.0 + 1e-3)
        turns.add(tuple((swing.places[0, 0, 2:] // (2.0 * np.pi)).tolist()))
    assert {(0.0, 1.0), (1.0, 0.0)} & turns
    assert {(0.0, 0.0), (1.0, 1.0)} & turns


@pytest.mark.parametrize("part", PARTS)
def test_a_fatigue_gradient_over_two_turns_is_that_of_differences(part: str) -> None:
    random = np.random.default_rng(68)
    fatigue = np.array([[4.3e-9, 2.4e-9]])
    compared = 0
    for design in random_designs(6, seed=67, least_margin=5e-2):
        gas = FourStroke(
            bore=random.uniform(0.04, 0.1),
            low=1e5,
            high=random.uniform(3e6, 6e6),
            clearance=0.1,
            compression_exponent=1.3,
            expansion_exponent=1.25,
            exhaust=1.5e5,
        )
        machine = replace(random_bars(random), loads=(gas,))
        found = stress_peaks(machine, PARTS[part], design[None], fatigue, gradients=True)[0]
        assert found.gradients is not None
        for column in range(3):
            step = 1e-6 * design.max() * np.eye(3)[column]
            low, high = (
                stress_peaks(machine, PARTS[part], at[None], fatigue, limit=1)[0].values[0, 0]
                for at in (design - step, design + step)
            )
            slope = (high - low) / (2.0 * step[column])
            scale = np.abs(found.gradients[0, 0]).max()
            assert found.gradients[0, 0, column] == pytest.approx(slope, abs=1e-5 * scale)
            compared += 1
    assert compared == 18
