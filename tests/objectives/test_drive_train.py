"""Loads on a motor behind a gear with losses: by hand, by an independent model, and their derivatives."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from slidercrank.model.errors import InputError, JobError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.drive import ConstantTorque, Drive
from slidercrank.model.machine.links_and_joints import Friction, RigidLink
from slidercrank.model.machine.loads.crank_torque import CrankTorque, CrankTorqueTable
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.machine.speed_profile import Harmonics
from slidercrank.model.machine.varying_numbers import Varying
from slidercrank.model.transient.forward_dynamics import simulate
from slidercrank.objectives.registry import QUANTITIES
from slidercrank.objectives.tables.cycle_curves import cycle_curves
from slidercrank.optimise.job import parse_job
from tests.model.cases import Array, random_designs
from tests.model.quadrature import integrals
from tests.model.test_averages_over_time import Case, breakpoints_of, cylinders, random_case, torque_of_one
from tests.objectives.richardson import derivatives, steps_to_the_nearest_edge

TURN = 2.0 * math.pi
LOSSY = Drive(
    flywheel=0.02,
    motor_inertia=6e-4,
    gear_ratio=7.0,
    gear_efficiency=0.9,
    braking_efficiency=0.8,
    greatest_torque=15.0,
    rated_torque=5.0,
    greatest_speed=400.0,
    copper_loss=90.0,
    recovery=0.6,
)
LOSSY_MOTOR = replace(LOSSY, motor=ConstantTorque(torque=20.0))
DESIGN = np.array([[0.05, 0.2, 0.02]])


def value(name: str, machine: Mechanism, designs: Array = DESIGN) -> float:
    return float(QUANTITIES[name].evaluate(machine, designs).values[0])


class HandMade:
    """The motor of a case once more: its torque from the torque of its cylinders, by virtual work."""

    def __init__(self, case: Case, drive: Drive) -> None:
        self.case, self.drive = case, drive
        points = np.concatenate([breakpoints_of(case), np.array(case.profile.knots)])
        self.period = TURN * case.turns
        laps = np.add.outer(TURN * np.arange(case.turns), points).ravel()
        self.edges = np.unique(np.concatenate([np.mod(laps, self.period), np.linspace(0.0, self.period, 41)]))

    def torque_and_speed(self, theta: Array) -> tuple[Array, Array]:
        """Return torque, N m, and speed, rad/s, of the motor in its direction of rotation."""
        machine, drive = self.case.machine, self.drive
        ratio = self.case.profile.speed_ratio(theta)
        speed, acceleration = (
            machine.speed * ratio,
            machine.speed**2 * ratio * self.case.profile.speed_ratio_slope(theta),
        )
        torque = np.sum(
            [
                torque_of_one(one, self.case.design, theta + lead, speed, acceleration)
                for one, lead, _ in cylinders(machine)
            ],
            axis=0,
        )
        sense = math.copysign(1.0, machine.speed)
        at_crank = sense * (torque + drive.flywheel * acceleration)
        output = np.where(
            at_crank > 0.0, at_crank / drive.gear_efficiency, at_crank * (drive.braking_efficiency or 1.0)
        )
        rotor = drive.motor_inertia * drive.gear_ratio * sense * acceleration
        return rotor + output / drive.gear_ratio, drive.gear_ratio * np.abs(speed)

    def averages(self) -> tuple[float, float]:
        """Return RMS torque over time and energy drawn, J."""

        def curves(theta: Array) -> Array:
            torque, speed = self.torque_and_speed(theta)
            loss = (self.drive.copper_loss or 0.0) * (torque / (self.drive.rated_torque or 1.0)) ** 2
            power = torque * speed + loss
            per_time = self.drive.gear_ratio / speed
            drawn = np.where(power > 0.0, power, self.drive.recovery * power)
            return np.stack([torque**2 * per_time, per_time, drawn * per_time])

        square, time, energy = integrals(curves, self.edges)
        return math.sqrt(square / time), float(energy)

    def peak(self, *, power: bool) -> float:
        """Return the greatest torque or power: 100 samples between edges, and again beside the best one."""

        def size(theta: Array) -> Array:
            torque, speed = self.torque_and_speed(theta)
            return np.abs(torque * speed if power else torque)

        best = 0.0
        for low, high in pairwise(self.edges):
            for _ in range(6 if high - low > 1e-9 else 0):
                theta = np.linspace(low + 1e-12, high - 1e-12, 101)
                values = size(theta)
                top = int(values.argmax())
                best, low, high = max(best, values[top]), theta[max(top - 1, 0)], theta[min(top + 1, 100)]
        return float(best)


@pytest.mark.parametrize(
    "seed", [1, 2, 4, pytest.param(6, marks=pytest.mark.slow), pytest.param(9, marks=pytest.mark.slow)]
)
def test_the_motor_is_that_of_an_independent_model_with_rotor_and_lossy_gear(seed: int) -> None:
    """Several cylinders, cycles of two turns, both directions, loads of all kinds, with a speed profile."""
    case = random_case(seed)
    machine, design = replace(case.machine, drive=LOSSY), case.design[None]
    made = HandMade(case, LOSSY)
    rms, energy = made.averages()
    assert value("motor_rms_torque", machine, design) == pytest.approx(rms, rel=1e-8)
    assert value("energy_drawn", machine, design) == pytest.approx(energy, rel=1e-8)
    assert value("motor_peak_torque", machine, design) == pytest.approx(made.peak(power=False), rel=1e-8)
    assert value("motor_power", machine, design) == pytest.approx(made.peak(power=True), rel=1e-8)
    assert value("thermal_use", machine, design) == pytest.approx(rms / 5.0, rel=1e-8)
    theta = np.sort(np.random.default_rng(seed).uniform(0.0, made.period, 200))
    crank, rod, offset = case.design
    linkage = Linkage(crank, rod, offset, branch=machine.branch)
    curves = {curve.field: curve.values for curve in cycle_curves(machine, linkage, theta)}
    torque, speed = made.torque_and_speed(theta)
    assert curves["motor_torque_Nm"] == pytest.approx(torque, rel=1e-9, abs=1e-9 * float(np.abs(torque).max()))
    assert curves["motor_speed_rpm"] == pytest.approx(speed, rel=1e-12)
    assert curves["motor_power_W"] == pytest.approx(
        torque * speed, rel=1e-9, abs=1e-9 * float(np.abs(torque * speed).max())
    )


def test_curves_of_a_motor_need_a_speed_for_power_and_a_moving_linkage_for_torque() -> None:
    linkage, load = Linkage(0.05, 0.2, 0.02), CrankTorque(torque=-20.0)
    resting = cycle_curves(Mechanism(loads=(load,), drive=LOSSY), linkage, [1.0, 2.0])
    assert [curve.name for curve in resting if curve.name.startswith("motor")] == ["motor_torque"]
    assert resting[-1].values == pytest.approx([20.0 / 7.0 / 0.9] * 2, rel=1e-12)
    locked = Mechanism(speed=10.0, loads=(load,), drive=LOSSY, friction=Friction(guide=9.0))
    assert all(np.isnan(curve.values).all() for curve in cycle_curves(locked, linkage, [1.0])[-1:])
    assert not [curve for curve in cycle_curves(Mechanism(), linkage, [1.0]) if curve.name.startswith("motor")]


def test_a_steady_torque_on_the_crank_is_that_of_the_gear_by_hand() -> None:
    """20 N m and 10 rad/s at the crank, through 7 : 1; 90 % driving, 80 % braking."""
    nothing = RigidLink(mass=0.0)
    for torque, wanted in ((-20.0, 20.0 / 7.0 / 0.9), (20.0, -20.0 / 7.0 * 0.8)):
        load = CrankTorque(torque=torque)
        machine = Mechanism(speed=10.0, crank=nothing, rod=nothing, loads=(load,), drive=LOSSY)
        power = wanted * 70.0 + 90.0 * (wanted / 5.0) ** 2
        drawn = (power if power > 0.0 else 0.6 * power) * TURN / 10.0
        assert value("motor_peak_torque", machine) == pytest.approx(abs(wanted), rel=1e-12)
        assert value("motor_rms_torque", machine) == pytest.approx(abs(wanted), rel=1e-12)
        assert value("motor_power", machine) == pytest.approx(abs(wanted) * 70.0, rel=1e-12)
        assert value("energy_drawn", machine) == pytest.approx(drawn, rel=1e-12)
        assert value("motor_torque_use", machine) == pytest.approx(abs(wanted) / 15.0, rel=1e-12)
        assert value("motor_speed_use", machine) == pytest.approx(70.0 / 400.0, rel=1e-12)


def test_a_rotor_alone_needs_the_torque_of_its_acceleration() -> None:
    """With p = 1 + 0.2 cos, p p' peaks where 0.2 (2 cos^2 - 1) + cos = 0."""
    nothing, profile = RigidLink(mass=0.0), Harmonics(cosines=(0.2,))
    drive = replace(LOSSY, flywheel=0.0, copper_loss=None, recovery=1.0)
    machine = Mechanism(speed=-10.0, crank=nothing, rod=nothing, speed_profile=profile, drive=drive)
    cosine = (math.sqrt(1.0 + 8.0 * 0.04) - 1.0) / 0.8
    greatest = 100.0 * (1.0 + 0.2 * cosine) * 0.2 * math.sqrt(1.0 - cosine**2)
    assert value("motor_peak_torque", machine) == pytest.approx(7.0 * 6e-4 * greatest, rel=1e-12)
    assert value("energy_drawn", machine) == pytest.approx(0.0, abs=1e-13)
    assert value("motor_speed", machine) == pytest.approx(7.0 * 10.0 * 1.2, rel=1e-12)
    assert value("inertia_ratio", machine) == 0.0


