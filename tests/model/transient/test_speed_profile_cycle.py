"""A speed profile: energies of a turn, power at every angle, runs of the forward model replayed, refusals."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from slidercrank.model.cycle.crank_speed import crank_speed_and_acceleration
from slidercrank.model.cycle.cycle import cycle
from slidercrank.model.cycle.multi_cylinder import multi_cylinder_curves, multi_cylinder_cycle, shaking_curves
from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.arrangement import Arrangement
from slidercrank.model.machine.drive import Drive, LinearMotor
from slidercrank.model.machine.loads.viscous import Viscous
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.machine.speed_profile import Harmonics, SpeedTable
from slidercrank.model.signals.averages import torque_averages
from slidercrank.model.signals.peaks import find_peaks
from slidercrank.model.signals.signals import Signal
from slidercrank.model.transient.crank_equation import CrankEquation
from slidercrank.model.transient.speed_profile_cycle import speed_profile_curves, speed_profile_cycle
from slidercrank.model.transient.steady_running import steady_running
from tests.model.cases import SMOOTH, linkage_of, random_designs, random_friction, random_machine
from tests.model.test_cylinder import random_case as compressor_case

TURN = 2.0 * math.pi


def random_uneven(seed: int, *, friction: bool = False) -> tuple[Mechanism, Linkage]:
    """Return a machine with a random profile of harmonics or points, and a linkage."""
    random = np.random.default_rng(seed)
    machine = random_machine(random) if seed % 3 else compressor_case(seed)[0]
    if seed % 2:
        profile: Harmonics | SpeedTable = Harmonics(
            cosines=tuple(random.uniform(-0.1, 0.1, 3)), sines=tuple(random.uniform(-0.1, 0.1, 4))
        )
    else:
        angles = np.sort(random.uniform(0.0, TURN, 9)) + 0.2 * np.arange(9)
        profile = SpeedTable(angles=tuple(angles * 0.75), speeds=tuple(random.uniform(0.9, 1.1, 9)))
    machine = replace(machine, acceleration=0.0, speed_profile=profile, slider_mass=0.5)
    machine = replace(machine, friction=random_friction(random)) if friction else machine
    design = random_designs(1, seed=seed, least_margin=0.8 if friction else 0.05)[0]
    return machine, linkage_of(design, machine.branch)


@pytest.mark.parametrize("seed", range(12))
def test_over_a_turn_the_torque_does_the_work_of_the_loads(seed: int) -> None:
    """Kinetic energy comes back: of loads that do not depend on speed the mean torque is that at constant speed."""
    machine, linkage = random_uneven(seed)
    still = replace(machine, loads=tuple(load for load in machine.loads if not load.speed_power))
    design = np.array([[linkage.crank, linkage.rod, linkage.offset]])
    found, wanted = speed_profile_cycle(still, linkage), torque_averages(still, design).mean[0]
    assert found.mean_torque == pytest.approx(wanted, rel=1e-10, abs=1e-10 * found.rms_torque)
    assert found.mean_power == pytest.approx(still.direction * TURN * found.mean_torque / found.period, rel=1e-12)


@pytest.mark.parametrize("seed", range(12))
def test_power_in_is_energy_gained_and_work_done_at_every_angle(seed: int) -> None:
    """Slope of the bodies' energy J w^2 / 2 + V over the crank angle is T + F x'."""
    machine, linkage = random_uneven(seed)
    equation = CrankEquation(replace(machine, acceleration=0.0), linkage)
    theta = np.random.default_rng(seed).uniform(0.0, TURN, 40)

    def energy(angle: NDArray[np.float64]) -> NDArray[np.float64]:
        speed, _ = crank_speed_and_acceleration(machine, angle)
        return 0.5 * equation.moving_inertia(angle) * speed**2 + equation.gravity_energy(angle)

    h = 1e-4
    slope = (8.0 * (energy(theta + h) - energy(theta - h)) - energy(theta + 2 * h) + energy(theta - 2 * h)) / (12.0 * h)
    found = speed_profile_curves(machine, linkage, theta)
    rate = np.asarray(linkage.at(theta, speed=1.0).slider_velocity) * linkage.sign
    wanted = slope - found.curves.load * rate
    assert np.abs(found.curves.torque - wanted).max() <= 2e-8 * np.abs(wanted).max()


def test_viscous_work_is_its_integral() -> None:
    """Integral of c x'^2 w over the turn, by trapezia on a smooth periodic curve."""
    machine = Mechanism(
        speed=-20.0, slider_mass=1.0, loads=(Viscous(coefficient=30.0),), speed_profile=Harmonics(sines=(0.1, 0.2))
    )
    linkage = Linkage(0.05, 0.2, 0.03)
    theta = np.linspace(0.0, TURN, 400, endpoint=False)
    rate = np.asarray(linkage.at(theta, speed=1.0).slider_velocity)
    wanted = 30.0 * np.mean(rate**2 * np.abs(crank_speed_and_acceleration(machine, theta)[0])) * TURN
    found = speed_profile_cycle(machine, linkage)
    assert found.work == pytest.approx(wanted, rel=1e-12)
    # 1 / (20 (1 + 0.1 sin + 0.2 sin 2)) likewise.
    assert found.period == pytest.approx(
        np.mean(1.0 / np.abs(crank_speed_and_acceleration(machine, theta)[0])) * TURN, rel=1e-12
    )


