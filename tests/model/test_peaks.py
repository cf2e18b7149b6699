"""Peaks over continuous crank angle against dense sweeps of independently written curves."""

from __future__ import annotations

import dataclasses
import functools
import math
from typing import Any

import numpy as np
import pytest

from slidercrank.model.cycle.cycle import cycle
from slidercrank.model.errors import AssemblyError
from slidercrank.model.linkage.inverse_kinematics import crank_from_stroke
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.links_and_joints import RigidLink
from slidercrank.model.machine.loads.angle_table import AngleTable
from slidercrank.model.machine.loads.position_table import PositionTable
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.loads.viscous import Viscous
from slidercrank.model.machine.mechanism import Mechanism, Tolerance, Tolerances, Window
from slidercrank.model.signals.averages import torque_averages
from slidercrank.model.signals.fast_torque_and_error import screened_maxima
from slidercrank.model.signals.peaks import STORED_PEAKS, find_peaks
from slidercrank.model.signals.signals import Signal
from tests.model.cases import (
    MACHINES,
    SMOOTH,
    TABLES,
    TOLERANCES,
    Array,
    linkage_of,
    random_designs,
    random_friction,
    random_machine,
)
from tests.model.sweep import greatest
from tests.model.virtual_work import drive_torque, position_error

DESIGNS = random_designs(1000, seed=1)
# Rounding of 1 - sin(phi)^2 near locking, to its third power in the torque, makes 1e-13; the rule asks for 1e-9.
EXACT = 2e-12
OF_ONE = [signal for signal in Signal if signal is not Signal.ROCKING_COUPLE]  # which takes several cylinders


def highest(machine: Mechanism, signal: Signal, designs: Array = DESIGNS, during: str = "cycle") -> Array:
    found: Array = find_peaks(machine, signal, designs, during=during, limit=1).values[:, 0]
    return found


@pytest.mark.parametrize("name", MACHINES)
def test_peak_torque_is_that_of_a_dense_sweep(name: str) -> None:
    machine = MACHINES[name]
    swept = greatest(lambda designs, theta: drive_torque(machine, designs, theta), DESIGNS)
    np.testing.assert_allclose(highest(machine, Signal.TORQUE), swept, rtol=EXACT)


@pytest.mark.parametrize("name", MACHINES)
@pytest.mark.parametrize("rss", [False, True], ids=["worst case", "root sum square"])
def test_position_error_is_that_of_a_dense_sweep(name: str, rss: bool) -> None:
    machine = MACHINES[name]
    designs = DESIGNS[:400]
    swept = greatest(lambda designs, theta: position_error(machine, designs, theta, rss=rss), designs)
    signal = Signal.POSITION_ERROR_RSS if rss else Signal.POSITION_ERROR
    np.testing.assert_allclose(highest(machine, signal, designs), swept, rtol=EXACT)


FIELDS: dict[Signal, tuple[str, ...]] = {
    Signal.PIVOT_FORCE: ("pivot_x", "pivot_y"),
    Signal.CRANK_PIN_FORCE: ("crank_pin_x", "crank_pin_y"),
    Signal.SLIDER_PIN_FORCE: ("slider_pin_x", "slider_pin_y"),
    Signal.GUIDE_FORCE: ("guide",),
    Signal.SLIDER_SPEED: ("slider_velocity",),
    Signal.SLIDER_ACCELERATION: ("slider_acceleration",),
}


@pytest.mark.parametrize("name", MACHINES)
@pytest.mark.parametrize("signal", FIELDS, ids=lambda signal: signal.name)
def test_peak_is_that_of_the_curve_over_the_cycle(name: str, signal: Signal) -> None:
    machine = MACHINES[name]
    designs = DESIGNS[:60]

    def curve(design: Array, theta: Array) -> Array:
        of_cycle = cycle(machine, linkage_of(design.reshape(3), machine.branch), theta.ravel())
        parts = [getattr(of_cycle, field) for field in FIELDS[signal]]
        size: Array = np.sqrt(sum(part**2 for part in parts)).reshape(theta.shape)
        return size

    swept = [greatest(curve, design[None])[0] for design in designs]
    np.testing.assert_allclose(highest(machine, signal, designs), swept, rtol=EXACT)