def test_without_losses_the_motor_is_the_crank_through_the_ratio() -> None:
    case = random_case(2)
    drive = Drive(gear_ratio=4.0, recovery=1.0)
    machine, design = replace(case.machine, drive=drive), case.design[None]
    for at_motor, at_crank in (("motor_peak_torque", "peak_torque"), ("motor_rms_torque", "rms_torque")):
        assert value(at_motor, machine, design) == pytest.approx(value(at_crank, machine, design) / 4.0, rel=1e-12)
    assert value("motor_power", machine, design) == pytest.approx(value("peak_power", machine, design), rel=1e-12)
    assert value("energy_drawn", machine, design) == pytest.approx(value("energy_per_cycle", machine, design), rel=1e-9)


VARYING = tuple(
    Varying(name=path, sets=((path, 1.0),), lower=low, upper=high)
    for path, low, high in (
        ("drive.gear_ratio", 3.0, 12.0),
        ("drive.motor_inertia", 1e-4, 1e-3),
        ("drive.flywheel", 0.01, 0.05),
        ("drive.gear_efficiency", 0.8, 0.95),
        ("drive.braking_efficiency", 0.7, 0.9),
        ("drive.recovery", 0.3, 0.8),
        ("drive.rated_torque", 3.0, 8.0),
        ("drive.greatest_torque", 9.0, 20.0),
        ("drive.greatest_speed", 200.0, 500.0),
        ("drive.copper_loss", 50.0, 120.0),
        ("slider_mass", 0.5, 2.0),
        ("speed", 10.0, 30.0),
    )
)
UNEVEN = Harmonics(cosines=(0.1, 0.15), sines=(0.05,))
NAMES = (
    *("motor_peak_torque", "motor_rms_torque", "motor_speed", "motor_power", "energy_drawn", "thermal_use"),
    *("motor_torque_use", "motor_speed_use", "inertia_ratio", "mean_inertia_ratio"),
)


