"""Tables of 720 deg: the load at every angle, peaks and means against two halves and dense sweeps, slopes, refusals."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from slidercrank.model.cycle.cycle import breakpoints, cycle, cycle_energies
from slidercrank.model.cycle.multi_cylinder import multi_cylinder_cycle
from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.linkage.loaded_stroke import loaded_stroke
from slidercrank.model.machine.arrangement import Arrangement
from slidercrank.model.machine.cylinders_and_turns import machines_of_turns
from slidercrank.model.machine.loads.angle_table import AngleTable
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.machine.varying_numbers import Varying
from slidercrank.model.signals.averages import torque_averages
from slidercrank.model.signals.peaks import find_peaks
from slidercrank.model.signals.signals import Signal
from slidercrank.objectives.registry import QUANTITIES
from slidercrank.objectives.tables.curve_extremes import curve_extremes
from tests.model.cases import random_friction, random_machine

Array = NDArray[np.float64]
TURN = 2.0 * math.pi
DENSE = np.linspace(0.0, 2.0 * TURN, 40_001)[:-1]


def random_case(seed: int) -> tuple[Mechanism, AngleTable, Array]:
    """Return a machine with one table of two turns among other loads, the table, and designs (2, 3)."""
    random = np.random.default_rng(seed)
    angles = np.sort(random.uniform(-0.5, 2.0 * TURN - 0.6, random.integers(3, 12)))
    table = AngleTable(
        angles=tuple(angles.tolist()),
        forces=tuple(random.uniform(-900.0, 900.0, len(angles)).tolist()),
        datum=random.choice(["zero crank angle", "inner dead centre", "outer dead centre"]),
        during=random.choice(["cycle", "outward stroke"]),
        cycle="720 deg",
    )
    machine = random_machine(random)
    machine = replace(machine, loads=(*machine.loads[:5], table) if seed % 2 else (table,))
    machine = replace(machine, friction=random_friction(random)) if seed % 4 == 3 else machine
    crank, offset = random.uniform(0.02, 0.06, 2), random.uniform(-0.03, 0.03, 2)
    rod = (crank + np.abs(offset)) * random.uniform(1.8, 4.0, 2)
    return machine, table, np.column_stack([crank, rod, offset])


@pytest.mark.parametrize("seed", range(12))
def test_the_load_is_that_of_the_table_over_two_turns(seed: int) -> None:
    machine, table, designs = random_case(seed)
    alone = replace(machine, loads=(table,))
    theta = np.random.default_rng(seed).uniform(-15.0, 30.0, 200)
    for crank, rod, offset in designs:
        linkage = Linkage(crank, rod, offset, machine.branch)
        inner, outer = (float(angle) for angle in linkage.dead_centre_angles)
        datum = {"inner dead centre": inner, "outer dead centre": outer}.get(table.datum, 0.0)
        way = 1.0 if table.datum == "zero crank angle" else machine.direction
        found = cycle(alone, linkage, theta)
        wanted = np.interp(way * (theta - datum), table.angles, table.forces, period=2.0 * TURN)
        outward = found.slider_velocity * np.sign(found.slider_position) > 0.0
        wanted = np.where(outward | (table.during == "cycle"), wanted, 0.0)
        assert np.abs(found.load - wanted).max() <= 1e-10 * np.abs(table.forces).max()


@pytest.mark.parametrize("seed", range(8))
def test_peaks_and_means_are_those_of_both_turns(seed: int) -> None:
    machine, _, designs = random_case(seed)
    peaks = find_peaks(machine, Signal.TORQUE, designs)
    averages = torque_averages(machine, designs)
    ends = [torque_averages(half, designs) for half in machines_of_turns(machine)]
    tops = [find_peaks(half, Signal.TORQUE, designs).values[:, 0] for half in machines_of_turns(machine)]
    assert peaks.values[:, 0] == pytest.approx(np.maximum(*tops), rel=1e-15)
    assert averages.mean == pytest.approx(0.5 * (ends[0].mean + ends[1].mean), rel=1e-12, abs=1e-12)
    for n, (crank, rod, offset) in enumerate(designs):
        linkage = Linkage(crank, rod, offset, machine.branch)
        torque = cycle(machine, linkage, DENSE).torque
        size = np.abs(torque).max()
        assert peaks.values[n, 0] == pytest.approx(size, rel=3e-3)
        assert peaks.values[n, 0] >= size * (1.0 - 1e-10)
        near = np.abs(cycle(machine, linkage, peaks.angles[n, 0] + np.array([-1e-10, 1e-10])).torque)
        assert np.abs(near / peaks.values[n, 0] - 1.0).min() < 1e-6
        assert averages.mean[n] == pytest.approx(torque.mean(), abs=5e-4 * size)
        assert averages.rms[n] == pytest.approx(math.sqrt(np.mean(torque**2)), rel=5e-4)
        cuts = breakpoints(machine, linkage)
        assert (np.diff(cuts) > 0.0).all()
        assert (cuts < 2.0 * TURN).all()
        whole = multi_cylinder_cycle(replace(machine, arrangement=Arrangement(phases=(0.0,))), linkage)
        assert abs(whole.peak.value) == pytest.approx(peaks.values[n, 0], rel=1e-10)
        assert whole.rms == pytest.approx(averages.rms[n], rel=1e-9)
        if n or seed > 3:
            continue
        extremes = {curve.name: curve for curve in curve_extremes(machine, linkage)}["torque"]
        assert max(extremes.greatest.value, -extremes.least.value) == pytest.approx(peaks.values[n, 0], rel=1e-9)
        given = cycle_energies(machine, linkage).input
        assert given == pytest.approx(machine.direction * 2.0 * TURN * averages.mean[n], rel=1e-9, abs=1e-9 * size)


@pytest.mark.parametrize("seed", range(8))
def test_slopes_of_quantities_are_those_of_differences(seed: int) -> None:
    machine, _, designs = random_case(seed)
    for name in ("peak_torque", "rms_torque", "mean_torque", "torque_fluctuation", "peak_guide_force"):
        found = QUANTITIES[name].evaluate(machine, designs, gradients=True)
        assert found.gradients is not None
        for column in range(3):
            step = 1e-7 * np.eye(3)[column]
            ends = [QUANTITIES[name].evaluate(machine, end).values for end in (designs + step, designs - step)]
            slope = (ends[0] - ends[1]) / 2e-7
            assert np.abs(found.gradients[:, column] - slope).max() <= 2e-5 * np.abs(found.gradients).max() + 1e-4


def test_numbers_that_vary_have_slopes_too() -> None:
    machine, _, designs = random_case(4)
    names = ("slider_mass", "speed")
    ends = (0.5, 2.0), tuple(sorted((machine.speed, 2.0 * machine.speed)))
    varying = [
        Varying(name=name, sets=((name, 1.0),), lower=low, upper=high)
        for name, (low, high) in zip(names, ends, strict=True)
    ]
    machine = replace(machine, acceleration=0.0, varying=tuple(varying))
    wide = np.column_stack([designs, [1.0, 1.5], [1.2 * machine.speed, 1.7 * machine.speed]])
    for name in ("peak_torque", "rms_torque"):
        found = QUANTITIES[name].evaluate(machine, wide, gradients=True)
        assert found.gradients is not None
        for column in (3, 4):
            step = 1e-6 * np.eye(5)[column]
            sides = [QUANTITIES[name].evaluate(machine, end).values for end in (wide + step, wide - step)]
            assert found.gradients[:, column] == pytest.approx((sides[0] - sides[1]) / 2e-6, rel=1e-5, abs=1e-6)
        one = QUANTITIES[name].evaluate(machine.with_values(wide[0, 3:].tolist()), wide[:1, :3]).values[0]
        assert found.values[0] == pytest.approx(one, rel=1e-12)


def test_a_table_that_repeats_after_one_turn_is_that_of_one_turn() -> None:
    once = AngleTable(angles=(0.2, 1.0, 4.0), forces=(10.0, -300.0, 50.0), datum="outer dead centre")
    twice = AngleTable(
        angles=(*once.angles, *(TURN + angle for angle in once.angles)),
        forces=2 * once.forces,
        datum=once.datum,
        cycle="720 deg",
    )
    designs = np.array([[0.03, 0.11, 0.01]])
    one, two = (Mechanism(speed=-30.0, slider_mass=0.4, loads=(table,)) for table in (once, twice))
    for quantity in QUANTITIES.values():
        if not quantity.unmet_need(one, "undefined"):
            values = [quantity.evaluate(machine, designs).values[0] for machine in (one, two)]
            turns = 2.0 if quantity.title.endswith("per cycle") else 1.0
            assert values[1] == pytest.approx(turns * values[0], rel=1e-10, abs=1e-12, nan_ok=True)
    assert loaded_stroke(two, designs) == loaded_stroke(one, designs)


def test_four_cylinders_of_four_strokes_fire_one_after_the_other() -> None:
    """A load that acts in one stroke of four: four of them, half a turn apart, act all the time."""
    table = AngleTable(angles=(0.0, 0.01, 3.1, 3.15), forces=(0.0, -500.0, -500.0, 0.0), cycle="720 deg")
    machine = Mechanism(speed=30.0, loads=(table,))
    linkage = Linkage(0.03, 0.11, 0.0)
    phases = tuple(math.radians(angle) for angle in (0, 180, 360, 540))
    four = replace(machine, arrangement=Arrangement(phases=phases, places=(0.0, 0.1, 0.2, 0.3)))
    found = multi_cylinder_cycle(four, linkage)
    assert found.mean == pytest.approx(4.0 * torque_averages(machine, np.array([[0.03, 0.11, 0.0]])).mean[0], rel=1e-10)
    spectrum = np.abs(np.fft.rfft(sum(cycle(machine, linkage, DENSE + phase).torque for phase in phases)))
    assert spectrum[[1, 2, 3]] == pytest.approx(0.0, abs=1e-9 * spectrum[4])


def test_impossible_cycles_are_refused() -> None:
    with pytest.raises(InputError, match=r"720 deg later; got three points there, from 0 deg to 720 deg"):
        AngleTable(angles=(0.0, 0.0, 2.0 * TURN), forces=(1.0, 2.0, 3.0), cycle="720 deg")
    with pytest.raises(InputError, match=r"at most 720 deg; got 859\.437 deg; give at most two turns"):
        AngleTable(angles=(0.0, 15.0), forces=(1.0, 2.0), cycle="720 deg")
    tables = [
        AngleTable(angles=(0.0, 9.0), forces=(1.0, 2.0), cycle="720 deg", datum=datum)
        for datum in ("inner dead centre", "outer dead centre")
    ]
    with pytest.raises(InputError, match="one datum; got inner dead centre and outer dead centre"):
        torque_averages(Mechanism(speed=1.0, loads=tuple(tables)), np.array([[0.03, 0.1, 0.0]]))
