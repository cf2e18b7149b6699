"""True steps of load tables against an own integration over the cycle, and against ever steeper ramps."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import brentq

from slidercrank.model.cycle.cycle import cycle
from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.loads.angle_table import AngleTable
from slidercrank.model.machine.loads.crank_torque import CrankTorqueTable
from slidercrank.model.machine.loads.load import Load
from slidercrank.model.machine.loads.position_table import PositionTable
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.signals.averages import torque_averages
from slidercrank.model.signals.peaks import find_peaks
from slidercrank.model.signals.signals import Signal
from slidercrank.model.signals.turn_work import LOAD, turn_work
from slidercrank.model.swing.peaks import swing_peaks
from slidercrank.model.swing.swing_states import DRIVE
from slidercrank.model.swing.work import swing_work
from slidercrank.optimise.job import parse_job
from tests.model.cases import linkage_of, random_designs, random_friction, random_machine
from tests.model.swing.swings import random_swings

Array = NDArray[np.float64]
TURN = 2.0 * math.pi
BESIDE = 1e-9  # rad: one side of a step
STROKES = ("cycle", "outward stroke", "inward stroke")
POSITION_DATUMS = ("crank pivot", "inner dead centre", "outer dead centre")
ANGLE_DATUMS = ("zero crank angle", "inner dead centre", "outer dead centre")


@dataclass(frozen=True)
class Case:
    """A machine with a table that steps, its linkage, and the same machine with ramps instead of steps."""

    machine: Mechanism
    linkage: Linkage
    ramped: Callable[[float], Load]
    turns: int = 1

    @property
    def design(self) -> Array:
        return np.array([[float(self.linkage.crank), float(self.linkage.rod), float(self.linkage.offset)]])

    def with_ramps(self, width: float) -> Mechanism:
        return replace(self.machine, loads=(self.ramped(width),))


def knots(random: np.random.Generator, low: float, high: float) -> tuple[Array, Array]:
    """Return five places, two of them steps, and the forces at them."""
    repeated = np.ones(5, dtype=int)
    repeated[random.choice(5, 2, replace=False)] = 2
    at = np.repeat(np.sort(random.uniform(low, high, 5)), repeated)
    return at, random.uniform(-900.0, 900.0, len(at))


def apart(at: Array, width: float) -> Array:
    """Return places whose equal ones are a width apart."""
    moved, first = at.copy(), np.flatnonzero(np.diff(at) == 0.0)
    moved[first] -= 0.5 * width
    moved[first + 1] += 0.5 * width
    return moved


def over_position(seed: int) -> Case:
    random = np.random.default_rng(seed)
    machine = replace(random_machine(random), loads=())
    linkage = linkage_of(random_designs(1, seed=seed, least_margin=0.2)[0], machine.branch)
    datum, during = POSITION_DATUMS[seed % 3], STROKES[seed // 3 % 3]
    inner, outer = (abs(float(x)) for x in linkage.dead_centres)
    start = inner if datum == "crank pivot" else 0.0
    at, forces = knots(random, start, start + outer - inner)

    def table(width: float) -> Load:
        return PositionTable(positions=tuple(apart(at, width)), forces=tuple(forces), datum=datum, during=during)  # type: ignore[arg-type]

    return Case(replace(machine, loads=(table(0.0),)), linkage, lambda width: table(width * (outer - inner)))


def over_angle(seed: int) -> Case:
    """Return a case of forces or torques, of one turn or two, that steps at its seam as well."""
    random = np.random.default_rng(seed)
    machine = replace(random_machine(random), loads=())
    linkage = linkage_of(random_designs(1, seed=seed, least_margin=0.2)[0], machine.branch)
    turns, start = 1 + seed % 2, float(random.uniform(-4.0, 4.0))
    at, forces = knots(random, start + 0.1, start + turns * TURN - 0.1)
    at, forces = np.array([start, *at, start + turns * TURN]), np.array([200.0, *forces, -350.0])
    more: dict[str, Any] = {"datum": ANGLE_DATUMS[seed % 3], "cycle": ("360 deg", "720 deg")[turns - 1]}

    def table(width: float) -> Load:
        places = apart(at, width)
        places[0], places[-1] = places[0] + 0.5 * width, places[-1] - 0.5 * width
        if seed // 2 % 2:
            return CrankTorqueTable(angles=tuple(places), forces=tuple(0.1 * forces), **more)
        return AngleTable(angles=tuple(places), forces=tuple(forces), during=STROKES[seed // 3 % 3], **more)  # type: ignore[arg-type]

    return Case(replace(machine, loads=(table(0.0),)), linkage, table, turns)


def own(case: Case) -> tuple[Callable[[Array], Array], list[float]]:
    """Return the torque by virtual work, and the angles between which it is smooth."""
    machine, linkage, load = case.machine, case.linkage, case.machine.loads[0]
    r, l, e, branch = float(linkage.crank), float(linkage.rod), float(linkage.offset), linkage.sign
    way, (inner, outer) = machine.direction, (float(angle) for angle in linkage.dead_centre_angles)
    low, high = (abs(float(x)) for x in linkage.dead_centres)

    def distance(theta: Any) -> Any:
        return branch * r * np.cos(theta) + np.sqrt(l * l - (e - r * np.sin(theta)) ** 2)

    def rate(theta: Any) -> Any:
        across = e - r * np.sin(theta)
        return -branch * r * np.sin(theta) + across * r * np.cos(theta) / np.sqrt(l * l - across**2)

    ends = [inner, outer]
    if isinstance(load, PositionTable):
        at, forces = np.array(load.positions), np.array(load.forces)
        zero, sense = {"crank pivot": (0.0, 1.0), "inner dead centre": (low, 1.0), "outer dead centre": (high, -1.0)}[
            load.datum
        ]
        for place in zero + sense * at:
            for first, last in (
                (inner, outer + (TURN if outer < inner else 0.0)),
                (outer, inner + (TURN if inner < outer else 0.0)),
            ):
                if low < place < high:
                    ends.append(brentq(lambda angle, x=place: distance(angle) - x, first, last, xtol=1e-15))

        def tabulated(theta: Array) -> Array:
            return np.asarray(np.interp(sense * (distance(theta) - zero), at, forces))
    else:
        assert isinstance(load, AngleTable)
        at, forces = np.array(load.angles), np.array(load.forces)
        zero = {"zero crank angle": 0.0, "inner dead centre": inner, "outer dead centre": outer}[load.datum]
        turned = way if load.datum != "zero crank angle" else 1.0
        ends += [zero + turned * (angle + n * TURN) for angle in at for n in range(-3, 4)]

        def tabulated(theta: Array) -> Array:
            counted = at[0] + np.mod(turned * (theta - zero) - at[0], case.turns * TURN)
            return np.asarray(np.interp(counted, at, forces))

    bare = replace(machine, loads=())

    def torque(theta: Array) -> Array:
        none = cycle(bare, linkage, theta).torque
        if load.on_crank:
            return np.asarray(none - tabulated(theta))
        outward = rate(theta) * way > 0.0
        during = getattr(load, "during", "cycle")
        counts = np.ones_like(outward) if during == "cycle" else outward == (during == "outward stroke")
        return np.asarray(none - np.where(counts, tabulated(theta), 0.0) * rate(theta))

    period = case.turns * TURN
    cuts = np.unique(np.round(np.mod([end + n * TURN for end in ends for n in range(case.turns)], period), 12))
    return torque, cuts.tolist()


def numbers(case: Case) -> tuple[float, float, float]:
    """Return greatest size, mean and root mean square of the torque: close samples, both sides of every cut, Gauss."""
    torque, cuts = own(case)
    period = case.turns * TURN
    sides = np.array([cut + side for cut in cuts for side in (-BESIDE, BESIDE)])
    peak = np.abs(torque(np.concatenate([np.linspace(0.0, period, 40_001), sides]))).max()
    nodes, weights = np.polynomial.legendre.leggauss(60)
    mean = square = 0.0
    for low, high in zip(cuts, [*cuts[1:], cuts[0] + period], strict=True):
        if high - low > 1e-9:
            value = torque(low + 0.5 * (high - low) * (1.0 + nodes))
            mean += 0.5 * (high - low) / period * float(weights @ value)
            square += 0.5 * (high - low) / period * float(weights @ value**2)
    return float(peak), mean, math.sqrt(square)


def slopes(of: Callable[[Array], float], design: Array) -> Array:
    """Return central differences by crank, rod and offset."""
    found = []
    for k in range(3):
        step = np.zeros_like(design)
        step[0, k] = 2e-6 * design[0, 1]
        found.append((of(design + step) - of(design - step)) / (2.0 * step[0, k]))
    return np.array(found)


CASES = [*(over_position(seed) for seed in range(9)), *(over_angle(seed) for seed in range(12))]


@pytest.mark.slow
@pytest.mark.parametrize("case", CASES)
def test_peak_mean_and_rms_torque_of_a_table_with_steps_are_those_of_an_own_integration(case: Case) -> None:
    """The step counts by the limits from both sides; samples miss a smooth top by 1e-8, sides by their distance."""
    peak, mean, rms = numbers(case)
    found = find_peaks(case.machine, Signal.TORQUE, case.design, limit=1).values[0, 0]
    assert peak * (1.0 - 1e-7) <= found <= peak * (1.0 + 1e-6)
    averages = torque_averages(case.machine, case.design)
    assert averages.mean[0] == pytest.approx(mean, abs=1e-9 * rms)
    assert averages.rms[0] == pytest.approx(rms, rel=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("case", CASES)
def test_derivatives_of_a_table_with_steps_are_differences_of_neighbours(case: Case) -> None:
    """A step that moves with the design carries peak, mean and mean square along; differences are right to 1e-6."""
    design = case.design
    for read, own_slopes in (
        (
            lambda at: find_peaks(case.machine, Signal.TORQUE, at, limit=1).values[0, 0],
            find_peaks(case.machine, Signal.TORQUE, design, limit=1, gradients=True).gradients,
        ),
        (
            lambda at: torque_averages(case.machine, at).mean[0],
            torque_averages(case.machine, design, gradients=True).mean_gradients,
        ),
        (
            lambda at: torque_averages(case.machine, at).rms[0],
            torque_averages(case.machine, design, gradients=True).rms_gradients,
        ),
        (
            lambda at: turn_work(case.machine, at).mean[0, LOAD],
            np.asarray(turn_work(case.machine, design, gradients=True).gradients)[:, LOAD],
        ),
    ):
        expected = slopes(read, design)
        size = np.abs(expected).max() + torque_averages(case.machine, design).rms[0] / design[0, 1]
        assert np.asarray(own_slopes).reshape(-1, 3)[0] == pytest.approx(expected, abs=1e-5 * size)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [20, 22, 23, 24])
def test_a_step_is_the_limit_of_ever_steeper_ramps_with_friction_too(seed: int) -> None:
    """With ramps of a millionth of the stroke and half of it, the limit errs by that squared."""
    case = (over_position if seed % 2 else over_angle)(seed)
    rubbing = replace(case.machine, friction=random_friction(np.random.default_rng(seed)))
    case = replace(case, machine=rubbing)
    for kind in (Signal.TORQUE, Signal.GUIDE_FORCE, Signal.CRANK_PIN_FORCE):
        wide, narrow, step = (
            find_peaks(machine, kind, case.design, limit=1).values[0, 0]
            for machine in (case.with_ramps(2e-6), case.with_ramps(1e-6), case.machine)
        )
        assert step == pytest.approx(2.0 * narrow - wide, rel=1e-8)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(6))
def test_means_with_friction_move_with_a_step_as_differences_say(seed: int) -> None:
    case = over_position(seed)
    machine = replace(case.machine, friction=random_friction(np.random.default_rng(seed)))
    found = torque_averages(machine, case.design, gradients=True)
    size = found.rms[0] / case.design[0, 1]
    for own_slopes, row in ((found.mean_gradients, 0), (found.rms_gradients, 2)):
        expected = slopes(lambda at, row=row: torque_averages(machine, at).values[row, 0], case.design)  # type: ignore[misc]
        assert np.asarray(own_slopes)[0] == pytest.approx(expected, abs=1e-5 * (size + np.abs(expected).max()))


@pytest.mark.slow
def test_a_swing_meets_a_step_as_the_limit_of_ramps() -> None:
    """Peak drive with derivatives, and work both ways; the limit has an error of the ramp squared."""
    random = np.random.default_rng(7)
    for machine, linkage, swing in [*random_swings(8, seed=5), *random_swings(4, seed=6, friction=True)]:
        distance = linkage.sign * linkage.at(np.linspace(swing.start, swing.end, 400)).slider_position
        span = float(np.ptp(distance))
        at, forces = knots(random, float(distance.min()), float(distance.max()))
        step, narrow, wide = (
            replace(machine, loads=(PositionTable(positions=tuple(apart(at, width * span)), forces=tuple(forces)),))
            for width in (0.0, 1e-6, 2e-6)
        )
        design = np.array([[float(linkage.crank), float(linkage.rod), float(linkage.offset)]])
        peaks = [swing_peaks(each, swing, DRIVE, design, gradients=True, limit=1) for each in (step, narrow, wide)]
        values = [found.values[0, 0] for found in peaks]
        assert values[0] == pytest.approx(2.0 * values[1] - values[2], rel=1e-7)
        moved = [np.asarray(found.gradients)[0, 0] for found in peaks]
        assert moved[0] == pytest.approx(moved[1], abs=2e-5 * np.abs(moved[1]).max())
        works = [swing_work(each, swing, design).values[0] for each in (step, narrow, wide)]
        assert works[0] == pytest.approx(2.0 * works[1] - works[2], abs=1e-9 * values[0] * span)


def test_a_shear_that_ends_in_a_step_has_its_peak_just_before() -> None:
    """A 4 mm blank is sheared from 20 mm before the end of the stroke: 600 kN fall to zero."""
    table = PositionTable(
        positions=(0.016, 0.020, 0.020), forces=(0.0, -6e5, 0.0), datum="outer dead centre", during="outward stroke"
    )
    assert table.has_steps
    machine = Mechanism(speed=1.0, loads=(table,))
    linkage = Linkage(0.06, 0.3, 0.0)
    angle = brentq(lambda theta: 0.36 - float(linkage.at(theta).slider_position) - 0.020, -1.5, -0.1)
    lever = -0.06 * math.sin(angle) * (1.0 + 0.06 * math.cos(angle) / math.sqrt(0.09 - (0.06 * math.sin(angle)) ** 2))
    found = find_peaks(machine, Signal.TORQUE, np.array([[0.06, 0.3, 0.0]]), limit=1)
    assert found.values[0, 0] == pytest.approx(6e5 * lever, rel=1e-12)
    assert found.angles[0, 0] == pytest.approx(angle + TURN, abs=1e-12)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (
            lambda: PositionTable(positions=(0.0, 0.02, 0.02, 0.02), forces=(0.0, 1.0, 2.0, 3.0)),
            "positions of a table must increase, except for two equal ones at a step; got 0.02 three times; keep",
        ),
        (
            lambda: AngleTable(angles=(1.0, 1.0, 1.0 + TURN), forces=(0.0, 1.0, 2.0)),
            "recurs 360 deg later; got three points there",
        ),
        (
            lambda: CrankTorqueTable(angles=(0.0, TURN, TURN), forces=(0.0, 1.0, 2.0)),
            "recurs 360 deg later; got three points there",
        ),
    ],
)
def test_three_points_at_one_place_are_refused(make: Callable[[], Load], message: str) -> None:
    with pytest.raises(InputError, match=message):
        make()


def test_a_table_that_ends_where_it_begins_a_cycle_later_closes_or_steps_there() -> None:
    open_ended = AngleTable(angles=(0.5, 2.0), forces=(5.0, 1.0))
    closed = AngleTable(angles=(0.5, 2.0, 0.5 + TURN), forces=(5.0, 1.0, 5.0))
    stepped = AngleTable(angles=(0.5, 2.0, 0.5 + TURN), forces=(5.0, 1.0, 1.0))
    assert open_ended.knots() == closed.knots()
    assert (open_ended.has_steps, closed.has_steps, stepped.has_steps) == (False, False, True)
    machine = Mechanism(speed=1.0, loads=(stepped,))
    beside = cycle(machine, Linkage(0.03, 0.1, 0.0), np.array([0.5 - 1e-9, 0.5 + 1e-9])).load
    assert beside == pytest.approx([1.0, 5.0], abs=1e-7)


@pytest.mark.parametrize(
    "table",
    [
        {"positions": ["0 mm", "20 mm", "2 cm"], "forces": ["0 N", "-600 N", "0 N"]},
        {"crank_angles": ["0 deg", "90 deg", "90 deg", "360 deg"], "forces": ["0 N", "-600 N", "0 N", "50 N"]},
        {"torque_angles": ["0 deg", "90 deg", "90 deg"], "torques": ["0 N m", "-6 N m", "0 N m"]},
        {"pressure_positions": ["0 mm", "20 mm", "20 mm"], "pressures": ["8 bar", "6 bar", "1 bar"], "bore": "70 mm"},
        {"pressure_angles": ["0 deg", "90 deg", "90 deg"], "pressures": ["8 bar", "6 bar", "1 bar"], "bore": "70 mm"},
    ],
)
def test_every_table_of_a_job_may_step(table: dict[str, Any]) -> None:
    job = {
        "name": "A table that steps",
        "mechanism": {"speed": "60 rpm", "slider": {"mass": "1 kg"}},
        "load": [table],
        "variables": {"crank": ["20 mm", "60 mm"], "rod": ["100 mm", "200 mm"], "offset": "0 mm"},
        "objectives": {"peak_torque": "minimise"},
    }
    machine = parse_job(job).mechanism
    assert machine.loads[0].has_steps
    peak = find_peaks(machine, Signal.TORQUE, np.array([[0.04, 0.15, 0.0]]), limit=1, gradients=True)
    assert np.isfinite(peak.values).all()
    assert np.isfinite(np.asarray(peak.gradients)).all()


@pytest.mark.parametrize("kind", [AngleTable, CrankTorqueTable])
def test_a_table_of_two_turns_with_all_points_in_one_of_them(kind: Any) -> None:
    chance = np.random.default_rng(37)
    for _ in range(200):
        begin = chance.choice([0.0, TURN]) + chance.uniform(-0.2, 2.0)
        angles = begin + np.sort(chance.uniform(0.0, TURN - 2.2, chance.integers(2, 6)))
        values = np.round(chance.uniform(-100.0, 100.0, len(angles)), 3)
        names = {"forces": tuple(values)}
        table = kind(angles=tuple(angles), cycle="720 deg", **names)
        for turn in (1, 2):
            at, forces = table.load_on_turn(turn).knots()
            where = np.linspace(0.0, TURN, 97)
            expected = np.interp(
                np.mod(where + TURN * (turn - 1) - angles[0], 2.0 * TURN),
                [*(angles - angles[0]), 2.0 * TURN],
                [*values, values[0]],
            )
            np.testing.assert_allclose(np.interp(where, at, forces), expected, rtol=0, atol=1e-6)
