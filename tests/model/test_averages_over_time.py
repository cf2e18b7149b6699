"""RMS values with a speed profile against integration over time."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from slidercrank.model.cycle.cycle import cycle
from slidercrank.model.cycle.multi_cylinder import multi_cylinder_cycle
from slidercrank.model.machine.arrangement import Arrangement
from slidercrank.model.machine.links_and_joints import Friction
from slidercrank.model.machine.loads.angle_table import AngleTable
from slidercrank.model.machine.loads.load import Load
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.machine.speed_profile import Harmonics, Profile, SpeedTable
from slidercrank.model.signals.averages import signal_averages, torque_averages
from slidercrank.model.signals.signals import Signal
from slidercrank.model.transient.speed_profile_cycle import speed_profile_cycle
from slidercrank.optimise.job import load_job
from tests.case_count import case_count
from tests.model.bodies import bodies
from tests.model.cases import linkage_of, random_designs, random_friction, random_machine
from tests.model.contour import distance_to_locking, motion_in_time
from tests.model.quadrature import NODES, WEIGHTS, integrals
from tests.model.test_averages import breakpoints
from tests.model.virtual_work import drive_torque, path

Array = NDArray[np.float64]
TURN = 2.0 * math.pi
FEEDER = np.array([[0.0376, 0.0998, 0.03119]])


@dataclass(frozen=True)
class Case:
    """A machine with a speed profile, one design (3,), and the number of turns in its cycle."""

    machine: Mechanism
    design: Array
    turns: int

    @property
    def profile(self) -> Profile:
        profile = self.machine.speed_profile
        assert profile is not None
        return profile


def random_profile(random: np.random.Generator, seed: int) -> Profile:
    """Return a profile: up to six harmonics, or a table.

    Harmonics go down to a tenth of the mean speed, the speeds of a table differ by a ratio of up to five.
    """
    if seed % 2:
        waves = random.normal(size=(2, random.integers(1, 7)))
        waves *= random.uniform(0.1, 0.9) / np.hypot(*waves).sum()
        return Harmonics(cosines=tuple(waves[0].tolist()), sines=tuple(waves[1].tolist()))
    count = int(random.integers(4, 10))
    angles = random.uniform(-2.0, 2.0) + TURN / count * (np.arange(count) + random.uniform(-0.2, 0.2, count))
    speeds = np.exp(random.uniform(0.0, math.log(5.0), count))
    while True:
        try:
            return SpeedTable(angles=tuple(angles.tolist()), speeds=tuple(speeds.tolist()))
        except ValueError:  # the spline falls below zero
            speeds = np.sqrt(speeds * speeds.mean())


def random_case(seed: int) -> Case:
    """Return a case: every third of several cylinders, every fourth of two turns, every fifth with friction."""
    random = np.random.default_rng(seed)
    machine = replace(random_machine(random), acceleration=0.0)
    several, two, rubs = seed % 3 == 0, seed % 4 == 0, seed % 5 == 0
    if two:
        angles = np.sort(random.uniform(-0.5, 2.0 * TURN - 0.6, 7))
        table = AngleTable(
            angles=tuple(angles.tolist()), forces=tuple(random.uniform(-900.0, 900.0, 7).tolist()), cycle="720 deg"
        )
        machine = replace(machine, loads=(*machine.loads[:5], table))
    if several:
        phases, banks = random.uniform(-7.0, 7.0, (2, int(random.integers(2, 4))))
        machine = replace(machine, arrangement=Arrangement(phases=tuple(phases), banks=tuple(banks)))
    machine = replace(
        machine,
        speed_profile=random_profile(random, seed),
        friction=random_friction(random) if rubs else Friction(),
    )
    return Case(machine, random_designs(1, seed=seed, least_margin=0.5 if rubs else 0.03)[0], 2 if two else 1)


class CrankOverTime:
    """The crank angle over time, by dtheta/dt = speed p(theta): dt = dtheta / (speed p), which is integrated.

    Gauss over panels of crank angle between the knots of p, as the crank turns from theta = 0 on.
    """

    def __init__(self, case: Case) -> None:
        self._speed, self._profile = case.machine.speed, case.profile
        self._turns = math.copysign(TURN * case.turns, self._speed)
        knots = np.add.outer(TURN * np.arange(case.turns), np.mod(np.array(self._profile.knots), TURN)).ravel()
        knots = knots if self._speed > 0.0 else abs(self._turns) - knots
        uniform = np.linspace(0.0, abs(self._turns), 1 + 200 * case.turns)
        self._angles = np.copysign(np.unique(np.concatenate([uniform, knots])), self._speed)
        self._times = np.concatenate([[0.0], np.cumsum(self._between(self._angles[:-1], self._angles[1:]))])
        self.knots = self._time_of(np.copysign(np.sort(knots), self._speed))
        self.period = float(self._times[-1])

    def _between(self, start: Array, end: Array) -> Array:
        """Return the times from one angle to another, of the same panel each."""
        width = end - start
        found: Array = 1.0 / self._profile.speed_ratio(start[:, None] + 0.5 * width[:, None] * (1.0 + NODES)) @ WEIGHTS
        return found * 0.5 * width / self._speed

    def _time_of(self, angles: Array) -> Array:
        place = np.clip(np.searchsorted(abs(self._angles), abs(angles), side="right") - 1, 0, len(self._angles) - 2)
        found: Array = self._times[place] + self._between(self._angles[place], angles)
        return found

    def angle(self, time: Array) -> Array:
        """Return crank angles at times (n,), by Newton's method from the line through the ends of their panel."""
        place = np.clip(np.searchsorted(self._times, time, side="right") - 1, 0, len(self._times) - 2)
        start, late = self._angles[place], time - self._times[place]
        found: Array = start + late * (self._angles[place + 1] - start) / (self._times[place + 1] - self._times[place])
        for _ in range(3):
            found = found + (late - self._between(start, found)) * self._speed * self._profile.speed_ratio(found)
        return found

    def times(self, angles: Array) -> Array:
        """Return the times of crank angles (n,), any turn."""
        return self._time_of(np.fmod(np.fmod(angles, self._turns) + self._turns, self._turns))


