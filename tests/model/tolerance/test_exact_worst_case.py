"""The exact worst case against brute force, and against the first order within its remainder."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np
import pytest
from scipy.optimize import minimize

from slidercrank.model.errors import AssemblyError, InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.mechanism import Branch, Clearances, Mechanism, Tolerance, Tolerances, Window
from slidercrank.model.signals.peaks import find_peaks
from slidercrank.model.signals.signals import Signal
from slidercrank.model.tolerance.error_distributions import angle_ranges_where_error_counts, limit_box
from slidercrank.model.tolerance.exact_worst_case import (
    first_order_position_errors,
    position_deviation_extremes,
    worst_position_error,
)
from tests.model.cases import Array
from tests.model.tolerance.machines import PUBLISHED, SUPPORT, random_cases

CASES = random_cases(6, seed=71)
WIDE = random_cases(6, seed=72, coarse=3.0)
SPECIAL = np.array([0.0, 0.5, 1.0, 1.5]) * math.pi
TURN = np.concatenate([np.linspace(0.0, 2.0 * math.pi, 17)[:-1] + 0.1, SPECIAL])


def deviation(point: Any, linkage: Linkage, angle: float) -> Any:
    """Return how far points (..., 4) of crank, rod, offset and deviation of the angle move the slider."""
    r, l, e, turn = np.moveaxis(point, -1, 0)
    theta = angle + turn
    x = r * np.cos(theta) + linkage.sign * np.sqrt(l * l - (e - r * np.sin(theta)) ** 2)
    return x - linkage.at(angle).slider_position


def searched(mechanism: Mechanism, linkage: Linkage, angle: float, sign: float) -> float:
    """Return the greatest deviation (sign 1) or the least (-1): a grid with all corners, then L-BFGS-B from its best.

    The box is scaled to -1 .. 1. A start within the box finds the maximum in the crank angle that corners miss.
    """
    box = limit_box(mechanism, linkage)
    middle, half = box.mean(axis=1), 0.5 * (box[:, 1] - box[:, 0])
    steps = np.linspace(-1.0, 1.0, 7)
    grid = np.stack(np.meshgrid(steps, [-1.0, 1.0], steps, np.linspace(-1.0, 1.0, 15)), axis=-1).reshape(-1, 4)
    values = sign * deviation(middle + half * grid, linkage, angle)
    size = float(np.abs(values).max())
    best = float(values.max())

    def loss(u: Array) -> tuple[float, Array]:
        """Return the value, and its gradient by complex steps."""
        moved = -sign * deviation(middle + half * (u + 1e-30j * np.eye(4)), linkage, angle) / size
        return float(moved[0].real), moved.imag / 1e-30

    for start in grid[np.argsort(values)[-2:]]:
        options: Any = {"ftol": 1e-15, "gtol": 1e-9}
        bounds = [(-1.0, 1.0)] * 4
        found = minimize(loss, 0.98 * start, jac=True, bounds=bounds, method="L-BFGS-B", options=options)
        best = max(best, -float(found.fun) * size)
    return sign * best


@pytest.mark.parametrize("cases", [CASES, WIDE], ids=["usual", "wide"])
def test_extremes_are_those_of_a_search_through_the_box(cases: list[tuple[Mechanism, Linkage]]) -> None:
    random = np.random.default_rng(73)
    for mechanism, linkage in cases:
        inner, outer = linkage.dead_centre_angles
        angles = np.array([random.uniform(0.0, 7.0), inner + 0.03, outer - 0.02, random.choice(SPECIAL)])
        found = position_deviation_extremes(mechanism, linkage, angles)
        for n, angle in enumerate(angles):
            expected = [searched(mechanism, linkage, angle, sign) for sign in (-1.0, 1.0)]
            size = max(np.abs(expected))
            # L-BFGS-B finds a smooth extremum to the square of 1e-5 or so of the box.
            assert found.least[n] == pytest.approx(expected[0], rel=0.0, abs=1e-8 * size)
            assert found.greatest[n] == pytest.approx(expected[1], rel=0.0, abs=1e-8 * size)


def test_no_machine_within_the_limits_is_beyond_the_extremes() -> None:
    random = np.random.default_rng(74)
    for mechanism, linkage in WIDE:
        box = limit_box(mechanism, linkage)
        found = position_deviation_extremes(mechanism, linkage, TURN)
        for n, angle in enumerate(TURN):
            points = random.uniform(box[:, 0], box[:, 1], (500, 4))
            moved = deviation(points, linkage, angle)
            slack = 1e-14
            assert moved.max() <= found.greatest[n] + slack
            assert moved.min() >= found.least[n] - slack


def test_extremes_within_the_box_are_beyond_its_corners() -> None:
    """Offset where the rod lies along the line; crank angle at a dead centre. Crank where it is normal to the rod."""
    for linkage, tolerances, angle, within in (
        (Linkage(0.05, 0.2, 0.0), Tolerances(offset=Tolerance(absolute=0.01)), 0.0, 0.0),
        (Linkage(0.05, 0.2, 0.0), Tolerances(crank_angle=Tolerance(absolute=0.1)), 0.0, 0.0),
        (Linkage(0.05, 0.2, 0.05), Tolerances(crank=Tolerance(absolute=0.01)), 0.5 * math.pi, 0.0),
    ):
        found = position_deviation_extremes(Mechanism(tolerances=tolerances), linkage, angle)
        assert found.greatest[0] == pytest.approx(within, abs=1e-16)
        assert found.least[0] < -1e-5


def test_crossed_branch_is_the_mirror_image() -> None:
    for mechanism, linkage in CASES[:10]:
        other: Branch = "open" if linkage.branch == "crossed" else "crossed"
        mirrored, image = dataclasses.replace(mechanism, branch=other), dataclasses.replace(linkage, branch=other)
        one, two = (
            position_deviation_extremes(mechanism, linkage, TURN),
            position_deviation_extremes(mirrored, image, math.pi - TURN),
        )
        np.testing.assert_allclose(one.least, -two.greatest, rtol=1e-9, atol=1e-15)
        np.testing.assert_allclose(one.greatest, -two.least, rtol=1e-9, atol=1e-15)


@pytest.mark.parametrize("cases", [[(PUBLISHED, SUPPORT)], CASES], ids=["case 4", "random"])
def test_exact_worst_case_is_the_first_order_within_its_remainder(cases: list[tuple[Mechanism, Linkage]]) -> None:
    for mechanism, linkage in cases:
        one, exact = (
            first_order_position_errors(mechanism, linkage, TURN),
            position_deviation_extremes(mechanism, linkage, TURN),
        )
        for size in (exact.greatest, -exact.least):
            assert np.all(np.abs(size - one.worst_case) <= one.remainder + 1e-15)


def test_exact_worst_case_tends_to_the_first_order_as_the_square_of_the_tolerances() -> None:
    for mechanism, linkage in CASES[:10]:
        gaps = []
        for part in (1e-2, 1e-3):
            t = mechanism.tolerances
            small = Tolerances(
                crank=Tolerance(absolute=part * t.crank.absolute),
                rod=Tolerance(absolute=part * t.rod.absolute),
                crank_angle=Tolerance(absolute=part * t.crank_angle.absolute),
                clearances=Clearances(guide=part * t.clearances.guide, crank_pin=part * t.clearances.crank_pin),
            )
            machine = dataclasses.replace(mechanism, tolerances=small)
            exact = (
                position_deviation_extremes(machine, linkage, TURN).largest_magnitude
                - first_order_position_errors(machine, linkage, TURN).worst_case
            )
            gaps.append(np.abs(exact).max())
        assert gaps[1] == pytest.approx(1e-2 * gaps[0], rel=0.05)


@pytest.mark.parametrize("during", ["cycle", "outward stroke", "inward stroke"])
@pytest.mark.parametrize("part", [(0.0, 1.0), (0.2, 0.7), (0.0, 0.4)])
@pytest.mark.parametrize("speed", [1.0, -1.0])
def test_worst_over_the_cycle_is_the_greatest_of_a_dense_sweep_of_the_window(
    during: str, part: tuple[float, float], speed: float
) -> None:
    for mechanism, linkage in CASES[:2]:
        window = Window(during=during, start=part[0], end=part[1])  # type: ignore[arg-type]
        machine = dataclasses.replace(
            mechanism, speed=speed, tolerances=dataclasses.replace(mechanism.tolerances, window=window)
        )
        theta = np.linspace(0.0, 2.0 * math.pi, 5001)
        at = linkage.at(theta, speed=speed)
        low, high = np.abs(linkage.dead_centres)
        share = (np.abs(at.slider_position) - low) / (high - low)
        counts = (share >= part[0]) & (share <= part[1])
        if during != "cycle":
            counts &= (linkage.sign * at.slider_velocity > 0.0) == (during == "outward stroke")
        dense = position_deviation_extremes(machine, linkage, theta[counts]).largest_magnitude.max()
        found = worst_position_error(machine, linkage)
        # The sweep misses a smooth top by the square of its spacing, an end of the window by its slope.
        assert found.size >= dense * (1.0 - 1e-12)
        assert found.size == pytest.approx(dense, rel=2e-3)
        assert position_deviation_extremes(machine, linkage, found.crank_angle).largest_magnitude[0] == pytest.approx(
            found.size, rel=1e-12
        )


def test_worst_over_the_whole_cycle_is_exact() -> None:
    for mechanism, linkage in [(PUBLISHED, SUPPORT), *CASES[:6]]:
        found = worst_position_error(mechanism, linkage)
        near = found.crank_angle + np.linspace(-1e-3, 1e-3, 2001)
        assert position_deviation_extremes(mechanism, linkage, near).largest_magnitude.max() <= found.size * (
            1.0 + 1e-12
        )
        everywhere = np.concatenate(angle_ranges_where_error_counts(mechanism, linkage, count=4096))
        assert position_deviation_extremes(mechanism, linkage, everywhere).largest_magnitude.max() <= found.size * (
            1.0 + 1e-12
        )


def test_worst_case_of_case_four_is_just_beyond_its_first_order() -> None:
    first = find_peaks(PUBLISHED, Signal.POSITION_ERROR, np.array([[1.4, 1.8, -0.05]]), limit=1)
    exact = worst_position_error(PUBLISHED, SUPPORT)
    remainder = first_order_position_errors(PUBLISHED, SUPPORT, first.angles[0]).remainder[0]
    assert first.values[0, 0] < exact.size < first.values[0, 0] + remainder


def test_linkages_within_the_limits_must_turn() -> None:
    close = Linkage(0.04, 0.0601, 0.02)
    mechanism = Mechanism(tolerances=Tolerances(rod=Tolerance(absolute=6e-5), crank=Tolerance(absolute=6e-5)))
    with pytest.raises(AssemblyError, match=r"got at worst rod 60\.04 mm, crank .* tighten the tolerances"):
        position_deviation_extremes(mechanism, close, 0.0)
    with pytest.raises(InputError, match="below 180 deg"):
        position_deviation_extremes(Mechanism(tolerances=Tolerances(crank_angle=Tolerance(absolute=4.0))), SUPPORT, 0.0)
    with pytest.raises(InputError, match=r"one linkage is possible at a time; got an array of shape \(2,\)"):
        position_deviation_extremes(PUBLISHED, Linkage([1.4, 1.5], 1.8), 0.0)