@pytest.mark.parametrize("seed", range(6))
def test_peaks_stand_above_a_dense_sweep(seed: int) -> None:
    machine, linkage = random_uneven(seed, friction=seed % 2 == 0)
    found = speed_profile_cycle(machine, linkage)
    swept = speed_profile_curves(machine, linkage, np.linspace(0.0, TURN, 20_000))
    for name, values in swept.named_curves.items():
        size = np.abs(values).max()
        assert found.peaks[name].value >= size * (1.0 - 1e-9), name
        near = speed_profile_curves(machine, linkage, found.peaks[name].angle + np.array([-1e-9, 1e-9])).named_curves[
            name
        ]
        assert np.abs(np.abs(near) / found.peaks[name].value - 1.0).min() < 1e-5, name
    assert found.greatest_speed.value == pytest.approx(swept.speed.max(), rel=1e-6)


def test_without_a_profile_it_is_the_cycle() -> None:
    machine, design = replace(SMOOTH, acceleration=0.0), np.array([[0.05, 0.2, 0.03]])
    found = speed_profile_cycle(machine, Linkage(0.05, 0.2, 0.03))
    for name, kind in (("torque", Signal.TORQUE), ("shaking_force", Signal.SHAKING_FORCE), ("power", Signal.POWER)):
        assert found.peaks[name].value == pytest.approx(
            find_peaks(machine, kind, design, limit=1).values[0, 0], rel=1e-10
        )
    assert found.rms_torque == pytest.approx(torque_averages(machine, design).rms[0], rel=1e-12)
    theta = np.linspace(0.0, TURN, 50)
    same = speed_profile_curves(machine, Linkage(0.05, 0.2, 0.03), theta).curves.torque
    assert (same == cycle(machine, Linkage(0.05, 0.2, 0.03), theta).torque).all()


def test_steady_running_under_a_motor_is_replayed() -> None:
    """The torque at the found speeds, less that of the flywheel, is the motor's."""
    drive = Drive(motor=LinearMotor(stall_torque=400.0, no_load_speed=40.0), flywheel=0.05)
    machine = replace(SMOOTH, acceleration=0.0, drive=drive)
    linkage = Linkage(0.05, 0.2, 0.03)
    running = steady_running(machine, linkage)
    turned = running.crank_angle - running.crank_angle[0]
    kept = np.concatenate([[True], np.diff(turned) > 1e-4]) & (turned < TURN - 1e-4)
    angle = running.crank_angle[kept]
    profile = SpeedTable(angles=tuple(angle.tolist()), speeds=tuple(running.speed[kept].tolist()))
    again = replace(machine, speed=profile.mean_speed, speed_profile=profile)
    found = speed_profile_curves(again, linkage, angle)
    size = np.abs(running.torque).max()
    assert np.abs(found.curves.torque - running.torque[kept]).max() < 1e-5 * size
    assert (
        np.abs(found.curves.torque + drive.inertia * found.acceleration - running.motor_torque[kept]).max()
        < 1e-5 * size
    )
    numbers = speed_profile_cycle(again, linkage)
    assert numbers.fluctuation == pytest.approx(running.fluctuation, rel=1e-6)
    assert numbers.period == pytest.approx(running.period, rel=1e-8)
    assert numbers.work == pytest.approx(running.work, rel=1e-6)


