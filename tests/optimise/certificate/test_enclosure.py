"""Enclosures hold every sample of the box, to rounding, and their excess shrinks with its square."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from slidercrank.model.arrays import Array
from slidercrank.model.cycle.cycle import cycle
from slidercrank.model.kernel.arithmetic import magnitude, root
from slidercrank.model.kinematics import geometry
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.loads.angle_table import AngleTable
from slidercrank.model.machine.loads.position_table import PositionTable
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.signals.peaks import find_peaks
from slidercrank.model.signals.signals import Signal
from slidercrank.optimise.certificate.enclosed_cycle_curve import CycleCurve
from slidercrank.optimise.certificate.enclosed_machine import interpolate_force
from slidercrank.optimise.certificate.enclosure import Enclosure, free_unknown

FORMULAS: dict[str, Callable[[Any, Any, Any], Any]] = {
    "sum": lambda x, y, z: 3.0 - (x + y) * 2.0 + z / 7.0 - x,
    "product": lambda x, y, z: x * y * z * (x - y),
    "square": lambda x, y, z: (x - y) * (x - y) + z * z,
    "quotient": lambda x, y, z: (x - 1.5) / (y + z) + 2.0 / y,
    "root": lambda x, y, z: root(x * x + y) - root(z),
    "arcsine": lambda x, y, z: np.arcsin((x - y) / (2.0 + z)),
    "magnitude": lambda x, y, z: magnitude(x - y) * z - magnitude(z),
    "array on the left": lambda x, y, z: np.float64(2.0) * x - np.array([[1.0]]) * y + np.array([[3.0]]) / z,
    "stroke": lambda x, y, z: geometry.stroke(x, 3.0 + y, 0.3 * z),
    "time ratio": lambda x, y, z: geometry.time_ratio(x, 3.0 + y, 0.3 * z),
    "transmission angle": lambda x, y, z: geometry.least_transmission_angle(x, 3.0 + y, 0.3 * z),
}


def boxes(width: float, seed: int = 3, count: int = 200) -> tuple[Array, Array]:
    """Return random boxes (n, 3) between 0.5 and 2."""
    low = 0.5 + 1.5 * np.random.default_rng(seed).random((count, 3))
    return low, low + width


def enclose(formula: Callable[[Any, Any, Any], Any], low: Array, high: Array) -> Enclosure:
    with np.errstate(all="ignore"):
        found = formula(*(free_unknown(low[:, i], high[:, i], i, 3) for i in range(3)))
    assert isinstance(found, Enclosure)
    return found


@pytest.mark.parametrize("width", [1e-6, 1e-2, 0.3, 1.5])
@pytest.mark.parametrize("name", FORMULAS)
def test_every_sample_lies_within_its_enclosure(name: str, width: float) -> None:
    low, high = boxes(width)
    least, most = enclose(FORMULAS[name], low, high).least_and_greatest()
    share = np.random.default_rng(4).random((100, 3))
    share[:8] = np.array(np.meshgrid(*[[0.0, 1.0]] * 3)).reshape(3, -1).T
    for part in share:
        x = low + (high - low) * part
        with np.errstate(invalid="ignore"):
            value = FORMULAS[name](*(x[:, i : i + 1] for i in range(3)))
        outside = (value < least) | (value > most)
        assert not outside.any()
    assert np.isfinite(least).mean() > (0.99 if width < 0.1 else -1.0)


@pytest.mark.parametrize("name", FORMULAS)
def test_the_linear_part_is_right_to_second_order(name: str) -> None:
    """Ten times the width, a hundred times the rest. Where a magnitude has its kink the rest is of first order."""
    rests = []
    for width in (1e-4, 1e-3):
        low, high = boxes(width)
        rests.append(np.median(enclose(FORMULAS[name], low, high).rest))
    assert rests[1] <= 130.0 * rests[0] + 1e-14


def test_a_root_that_is_negative_in_all_of_the_box_is_said_to_be_empty() -> None:
    low, high = boxes(0.1)
    found = enclose(lambda x, y, z: root(x * y - 10.0), low, high)
    assert found.empty is not None
    assert found.empty.all()
    assert enclose(lambda x, y, z: root(x * y), low, high).empty is None


def test_a_root_that_is_negative_in_a_part_of_the_box_bounds_the_rest_of_it() -> None:
    low, high = boxes(0.5)
    least, most = enclose(lambda x, y, z: root(x - y), low, high).least_and_greatest()
    for part in np.random.default_rng(4).random((100, 3)):
        x = low + (high - low) * part
        with np.errstate(invalid="ignore"):
            value = np.sqrt(x[:, :1] - x[:, 1:2])
        assert not ((value < least) | (value > most)).any()


def test_a_division_by_what_may_be_zero_says_nothing() -> None:
    low, high = boxes(0.5)
    found = enclose(lambda x, y, z: 1.0 / (x - 0.5 * (low[:, :1] + high[:, :1])), low, high)
    least, most = found.least_and_greatest()
    assert np.isneginf(least).all()
    assert np.isposinf(most).all()


@pytest.mark.parametrize("width", [1e-3, 0.1, 1.0])
def test_a_table_over_an_enclosed_position_holds_every_sample(width: float) -> None:
    at, force = np.array([0.8, 1.0, 1.3, 1.3, 1.31, 2.0]), np.array([2.0, -1.0, 4.0, 6.0, 0.0, 0.5])
    low, high = boxes(width)
    least, most = interpolate_force(free_unknown(low[:, 0], high[:, 0], 0, 3), at, force).least_and_greatest()
    for part in np.linspace(0.0, 1.0, 200):
        value = np.interp(low[:, :1] + (high[:, :1] - low[:, :1]) * part, at, force)
        assert not ((value < least) | (value > most)).any()


@pytest.mark.parametrize("datum", ["zero crank angle", "outer dead centre"])
def test_the_torque_of_a_table_that_steps_at_its_seam_is_enclosed_for_every_design_of_a_box(datum: Any) -> None:
    """Just before, at and after the seam, where the force jumps from -200 N to 500 N."""
    table = AngleTable(angles=(0.4, 2.0, 0.4 + 2.0 * np.pi), forces=(500.0, -300.0, -200.0), datum=datum)
    machine = Mechanism(speed=20.0, slider_mass=0.5, loads=(table,))
    curve = CycleCurve(machine, Signal.TORQUE)
    random = np.random.default_rng(5)
    low = np.array([0.04, 0.15, 0.01]) * random.uniform(0.9, 1.1, (40, 3))
    high = low * 1.02
    angles = 0.4 + random.uniform(-0.4, 0.4, 40)
    sides = {k: free_unknown(low[:, k], high[:, k], k, 3) for k in range(3)}
    found = curve.enclose(sides, angles[:, None], 0.5 * (low + high))
    least, most = (end.reshape(40, -1) for end in found.least_and_greatest())
    for design, angle, lower, upper in zip(low, angles, least, most, strict=True):
        for share in random.random((20, 3)):
            r, l, e = design * (1.0 + 0.02 * share)
            torque = abs(float(cycle(machine, Linkage(r, l, e), [angle]).torque[0]))
            assert lower.min() <= torque <= upper.max()


def test_a_peak_on_a_step_is_bounded_the_better_the_smaller_the_box() -> None:
    """A shear load drops from 1 kN to zero: its peak is at this step, which depends on the design."""
    table = PositionTable(
        positions=(0.0, 0.02, 0.02), forces=(0.0, -1000.0, 0.0), datum="outer dead centre", during="outward stroke"
    )
    machine = Mechanism(speed=20.0, loads=(table,))
    middle = np.array([[0.05, 0.2, 0.01]])
    peak = find_peaks(machine, Signal.TORQUE, middle, limit=1)
    for width in (1e-3, 1e-4, 1e-5):
        low, high = middle * (1.0 - width), middle * (1.0 + width)
        sides = {k: free_unknown(low[:, k], high[:, k], k, 3) for k in range(3)}
        least = CycleCurve(machine, Signal.TORQUE).enclose(sides, peak.angles, middle).least_and_greatest()[0]
        assert least.max() <= peak.values[0, 0]
        assert least.max() >= peak.values[0, 0] * (1.0 - 100.0 * width)