@pytest.mark.parametrize(
    ("name", "profile"),
    [*((name, None) for name in NAMES), *((name, UNEVEN) for name in NAMES[:5])],
)
def test_derivatives_by_lengths_and_drive_are_those_of_extrapolated_differences(
    name: str, profile: Harmonics | None
) -> None:
    machine = replace(random_case(1).machine, speed=20.0, speed_profile=profile, drive=LOSSY, varying=VARYING)
    designs = random_designs(2, seed=3, least_margin=0.2)
    random = np.random.default_rng(5)
    spans = np.array([[item.lower, item.upper] for item in VARYING])
    numbers = spans[:, 0] + random.uniform(0.3, 0.7, (len(designs), len(VARYING))) * np.ptp(spans, axis=1)
    full = np.hstack([designs, numbers])
    first = np.hstack([0.2 * steps_to_the_nearest_edge(designs, kink_without_offset=True), 0.05 * numbers])

    def function(displaced: Array, index: Any) -> Array:
        return QUANTITIES[name].evaluate(machine, displaced).values

    wanted, _ = derivatives(function, full, first)
    found = QUANTITIES[name].evaluate(machine, full, gradients=True).gradients
    assert found is not None
    scale = np.abs(full)  # each number has its own unit
    size = np.abs(wanted * scale).max(axis=1, keepdims=True)
    assert (np.abs(found - wanted) * scale / size).max() < 1e-7


