"""Quantities of several cylinders and with a speed profile: sums, sweeps, derivatives, what is of all or of one."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from slidercrank import solve
from slidercrank.model.cycle.cycle import cycle
from slidercrank.model.cycle.multi_cylinder import multi_cylinder_curves, multi_cylinder_cycle
from slidercrank.model.errors import InputError, JobError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.arrangement import Arrangement
from slidercrank.model.machine.cylinders_and_turns import machines_of_arrangement, single_cylinder_machine
from slidercrank.model.machine.loads.engine import FourStroke
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.machine.speed_profile import Harmonics
from slidercrank.model.signals.averages import signal_averages
from slidercrank.model.signals.peaks import find_peaks
from slidercrank.model.signals.signals import Signal
from slidercrank.model.transient.speed_profile_cycle import speed_profile_curves, speed_profile_cycle
from slidercrank.objectives.quantity import Quantity
from slidercrank.objectives.registry import QUANTITIES
from slidercrank.optimise.job import parse_job
from slidercrank.optimise.problem.problem import Problem
from tests.model.cases import AIR, RUBBING_PIVOT, SMOOTH, Array, linkage_of, random_designs, random_friction
from tests.model.test_multi_cylinder import random_whole
from tests.model.transient.test_speed_profile_cycle import random_uneven
from tests.model.varying_machines import BARS, unit_steps, varied_designs
from tests.objectives.richardson import derivatives, steps_to_the_nearest_edge

TURN = 2.0 * math.pi
BANKS = Arrangement(phases=(0.0, 2.1, 4.2), banks=(0.4, -0.4, 0.4), places=(-0.1, 0.0, 0.13))
UNEVEN = Harmonics(cosines=(0.02, 0.06), sines=(-0.03, 0.04, 0.02))
EVEN = replace(SMOOTH, acceleration=0.0)
FOUR = FourStroke(
    bore=0.08, low=9e4, high=5e6, clearance=1.0 / 9.0, compression_exponent=1.3, expansion_exponent=1.25, exhaust=1.1e5
)
MOVING = {
    "torque": Signal.TORQUE,
    "power": Signal.POWER,
    "pivot_force": Signal.PIVOT_FORCE,
    "crank_pin_force": Signal.CRANK_PIN_FORCE,
    "slider_pin_force": Signal.SLIDER_PIN_FORCE,
    "guide_force": Signal.GUIDE_FORCE,
    "slider_speed": Signal.SLIDER_SPEED,
    "slider_acceleration": Signal.SLIDER_ACCELERATION,
    "shaking_force": Signal.SHAKING_FORCE,
    "shaking_moment": Signal.SHAKING_MOMENT,
}


def row(linkage: Linkage) -> Array:
    return np.array([[float(linkage.crank), float(linkage.rod), float(linkage.offset)]])


@pytest.mark.parametrize("seed", range(8))
def test_peaks_and_averages_of_the_whole_are_those_of_polynomials_through_its_sum(seed: int) -> None:
    """Compare with `multi_cylinder_cycle`, which adds curves first: 2 to 6 cylinders in banks, some with friction."""
    machine, linkage = random_whole(seed)
    whole, design = multi_cylinder_cycle(machine, linkage), row(linkage)
    for kind, wanted, rms in (
        (Signal.TORQUE, abs(whole.peak.value), whole.rms),
        (Signal.SHAKING_FORCE, whole.shaking_force.value, whole.rms_shaking_force),
        (Signal.SHAKING_MOMENT, whole.shaking_moment.value, whole.rms_shaking_moment),
        (Signal.ROCKING_COUPLE, whole.couple.value, None),
    ):
        assert find_peaks(machine, kind, design, limit=1).values[0, 0] == pytest.approx(wanted, rel=1e-12)
        if rms is not None:
            assert signal_averages(machine, kind, design).rms[0] == pytest.approx(rms, rel=1e-12)
    mean = QUANTITIES["mean_torque"].evaluate(machine, design).values[0]
    assert mean == pytest.approx(whole.mean, rel=1e-10, abs=1e-12 * whole.rms)
    assert QUANTITIES["torque_fluctuation"].evaluate(machine, design).values[0] == pytest.approx(whole.fluctuation)


@pytest.mark.parametrize("seed", [*range(8), 84])  # of 84 all forces vanish where the guide changes sides
def test_peaks_along_a_profile_are_those_of_its_curves(seed: int) -> None:
    """Every second machine has friction; its guide changes sides elsewhere than at constant speed."""
    machine, linkage = random_uneven(seed, friction=seed % 2 == 0)
    found, design = speed_profile_cycle(machine, linkage), row(linkage)
    for name, kind in MOVING.items():
        wanted = found.peaks[name].value
        assert find_peaks(machine, kind, design, limit=1).values[0, 0] == pytest.approx(wanted, rel=1e-12)
    averages = signal_averages(machine, Signal.TORQUE, design)
    assert averages.rms[0] == pytest.approx(found.rms_torque, rel=1e-12)
    assert averages.mean[0] == pytest.approx(found.mean_torque, rel=1e-10, abs=1e-12 * found.rms_torque)
    power = QUANTITIES["mean_power"].evaluate(machine, design).values[0]
    assert power == pytest.approx(found.mean_power, rel=1e-9, abs=1e-12 * found.peaks["power"].value)


def test_the_jerk_along_a_profile_is_the_slope_of_the_acceleration() -> None:
    machine, linkage = random_uneven(5)
    theta, h = np.linspace(0.0, TURN, 2000, endpoint=False), 1e-5
    ahead, behind = (speed_profile_curves(machine, linkage, theta + step) for step in (h, -h))
    slope = (ahead.curves.slider_acceleration - behind.curves.slider_acceleration) / (2.0 * h)
    jerk = np.abs(slope * 0.5 * (ahead.speed + behind.speed))
    found = find_peaks(machine, Signal.SLIDER_JERK, row(linkage), limit=1)
    assert found.values[0, 0] == pytest.approx(jerk.max(), rel=1e-5)


def test_a_profile_of_nothing_changes_nothing() -> None:
    """Every quantity of a machine with gas, friction of the pivot and all else at p = 1, to rounding."""
    machine = replace(EVEN, loads=(*EVEN.loads, AIR), friction=RUBBING_PIVOT)
    flat = replace(machine, speed_profile=Harmonics(cosines=(0.0,)))
    designs = random_designs(12, seed=3, least_margin=0.1)
    for name, quantity in QUANTITIES.items():
        if not quantity.undefined_because([flat]):
            wanted, found = (quantity.evaluate(each, designs).values for each in (machine, flat))
            size = np.abs(wanted).max()
            assert found == pytest.approx(wanted, rel=1e-9, abs=1e-12 * size), name


SHAFTS: dict[str, Mechanism] = {
    "banks": replace(EVEN, arrangement=BANKS),
    "profile": replace(EVEN, speed_profile=UNEVEN),
    "both": replace(EVEN, arrangement=BANKS, speed_profile=UNEVEN, loads=(AIR,)),
    "rubbing": replace(
        EVEN,
        arrangement=Arrangement(phases=(0.0, 2.1), banks=(0.4, -0.4)),
        speed_profile=UNEVEN,
        friction=random_friction(np.random.default_rng(9)),
    ),
    "four-stroke": Mechanism(
        speed=120.0,
        slider_mass=0.4,
        loads=(FOUR,),
        arrangement=Arrangement(phases=(0.0, math.pi, 3.0 * math.pi, TURN), places=(-0.15, -0.05, 0.05, 0.15)),
    ),
}
MANY = (
    *("peak_torque", "rms_torque", "mean_torque", "torque_fluctuation", "peak_power", "mean_power", "efficiency"),
    *("peak_shaking_force", "rms_shaking_force", "peak_shaking_moment", "peak_rocking_couple", "indicated_work"),
    *("peak_reflected_inertia", "peak_crank_pin_force", "peak_guide_force", "peak_slider_jerk", "friction_loss"),
    *("time_ratio", "outward_stroke_time", "inward_stroke_time", "outward_to_inward_time_ratio", "crank_angle_ratio"),
    "inward_to_outward_time_ratio",
)
FEW = {"rubbing": ("peak_torque", "rms_torque", "peak_guide_force"), "four-stroke": MANY[:6]}


def checked(quantity: Quantity, machine: Mechanism, designs: Array, first: Array) -> None:
    """Compare derivatives with extrapolated differences of the piece that is the greatest."""
    pieces = quantity.pieces(machine, designs)
    place = (np.argmin if pieces.least else np.argmax)(pieces.values, axis=1)
    label = pieces.labels[np.arange(len(designs)), place]

    def followed(displaced: Array, index: NDArray[np.int64]) -> Array:
        if pieces.values.shape[1] == 1:
            return quantity.evaluate(machine, displaced).values
        there = quantity.pieces(machine, displaced)
        away = np.abs(np.angle(np.exp(1j * (there.labels - label[index, None]))))
        nearest = np.nanargmin(np.where(np.isfinite(there.values), away, np.nan), axis=1)
        found: Array = there.values[np.arange(len(displaced)), nearest]
        return found

    wanted, _ = derivatives(followed, designs, first)
    found = quantity.evaluate(machine, designs, gradients=True).gradients
    assert found is not None
    assert np.abs(found - wanted).max() <= 1e-7 * np.abs(wanted).max()


@pytest.mark.parametrize("name", SHAFTS)
def test_derivatives_are_those_of_extrapolated_differences(name: str) -> None:
    machine, designs = SHAFTS[name], random_designs(1 if name in FEW else 2, seed=11, least_margin=0.5)
    first = 0.3 * steps_to_the_nearest_edge(designs, kink_without_offset=True)
    for quantity in (QUANTITIES[each] for each in FEW.get(name, MANY)):
        if not quantity.undefined_because([machine]) and not quantity.zero_because([machine]):
            checked(quantity, machine, designs, first)


def test_derivatives_by_numbers_that_vary_count_the_bank_of_gravity() -> None:
    """Speed, masses, sections, loads and gravity, in banks and with a profile."""
    varying = tuple(item for item in BARS.varying if item.name != "acceleration")
    machine = replace(BARS, acceleration=0.0, arrangement=BANKS, speed_profile=UNEVEN, varying=varying)
    designs = varied_designs(machine, 1, seed=4)
    one = replace(machine, arrangement=Arrangement(phases=(0.7,)))
    for name in ("time_ratio", "outward_stroke_time", "inward_stroke_time"):
        checked(QUANTITIES[name], one, designs, unit_steps(one, designs))
    for name in ("peak_torque", "rms_torque", "peak_crank_pin_force", "mean_power"):
        checked(QUANTITIES[name], machine, designs, unit_steps(machine, designs))


def test_four_strokes_in_line_are_a_dense_sweep_of_their_sum() -> None:
    machine, design = SHAFTS["four-stroke"], random_designs(1, seed=2, least_margin=0.5)
    linkage, theta = linkage_of(design[0]), np.linspace(0.0, 2.0 * TURN, 40_001)[:-1]
    torque = np.zeros(len(theta))
    for own in machines_of_arrangement(machine):
        torque += cycle(own.mechanism, linkage, theta + own.lead).torque
    found = find_peaks(machine, Signal.TORQUE, design, limit=1)
    assert found.values[0, 0] == pytest.approx(np.abs(torque).max(), rel=1e-6)
    at = multi_cylinder_curves(machine, linkage, found.angles[0] + np.array([-1e-9, 1e-9])).torque
    assert np.abs(at).max() == pytest.approx(found.values[0, 0], rel=1e-6)
    assert signal_averages(machine, Signal.TORQUE, design).rms[0] == pytest.approx(
        math.sqrt(np.mean(torque**2)), rel=1e-5
    )


def test_works_and_volumes_are_those_of_all_cylinders_and_ratios_those_of_one() -> None:
    machine, designs = replace(EVEN, loads=(AIR,), arrangement=BANKS), random_designs(4, seed=5, least_margin=0.3)
    for name, factor in {
        **dict.fromkeys(("indicated_work", "displacement_volume", "delivered_work", "mean_torque"), 3.0),
        **dict.fromkeys(("clearance_ratio", "mean_effective_pressure", "volumetric_efficiency", "stroke"), 1.0),
    }.items():
        one, all_of_them = (
            QUANTITIES[name].evaluate(each, designs).values for each in (single_cylinder_machine(machine), machine)
        )
        assert all_of_them == pytest.approx(factor * one, rel=1e-10), name


def boxer(**changed: Any) -> Problem:
    mechanism = {
        "speed": "900 rpm",
        "slider": {"mass": "0.4 kg"},
        "cylinders": {"phases": ["0 deg", "180 deg"], "banks": ["0 deg", "180 deg"], "places": ["0 mm", "40 mm"]},
    }
    return parse_job(
        {
            "name": "boxer",
            "mechanism": mechanism | changed.pop("mechanism", {}),
            "variables": {"crank": ["20 mm", "40 mm"], "rod": ["60 mm", "200 mm"], "offset": "0 mm"},
            "objectives": {"peak_rocking_couple": "minimise", "footprint": "minimise"},
            **changed,
        }
    )


def test_a_boxer_shakes_by_a_couple_alone_and_says_so() -> None:
    machine = boxer().mechanism
    found = find_peaks(machine, Signal.SHAKING_FORCE, np.array([[0.03, 0.1, 0.0]]), limit=1, gradients=True)
    assert found.values[0, 0] == 0.0
    assert found.gradients is not None
    assert not found.gradients.any()
    with pytest.raises(InputError, match="shaking forces of these cylinders cancel"):
        solve(boxer(objectives={"peak_shaking_force": "minimise", "footprint": "minimise"}))


def test_what_is_not_of_a_crankshaft_is_refused_with_the_way_out() -> None:
    with pytest.raises(JobError, match=r"a stroke belongs to one cylinder; .* use peak_torque"):
        boxer(objectives={"peak_torque_outward": "minimise", "footprint": "minimise"})
    plane = {"cylinders": {"phases": ["0 deg", "180 deg"]}}
    with pytest.raises(JobError, match="a rocking couple needs cylinders at different places"):
        boxer(mechanism=plane)
