"""Loads that change over a tiny distance, where rounding of a position changes the load considerably."""

from __future__ import annotations

import math
import time
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.optimize import brentq

from slidercrank.model.cycle.cycle import cycle_energies
from slidercrank.model.cycle.multi_cylinder import multi_cylinder_cycle
from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.arrangement import Arrangement
from slidercrank.model.machine.links_and_joints import Friction, Pin
from slidercrank.model.machine.loads.position_table import PositionTable
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.signals.averages import torque_averages
from slidercrank.model.transient import steady_cycle
from slidercrank.model.transient.flywheel import design_flywheel
from slidercrank.model.transient.speed_profile_cycle import speed_profile_cycle
from slidercrank.model.transient.steady_running import Runner
from tests.model.cases import Array

CRANK, ROD, SPEED = 0.06, 0.3, 24.0 * math.pi / 30.0
FORCE, RISE, END = -660e3, 0.02, 0.020002  # N at RISE from the outer dead centre, m; none from END on
WORK = -0.5 * FORCE * END
PRESS = Mechanism(
    speed=SPEED,
    loads=(
        PositionTable(
            positions=(0.0, RISE, END), forces=(0.0, FORCE, 0.0), datum="outer dead centre", during="outward stroke"
        ),
    ),
)
LINKAGE, DESIGN = Linkage(CRANK, ROD, 0.0), np.array([[CRANK, ROD, 0.0]])


def _position(theta: Array) -> Array:
    return np.asarray(CRANK * np.cos(theta) + np.sqrt(ROD**2 - (CRANK * np.sin(theta)) ** 2))


def _angle(from_outer: float) -> float:
    """Return the crank angle of the outward stroke, from pi to 2 pi, by the law of cosines."""
    x = CRANK + ROD - from_outer
    return 2.0 * math.pi - math.acos((CRANK**2 + x**2 - ROD**2) / (2.0 * CRANK * x))


def _fluctuation(flywheel: float, slider: float) -> float:
    """Return the fluctuation under the constant torque that keeps the mean speed, from energies alone."""
    ends = [0.0, math.pi, _angle(END), _angle(RISE), 2.0 * math.pi]
    theta = np.unique(np.concatenate([np.linspace(a, b, 20_001) for a, b in pairwise(ends)]))
    along = -CRANK * np.sin(theta) * (1.0 + CRANK * np.cos(theta) / np.sqrt(ROD**2 - (CRANK * np.sin(theta)) ** 2))
    inertia = flywheel + slider * along**2
    away = CRANK + ROD - _position(theta)
    rising = 0.5 * FORCE * (away**2 / RISE)  # the integral of the force from the dead centre, inward
    falling = 0.5 * FORCE * (END - (END - away).clip(0.0) ** 2 / (END - RISE))
    taken = np.where(theta < math.pi, 0.0, -0.5 * FORCE * END + np.where(away <= RISE, rising, falling))
    gained = WORK * theta / (2.0 * math.pi) - taken
    gained -= gained.min()

    def speeds(least: float) -> Array:
        return np.asarray(np.sqrt(2.0 * (least + gained) / inertia))

    def late(least: float) -> float:
        return float(np.trapezoid(1.0 / speeds(least), theta)) * SPEED / (2.0 * math.pi) - 1.0

    found = speeds(float(brentq(late, 1e-6, 1e6, xtol=1e-12)))
    return float(np.ptp(found)) / SPEED


@pytest.mark.parametrize("slider", [50.0, 0.0])
def test_the_flywheel_of_a_press_is_that_of_its_energies_on_few_panels(
    slider: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(steady_cycle, "_MOST", 100)
    found = design_flywheel(replace(PRESS, slider_mass=slider), LINKAGE, 0.4)
    assert found.running.fluctuation == pytest.approx(0.4, rel=1e-9)
    # The trapezoidal rule on 80,000 stretches is good to a millionth.
    assert _fluctuation(found.inertia, slider) == pytest.approx(0.4, rel=1e-6)
    assert found.running.work == pytest.approx(WORK, rel=1e-9)


def test_without_any_inertia_there_are_no_speeds_and_it_is_said_why() -> None:
    for slider in (0.0, 50.0):  # that stands still at the dead centres
        with pytest.raises(InputError, match="the crank needs inertia at every angle"):
            Runner(replace(PRESS, slider_mass=slider), LINKAGE).least_and_greatest_speed(0.0)


def test_more_panels_than_a_bound_end_in_a_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(steady_cycle, "_MOST", 0)
    with pytest.raises(InputError, match=r"that 4\d panels do not resolve, for example at a crank angle of"):
        Runner(replace(PRESS, slider_mass=50.0), LINKAGE).run_under_constant_torque(700.0)


def test_means_and_energies_with_friction_do_not_halve_panels_without_end() -> None:
    machine = replace(
        PRESS, slider_mass=50.0, friction=Friction(guide=0.1, crank_pin=Pin(radius=0.02, coefficient=0.05))
    )
    before = time.process_time()
    found = cycle_energies(machine, LINKAGE)
    mean = torque_averages(machine, DESIGN, gradients=True)
    several = multi_cylinder_cycle(replace(machine, arrangement=Arrangement(phases=(0.0, math.pi))), LINKAGE)
    uneven = speed_profile_cycle(machine, LINKAGE)
    # They take a quarter of a second; halving panels down to rounding takes minutes or never ends.
    assert time.process_time() - before < 10.0
    assert found.useful == pytest.approx(WORK, rel=1e-9)
    assert found.input == pytest.approx(found.useful + found.heat, rel=1e-9)
    assert 2.0 * math.pi * mean.mean[0] == pytest.approx(found.input, rel=1e-9)
    assert uneven.work == pytest.approx(found.input, rel=1e-9)
    assert 2.0 * math.pi * several.mean == pytest.approx(2.0 * found.input, rel=1e-9)