@pytest.mark.parametrize("name", MACHINES)
def test_higher_of_the_two_strokes_is_the_cycle(name: str) -> None:
    machine = MACHINES[name]
    outward = highest(machine, Signal.TORQUE, during="outward stroke")
    inward = highest(machine, Signal.TORQUE, during="inward stroke")
    np.testing.assert_allclose(np.maximum(outward, inward), highest(machine, Signal.TORQUE), rtol=EXACT)
    assert np.mean(outward > inward) > 0.005
    assert np.mean(outward < inward) > 0.005


@pytest.mark.parametrize("during", ["outward stroke", "inward stroke"])
@pytest.mark.parametrize("name", MACHINES)
def test_peak_torque_of_a_stroke_is_that_of_a_dense_sweep(name: str, during: str) -> None:
    machine = MACHINES[name]
    designs = DESIGNS[:200]
    turn = (1.0 if machine.branch == "open" else -1.0) * (1.0 if machine.speed > 0.0 else -1.0)
    wanted = 1.0 if during == "outward stroke" else -1.0

    def curve(designs: Array, theta: Array) -> Array:
        motion = linkage_of(designs, machine.branch).at(theta, speed=1.0)
        counts: Any = turn * wanted * motion.slider_velocity > 0.0
        part: Array = np.where(counts, drive_torque(machine, designs, theta), 0.0)
        return part

    swept = greatest(curve, designs)
    # The sweep ends within 1e-14 rad of the dead centre, where the torque may be steep.
    np.testing.assert_allclose(highest(machine, Signal.TORQUE, designs, during), swept, rtol=1e-10)


@pytest.mark.parametrize("name", MACHINES)
@pytest.mark.parametrize("signal", OF_ONE, ids=lambda signal: signal.name)
def test_peaks_are_sorted_and_lie_where_they_say(name: str, signal: Signal) -> None:
    machine = MACHINES[name]
    designs = DESIGNS[:50]
    found = find_peaks(machine, signal, designs, gradients=True)
    assert found.values.shape == found.angles.shape == (50, STORED_PEAKS)
    assert found.gradients is not None
    assert found.gradients.shape == (50, STORED_PEAKS, 3)
    there = np.isfinite(found.values)
    assert np.all(there[:, 0])
    assert np.all(found.values[:, :-1] >= found.values[:, 1:])
    assert np.all((found.angles[there] >= 0.0) & (found.angles[there] < 2.0 * math.pi))
    assert np.all(np.isnan(found.angles[~there]))
    assert np.all(np.isfinite(found.gradients))
    assert np.all(found.gradients[~there] == 0.0)
    if signal == Signal.TORQUE:
        at = np.where(there, found.angles, 0.0)
        value = np.abs(drive_torque(machine, designs[:, None, :], at))
        np.testing.assert_allclose(value[there], found.values[there], rtol=1e-10)


@pytest.mark.parametrize("name", MACHINES)
def test_a_design_is_judged_alike_alone_and_in_a_batch(name: str) -> None:
    together = find_peaks(MACHINES[name], Signal.TORQUE, DESIGNS, gradients=True)
    assert together.gradients is not None
    for n in (0, 511, 512, 999):
        alone = find_peaks(MACHINES[name], Signal.TORQUE, DESIGNS[n : n + 1], gradients=True)
        np.testing.assert_array_equal(alone.values[0], together.values[n])
        assert alone.gradients is not None
        np.testing.assert_array_equal(alone.gradients[0], together.gradients[n])


