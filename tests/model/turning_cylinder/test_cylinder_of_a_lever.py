"""Reach, pressures, flow and buckling of a lever's cylinder, and the numbers of a whole swing."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from slidercrank.model.errors import InputError
from slidercrank.model.machine.lever_cylinder import Cylinder
from slidercrank.model.swing.swing_types import LeverLaw
from slidercrank.model.turning_cylinder.cylinder_and_pin_forces import LeverSwing, lever_curves
from slidercrank.model.turning_cylinder.lever_geometry import DimensionErrors, TurningCylinder
from slidercrank.model.turning_cylinder.swing_summary import summarise_swing
from tests.model.turning_cylinder.machines import some_machine
from tests.model.turning_cylinder.test_lever_forces import LIFT, carrying_80_kg

TIPPER = carrying_80_kg(0.35, 0.9)
SLOW = LeverSwing(*LIFT)


def test_the_published_swing_says_whether_a_single_stage_cylinder_can_make_it() -> None:
    long, short = summarise_swing(carrying_80_kg(0.4, 0.6), SLOW, Cylinder()), summarise_swing(TIPPER, SLOW, Cylinder())
    assert (long.suits_single_stage_cylinder, short.suits_single_stage_cylinder) == (False, True)
    assert long.extension_ratio == pytest.approx(827.145 / 390.255, rel=1e-5)
    assert short.push.value == pytest.approx(1710.09, abs=5e-3)
    assert short.push.lever_angle == pytest.approx(LIFT[0])
    assert short.pull.value == 0.0
    assert (short.hold[1], short.energy_out) == pytest.approx((1278.19, 608.726), abs=5e-3)


def test_peaks_are_those_of_a_dense_sweep_in_both_directions() -> None:
    random = np.random.default_rng(11)
    jumps = [third + side for third in (1.0 / 3.0, 2.0 / 3.0) for side in (-1e-9, 0.0, 1e-9)]  # of a trapezoid
    share = np.sort([*np.linspace(0.0, 1.0, 20_001), *jumps])
    for _ in range(12):
        machine, swing = some_machine(random)
        cylinder = Cylinder(bore=0.08, rod=0.04, seal_friction=35.0)
        found, curves = summarise_swing(machine, swing, cylinder), lever_curves(machine, swing, share)
        rest = lever_curves(machine, LeverSwing(swing.start, swing.end), np.array([0.0, 1.0]))
        push = np.append(curves.push, rest.push)
        size = float(np.abs(push).max()) + 35.0
        assert found.push.value == pytest.approx(max(push.max() + 35.0, 0.0), abs=1e-5 * size)
        assert found.pull.value == pytest.approx(max(35.0 - push.min(), 0.0), abs=1e-5 * size)
        for point, name in ((found.pin, "pin"), (found.pivot, "pivot")):
            forces = np.append(getattr(curves, name), getattr(rest, name))
            assert point.value == pytest.approx(float(np.abs(forces).max()), rel=1e-5)
        assert found.transmission.value == pytest.approx(float(curves.transmission.min()), abs=1e-6)
        assert found.energy_out + found.energy_back == pytest.approx(
            70.0 * abs(found.lengths[1] - found.lengths[0]), abs=1e-9 * size
        )
        if swing.duration is not None:
            assert found.speed is not None
            assert found.flows is not None
            assert found.speed.value == pytest.approx(float(np.abs(curves.speed).max()), rel=1e-6)
            areas = 0.25 * math.pi * 0.08**2, 0.25 * math.pi * (0.08**2 - 0.04**2)
            assert found.flows == pytest.approx([area * found.speed.value for area in areas], rel=1e-12)


def test_pressures_are_forces_over_the_full_and_the_annular_area() -> None:
    cylinder = Cylinder(bore=0.04, rod=0.02, seal_friction=50.0)
    found = summarise_swing(TIPPER, SLOW, cylinder)
    assert found.pressures == pytest.approx((1760.0899 / (math.pi * 4e-4), 0.0), rel=1e-6)
    down = summarise_swing(replace(TIPPER, gravity=(0.0, 9.81)), SLOW, cylinder)
    assert down.pressures == pytest.approx((0.0, 1760.0899 / (math.pi * 3e-4)), rel=1e-6)
    assert down.buckling_margin is None
    assert found.flows is None


def test_the_buckling_margin_is_the_load_of_the_slender_column_over_the_push() -> None:
    """A steel rod of 20 mm whose pins are 1 m apart: pi^3 E d^4 / 64 = 16.278 kN."""
    load = Cylinder(rod=0.02).buckling_margin(np.array([1.0]), np.array([1.0]))
    assert load is not None
    assert load[0] == pytest.approx(math.pi**3 * 210e9 * 0.02**4 / 64.0, rel=1e-12)
    assert load[0] == pytest.approx(16278.0, rel=1e-4)
    found = summarise_swing(TIPPER, SLOW, Cylinder(rod=0.02)).buckling_margin
    assert found is not None
    curves = lever_curves(TIPPER, SLOW, np.linspace(0.0, 1.0, 5001))
    assert found.value == pytest.approx(float((load[0] / curves.length**2 / curves.push).min()), rel=1e-6)


def test_sizes_that_take_the_whole_stroke_make_the_swing_with_it() -> None:
    cylinder = Cylinder(closed_length=0.64, stroke=0.44)
    fitting = summarise_swing(TIPPER, SLOW, cylinder).fitting_sizes
    assert fitting is not None
    swapped = replace(TIPPER, sizes=replace(TIPPER.sizes, crank=0.9, frame=0.35))
    assert summarise_swing(swapped, SLOW, cylinder).fitting_sizes == pytest.approx(fitting[::-1], rel=1e-12)
    lengths = [
        TurningCylinder(crank=one, frame=other, frame_angle=math.radians(-60.0)).cylinder_length(np.array(LIFT))
        for one, other in (fitting, fitting[::-1])
    ]
    assert np.allclose(lengths, [0.64, 1.08], rtol=1e-9)


@pytest.mark.parametrize("law", ["constant", "harmonic", "cycloidal"])
def test_the_cylinder_holds_the_lever_at_both_ends_whatever_the_law(law: LeverLaw) -> None:
    """Moments about O: 80 kg at 0.7 m, arm r f sin(psi) / L, psi = 40 deg."""
    arm = 0.35 * 0.9 * math.sin(math.radians(40.0)) / float(TIPPER.sizes.cylinder_length(LIFT[0]))
    hold = 80.0 * 9.81 * 0.7 * math.cos(LIFT[0]) / arm
    swing, cylinder = LeverSwing(*LIFT, law, 4.0), Cylinder(bore=0.04, rod=0.02)
    found = summarise_swing(TIPPER, swing, cylinder)
    assert found.push.value >= hold * (1.0 - 1e-12)
    with pytest.raises(InputError, match="raise it, enlarge the bore"):
        summarise_swing(TIPPER, swing, replace(cylinder, supply_pressure=0.9999 * hold / (math.pi * 4e-4)))


def test_needs_suffice_as_reported() -> None:
    cases: tuple[tuple[str, str, float, dict[str, Any]], ...] = (
        ("supply_pressure", r"needs ([\d.]+) bar", 1e5, {"bore": 0.04, "supply_pressure": 1e6}),
        ("rod", r"use at least ([\d.]+) mm", 1e-3, {"rod": 0.008}),
    )
    for field, pattern, unit, given in cases:
        with pytest.raises(InputError) as refused:
            summarise_swing(TIPPER, SLOW, Cylinder(**given))
        (reported,) = re.findall(pattern, str(refused.value))
        needed = float(reported) * unit
        summarise_swing(TIPPER, SLOW, Cylinder(**given | {field: needed}))
        with pytest.raises(InputError):
            summarise_swing(TIPPER, SLOW, Cylinder(**given | {field: 0.9998 * needed}))


def test_an_error_of_the_lever_angle_needs_tolerances() -> None:
    assert summarise_swing(TIPPER, SLOW, Cylinder()).angle_error is None
    assert summarise_swing(TIPPER, SLOW, Cylinder(), DimensionErrors()).angle_error is None
    found = summarise_swing(TIPPER, SLOW, Cylinder(), DimensionErrors(length=1e-3)).angle_error
    assert found is not None
    assert found.value == pytest.approx(1e-3 / min(TIPPER.sizes.motion_at(np.array(LIFT)).length_1), rel=1e-9)


@pytest.mark.parametrize(
    ("sizes", "part"),
    [
        ({"closed_length": 0.7, "stroke": 0.5}, "a closed length of 700 mm, and the swing needs 670.74 mm, 29.2601 mm"),
        (
            {"closed_length": 0.65, "stroke": 0.4},
            "got 1050 mm, and the swing needs 1071.43 mm, 21.4349 mm more",
        ),
        (
            {"closed_length": 0.6, "stroke": 0.6},
            "stroke of a single-stage cylinder must be less than",
        ),
        ({"closed_length": 0.6}, "got no stroke; give both, or neither"),
        ({"stroke": 0.6}, "got no closed length; give both, or neither"),
        (
            {"bore": 0.02, "rod": 0.02},
            "the bore must exceed the piston rod; got a bore of 20 mm",
        ),
        ({"supply_pressure": 1e6}, "a supply pressure needs a cylinder bore; got 10 bar and no bore"),
        ({"bore": 0.04, "supply_pressure": 1e6}, "a push of 1710.09 N needs 13.609 bar; got 10 bar; raise it"),
        (
            {"rod": 0.008},
            "it carries 0.2838 times the push of the cylinder; got a piston rod of 8 mm; use at least 10.9",
        ),
        ({"bore": math.nan}, "the bore of a cylinder must be positive and finite; got nan m"),
        ({"seal_friction": -1.0}, "the friction of a seal must be zero or more and finite; got -1 N"),
    ],
)
def test_a_cylinder_that_cannot_make_the_swing_is_refused_with_the_amount(sizes: dict[str, Any], part: str) -> None:
    with pytest.raises(InputError, match=part):
        summarise_swing(TIPPER, SLOW, Cylinder(**sizes))


def test_a_swing_may_use_its_whole_cylinder_within_rounding() -> None:
    lengths = TIPPER.sizes.cylinder_length(np.array(LIFT))
    needed = summarise_swing(TIPPER, SLOW, Cylinder(bore=0.04))
    assert needed.pressures is not None
    closed = float(lengths[0]) * (1.0 + 1e-12)
    cylinder = Cylinder(closed_length=closed, stroke=float(lengths[1]) * (1.0 - 1e-12) - closed, bore=0.04)
    summarise_swing(TIPPER, SLOW, replace(cylinder, supply_pressure=needed.pressures[0] * (1.0 - 1e-12)))


def test_a_dead_length_adds_to_the_stroke_or_to_the_travel() -> None:
    lengths = 0.670740, 1.071435
    known = Cylinder(dead_length=0.2, stroke=0.44)
    assert known.closed_length_and_stroke(0.4) == pytest.approx((0.64, 0.44))
    assert summarise_swing(TIPPER, SLOW, known).fitting_sizes == pytest.approx(
        summarise_swing(TIPPER, SLOW, Cylinder(closed_length=0.64, stroke=0.44)).fitting_sizes
    )
    assert Cylinder(dead_length=0.22).closed_length_and_stroke(0.4) == pytest.approx((0.62, 0.4))
    summarise_swing(TIPPER, SLOW, Cylinder(dead_length=lengths[0] - (lengths[1] - lengths[0]) - 1e-5))
    with pytest.raises(InputError, match=r"got a closed length of 700\.695 mm, and the swing needs 670\.74 mm"):
        summarise_swing(TIPPER, SLOW, Cylinder(dead_length=0.3))


def test_on_a_trunnion_the_stroke_may_exceed_the_closed_length() -> None:
    cylinder = Cylinder(closed_length=0.35, stroke=0.5, mounting="trunnion", rod=0.022)
    found = summarise_swing(carrying_80_kg(0.4, 0.6), SLOW, cylinder)
    assert found.suits_single_stage_cylinder
    assert found.buckling_margin is not None
    assert found.buckling_margin == summarise_swing(carrying_80_kg(0.4, 0.6), SLOW, Cylinder(rod=0.022)).buckling_margin
    with pytest.raises(InputError, match=r'less than its closed length.* set mounting = "trunnion"'):
        summarise_swing(TIPPER, SLOW, replace(cylinder, mounting="clevis"))
    with pytest.raises(InputError, match=r"a dead length belongs to a cylinder on a clevis.*; give closed_length and"):
        summarise_swing(TIPPER, SLOW, Cylinder(dead_length=0.1, mounting="trunnion"))
    with pytest.raises(InputError, match="got both a closed length and a dead length; leave out one"):
        summarise_swing(TIPPER, SLOW, Cylinder(dead_length=0.1, closed_length=0.5, stroke=0.4))
