"""Drag, the load that grows with the square of the slider speed: force, peaks, means, gradients, running, job file."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from slidercrank.model.cycle.cycle import cycle
from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.drive import Drive, LinearMotor
from slidercrank.model.machine.links_and_joints import RigidLink
from slidercrank.model.machine.loads.drag import Drag
from slidercrank.model.machine.loads.spring import Spring
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.machine.varying_numbers import Varying
from slidercrank.model.signals.averages import torque_averages
from slidercrank.model.signals.peaks import find_peaks
from slidercrank.model.signals.signals import Signal
from slidercrank.model.transient.steady_running import Runner
from slidercrank.optimise.job import parse_job
from tests.model.virtual_work import drive_torque

LINKAGE = Linkage(0.05, 0.2, 0.03)
DESIGNS = np.array([[0.05, 0.2, 0.03], [0.08, 0.25, -0.1], [0.1, 0.101, 0.0], [0.06, 0.19, 0.128]])
BARE = Mechanism(speed=20.0, loads=(Drag(drag=35.0),))
HEAVY = Mechanism(
    speed=-12.0,
    slider_mass=1.5,
    rod=RigidLink(mass=0.4),
    gravity=(-9.81, 0.0),
    loads=(Drag(drag=60.0), Spring(stiffness=300.0, free_position=0.1)),
)
DENSE = np.linspace(0.0, 2.0 * math.pi, 200_001)


def dissipated(design: NDArray[np.float64], drag: float, speed: float) -> float:
    """Return the work of a turn against drag, J: the integral of drag w^2 |x'|^3, by the midpoint rule."""
    theta = (np.arange(400_000) + 0.5) * (2.0 * math.pi / 400_000)
    slope = Linkage(*design).at(theta, speed=1.0).slider_velocity
    return float(drag * speed**2 * np.mean(np.abs(slope) ** 3) * 2.0 * math.pi)


@pytest.mark.parametrize("speed", [8.0, -8.0])
def test_drag_opposes_the_motion_with_the_square_of_the_speed(speed: float) -> None:
    angles = np.linspace(0.0, 2.0 * math.pi, 91)
    velocity = LINKAGE.at(angles, speed=speed).slider_velocity
    load = cycle(replace(BARE, speed=speed), LINKAGE, angles).load
    assert np.abs(load + 35.0 * velocity * np.abs(velocity)).max() <= 1e-13 * np.abs(load).max()


@pytest.mark.parametrize("machine", [BARE, HEAVY, replace(HEAVY, branch="crossed", acceleration=30.0)])
@pytest.mark.parametrize("signal", [Signal.TORQUE, Signal.GUIDE_FORCE])
def test_peaks_with_drag_are_those_of_a_dense_sweep(machine: Mechanism, signal: Signal) -> None:
    """200,000 angles miss a peak by f'' h^2 / 8, some 1e-9 of it near locking."""
    found = find_peaks(machine, signal, DESIGNS[[0, 1, 3]]).values[:, 0]
    for value, design in zip(found, DESIGNS[[0, 1, 3]], strict=True):
        curve = cycle(machine, Linkage(design[0], design[1], design[2], machine.branch), DENSE)
        swept = np.abs(curve.torque if signal == Signal.TORQUE else curve.guide).max()
        assert swept * (1.0 - 1e-13) <= value <= swept * (1.0 + 1e-7)


def test_the_torque_is_that_of_virtual_work() -> None:
    for design in DESIGNS[[0, 1, 3]]:
        wanted = drive_torque(HEAVY, design, DENSE[::1000])
        got = cycle(HEAVY, Linkage(*design), DENSE[::1000]).torque
        assert np.abs(got - wanted).max() <= 1e-11 * np.abs(wanted).max()


def test_the_mean_torque_is_what_drag_dissipates() -> None:
    found = torque_averages(BARE, DESIGNS).mean
    for value, design in zip(found, DESIGNS, strict=True):
        assert value * 2.0 * math.pi == pytest.approx(dissipated(design, 35.0, 20.0), rel=1e-9)


def test_gradients_of_a_peak_by_dimensions_and_by_the_drag_itself_are_those_of_differences() -> None:
    varying = Varying(name="drag", lower=10.0, upper=90.0, sets=(("loads.0.drag", 1.0),))
    machine = replace(HEAVY, varying=(varying,))
    designs = np.column_stack([DESIGNS[[0, 1, 3]], [20.0, 50.0, 80.0]])
    found = find_peaks(machine, Signal.TORQUE, designs, gradients=True).gradients
    assert found is not None
    slopes = found[:, 0]
    for column, step in enumerate((1e-7, 1e-7, 1e-7, 1e-3)):
        ends = [
            find_peaks(machine, Signal.TORQUE, designs + sign * step * np.eye(4)[column]).values[:, 0]
            for sign in (1.0, -1.0)
        ]
        assert np.abs((ends[0] - ends[1]) / (2.0 * step) - slopes[:, column]).max() <= 1e-6 * np.abs(slopes).max()


def test_a_motor_settles_where_it_gives_what_drag_takes() -> None:
    machine = Mechanism(speed=20.0, slider_mass=0.2, loads=(Drag(drag=35.0),))
    motor = LinearMotor(stall_torque=4.0, no_load_speed=40.0)
    speed = Runner(machine, LINKAGE).balanced_speed(Drive(motor=motor))
    wanted = dissipated(np.array([0.05, 0.2, 0.03]), 35.0, speed) / (2.0 * math.pi)
    assert float(motor.torque_at(speed)) == pytest.approx(wanted, rel=1e-8)


def test_drag_of_a_job_file_is_in_si_and_must_be_positive() -> None:
    job = {
        "name": "pump",
        "mechanism": {"speed": "300 rpm"},
        "load": [{"drag": "20 N s^2/m^2"}],
        "variables": {"crank": "50 mm", "rod": ["100 mm", "300 mm"], "offset": "0 mm"},
        "objectives": {"peak_torque": "minimise"},
    }
    assert parse_job(job).mechanism.loads == (Drag(drag=20.0),)
    with pytest.raises(InputError, match=r"drag.*positive"):
        parse_job({**job, "load": [{"drag": "-20 N s^2/m^2"}]})
    with pytest.raises(InputError, match=r"drag.*20 N s\^2/m\^2"):
        parse_job({**job, "load": [{"drag": "20 N s/m"}]})