def over_time(case: Case, curve: Callable[[Array, Array, Array], Array]) -> Array:
    """Return the means over time of squares of curves (m, n) of crank angle, speed and acceleration, (m,)."""
    speed, profile, turning = case.machine.speed, case.profile, CrankOverTime(case)

    def squares(time: Array) -> Array:
        theta = turning.angle(time)
        ratio = profile.speed_ratio(theta)
        return np.asarray(curve(theta, speed * ratio, speed**2 * ratio * profile.speed_ratio_slope(theta)) ** 2)

    kinks = turning.times(breakpoints_of(case))
    panels = (300 if case.machine.friction != Friction() else 40) * case.turns  # kinks from friction have to be found
    edges = np.concatenate([turning.knots, kinks, np.linspace(0.0, turning.period, 1 + panels)])
    return integrals(squares, edges) / turning.period


def breakpoints_of(case: Case) -> Array:
    """Return the crank angles at which the torque may have a kink or a jump, except those from friction."""
    plain, tables = split_two_turn_tables(case.machine)
    found = [0.0]
    for one, lead, _ in cylinders(plain):
        own = [*breakpoints(one, case.design), *(angle % (2.0 * TURN) for table in tables for angle in table.angles)]
        found += [angle + turn * TURN - lead for angle in own for turn in range(case.turns)]
    return np.array(found)


def split_two_turn_tables(machine: Mechanism) -> tuple[Mechanism, list[AngleTable]]:
    """Return a machine without its two-turn tables, and these tables."""
    tables: list[AngleTable] = []
    others: list[Load] = []
    for load in machine.loads:
        if isinstance(load, AngleTable) and load.cycle == "720 deg":
            tables.append(load)
        else:
            others.append(load)
    return replace(machine, loads=tuple(others)), tables


def torque_of_one(machine: Mechanism, design: Array, theta: Array, speed: Array, acceleration: Array) -> Array:
    """Return the drive torque of one cylinder: by virtual work, or by `cycle` if it has friction.

    Without friction the torque is a polynomial of second order in a speed of one sign and of first order in the
    acceleration. `cycle` with friction is compared with nine equations in `test_friction`.
    """
    if machine.friction != Friction():
        linkage = linkage_of(design, machine.branch)
        return np.asarray(cycle(machine, linkage, theta, speed=speed, acceleration=acceleration).torque)
    plain, tables = split_two_turn_tables(machine)
    w = machine.speed
    at = [drive_torque(replace(plain, speed=k * w), design, theta) for k in (0.5, 1.0, 2.0)]
    inertia = drive_torque(replace(plain, acceleration=1.0), design, theta) - at[1]
    k = speed / w
    found = (
        at[0] * (k - 1.0) * (k - 2.0) / 0.75 - at[1] * (k - 0.5) * (k - 2.0) / 0.5 + at[2] * (k - 0.5) * (k - 1.0) / 1.5
    )
    sign = 1.0 if machine.branch == "open" else -1.0
    for table in tables:
        force = np.interp(theta, table.angles, table.forces, period=2.0 * TURN)
        found = found - sign * force * path(design, theta, sign).x_1
    return np.asarray(found + inertia * acceleration)


def cylinders(machine: Mechanism) -> list[tuple[Mechanism, float, float]]:
    """Return each cylinder as a separate machine, with the lead of its crank over the shaft and its bank."""
    one = replace(machine, speed_profile=None, arrangement=None)
    if machine.arrangement is None:
        return [(one, 0.0, 0.0)]
    found = []
    for phase, bank in zip(machine.arrangement.phases, machine.arrangement.banks, strict=True):
        pull = complex(*machine.gravity) * np.exp(-1j * bank)
        found.append((replace(one, gravity=(float(pull.real), float(pull.imag))), phase - bank, bank))
    return found


