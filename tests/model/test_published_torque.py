"""Obaseki and Alfred, Modeling and Investigating the Effect of Offset Distance on Slider-Crank Mechanism: torque.

Crank 40, rod 64 mm, 251 rad/s; the paper lumps both links half and half, 1.05 kg move with the slider. It prints peaks
of 80, 120 and 250 N m for offsets of 0, 10 and 20 mm from a formula that drops the time derivative of inertia; the
exact peaks of that very mechanism are 105.1, 133.7 and 316.1 N m.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from slidercrank.model.machine.links_and_joints import RigidLink
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.signals.fast_torque_and_error import screened_maxima
from slidercrank.model.signals.peaks import find_peaks
from slidercrank.model.signals.signals import Signal
from tests.model.virtual_work import path

RECIPROCATING = Mechanism(speed=251.0, slider_mass=1.05)


def peak_in_extended_precision(offset_mm: int) -> float:
    """Return the greatest |m w^2 x' x''| over the cycle in 80-bit numbers, by nested sweeps."""
    design = np.array([40, 64, offset_mm], dtype=np.longdouble) / 1000
    factor = np.longdouble("1.05") * np.longdouble(251) ** 2
    at, half = np.longdouble(math.pi), np.longdouble(math.pi)
    for _ in range(12):
        theta = at + half * np.linspace(-1, 1, 20_001, dtype=np.longdouble)
        motion = path(design, theta, 1.0)
        torque = np.abs(factor * motion.x_1 * motion.x_2)
        at, half = theta[np.argmax(torque)], half / 100
    return float(torque.max())


@pytest.mark.parametrize(("offset_mm", "figure"), [(0, 105.1), (10, 133.7), (20, 316.1)])
def test_peak_inertia_torque_is_exact(offset_mm: int, figure: float) -> None:
    designs = np.array([[0.040, 0.064, -1e-3 * offset_mm]])
    exact = peak_in_extended_precision(offset_mm)
    assert exact == pytest.approx(figure, rel=0.0, abs=0.05)
    for peak in (
        find_peaks(RECIPROCATING, Signal.TORQUE, designs).values[0, 0],
        screened_maxima(RECIPROCATING, (Signal.TORQUE,), designs)[0].values[0],
    ):
        # A torque of 1e2 N m is the sum of some ten products, each rounded: 1e-15 of it.
        assert peak == pytest.approx(exact, rel=1e-13)


def test_rotating_masses_at_the_crank_pin_need_no_torque_at_constant_speed() -> None:
    designs = np.array([[0.040, 0.064, -0.020]])
    heavier = Mechanism(speed=251.0, slider_mass=1.05, crank=RigidLink(mass=0.35, centre=0.040, inertia=1e-3))
    a = find_peaks(RECIPROCATING, Signal.TORQUE, designs).values[0, 0]
    b = find_peaks(heavier, Signal.TORQUE, designs).values[0, 0]
    assert a == pytest.approx(b, rel=1e-14)
