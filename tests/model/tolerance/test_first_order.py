"""Contributions of the sources to the first-order position error, and what clearances add."""

from __future__ import annotations

import dataclasses
import itertools
import math

import numpy as np
import pytest

from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.mechanism import Clearances, Mechanism, Tolerance, Tolerances
from slidercrank.model.signals.fast_torque_and_error import screened_maxima, supports_screening
from slidercrank.model.signals.peaks import find_peaks
from slidercrank.model.signals.signals import Signal
from slidercrank.model.tolerance.error_distributions import limits_of_sources
from slidercrank.model.tolerance.exact_worst_case import first_order_position_errors, higher_order_bound
from tests.model.cases import SMOOTH, random_designs
from tests.model.tolerance.machines import PUBLISHED, SUPPORT, random_cases

TURN = np.linspace(0.0, 2.0 * math.pi, 60)
CASES = [(PUBLISHED, SUPPORT), *random_cases(20, seed=81)]
GAPS = Clearances(crank_pivot=2e-5, crank_pin=3e-5, slider_pin=4e-5, guide=5e-5)


def with_gaps(mechanism: Mechanism, gaps: Clearances = GAPS) -> Mechanism:
    return dataclasses.replace(mechanism, tolerances=dataclasses.replace(mechanism.tolerances, clearances=gaps))


def test_contributions_add_up_to_the_worst_case_and_the_root_sum_square() -> None:
    for mechanism, linkage in CASES:
        found = first_order_position_errors(mechanism, linkage, TURN)
        np.testing.assert_allclose(found.contributions.sum(axis=0), found.worst_case, rtol=1e-13)
        np.testing.assert_allclose(np.hypot.reduce(found.contributions), found.root_sum_square, rtol=1e-13)


def test_shares_sum_to_one() -> None:
    for mechanism, linkage in CASES:
        found = first_order_position_errors(mechanism, linkage, TURN)
        np.testing.assert_allclose(found.share_of_worst_case.sum(axis=0), 1.0, rtol=1e-14)
        np.testing.assert_allclose(found.share_of_variance.sum(axis=0), 1.0, rtol=1e-14)


def test_shares_of_nothing_are_not_defined() -> None:
    found = first_order_position_errors(Mechanism(), SUPPORT, [0.3])
    assert np.all(found.worst_case == 0.0)
    assert np.all(np.isnan(found.share_of_variance))
    assert np.all(np.isnan(found.share_of_worst_case))


def test_clearance_of_a_pin_is_a_tolerance_of_the_rod_and_that_of_the_guide_one_of_the_offset() -> None:
    designs = random_designs(300, seed=82)
    plain = SMOOTH.tolerances
    pins = GAPS.crank_pivot + GAPS.crank_pin + GAPS.slider_pin
    as_rod = dataclasses.replace(
        plain,
        rod=Tolerance(absolute=plain.rod.absolute + pins, fraction=plain.rod.fraction),
        offset=Tolerance(absolute=plain.offset.absolute + GAPS.guide, fraction=plain.offset.fraction),
    )
    one = find_peaks(with_gaps(SMOOTH), Signal.POSITION_ERROR, designs, gradients=True)
    two = find_peaks(dataclasses.replace(SMOOTH, tolerances=as_rod), Signal.POSITION_ERROR, designs, gradients=True)
    assert one.gradients is not None
    assert two.gradients is not None
    np.testing.assert_allclose(one.values[:, 0], two.values[:, 0], rtol=1e-13)
    np.testing.assert_allclose(one.gradients[:, 0], two.gradients[:, 0], rtol=1e-9, atol=1e-12)


def test_pin_displaced_by_its_clearance_moves_the_slider_by_the_influence_of_the_rod() -> None:
    """Geometry of the two circles. The crank pin is off by u in every direction; the best lies along the rod."""
    c = 1e-6
    for mechanism, linkage in CASES:
        r, l, e, sign = linkage.crank, linkage.rod, linkage.offset, linkage.sign
        only = with_gaps(Mechanism(branch=mechanism.branch), Clearances(crank_pin=c))
        expected = first_order_position_errors(only, linkage, TURN).worst_case
        direction = np.linspace(0.0, 2.0 * math.pi, 5000)[:, None]
        a = r * np.cos(TURN) + c * np.cos(direction)
        b = r * np.sin(TURN) + c * np.sin(direction)
        moved = a + sign * np.sqrt(l * l - (e - b) ** 2) - linkage.at(TURN).slider_position
        # Second order, c / l, and the best of 5000 directions, 1e-6.
        np.testing.assert_allclose(moved.max(axis=0), expected, rtol=1e-3)


def test_root_sum_square_counts_each_clearance_by_itself() -> None:
    mechanism = with_gaps(Mechanism())
    i = SUPPORT.error_influences(TURN)
    squares = GAPS.crank_pivot**2 + GAPS.crank_pin**2 + GAPS.slider_pin**2
    expected = np.sqrt(i.rod**2 * squares + i.offset**2 * GAPS.guide**2)
    np.testing.assert_allclose(
        first_order_position_errors(mechanism, SUPPORT, TURN).root_sum_square, expected, rtol=1e-13
    )


