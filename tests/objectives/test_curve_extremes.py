"""Least and greatest value of every curve: against dense sweeps, peaks and closed forms."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.links_and_joints import Friction
from slidercrank.model.machine.loads.angle_table import AngleTable
from slidercrank.model.machine.loads.position_table import PositionTable
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.mechanism import Branch, Mechanism
from slidercrank.model.signals.peaks import find_peaks
from slidercrank.model.signals.signals import Signal
from slidercrank.objectives.tables.curve_extremes import CurveExtremes, curve_extremes, defined_curves
from tests.model.cases import TOLERANCES, linkage_of, random_designs, random_friction, random_machine

PEAKS = {
    "torque": Signal.TORQUE,
    "power": Signal.POWER,
    "slider_velocity": Signal.SLIDER_SPEED,
    "slider_acceleration": Signal.SLIDER_ACCELERATION,
    "pivot": Signal.PIVOT_FORCE,
    "crank_pin": Signal.CRANK_PIN_FORCE,
    "slider_pin": Signal.SLIDER_PIN_FORCE,
    "guide": Signal.GUIDE_FORCE,
}


def machines(count: int, *, seed: int) -> list[tuple[Mechanism, Linkage]]:
    """Return random machines with all kinds of loads, in turn with friction, with tolerances and without either."""
    random = np.random.default_rng(seed)
    found = []
    for index, design in enumerate(random_designs(count, seed=seed)):
        machine = random_machine(random)
        if index % 3 == 1:
            machine = replace(machine, friction=random_friction(random))
        if index % 3 == 2:
            machine = replace(machine, tolerances=TOLERANCES)
        found.append((machine, linkage_of(design, machine.branch)))
    return found


@cache
def judged(seed: int) -> list[tuple[Mechanism, Linkage, list[CurveExtremes]]]:
    """Return six machines with the extremes of their curves, which are looked at in several ways."""
    return [(mechanism, linkage, curve_extremes(mechanism, linkage)) for mechanism, linkage in machines(6, seed=seed)]


def by_name(mechanism: Mechanism, linkage: Linkage) -> dict[str, CurveExtremes]:
    return {found.name: found for found in curve_extremes(mechanism, linkage)}


@pytest.mark.parametrize("seed", range(3))
def test_no_angle_of_a_dense_sweep_exceeds_the_extremes(seed: int) -> None:
    theta = np.linspace(0.0, 2.0 * math.pi, 200_000, endpoint=False)
    for mechanism, linkage, extremes in judged(seed):
        curves = defined_curves(mechanism, linkage, theta)
        assert [found.name for found in extremes] == [curve.name for curve in curves]
        for found, curve in zip(extremes, curves, strict=True):
            assert math.isnan(found.least.value) == bool(np.isnan(curve.values).any())
            if not math.isnan(found.least.value):
                size = np.abs(curve.values).max()
                assert curve.values.max() <= found.greatest.value + 1e-9 * size
                assert curve.values.min() >= found.least.value - 1e-9 * size
                # Between two angles of the sweep a curve with kinks changes by its slope times their distance.
                assert curve.values.max() == pytest.approx(found.greatest.value, abs=3e-3 * size)
                assert curve.values.min() == pytest.approx(found.least.value, abs=3e-3 * size)


@pytest.mark.parametrize("seed", range(2))
def test_extremes_are_reached_next_to_their_crank_angle(seed: int) -> None:
    # On one side at least: at a jump an extreme is a limit. A curve changes by some 1e-8 of its size over 3e-9 rad.
    for mechanism, linkage, extremes in judged(seed):
        for found in extremes:
            for extreme in (found.least, found.greatest):
                if math.isnan(extreme.crank_angle):
                    continue
                assert 0.0 <= extreme.crank_angle <= 2.0 * math.pi
                at = extreme.crank_angle + np.array([-3e-9, 0.0, 3e-9])
                near = next(
                    curve.values for curve in defined_curves(mechanism, linkage, at) if curve.name == found.name
                )
                size = max(abs(found.least.value), abs(found.greatest.value))
                assert np.abs(near - extreme.value).min() <= 1e-6 * size, found.name
                position = float(linkage.at(extreme.crank_angle).slider_position)
                assert extreme.slider_position == pytest.approx(position, rel=1e-12)


@pytest.mark.parametrize("seed", range(4))
def test_the_greater_magnitude_of_both_extremes_is_the_peak(seed: int) -> None:
    for mechanism, linkage, extremes in judged(seed):
        design = np.array([[float(linkage.crank), float(linkage.rod), float(linkage.offset)]])
        for found in extremes:
            name = found.name
            if name in PEAKS:
                peak = float(find_peaks(mechanism, PEAKS[name], design, limit=1).values[0, 0])
                greatest = max(abs(found.least.value), abs(found.greatest.value))
                # Where friction locks the peak is infinite, and there is no extreme.
                assert math.isnan(greatest) if math.isinf(peak) else greatest == pytest.approx(peak, rel=1e-9), name


@pytest.mark.parametrize("branch", ["open", "crossed"])
def test_extremes_of_the_position_are_the_dead_centres(branch: Branch) -> None:
    for design in random_designs(5, seed=21):
        linkage = linkage_of(design, branch)
        found = by_name(Mechanism(branch=branch), linkage)["slider_position"]
        (inner, outer), (at_inner, at_outer) = linkage.dead_centres, linkage.dead_centre_angles
        ends = (found.least, found.greatest) if branch == "open" else (found.greatest, found.least)
        for extreme, value, angle in zip(ends, (inner, outer), (at_inner, at_outer), strict=True):
            assert extreme.value == pytest.approx(float(value), rel=1e-12)
            assert extreme.slider_position == pytest.approx(extreme.value, rel=1e-12)
            assert math.cos(extreme.crank_angle - float(angle)) == pytest.approx(1.0, abs=1e-13)


@pytest.mark.parametrize("branch", ["open", "crossed"])
def test_extremes_of_the_angles_are_closed_forms(branch: Branch) -> None:
    for crank, rod, offset in random_designs(5, seed=22):
        linkage = Linkage(crank, rod, offset, branch)
        found = by_name(Mechanism(branch=branch), linkage)
        least, greatest = math.asin((offset - crank) / rod), math.asin((offset + crank) / rod)
        if branch == "crossed":
            least, greatest = math.pi - greatest, math.pi - least
        assert found["rod_angle"].least.value == pytest.approx(least, rel=1e-12)
        assert found["rod_angle"].greatest.value == pytest.approx(greatest, rel=1e-12)
        transmission = found["transmission_angle"]
        assert transmission.least.value == pytest.approx(float(linkage.least_transmission_angle), rel=1e-9)
        # The rod reaches the slider's line only where the offset is less than the crank.
        turned = 0.5 * math.pi - math.asin(max(0.0, abs(offset) - crank) / rod)
        assert transmission.greatest.value == pytest.approx(turned, rel=1e-12)


def test_the_in_line_acceleration_is_greatest_at_the_outer_dead_centre() -> None:
    crank, rod, speed = 0.05, 0.2, 12.0
    least = by_name(Mechanism(speed=speed), Linkage(crank, rod))["slider_acceleration"].least
    assert least.value == pytest.approx(-crank * speed**2 * (1.0 + crank / rod), rel=1e-12)
    assert least.crank_angle == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("branch", ["open", "crossed"])
def test_velocity_changes_its_sign_with_the_direction_of_rotation(branch: Branch) -> None:
    for design in random_designs(3, seed=23):
        linkage = linkage_of(design, branch)
        one, other = (
            by_name(Mechanism(speed=speed, branch=branch), linkage)["slider_velocity"] for speed in (7.0, -7.0)
        )
        assert other.least.value == pytest.approx(-one.greatest.value, rel=1e-12)
        assert other.greatest.value == pytest.approx(-one.least.value, rel=1e-12)


def test_curves_that_a_machine_does_not_define_are_left_out() -> None:
    linkage = Linkage(0.05, 0.15, 0.01)
    geometry = ["slider_position", "rod_angle", "transmission_angle"]
    assert list(by_name(Mechanism(), linkage)) == geometry
    motion = ["slider_velocity", "slider_acceleration", "slider_jerk"]
    assert list(by_name(Mechanism(speed=3.0), linkage)) == [geometry[0], *motion, *geometry[1:]]
    heavy = set(by_name(Mechanism(slider_mass=2.0, gravity=(0.0, -9.81)), linkage))
    assert {"torque", "pivot", "crank_pin_x", "slider_pin", "guide"} <= heavy
    assert not {"load", "power", "slider_velocity", "position_error"} & heavy
    loaded = Mechanism(loads=(StrokeForce(outward=-5.0, inward=-5.0),), tolerances=TOLERANCES)
    assert {"load", "torque", "position_error", "position_error_rss"} <= set(by_name(loaded, linkage))


@pytest.mark.parametrize("speed", [-4.0, 0.0, 4.0])
@pytest.mark.parametrize("branch", ["open", "crossed"])
def test_a_force_of_each_stroke_has_its_two_values_as_extremes(branch: Branch, speed: float) -> None:
    machine = Mechanism(speed=speed, loads=(StrokeForce(outward=-200.0, inward=30.0),), branch=branch)
    for design in random_designs(2, seed=24):
        linkage = linkage_of(design, branch)
        load = by_name(machine, linkage)["load"]
        assert (load.least.value, load.greatest.value) == pytest.approx((-200.0, 30.0), rel=1e-14)


def test_a_constant_load_has_no_place() -> None:
    machine = Mechanism(speed=2.0, loads=(StrokeForce(outward=-60.0, inward=-60.0),))
    load = by_name(machine, Linkage(0.05, 0.15, 0.01))["load"]
    assert (load.least.value, load.greatest.value) == (-60.0, -60.0)
    assert math.isnan(load.least.crank_angle)
    assert math.isnan(load.greatest.slider_position)


def test_extremes_of_a_table_over_the_crank_angle_are_its_knots() -> None:
    knots, forces = (-0.3, 0.9, 2.0, 3.3, 4.6), (0.0, 80.0, -90.0, 10.0, 60.0)
    load = by_name(Mechanism(loads=(AngleTable(angles=knots, forces=forces),)), Linkage(0.05, 0.15, 0.01))["load"]
    assert (load.least.value, load.greatest.value) == pytest.approx((-90.0, 80.0), rel=1e-12)
    assert (load.least.crank_angle, load.greatest.crank_angle) == pytest.approx((2.0, 0.9), abs=1e-9)


def test_extremes_of_a_table_over_the_position_are_at_the_position_of_its_knots() -> None:
    table = PositionTable(
        positions=(0.0, 0.01, 0.025, 0.06), forces=(0.0, -150.0, 40.0, 0.0), datum="inner dead centre"
    )
    linkage = Linkage(0.05, 0.15, 0.01)
    load = by_name(Mechanism(loads=(table,)), linkage)["load"]
    inner = float(linkage.dead_centres[0])
    assert (load.least.value, load.greatest.value) == pytest.approx((-150.0, 40.0), rel=1e-12)
    places = (load.least.slider_position - inner, load.greatest.slider_position - inner)
    assert places == pytest.approx((0.01, 0.025), rel=1e-9)


def test_what_friction_leaves_undetermined_is_no_number() -> None:
    machine = replace(random_machine(np.random.default_rng(3)), friction=Friction(guide=1.5), branch="open")
    found = by_name(machine, Linkage(0.04, 0.1, 0.02))
    for name in ("torque", "guide", "crank_pin"):
        assert math.isnan(found[name].least.value)
        assert math.isnan(found[name].greatest.crank_angle)
    for name in ("slider_position", "slider_velocity", "load"):
        assert found[name].least.value < found[name].greatest.value