def test_several_cylinders_share_the_speed_of_the_shaft() -> None:
    machine, linkage = random_uneven(1)
    arrangement = Arrangement(phases=(0.3, 2.0), banks=(0.0, 0.7))
    both = replace(machine, arrangement=arrangement)
    theta = np.linspace(0.1, 6.0, 20)
    speed, rise = crank_speed_and_acceleration(machine, theta)
    torque, moment = np.zeros(20), np.zeros(20)
    for k in range(2):
        c = np.exp(-1j * arrangement.bank_angle(k)) * complex(*machine.gravity)
        alone = replace(machine, gravity=(c.real, c.imag))
        at = theta + arrangement.lead_over_slider_line(k)
        torque += cycle(alone, linkage, at, speed=speed, acceleration=rise).torque
        moment += shaking_curves(alone, linkage, at, speed=speed, acceleration=rise).moment
    found = multi_cylinder_curves(both, linkage, theta)
    assert found.torque == pytest.approx(torque, rel=1e-12)
    assert found.moment == pytest.approx(moment, rel=1e-12)
    assert multi_cylinder_cycle(both, linkage).greatest.value >= torque.max()


def test_impossible_profiles_are_refused() -> None:
    four = (0.0, 1.0, 2.0, 3.0)
    for build, said in (
        (lambda: Harmonics(), "0 cosines and 0 sines"),
        (lambda: Harmonics(cosines=(1.2,)), r"got -20 % of the mean at 180 deg; reduce the harmonics"),
        (lambda: Harmonics(sines=(math.inf,)), "must be finite"),
        (lambda: SpeedTable(angles=(0.0, 3.0), speeds=(1.0, 2.0)), "at least 4; got 2 crank angles and 2 speeds"),
        (lambda: SpeedTable(angles=four, speeds=(1.0, -2.0, 1.0, 1.0)), "got -19.0986 rpm at 57.2958 deg"),
        (lambda: SpeedTable(angles=four, speeds=(1.0, 0.0, 1.0, 1.0)), "got 0 rpm"),
        (lambda: SpeedTable(angles=four, speeds=(9.0, 0.1, 9.0, 0.1)), "% of the mean at .* add points"),
        (
            lambda: SpeedTable(angles=(0.0, 1.0, 2.0, TURN), speeds=(1.0, 2.0, 2.0, 1.5)),
            "differs from it by 4.77465 rpm",
        ),
        (lambda: SpeedTable(angles=(0.0, 1.0, 2.0, TURN), speeds=(1.0, 2.0, 2.0, 1.0)), "which repeats the first"),
        (lambda: SpeedTable(angles=(0.0, 2.0, 1.0, 3.0), speeds=four), "got 57.2958 deg after 114.592 deg"),
        (lambda: Mechanism(speed=1.0, acceleration=2.0, speed_profile=Harmonics(cosines=(0.1,))), "leave out one"),
    ):
        with pytest.raises(InputError, match=said):
            build()


@pytest.mark.parametrize("speed", [31.0, -300.0, 1e-3])
def test_a_table_of_one_speed_is_a_constant_one(speed: float) -> None:
    profile = SpeedTable(angles=(0.0, 1.0, 2.5, 4.0, 5.0), speeds=(speed,) * 5)
    theta = np.linspace(0.0, TURN, 50)
    np.testing.assert_allclose(profile.speed_ratio(theta), 1.0, rtol=1e-14)
    np.testing.assert_allclose(profile.speed_ratio_slope(theta), 0.0, atol=1e-14)