@pytest.mark.parametrize("signal", [Signal.POSITION_ERROR, Signal.POSITION_ERROR_RSS])
def test_gradients_with_clearances_are_those_of_differences(signal: Signal) -> None:
    designs, machine = random_designs(100, seed=83, least_margin=0.1), with_gaps(SMOOTH)
    found = find_peaks(machine, signal, designs, gradients=True, limit=1)
    assert found.gradients is not None
    for v in range(3):
        step = np.zeros(3)
        step[v] = 1e-7
        up, down = (find_peaks(machine, signal, designs + s * step, limit=1).values[:, 0] for s in (1.0, -1.0))
        # Central differences: 1e-16 / 1e-7 of rounding and the square of 1e-7 over a tenth of the shortest offset.
        size = np.abs(found.gradients[:, 0]).max(axis=1)
        away = np.abs(found.gradients[:, 0, v] - (up - down) / 2e-7) / size
        assert np.quantile(away, 0.97) < 1e-5


def test_screening_is_consistent_with_clearances() -> None:
    designs, machine = random_designs(500, seed=84), with_gaps(SMOOTH)
    assert supports_screening(machine, Signal.POSITION_ERROR)
    fast = screened_maxima(machine, (Signal.POSITION_ERROR,), designs)[0]
    exact = find_peaks(machine, Signal.POSITION_ERROR, designs, limit=1)
    np.testing.assert_allclose(fast.values, exact.values[:, 0], rtol=1e-12)
    assert not supports_screening(machine, Signal.POSITION_ERROR_RSS)
    assert supports_screening(SMOOTH, Signal.POSITION_ERROR_RSS)


def test_limits_are_absolute_plus_share_of_the_size_of_the_dimension() -> None:
    mechanism = with_gaps(PUBLISHED)
    expected = [1.4e-3, 1.8e-3, 5e-5, math.radians(0.1), 2e-5, 3e-5, 4e-5, 5e-5]
    np.testing.assert_allclose(limits_of_sources(mechanism, SUPPORT), expected, rtol=1e-14)


def test_remainder_holds_for_every_deviation_within_the_limits() -> None:
    random = np.random.default_rng(85)
    for mechanism, linkage in CASES:
        reach = limits_of_sources(mechanism, linkage)
        reach[4:] = 0.0
        u = random.uniform(-1.0, 1.0, (200, 4)) * reach[:4]
        i = linkage.error_influences(TURN)
        linear = u[:, :1] * i.crank + u[:, 1:2] * i.rod + u[:, 2:3] * i.offset + u[:, 3:] * i.crank_angle
        other = Linkage(linkage.crank + u[:, :1], linkage.rod + u[:, 1:2], linkage.offset + u[:, 2:3], linkage.branch)
        true = other.at(TURN + u[:, 3:]).slider_position - linkage.at(TURN).slider_position
        bound = higher_order_bound(mechanism, linkage, TURN)
        assert np.all(np.abs(true - linear) <= bound + 1e-15)
        # A bound that is never within reach would say nothing.
        assert np.any(np.abs(true - linear) > 0.02 * bound)


@pytest.mark.parametrize("pair", [*itertools.combinations(range(4), 2)])
def test_two_sources_at_their_limits_come_near_the_remainder(pair: tuple[int, int]) -> None:
    """No corner of small limits is beyond the bound, and some corner comes within 1 % of it.

    Where the second derivatives of a pair add up, corners reach the bound but for third orders. The rounding of x is
    1e-15 m.
    """
    nearest = 0.0
    for _, linkage in CASES:
        i = linkage.error_influences(TURN)
        slopes = np.stack([i.crank, i.rod, i.offset, i.crank_angle])
        size = math.sqrt(linkage.rod**2 - linkage.crank**2)
        for ratio in 10.0 ** np.linspace(-1.5, 1.5, 7):
            limit = np.zeros(4)
            limit[[*pair]] = 1e-4 * np.array([ratio**-0.5, ratio**0.5]) * np.where(np.array(pair) < 3, size, 1.0)
            crank, rod, offset, angle = (Tolerance(absolute=each) for each in limit.tolist())
            tolerances = Tolerances(crank=crank, rod=rod, offset=offset, crank_angle=angle)
            bound = higher_order_bound(Mechanism(branch=linkage.branch, tolerances=tolerances), linkage, TURN)
            for signs in itertools.product((-1.0, 1.0), repeat=2):
                u = np.zeros(4)
                u[[*pair]] = limit[[*pair]] * signs
                other = Linkage(linkage.crank + u[0], linkage.rod + u[1], linkage.offset + u[2], linkage.branch)
                true = other.at(TURN + u[3]).slider_position - linkage.at(TURN).slider_position
                away = np.abs(true - u @ slopes)
                nearest = max(nearest, float(np.max((away - 1e-15) / bound)))
    assert nearest == pytest.approx(1.0, abs=0.01)


@pytest.mark.parametrize("value", [-1e-6, math.nan, math.inf])
def test_clearances_must_be_zero_or_more(value: float) -> None:
    with pytest.raises(InputError, match="the guide clearance must be zero or more and finite; got "):
        Clearances(guide=value)
