"""Deviation of measured curves: known shifts are recovered, and nothing fits better than what is told."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.cylinders_and_turns import cycle_turns
from slidercrank.model.machine.links_and_joints import Friction
from slidercrank.model.machine.loads.angle_table import AngleTable
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.objectives.quantity import Array
from slidercrank.objectives.tables.curve_deviation import Deviation, curve_deviations
from slidercrank.objectives.tables.curve_extremes import defined_curves
from tests.model.cases import SMOOTH, linkage_of, random_designs, random_machine

SMOOTH_CURVES = ("slider_position", "slider_velocity", "slider_acceleration", "rod_angle", "transmission_angle")
LINKAGE = Linkage(0.05, 0.2, 0.03)
MOVING = Mechanism(speed=12.0)


def computed(mechanism: Mechanism, linkage: Linkage, angles: Array) -> dict[str, Array]:
    turned = np.mod(angles, 2.0 * math.pi * cycle_turns(mechanism))
    return {curve.name: curve.values for curve in defined_curves(mechanism, linkage, turned)}


def one(mechanism: Mechanism, linkage: Linkage, angles: Array, name: str, values: Array) -> Deviation:
    (found,) = curve_deviations(mechanism, linkage, angles, {name: values})
    return found


def test_known_shifts_of_random_machines_are_recovered() -> None:
    random = np.random.default_rng(41)
    for design in random_designs(8, seed=41, least_margin=0.05):
        machine = random_machine(random)
        linkage = linkage_of(design, machine.branch)
        turn, rows = random.uniform(-math.pi, math.pi), int(random.integers(40, 400))
        angles = random.uniform(-3.0, 3.0, rows) * math.pi
        true = computed(machine, linkage, angles + turn)
        sizes = {name: float(np.abs(values).max()) for name, values in true.items()}
        measured = {name: true[name] - 0.1 * sizes[name] for name in SMOOTH_CURVES}
        for found in curve_deviations(machine, linkage, angles, measured):
            assert found.fit is not None
            size = sizes[found.name]
            off = math.remainder(found.fit.crank_angle - turn, 2.0 * math.pi)
            assert abs(off) < 1e-6, (found.name, off)
            assert found.fit.value == pytest.approx(0.1 * size, rel=1e-5)
            assert found.fit.rms < 1e-6 * size


def test_a_cycle_of_two_turns_is_shifted_by_up_to_a_whole_turn() -> None:
    """Forces tell the turns apart, so that a shift is determined within the cycle; the position repeats every turn."""
    random = np.random.default_rng(47)
    for design in random_designs(3, seed=47, least_margin=0.05):
        knots = np.linspace(0.2, 12.4, 9)
        table = AngleTable(
            angles=tuple(knots.tolist()), forces=tuple(random.normal(0.0, 900.0, 9).tolist()), cycle="720 deg"
        )
        machine = replace(SMOOTH, acceleration=0.0, loads=(table,))
        linkage, shift = linkage_of(design, machine.branch), random.uniform(math.pi, 2.0 * math.pi)
        angles = random.uniform(0.0, 30.0, 300)
        true = computed(machine, linkage, angles + shift)
        load, position = curve_deviations(
            machine, linkage, angles, {name: true[name] for name in ("load", "slider_position")}
        )
        assert load.fit is not None
        assert position.fit is not None
        assert load.fit.crank_angle == pytest.approx(shift, abs=1e-6)
        assert load.fit.rms < 1e-6 * np.abs(true["load"]).max()
        assert position.fit.crank_angle == pytest.approx(shift - 2.0 * math.pi, abs=1e-6)
        assert 0.0 <= load.crank_angle < 4.0 * math.pi


def test_a_deviation_is_measured_minus_computed_at_every_sample() -> None:
    random = np.random.default_rng(42)
    machine = replace(SMOOTH, acceleration=0.0)
    angles = random.uniform(0.0, 20.0, 300)
    noise = random.normal(0.3, 2.0, 300)
    found = one(machine, LINKAGE, angles, "torque", computed(machine, LINKAGE, angles)["torque"] + noise)
    worst = int(np.argmax(np.abs(noise)))
    assert (found.count, found.title, found.kind.unit) == (300, "drive torque", "N m")
    assert found.rms == pytest.approx(math.sqrt(np.mean(noise**2)), rel=1e-9)
    assert found.mean == pytest.approx(noise.mean(), rel=1e-9)
    assert found.largest == pytest.approx(noise[worst], rel=1e-9)
    assert found.crank_angle == pytest.approx(angles[worst] % (2.0 * math.pi), rel=1e-12)


@pytest.mark.parametrize("rows", [5, 60, 2500])
def test_no_other_shift_leaves_less(rows: int) -> None:
    random = np.random.default_rng(rows)
    machine = random_machine(random)
    linkage = linkage_of(random_designs(1, seed=rows, least_margin=0.1)[0], machine.branch)
    angles = random.uniform(0.0, 2.0 * math.pi, rows)
    true = computed(machine, linkage, angles + 0.7)
    shifts = np.linspace(-math.pi, math.pi, 721 if rows < 100 else 91)
    shifted = [computed(machine, linkage, angles + shift) for shift in shifts]
    for name in ("slider_position", "torque", "guide"):
        values = true[name] + random.normal(0.0, 0.2 * true[name].std(), rows)
        found = one(machine, linkage, angles, name, values)
        assert found.fit is not None
        least = min((values - curves[name]).std() for curves in shifted)
        assert found.fit.rms <= least * (1.0 + 1e-9)
        off = values + found.fit.value - computed(machine, linkage, angles + found.fit.crank_angle)[name]
        assert math.sqrt(np.mean(off**2)) == pytest.approx(found.fit.rms, rel=1e-9)
        assert off.mean() == pytest.approx(0.0, abs=1e-9 * found.rms)


def test_many_samples_give_the_shift_of_all_of_them() -> None:
    random = np.random.default_rng(43)
    angles = random.uniform(0.0, 50.0, 30_000)
    noise = random.normal(0.0, 1e-3, 30_000)
    values = computed(MOVING, LINKAGE, angles - 0.25)["slider_position"] + noise
    found = one(MOVING, LINKAGE, angles, "slider_position", values)
    assert found.fit is not None
    # Least squares: the standard error is noise / (sqrt(n) rms of the derivative), about 2e-4 rad.
    assert found.fit.crank_angle == pytest.approx(-0.25, abs=8e-4)
    assert found.fit.rms == pytest.approx(noise.std(), rel=1e-3)
    shifts = found.fit.crank_angle + np.linspace(-1e-4, 1e-4, 3)
    left = [(values - computed(MOVING, LINKAGE, angles + shift)["slider_position"]).std() for shift in shifts]
    assert found.fit.rms <= min(left) * (1.0 + 1e-9)


def test_order_turns_and_repeated_angles_do_not_matter() -> None:
    random = np.random.default_rng(44)
    angles = random.uniform(0.0, 2.0 * math.pi, 80)
    values = computed(MOVING, LINKAGE, angles)["slider_velocity"] + random.normal(0.0, 0.1, 80)
    expected = one(MOVING, LINKAGE, angles, "slider_velocity", values)
    order = random.permutation(80)
    turned = angles[order] + 2.0 * math.pi * random.integers(-5, 5, 80)
    again = one(MOVING, LINKAGE, np.tile(turned, 2), "slider_velocity", np.tile(values[order], 2))
    assert expected.fit is not None
    assert again.fit is not None
    assert again.count == 2 * expected.count
    assert (again.rms, again.mean, again.largest) == pytest.approx(
        (expected.rms, expected.mean, expected.largest), rel=1e-9
    )
    assert again.fit.crank_angle == pytest.approx(expected.fit.crank_angle, abs=1e-6)


def test_what_is_not_measured_does_not_count() -> None:
    angles = np.linspace(0.0, 6.0, 30)
    values = computed(MOVING, LINKAGE, angles)["slider_position"] + 0.001
    gaps = values.copy()
    gaps[::3] = np.nan
    found = one(MOVING, LINKAGE, angles, "slider_position", gaps)
    assert found.count == 20
    assert (found.rms, found.mean) == pytest.approx((0.001, 0.001), rel=1e-9)


def test_the_computed_curve_itself_needs_no_shift() -> None:
    random = np.random.default_rng(45)
    for design in random_designs(2, seed=45):
        machine = random_machine(random)
        linkage = linkage_of(design, machine.branch)
        angles = np.linspace(0.0, 2.0 * math.pi, 50)
        for found in curve_deviations(machine, linkage, angles, computed(machine, linkage, angles)):
            assert (found.rms, found.largest) == (0.0, 0.0)
            assert found.fit is None or abs(found.fit.crank_angle) < 1e-6


@pytest.mark.parametrize("angles", [[1.0], [1.0, 2.0], [1.0, 1.0, 2.0, 2.0 + 1e-18]])
def test_two_crank_angles_do_not_determine_shifts(angles: list[float]) -> None:
    found = one(MOVING, LINKAGE, np.array(angles), "slider_position", np.full(len(angles), 0.2))
    assert found.fit is None
    assert math.isfinite(found.rms)


def test_samples_once_a_turn_determine_no_shift_however_their_times_are_rounded() -> None:
    random = np.random.default_rng(46)
    for digits in (6, 9, 17):
        speed = float(random.uniform(5.0, 30.0))
        machine, place = replace(MOVING, speed=speed), random.choice([0.0, float(random.uniform(0.0, 6.0))])
        for places in ((place,), (place, place + 2.0)):
            times = [(2.0 * math.pi * turn + at) / speed for turn in range(12) for at in places]
            angles = speed * np.array([float(f"{time:.{digits}g}") for time in times])
            found = one(machine, LINKAGE, angles, "slider_position", np.full(len(times), 0.2))
            assert found.fit is None
            assert math.isfinite(found.rms)
        found = one(machine, LINKAGE, np.append(angles, place + 4.0), "slider_position", np.full(len(angles) + 1, 0.2))
        assert found.fit is not None


def test_a_constant_curve_has_no_shift_and_a_locked_one_no_deviation() -> None:
    angles = np.linspace(0.0, 6.0, 20)
    constant = replace(SMOOTH, loads=SMOOTH.loads[:1])  # the same force in both strokes
    found = one(constant, LINKAGE, angles, "load", np.linspace(-70.0, -50.0, 20))
    assert found.fit is None
    assert found.mean == pytest.approx(0.0, abs=1e-9)
    locked = one(replace(SMOOTH, friction=Friction(guide=9.0)), LINKAGE, angles, "torque", angles)
    assert locked.fit is None
    assert math.isnan(locked.rms)
    assert locked.count == 20