@pytest.mark.parametrize("seed", range(6))
def test_one_peak_asked_for_is_the_highest_of_all(seed: int) -> None:
    """Where one is asked for, samples far below the highest are not followed."""
    random = np.random.default_rng([seed, 20261126])
    machine = dataclasses.replace(random_machine(random), tolerances=TOLERANCES)
    knots = np.sort(random.uniform(0.0, random.uniform(0.02, 0.3), 120))
    forces = random.uniform(-300.0, 300.0, len(knots))
    spikes = PositionTable(positions=tuple(knots), forces=tuple(forces), datum="inner dead centre")
    designs = random_designs(60, seed=seed, least_margin=1e-4)
    for other in (
        machine,
        dataclasses.replace(machine, friction=random_friction(random)),
        dataclasses.replace(machine, loads=(spikes,)),
    ):
        for signal in OF_ONE:
            one, all_of_them = (find_peaks(other, signal, designs, limit=kept) for kept in (1, STORED_PEAKS))
            np.testing.assert_array_equal(one.values, all_of_them.values[:, :1])
            np.testing.assert_array_equal(one.angles, all_of_them.angles[:, :1])


def test_no_designs_have_no_peaks() -> None:
    assert find_peaks(SMOOTH, Signal.TORQUE, np.empty((0, 3))).values.shape == (0, STORED_PEAKS)


def test_flywheel_alone_has_a_constant_torque() -> None:
    flywheel = Mechanism(speed=1.0, acceleration=4.0, crank=RigidLink(mass=2.0, centre=0.0, inertia=0.5))
    np.testing.assert_allclose(highest(flywheel, Signal.TORQUE), 2.0, rtol=1e-15)


def test_mechanism_at_rest_has_peaks_of_zero() -> None:
    for signal in OF_ONE:
        assert np.all(highest(Mechanism(), signal) == 0.0), signal


# Without offset the dead centres lie in the middle between breakpoints that mirror each other: there rounding must not
# decide which part of the cycle counts, or which piece of a table acts.
OFFSETS = [0.0, 1e-18, -1e-18, 1e-9, -1e-9, 1e-5]


@pytest.mark.parametrize("offset", OFFSETS)
@pytest.mark.parametrize("window", [Window(), Window(end=0.5), Window(start=0.2), Window(during="inward stroke")])
def test_position_error_of_a_part_of_the_stroke_holds_without_offset(offset: float, window: Window) -> None:
    designs = random_designs(60, seed=7) * [1.0, 1.0, 0.0] + [0.0, 0.0, offset]
    machine = Mechanism(tolerances=dataclasses.replace(TOLERANCES, window=window))
    swept = greatest(lambda designs, theta: position_error(machine, designs, theta), designs)
    # A window's end moves by sqrt(1e-16) rad where it meets a dead centre.
    np.testing.assert_allclose(highest(machine, Signal.POSITION_ERROR, designs), swept, rtol=1e-9)


@pytest.mark.parametrize("offset", OFFSETS)
@pytest.mark.parametrize("datum", ["inner dead centre", "outer dead centre"])
@pytest.mark.parametrize("branch", ["open", "crossed"])
def test_table_that_starts_at_a_dead_centre_holds_without_offset(offset: float, datum: Any, branch: Any) -> None:
    designs = random_designs(100, seed=7) * [1.0, 1.0, 0.0] + [0.0, 0.0, offset]
    table = PositionTable(positions=(0.0, 0.02, 0.03), forces=(1.0, 20.0, 3.0), datum=datum)
    machine = Mechanism(speed=3.0, slider_mass=1.0, loads=(table,), branch=branch)
    swept = greatest(lambda designs, theta: drive_torque(machine, designs, theta), designs, angles=1000)
    np.testing.assert_allclose(highest(machine, Signal.TORQUE, designs), swept, rtol=1e-9)


def test_table_that_ends_at_the_other_dead_centre_is_no_special_case() -> None:
    # A stroke of exactly 0.1 m, as an optimiser with a given stroke delivers it.
    designs = np.array([[0.05, rod, 0.0] for rod in (0.0501, 0.06, 0.1, 0.3)])
    table = PositionTable(positions=(0.0, 0.05, 0.1), forces=(5.0, 20.0, 90.0), datum="inner dead centre")
    machine = Mechanism(speed=3.0, slider_mass=1.0, gravity=(0.0, -9.81), loads=(table,))
    swept = greatest(lambda designs, theta: drive_torque(machine, designs, theta), designs)
    np.testing.assert_allclose(highest(machine, Signal.TORQUE, designs), swept, rtol=EXACT)


