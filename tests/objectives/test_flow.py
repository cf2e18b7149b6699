"""Delivered flow and its ripple against volumes by hand and dense curves of the pistons' speeds."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from slidercrank.model.machine.arrangement import Arrangement
from slidercrank.model.machine.loads.compressor import Compressor
from slidercrank.model.machine.mechanism import Branch, Mechanism
from slidercrank.model.machine.speed_profile import Harmonics
from slidercrank.model.machine.varying_numbers import Varying
from slidercrank.objectives.flow import FLOW, FLOW_RIPPLE
from slidercrank.objectives.quantity import Quantity
from slidercrank.objectives.registry import QUANTITIES
from tests.model.cases import Array, linkage_of, random_designs
from tests.objectives.richardson import derivatives, steps_to_the_nearest_edge

PUMP = Compressor(bore=0.05, low=1e5, high=6e5, compression_exponent=0.0, expansion_exponent=0.0)
BACK = replace(PUMP, head="inner dead centre", piston_rod=0.03)
AIR = Compressor(bore=0.07, low=1e5, high=8e5, clearance=0.05, compression_exponent=1.3, expansion_exponent=1.2)
EVEN = Arrangement(phases=(0.0, 2.0 * math.pi / 3.0, 4.0 * math.pi / 3.0))
VEE = Arrangement(phases=(0.0, 1.0, 2.5), banks=(-0.5, 0.5, 0.5))
DESIGNS = random_designs(12, seed=3, least_margin=0.02)
TURN = 2.0 * math.pi


def flow_at(machine: Mechanism, design: Array, angles: Array) -> Array:
    """Return the volume that all pumps deliver per crank angle at crank angles of the shaft, m^3/rad."""
    linkage, whole, shaft = linkage_of(design, machine.branch), np.zeros(angles.shape), machine.arrangement
    for lead in (0.0,) if shaft is None else map(shaft.lead_over_slider_line, range(len(shaft.phases))):
        rate = linkage.at(angles + lead, speed=1.0).slider_velocity * machine.sign * machine.direction
        for load in machine.loads:
            assert isinstance(load, Compressor)
            area = 0.25 * math.pi * (load.bore**2 - load.piston_rod**2)
            whole += area * np.maximum(0.0, rate if load.head == "outer dead centre" else -rate)
    return whole


def ripple_of(machine: Mechanism, design: Array) -> float:
    """Return the ripple from 20,000 angles, with grids that close in on each local extreme, smooth or a tip."""
    angles = np.linspace(0.0, TURN, 20_001)[:-1]
    found = flow_at(machine, design, angles)
    ends = []
    for sign in (1.0, -1.0):
        rough, step = sign * found, angles[1]
        highest = np.flatnonzero((rough >= np.roll(rough, 1)) & (rough >= np.roll(rough, -1)))
        near, best = angles[highest[np.argsort(-rough[highest])[:20]]], rough.max()
        for _ in range(4):
            fine = near[:, None] + step * np.linspace(-1.0, 1.0, 201)
            values = sign * flow_at(machine, design, fine)
            rows, places = np.arange(len(near)), values.argmax(axis=1)
            near, best, step = fine[rows, places], max(best, values.max()), step / 100.0
        ends.append(sign * best)
    strokes = 1 if machine.arrangement is None else len(machine.arrangement.phases)
    pumps = (load for load in machine.loads if isinstance(load, Compressor))
    area = sum(0.25 * math.pi * (load.bore**2 - load.piston_rod**2) for load in pumps)
    return float((ends[0] - ends[1]) / (strokes * area * linkage_of(design).stroke / TURN))


@pytest.mark.parametrize("branch", ["open", "crossed"])
@pytest.mark.parametrize("speed", [7.0, -7.0])
@pytest.mark.parametrize("shaft", [None, EVEN, VEE], ids=["one", "even", "vee"])
@pytest.mark.parametrize("pumps", [(PUMP,), (PUMP, BACK)], ids=["single-acting", "double-acting"])
def test_ripple_is_that_of_a_dense_sweep(
    pumps: tuple[Compressor, ...], shaft: Arrangement | None, speed: float, branch: Branch
) -> None:
    machine = Mechanism(speed=speed, branch=branch, loads=pumps, arrangement=shaft)
    found = FLOW_RIPPLE.evaluate(machine, DESIGNS).values
    np.testing.assert_allclose(found, [ripple_of(machine, design) for design in DESIGNS], rtol=1e-9)


def test_ripple_of_one_pump_in_line_is_its_greatest_speed_over_the_mean() -> None:
    designs = DESIGNS * [1.0, 1.0, 0.0]
    machine = Mechanism(speed=30.0, loads=(PUMP,))
    greatest, stroke = (QUANTITIES[name].evaluate(machine, designs).values for name in ("peak_slider_speed", "stroke"))
    found = FLOW_RIPPLE.evaluate(machine, designs).values
    np.testing.assert_allclose(found, TURN * greatest / (30.0 * stroke), rtol=1e-12)


def test_three_even_pumps_with_a_very_long_rod_ripple_as_sines_do() -> None:
    """The sum of |r sin| is between 3/2 and sqrt(3); the rod's part falls with r / l squared."""
    found = FLOW_RIPPLE.evaluate(Mechanism(loads=(PUMP,), arrangement=EVEN), np.array([[0.05, 0.5e6, 0.0]])).values
    assert found[0] == pytest.approx((math.pi / 3.0) * (1.0 - math.cos(math.pi / 6.0)), rel=1e-6)