def torque_over_time(case: Case) -> float:
    """Return the RMS torque over time of all cylinders together."""

    def curve(theta: Array, speed: Array, acceleration: Array) -> Array:
        parts = [
            torque_of_one(one, case.design, theta + lead, speed, acceleration)
            for one, lead, _ in cylinders(case.machine)
        ]
        return np.stack([np.sum(parts, axis=0)])

    return math.sqrt(over_time(case, curve)[0])


def shaking_over_time(case: Case) -> tuple[float, float]:
    """Return RMS shaking force and moment over time, from momentum and angular momentum of mass points."""
    reach = distance_to_locking(*case.design)

    def curve(theta: Array, speed: Array, acceleration: Array) -> Array:
        found = np.zeros((3, len(theta)))
        for one, lead, bank in cylinders(case.machine):
            force = np.zeros(len(theta), dtype=complex)
            for part in bodies(one, case.design).values():
                x, y, turn = (
                    motion_in_time(f, theta + lead, speed=1.0, acceleration=0.0, reach=reach)
                    for f in (part.x, part.y, part.turn)
                )
                second, first = speed**2, acceleration
                push_x, push_y = (part.mass * (second * q[2] + first * q[1]) for q in (x, y))
                force -= push_x + 1j * push_y
                found[2] -= x[0] * push_y - y[0] * push_x + part.inertia * (second * turn[2] + first * turn[1])
            force *= np.exp(1j * bank)
            found[:2] += np.stack([force.real, force.imag])
        return found

    x, y, moment = over_time(case, curve)
    return math.sqrt(x + y), math.sqrt(moment)


@pytest.mark.parametrize("seed", range(8))
def test_crank_angles_over_time_solve_their_differential_equation(seed: int) -> None:
    """dtheta/dt = speed p(theta), by Dormand and Prince from theta = 0 on, anew at every knot of p."""
    case = random_case(seed)
    turning = CrankOverTime(case)
    times = np.unique([*turning.knots, *np.linspace(0.0, turning.period, 9)])
    angle, angles = 0.0, [0.0]
    for start, end in pairwise(times):
        solved = solve_ivp(
            lambda _, y: case.machine.speed * case.profile.speed_ratio(y),
            (start, end),
            [angle],
            method="DOP853",
            rtol=1e-12,
            atol=1e-13,
        )
        angle = float(solved.y[0, -1])
        angles.append(angle)
    assert angle == pytest.approx(math.copysign(TURN * case.turns, case.machine.speed), rel=1e-10)
    assert turning.angle(times) == pytest.approx(angles, abs=1e-9)
    inside = np.array(angles[1:-1])
    assert turning.times(inside + 2.0 * TURN * case.turns) == pytest.approx(times[1:-1], rel=1e-9)


@pytest.mark.parametrize("seed", range(100))
def test_rms_torque_along_a_profile_is_over_time(seed: int) -> None:
    """Both sides resolve the torque to some 1e-12 of its greatest value."""
    case = random_case(seed)
    wanted = torque_over_time(case)
    assert torque_averages(case.machine, case.design[None]).rms[0] == pytest.approx(wanted, rel=1e-9)
    linkage = linkage_of(case.design, case.machine.branch)
    if case.machine.arrangement is not None:
        assert multi_cylinder_cycle(case.machine, linkage).rms == pytest.approx(wanted, rel=1e-9)
    else:
        assert speed_profile_cycle(case.machine, linkage).rms_torque == pytest.approx(wanted, rel=1e-9)


@pytest.mark.parametrize("seed", range(case_count(8, 20)))
def test_rms_shaking_along_a_profile_is_over_time(seed: int) -> None:
    case = random_case(seed)
    case = Case(replace(case.machine, friction=Friction(), loads=()), case.design, 1)
    design, wanted = case.design[None], shaking_over_time(case)
    for kind, rms in zip((Signal.SHAKING_FORCE, Signal.SHAKING_MOMENT), wanted, strict=True):
        assert signal_averages(case.machine, kind, design).rms[0] == pytest.approx(rms, rel=1e-9)
    if case.machine.arrangement is not None:
        whole = multi_cylinder_cycle(case.machine, linkage_of(case.design, case.machine.branch))
        assert (whole.rms_shaking_force, whole.rms_shaking_moment) == pytest.approx(wanted, rel=1e-9)


@pytest.mark.parametrize(("cosine", "rms"), [(0.5, 88.22), (-0.5, 43.82)])
def test_a_feeder_at_2400_rpm_heats_its_motor_by_the_time_it_takes(
    cosine: float, rms: float, pytestconfig: pytest.Config
) -> None:
    """Over the crank angle these would be 96.80 and 49.10 N m."""
    machine = load_job(pytestconfig.rootpath / "runs/feeder.toml").mechanism
    machine = replace(machine, speed_profile=Harmonics(cosines=(cosine,)))
    assert torque_averages(machine, FEEDER).rms[0] == pytest.approx(rms, abs=0.005)
    assert speed_profile_cycle(machine, linkage_of(FEEDER[0])).rms_torque == pytest.approx(rms, abs=0.005)