def test_a_peak_on_the_kink_of_the_gear_moves_with_it() -> None:
    """The crank's torque crosses zero where the rotor brakes more and more, between the two slopes of the gear."""
    nothing, angle = RigidLink(mass=0.0), 1.5
    profile = Harmonics(cosines=(0.3 * math.cos(0.5),), sines=(0.3 * math.sin(0.5),))  # 0.3 cos(theta - 0.5)
    rotor = LOSSY.gear_ratio * LOSSY.motor_inertia
    ratio, slope, bend = 1.0 + 0.3 * math.cos(1.0), -0.3 * math.sin(1.0), -0.3 * math.cos(1.0)
    fall = rotor * 400.0 * (slope**2 + ratio * bend)  # of the rotor's torque at 20 rad/s, N m/rad
    rise = -fall * LOSSY.gear_ratio
    loads = (CrankTorqueTable(angles=(1.0, 2.0), forces=(0.5 * rise, -0.5 * rise)), CrankTorque())
    torque = Varying(name="torque", sets=(("loads.1.torque", 1.0),), lower=-0.1, upper=0.1)
    machine = Mechanism(
        speed=20.0,
        crank=nothing,
        rod=nothing,
        loads=loads,
        speed_profile=profile,
        drive=replace(LOSSY, flywheel=0.0),
        varying=(torque,),
    )
    pieces = QUANTITIES["motor_peak_torque"].pieces(machine, np.hstack([DESIGN, [[0.0]]]))
    (place,) = np.flatnonzero(np.abs(pieces.labels[0] - angle) < 1e-9)
    assert fall < 0.0
    assert pieces.values[0, place] == pytest.approx(-rotor * 400.0 * ratio * slope, rel=1e-12)
    assert pieces.gradients[0, place, 3] == pytest.approx(-fall / rise, rel=1e-9)  # M > 0 drives: the zero comes later


SMALL: dict[str, Any] = {
    "name": "Small",
    "mechanism": {"speed": "300 rpm", "slider": {"mass": "2 kg"}},
    "variables": {"crank": "40 mm", "rod": ["100 mm", "200 mm"], "offset": 0},
    "objectives": {"motor_peak_torque": "minimise"},
}


@pytest.mark.parametrize(
    ("drive", "words"),
    [
        (None, ["motor_peak_torque", "it needs [drive]; got none; for example, add [drive] gear_ratio = 5"]),
        ({"gear_ratio": 0}, ["drive.gear_ratio", "positive"]),
        ({"gear_efficiency": 1.1}, ["drive.gear_efficiency", "at most 1; got 1.1"]),
        ({"gear_efficiency": 0}, ["drive.gear_efficiency", "positive"]),
        ({"braking_efficiency": 94}, ["drive.braking_efficiency", "write 90 % as 0.9"]),
        ({"recovery": 1.5}, ["drive.recovery", "at most 1; got 1.5"]),
        ({"copper_loss": "90 W"}, ["drive", "got no rated_torque"]),
        ({"greatest_torque": "0 N m"}, ["drive.greatest_torque", "positive"]),
    ],
)
def test_a_bad_drive_train_is_refused_in_one_sentence(drive: dict[str, Any] | None, words: list[str]) -> None:
    with pytest.raises(JobError) as caught:
        parse_job(SMALL | ({} if drive is None else {"drive": drive}))
    message = str(caught.value)
    assert all(word in message for word in words), message
    assert len(message.splitlines()) == 1


def test_a_machine_does_not_run_under_a_drive_without_torque_or_with_losses() -> None:
    machine = Mechanism(speed=10.0, crank=RigidLink(mass=1.0), slider_mass=2.0)
    for drive, words in ((Drive(gear_ratio=5.0), "needs a motor torque"), (LOSSY_MOTOR, "gear without losses")):
        with pytest.raises(InputError, match=words):
            simulate(machine, Linkage(crank=0.05, rod=0.2, offset=0.02), drive, duration=1.0)