def test_slopes_by_lengths_and_bores_are_those_of_differences() -> None:
    varying = (
        Varying(name="bore", sets=(("loads.0.bore", 1.0),), lower=0.03, upper=0.06),
        Varying(name="speed", sets=(("speed", 1.0),), lower=5.0, upper=90.0),
    )
    machine = Mechanism(speed=30.0, loads=(PUMP, BACK), arrangement=VEE, varying=varying)
    designs = np.column_stack([DESIGNS, np.full(len(DESIGNS), 0.047), np.full(len(DESIGNS), 31.0)])
    lengths = steps_to_the_nearest_edge(DESIGNS, kink_without_offset=True)
    first = np.column_stack([lengths, np.tile([1e-3, 1.0], (len(DESIGNS), 1))])
    for quantity in (FLOW, FLOW_RIPPLE):

        def function(some: Array, _: object, quantity: Quantity = quantity) -> Array:
            return quantity.evaluate(machine, some).values

        expected, _ = derivatives(function, designs, first)
        slopes = quantity.evaluate(machine, designs, gradients=True).gradients
        assert slopes is not None
        np.testing.assert_allclose(slopes, expected, rtol=1e-6, atol=1e-7 * np.abs(expected).max())


def test_flow_is_the_volume_taken_in_times_the_turns_of_a_minute() -> None:
    """70 mm bore, 60 mm in-line stroke, 1,200 rpm: 277.09 L/min swept.

    The fraction taken in is 0.95 + 0.05 less 0.05 8^(1 / 1.2).
    """
    machine = Mechanism(speed=-40.0 * math.pi, loads=(AIR,))
    swept = 0.25 * math.pi * 0.7**2 * 0.6 * 1200.0  # L/min, in dm
    assert swept == pytest.approx(277.0884720, rel=1e-9)
    share = 1.0 - 0.05 * (8.0 ** (1.0 / 1.2) - 1.0)
    design = np.array([[0.03, 0.12, 0.0]])
    assert 6e4 * FLOW.evaluate(machine, design).values[0] == pytest.approx(share * swept, rel=1e-12)
    several = replace(machine, arrangement=EVEN, loads=(AIR, replace(PUMP, bore=0.07)))
    assert 6e4 * FLOW.evaluate(several, design).values[0] == pytest.approx(3.0 * (1.0 + share) * swept, rel=1e-12)


def test_flow_along_a_speed_profile_has_the_turns_over_time() -> None:
    profile = Harmonics(cosines=(0.0, 0.2), sines=(0.1,))
    even = Mechanism(speed=20.0, loads=(PUMP,))
    uneven = replace(even, speed_profile=profile)
    angles = np.linspace(0.0, TURN, 4097)[:-1]
    time = np.mean(1.0 / profile.speed_ratio(angles))
    found, plain = (FLOW.evaluate(machine, DESIGNS).values for machine in (uneven, even))
    np.testing.assert_allclose(found, plain / time, rtol=1e-12)
    assert FLOW_RIPPLE.undefined_because([uneven]) is not None


def test_a_compressor_that_delivers_nothing_counts_as_nothing() -> None:
    full = replace(AIR, clearance=0.0, clearance_volume=1e-4)
    machine = Mechanism(speed=10.0, loads=(full, PUMP))
    small = np.array([[0.005, 0.1, 0.002]])
    efficiency = QUANTITIES["volumetric_efficiency"]
    assert efficiency.evaluate(replace(machine, loads=(full,)), small).values[0] < 0.0
    alone = FLOW.evaluate(replace(machine, loads=(full,)), small, gradients=True)
    assert alone.values[0] == 0.0
    assert alone.gradients is not None
    assert not alone.gradients.any()
    assert FLOW.evaluate(machine, small).values == FLOW.evaluate(replace(machine, loads=(PUMP,)), small).values


def test_ripple_needs_a_pump_of_a_liquid() -> None:
    assert "it needs pumps for a liquid" in str(FLOW_RIPPLE.undefined_because([Mechanism(loads=(AIR,))]))
    mixed = Mechanism(loads=(AIR, PUMP))
    assert FLOW_RIPPLE.evaluate(mixed, DESIGNS).values == pytest.approx(
        FLOW_RIPPLE.evaluate(Mechanism(loads=(PUMP,)), DESIGNS).values, rel=1e-14
    )


@pytest.mark.parametrize("offset", [0.0, 1e-16, -1e-15, 1e-12])
def test_without_offset_a_tip_at_angle_zero_moves_with_it(offset: float) -> None:
    """A dead centre lies where the cycle begins there, and is no fixed place for that."""
    chance, step = np.random.default_rng(37), 1e-6
    for _ in range(30):
        phases = tuple(np.sort(chance.uniform(0.0, TURN, chance.integers(2, 6))).tolist())
        machine = Mechanism(speed=10.0, arrangement=Arrangement(phases=(0.0, *phases[1:])), loads=(PUMP,))
        design = np.array([0.04, chance.uniform(0.15, 0.3), offset])
        found = FLOW_RIPPLE.evaluate(machine, design[None], gradients=True).gradients
        assert found is not None
        beside = design + step * np.array([[0.0, 0.0, side] for side in (-1.0, 0.0, 1.0)])
        low, here, high = FLOW_RIPPLE.evaluate(machine, beside).values
        below, above = (here - low) / step, (high - here) / step
        if abs(above - below) > 1e-3 * max(1.0, abs(above)):
            continue  # a kink: two tips are equally high
        assert found[0, 2] == pytest.approx(0.5 * (below + above), rel=1e-4, abs=1e-4)
