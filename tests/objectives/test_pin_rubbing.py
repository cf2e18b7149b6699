"""Pressure times rubbing speed and wear of the pins: sums over many angles, closed forms, refusals."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from slidercrank.model.cycle.cycle import cycle
from slidercrank.model.machine.links_and_joints import Bar, RigidLink
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.machine.varying_numbers import Varying
from slidercrank.objectives.registry import QUANTITIES
from tests.model.cases import STRENGTH, linkage_of, random_designs, random_friction
from tests.model.strength.sections import random_bars
from tests.objectives.richardson import derivatives, steps_to_the_nearest_edge

PINS = ("pivot", "crank_pin", "slider_pin")


@pytest.mark.parametrize("rubbing", [False, True])
def test_they_are_sums_of_force_times_turning_over_many_angles(rubbing: bool) -> None:
    random = np.random.default_rng(91)
    theta = (np.arange(40_000) + 0.5) * (2.0 * np.pi / 40_000)
    for design in random_designs(5, seed=92, least_margin=0.3):
        machine = random_bars(random)
        machine = replace(machine, friction=random_friction(random)) if rubbing else machine
        assert isinstance(machine.crank, Bar)
        assert isinstance(machine.rod, Bar)
        linkage = linkage_of(design, machine.branch)
        found, swing = cycle(machine, linkage, theta), linkage.at(theta, speed=1.0).rod_velocity
        forces = [np.hypot(getattr(found, f"{name}_x"), getattr(found, f"{name}_y")) for name in PINS]
        depths = (machine.crank.depth, min(machine.crank.depth, machine.rod.depth), machine.rod.depth)
        diameters = (STRENGTH.crank_pivot, STRENGTH.crank_pin, STRENGTH.slider_pin)
        turned = (np.ones_like(swing), np.abs(1.0 - swing), np.abs(swing))
        for name, force, turning, b, d in zip(PINS, forces, turned, depths, diameters, strict=True):
            pressure, path = force / (d * b), 0.5 * d * turning  # path: per rad of the crank
            pv = float(np.mean(pressure * path)) * abs(machine.speed)
            worn = 1e6 * 1e-15 * 2.0 * math.pi * float(np.mean(pressure * path))
            assert QUANTITIES[f"pv_{name}"].evaluate(machine, design[None]).values[0] == pytest.approx(pv, rel=2e-4)
            assert QUANTITIES[f"wear_{name}"].evaluate(machine, design[None]).values[0] == pytest.approx(worn, rel=2e-4)


def test_a_pivot_under_a_weight_wears_as_archard_says() -> None:
    """Worked by hand: a crank of mass m at a crawl, a million turns of pi D."""
    crank = Bar(width=0.03, depth=0.02, density=7850.0)
    machine = Mechanism(speed=1e-6, crank=crank, gravity=(0.0, -9.81), strength=STRENGTH)
    weight, d = 9.81 * crank.mass(0.1), STRENGTH.crank_pivot
    depth = 1e-15 * weight / (d * 0.02) * 1e6 * math.pi * d
    design = np.array([[0.1, 0.4, 0.02]])
    assert QUANTITIES["wear_pivot"].evaluate(machine, design).values[0] == pytest.approx(depth, rel=1e-9)
    # A machine at twice the speed under the same force rubs twice as fast.
    slow, quick = (
        QUANTITIES["pv_pivot"].evaluate(replace(machine, speed=speed), design).values[0] for speed in (1e-6, -2e-6)
    )
    assert slow == pytest.approx(weight / (d * 0.02) * 0.5 * d * 1e-6, rel=1e-9)
    assert quick == pytest.approx(2.0 * slow, rel=1e-9)


@pytest.mark.parametrize("name", ["pv_crank_pin", "wear_slider_pin"])
def test_gradients_by_sections_and_speed_are_those_of_extrapolated_differences(name: str) -> None:
    more = (
        Varying(name="depth", sets=(("rod.depth", 1.0),), lower=0.001, upper=0.02),
        Varying(name="width", sets=(("rod.width", 1.0),), lower=0.01, upper=0.1),
        Varying(name="pin", sets=(("strength.crank_pin", 1.0),), lower=0.002, upper=0.01),
        Varying(name="speed", sets=(("speed", 1.0),), lower=-30.0, upper=-2.0),
    )
    own = random_designs(6, seed=93, least_margin=0.1)
    machine = replace(random_bars(np.random.default_rng(94)), varying=more)
    designs = np.column_stack([own, np.tile([0.004, 0.04, 0.005, -10.0], (len(own), 1))])
    lengths = 0.3 * steps_to_the_nearest_edge(own, kink_without_offset=True)
    first = np.column_stack([lengths, np.tile([4e-4, 4e-3, 5e-4, 1.0], (len(own), 1))])
    quantity = QUANTITIES[name]
    expected, _ = derivatives(lambda rows, _: quantity.evaluate(machine, rows).values, designs, first)
    gradients = quantity.evaluate(machine, designs, gradients=True).gradients
    assert gradients is not None
    assert np.all(gradients[:, 5] == 0.0)  # the pin's diameter cancels
    size = np.abs(expected).max(axis=1, keepdims=True)
    assert np.max(np.abs(gradients - expected) / size) < 1e-7


def test_what_is_missing_is_told_with_its_remedy() -> None:
    bar = Bar(width=0.03, depth=0.012, density=7850.0)
    machine = Mechanism(speed=10.0, rod=bar, crank=bar, slider_mass=1.0, strength=STRENGTH)
    plain = replace(machine, strength=replace(STRENGTH, wear_coefficient=None))
    wear, pv = QUANTITIES["wear_crank_pin"], QUANTITIES["pv_slider_pin"]
    assert "wear_coefficient =" in str(wear.undefined_because([plain]))
    assert np.isnan(wear.evaluate(plain, np.array([[0.05, 0.2, 0.0]])).values).all()
    assert pv.undefined_because([plain]) is None
    assert "width" in str(pv.undefined_because([replace(machine, rod=RigidLink(mass=1.0))]))
    still = replace(machine, speed=0.0, gravity=(0.0, -9.81))
    assert "speed" in str(pv.undefined_because([still]))
    assert wear.undefined_because([still]) is None
    assert wear.zero_because([still]) is None
