"""Safety of crank and rod: rainflow counting, columns by finite differences, formulas by hand, refusals."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import eigh_tridiagonal

from slidercrank.model.cycle.cycle import breakpoints
from slidercrank.model.machine.links_and_joints import Bar, RigidLink
from slidercrank.model.machine.loads.angle_table import AngleTable
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.mechanism import Criterion, Mechanism
from slidercrank.objectives.link_strength import critical_stress_formula
from slidercrank.objectives.registry import QUANTITIES
from tests.model.cases import STRENGTH, Array, random_designs
from tests.model.strength.sections import eye_rows, linkage_with, random_bars, stress_rows

STEEL = STRENGTH.material


def rainflow(history: Array) -> list[tuple[float, float]]:
    """Return amplitude and mean of every cycle of a closed history, by the four-point rule from its greatest value."""
    turned = np.roll(history, -int(np.argmax(history)))
    stack: list[float] = []
    found = []
    for value in [*turned.tolist(), float(turned[0])]:
        if len(stack) > 1 and (value - stack[-1]) * (stack[-1] - stack[-2]) >= 0.0:
            stack.pop()  # no turning point
        stack.append(value)
        while len(stack) > 3:
            a, b, c, d = stack[-4:]
            if not min(a, d) <= min(b, c) <= max(b, c) <= max(a, d):
                break
            found.append((0.5 * abs(b - c), 0.5 * (b + c)))
            del stack[-3:-1]
    greatest, least = max(stack), min(stack)
    return [*found, (0.5 * (greatest - least), 0.5 * (greatest + least))]


@pytest.mark.parametrize(("criterion", "turns"), [("goodman", 1), ("soderberg", 1), ("goodman", 2)])
def test_fatigue_is_that_of_the_worst_cycle_that_rainflow_counts(criterion: Criterion, turns: int) -> None:
    random = np.random.default_rng(71)
    shares = np.linspace(0.0, 1.0, 65)
    for design in random_designs(8, seed=72, least_margin=5e-2):
        machine = random_bars(random)
        if turns == 2:
            angles, forces = np.sort(random.uniform(0.0, 4.0 * np.pi, 9)), random.normal(0.0, 1500.0, 9)
            table = AngleTable(angles=tuple(angles.tolist()), forces=tuple(forces.tolist()), cycle="720 deg")
            machine = replace(machine, loads=(table,))
        machine = replace(machine, strength=replace(STRENGTH, criterion=criterion))
        linkage = linkage_with(machine, design)
        cuts = breakpoints(machine, linkage)
        theta = np.sort(np.concatenate([np.arange(720 * turns) * (np.pi / 360.0), cuts - 1e-9, cuts + 1e-9]))
        steady = STEEL.ultimate_strength if criterion == "goodman" else STEEL.yield_strength
        used = 0.0
        for part in ("rod", "crank"):
            axial, bending = stress_rows(machine, part, linkage, theta, shares)
            for history in (*(axial + bending).T, *(axial - bending).T, *eye_rows(machine, part, linkage, theta).T):
                used = max(
                    used, *(swing / STEEL.endurance + max(mean, 0.0) / steady for swing, mean in rainflow(history))
                )
        found = QUANTITIES["fatigue_safety"].evaluate(machine, design[None]).values[0]
        assert used * found == pytest.approx(1.0, abs=1e-3)
        assert used * found <= 1.0 + 1e-7  # samples miss the worst by a little


@pytest.mark.parametrize(("held", "clamped"), [(1.0, False), (0.25, True)])
def test_a_slender_bar_buckles_at_the_least_eigenvalue_of_its_bending(held: float, clamped: bool) -> None:
    length, side, n = 0.6, 0.01, 800
    h = length / n
    rows = n if clamped else n - 1
    sides = np.full(rows - 1, -1.0)
    if clamped:  # the half of a pinned column of twice the length: its slope is zero at the clamped end
        sides[0] = -math.sqrt(2.0)  # of -2 in the first row and -1 in the second, made symmetric
    found = eigh_tridiagonal(np.full(rows, 2.0), sides, eigvals_only=True, select="i", select_range=(0, 0))
    least = float(found[0]) / h**2
    stress = critical_stress_formula(0, 1, held, STEEL.elasticity, STEEL.yield_strength)(
        {0: length, 1: side}.__getitem__
    )
    assert stress == pytest.approx(STEEL.elasticity * side**2 / 12.0 * least, rel=1e-5)


def test_eulers_and_johnsons_stress_meet_smoothly_at_half_the_yield_strength() -> None:
    formula = critical_stress_formula(0, 1, 1.0, STEEL.elasticity, STEEL.yield_strength)
    slender = math.sqrt(2.0 * math.pi**2 * STEEL.elasticity / STEEL.yield_strength)
    side = math.sqrt(12.0) / slender

    def at(length: complex) -> complex:
        return complex(formula({0: length, 1: side}.__getitem__))

    low, high = at(1.0 - 1e-9 + 1e-30j), at(1.0 + 1e-9 + 1e-30j)
    assert low.real == pytest.approx(0.5 * STEEL.yield_strength, rel=1e-8)
    assert high == pytest.approx(low, rel=1e-8)
    assert at(1e-6).real == pytest.approx(STEEL.yield_strength)


def test_a_massless_rod_under_a_steady_pull_has_the_stress_of_its_sections() -> None:
    """By hand: without mass and offset the rod carries F / cos(phi), greatest where sin(phi) = r / l."""
    bar = Bar(width=0.03, depth=0.012, density=1e-9)
    machine = Mechanism(
        speed=1.0, crank=bar, rod=bar, loads=(StrokeForce(outward=4000.0, inward=4000.0),), strength=STRENGTH
    )
    design = np.array([[0.05, 0.2, 0.0]])
    force = 4000.0 / math.sqrt(1.0 - (0.05 / 0.2) ** 2)
    eye = STRENGTH.eye_concentration * force / ((0.03 - STRENGTH.crank_pin) * 0.012)
    crank = 0.05 * 4000.0  # torque at the pivot; its greatest value, times the lean of the rod, is the drive torque
    values = {name: QUANTITIES[name].evaluate(machine, design).values[0] for name in NAMES}
    assert values["rod_stress"] == pytest.approx(max(force / (0.03 * 0.012), eye), rel=1e-9)
    assert values["crank_stress"] > 6.0 * crank / (0.012 * 0.03**2)
    assert values["pin_pressure_slider_pin"] == pytest.approx(force / (STRENGTH.slider_pin * 0.012), rel=1e-9)
    assert values["pin_shear_slider_pin"] == pytest.approx(force / (0.25 * math.pi * STRENGTH.slider_pin**2), rel=1e-9)
    # The rod is only pulled; stress from nothing to its greatest: amplitude and mean are half of it.
    pulled = QUANTITIES["buckling_safety"].evaluate(replace(machine, crank=RigidLink(mass=1.0)), design).values[0]
    assert math.isinf(pulled)


NAMES = ("rod_stress", "crank_stress", "pin_pressure_slider_pin", "pin_shear_slider_pin")


@pytest.mark.parametrize("name", ["rod_stress", "static_safety", "buckling_safety", "pin_pressure_slider_pin"])
def test_what_lacks_material_or_section_is_refused_with_the_remedy(name: str) -> None:
    bar = Bar(width=0.03, depth=0.012, density=7850.0)
    quantity = QUANTITIES[name]
    assert "for example, add [sections]" in str(quantity.undefined_because([Mechanism(rod=bar, crank=bar)]))
    loose = Mechanism(rod=RigidLink(mass=1.0), crank=RigidLink(mass=1.0), strength=STRENGTH)
    assert "width" in str(quantity.undefined_because([loose]))
    assert np.isnan(quantity.evaluate(loose, np.array([[0.05, 0.2, 0.0]])).values).all()


def test_a_pin_as_wide_as_its_eye_is_told_as_no_section() -> None:
    bar = Bar(width=STRENGTH.crank_pin, depth=0.012, density=7850.0)
    machine = Mechanism(speed=10.0, rod=bar, crank=bar, slider_mass=1.0, strength=STRENGTH)
    design = np.array([[0.05, 0.2, 0.01]])
    assert math.isinf(QUANTITIES["rod_stress"].evaluate(machine, design).values[0])
    assert QUANTITIES["static_safety"].evaluate(machine, design).values[0] <= 0.0