def test_gradients_stay_finite_where_a_table_ends_at_the_dead_centres() -> None:
    """The crank angle of a knot there has no derivative. Nor has the curve a kink that it could belong to."""
    random = np.random.default_rng(9)
    rod, offset = random.uniform(0.15, 0.5, 300), random.uniform(-0.03, 0.03, 300) * random.integers(0, 2, 300)
    designs = np.stack([crank_from_stroke(0.1, rod=rod, offset=offset), rod, offset], axis=1)
    table = PositionTable(positions=(0.0, 0.05, 0.1), forces=(5.0, -20.0, -90.0), datum="inner dead centre")
    machine = Mechanism(speed=3.0, slider_mass=1.0, rod=RigidLink(mass=0.5), gravity=(0.0, -9.81), loads=(table,))
    for signal in (Signal.TORQUE, Signal.PIVOT_FORCE, Signal.GUIDE_FORCE):
        found = find_peaks(machine, signal, designs, gradients=True)
        assert found.gradients is not None
        # A peak changes by about its size over a tenth of the crank at most.
        assert np.all(np.abs(found.gradients).max(axis=(1, 2)) < 10.0 * found.values[:, 0] / designs[:, 0])


def test_tables_with_the_same_knots_have_the_peaks_of_their_sum() -> None:
    positions = (0.01, 0.02, 0.045)
    first, second = (10.0, -70.0, 90.0), (-30.0, 20.0, 5.0)
    total = tuple(a + b for a, b in zip(first, second, strict=True))

    def peaks(*forces: tuple[float, ...]) -> tuple[Array, Array]:
        tables = tuple(PositionTable(positions=positions, forces=f, datum="inner dead centre") for f in forces)
        found = find_peaks(dataclasses.replace(TABLES, loads=tables), Signal.GUIDE_FORCE, DESIGNS, gradients=True)
        assert found.gradients is not None
        return found.values, found.gradients

    apart, together = peaks(first, second), peaks(total)
    np.testing.assert_allclose(apart[0], together[0], rtol=1e-11)
    size = np.abs(together[1]).max(axis=(1, 2), keepdims=True)
    assert np.quantile(np.abs(apart[1] - together[1]).max(axis=(1, 2)) / size[:, 0, 0], 0.99) < 1e-7


def test_peak_on_the_kink_of_a_table_is_found_on_the_kink() -> None:
    spike = AngleTable(angles=(0.9, 1.0, 1.1), forces=(0.0, -500.0, 0.0))
    found = find_peaks(Mechanism(loads=(spike,)), Signal.TORQUE, np.array([[0.05, 0.2, 0.03]]), gradients=True)
    assert found.angles[0, 0] == pytest.approx(1.0, rel=1e-15)


def test_peak_before_a_jump_of_the_load_is_its_limit() -> None:
    # The guide force jumps at the dead centres, where the load does.
    machine = Mechanism(loads=(StrokeForce(outward=-500.0, inward=0.0),))
    design = np.array([[0.05, 0.2, 0.03]])
    found = find_peaks(machine, Signal.GUIDE_FORCE, design)
    swept = greatest(
        lambda d, theta: cycle(machine, Linkage(*d.reshape(3)), theta.ravel()).guide.reshape(theta.shape), design
    )
    np.testing.assert_allclose(found.values[0, 0], swept[0], rtol=1e-12)


def test_more_tables_than_peaks_kept() -> None:
    knots = np.linspace(0.0, 6.0, 20)
    forces = np.where(np.arange(20) % 2, 100.0, -100.0)
    machine = dataclasses.replace(TABLES, loads=(AngleTable(angles=tuple(knots), forces=tuple(forces)),))
    designs = DESIGNS[:100]
    swept = greatest(lambda designs, theta: drive_torque(machine, designs, theta), designs)
    np.testing.assert_allclose(highest(machine, Signal.TORQUE, designs), swept, rtol=EXACT)


@pytest.mark.parametrize("over", ["positions", "crank angles"])
def test_peaks_of_tables_of_any_length_are_those_of_a_dense_sweep(over: str) -> None:
    # Segments between the knots are longer than the spacing of the samples, or up to sixty times shorter.
    random = np.random.default_rng(17)
    for count in (2, 3, 7, 40, 120, 300):
        designs = random_designs(6, seed=count)
        rough = np.cumsum(random.normal(0.0, 1.0 / math.sqrt(count), count))
        smooth = np.sin(random.uniform(1.0, 6.0) * np.linspace(0.0, 1.0, count) + random.uniform(0.0, 6.0))
        for shape in (rough, smooth, random.normal(0.0, 1.0, count)):
            forces = tuple(400.0 * shape)
            steps = np.cumsum(random.uniform(0.1, 1.0, count))
            if over == "positions":
                load: Any = PositionTable(
                    positions=tuple(0.12 * steps / steps[-1]), forces=forces, datum="inner dead centre"
                )
            else:
                load = AngleTable(angles=tuple(6.28 * steps / steps[-1]), forces=forces)
            machine = dataclasses.replace(TABLES, loads=(load,))
            swept = greatest(functools.partial(drive_torque, machine), designs)
            found = highest(machine, Signal.TORQUE, designs)
            assert (found >= swept * (1.0 - EXACT)).all(), "a peak is missed"
            np.testing.assert_allclose(found, swept, rtol=1e-9)


def test_tolerance_of_the_crank_angle_alone_gives_the_slider_speed() -> None:
    error = Mechanism(tolerances=Tolerances(crank_angle=Tolerance(absolute=0.002)))
    np.testing.assert_allclose(
        highest(error, Signal.POSITION_ERROR), highest(Mechanism(speed=0.002), Signal.SLIDER_SPEED), rtol=1e-14
    )


def test_higher_of_two_close_peaks_is_found_where_the_samples_show_only_the_lower() -> None:
    # Near locking the guide force has two peaks 2 deg apart, 0.09 % different: 20, 22 or 40 samples show the lower.
    machine = Mechanism(
        speed=-6.16673,
        crank=RigidLink(mass=1.5435, centre_across=-0.001076),
        rod=RigidLink(mass=2.34125, centre_across=-0.0375137),
        slider_mass=2.31532,
        gravity=(3.12759, 4.30252),
        loads=(
            PositionTable(
                positions=(0.0947334, 0.219162, 0.258769, 0.38938),
                forces=(248.407, 361.002, 113.779, 83.5898),
                datum="outer dead centre",
            ),
            AngleTable(
                angles=(0.691038, 0.775973, 2.03643, 3.58943, 6.10435),
                forces=(16.1451, -12.5321, -68.6467, -36.9461, -26.7362),
            ),
            Viscous(coefficient=10.3372),
        ),
    )
    design = np.array([[0.04858864623496388, 0.1381426866270267, 0.08910906605232072]])
    swept = greatest(
        lambda d, theta: cycle(machine, Linkage(*d.reshape(3)), theta.ravel()).guide.reshape(theta.shape), design
    )
    for angles in (20, 22, 40, 128):
        found = find_peaks(machine, Signal.GUIDE_FORCE, design, angles=angles, limit=1).values
        np.testing.assert_allclose(found[0, 0], swept[0], rtol=EXACT, err_msg=f"{angles} angles")


@pytest.mark.parametrize("design", [(0.1, 0.12, 0.03), (0.1, 0.13, -0.03), (-0.1, 0.3, 0.0), (0.1, math.nan, 0.0)])
def test_designs_that_do_not_turn_have_no_peaks_and_no_averages(design: tuple[float, float, float]) -> None:
    designs = np.array([[0.1, 0.3, 0.02], design])
    message = "for full rotation, .*; got rod .* in design 1"
    with pytest.raises(AssemblyError, match=message):
        find_peaks(SMOOTH, Signal.TORQUE, designs)
    with pytest.raises(AssemblyError, match=message):
        screened_maxima(SMOOTH, (Signal.TORQUE,), designs)
    with pytest.raises(AssemblyError, match=message):
        torque_averages(SMOOTH, designs)
