"""Monte Carlo simulation against the first order, the exact extremes and the binomial law."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np
import pytest
from scipy import stats

from slidercrank.model.errors import InputError
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.mechanism import Clearances, Mechanism, Tolerance, Tolerances, Window
from slidercrank.model.tolerance.error_distributions import Contact, Shape, Spreads, error_distribution
from slidercrank.model.tolerance.exact_worst_case import (
    first_order_position_errors,
    fractions_of_sum,
    position_deviation_extremes,
    worst_position_error,
)
from slidercrank.model.tolerance.monte_carlo import (
    CHUNK,
    simulate_machines_with_errors,
    summarise_sample,
    variance_contributions,
    yield_within,
)
from tests.model.tolerance.machines import PUBLISHED, SUPPORT, random_cases

TURN = np.array([0.2, 1.3, 2.9, 4.0, 5.5])
CASES = [(PUBLISHED, SUPPORT), *random_cases(5, seed=91, coarse=0.1)]
SAMPLES = 8_000
GAPPED = Mechanism(
    tolerances=Tolerances(clearances=Clearances(crank_pivot=2e-5, crank_pin=3e-5, slider_pin=4e-5, guide=5e-5))
)


def test_standard_deviation_is_a_third_of_the_root_sum_square_for_limits_of_three_standard_deviations() -> None:
    for mechanism, linkage in CASES:
        plain = dataclasses.replace(
            mechanism, tolerances=dataclasses.replace(mechanism.tolerances, clearances=Clearances())
        )
        found = simulate_machines_with_errors(plain, linkage, TURN, samples=SAMPLES, seed=2)
        expected = first_order_position_errors(plain, linkage, TURN)
        # A sample's standard deviation scatters by 1 / sqrt(2 n), 0.5 %; five of them. The second order adds to it by
        # its own size, at three limits' width.
        slack = 5.0 / math.sqrt(2.0 * SAMPLES) * expected.root_sum_square / 3.0 + expected.remainder
        assert np.all(np.abs(found.errors.std(axis=0) - expected.root_sum_square / 3.0) < slack)
        assert np.all(np.abs(found.errors.mean(axis=0)) < slack)


@pytest.mark.parametrize("contact", ["along the rod", "any direction", "anywhere"])
@pytest.mark.parametrize("shape", ["normal", "truncated normal", "uniform", "triangular"])
def test_variance_is_the_sum_of_those_of_the_sources(shape: Shape, contact: Contact) -> None:
    of = error_distribution(shape)
    spreads = Spreads(crank=of, rod=of, offset=of, crank_angle=of, contact=contact)
    for mechanism, linkage in ((PUBLISHED, SUPPORT), CASES[3], (GAPPED, Linkage(0.14, 0.31, 0.06))):
        found = simulate_machines_with_errors(mechanism, linkage, TURN, samples=SAMPLES, seed=3, spreads=spreads)
        expected = variance_contributions(mechanism, linkage, TURN, spreads=spreads).sum(axis=0)
        remainder = first_order_position_errors(mechanism, linkage, TURN).remainder
        slack = 5.0 / math.sqrt(2.0 * SAMPLES) * np.sqrt(expected) + remainder
        assert np.all(np.abs(found.errors.std(axis=0) - np.sqrt(expected)) < slack)


def test_shares_of_the_variance_sum_to_one() -> None:
    for mechanism, linkage in CASES:
        parts = fractions_of_sum(
            variance_contributions(mechanism, linkage, TURN, spreads=Spreads(rod=error_distribution("uniform")))
        )
        np.testing.assert_allclose(parts.sum(axis=0), 1.0, rtol=1e-14)


@pytest.mark.parametrize("shape", ["truncated normal", "uniform", "triangular"])
@pytest.mark.parametrize("contact", ["along the rod", "any direction", "anywhere"])
def test_errors_within_limits_stay_within_the_exact_extremes(shape: Shape, contact: Contact) -> None:
    of = error_distribution(shape)
    spreads = Spreads(crank=of, rod=of, offset=of, crank_angle=of, contact=contact)
    for mechanism, linkage in random_cases(2, seed=92, coarse=1.0):
        found = simulate_machines_with_errors(mechanism, linkage, TURN, samples=2000, seed=4, spreads=spreads)
        bounds = position_deviation_extremes(mechanism, linkage, TURN)
        assert found.stuck == 0
        assert np.all(found.errors <= bounds.greatest + 1e-15)
        assert np.all(found.errors >= bounds.least - 1e-15)
        assert found.greatest.max() <= worst_position_error(mechanism, linkage).size + 1e-15
        # Samples that never come near the limits would meet any bound.
        assert np.all(np.ptp(found.errors, axis=0) > 0.3 * (bounds.greatest - bounds.least))


def test_yield_of_a_linear_error_is_that_of_the_normal_distribution() -> None:
    """An error of the rod at a dead centre of an in-line linkage: dx = dl, exactly."""
    mechanism = Mechanism(tolerances=Tolerances(rod=Tolerance(absolute=3e-4)))
    found = simulate_machines_with_errors(mechanism, Linkage(0.05, 0.2), [0.0], samples=SAMPLES, seed=5)
    for limit in (1e-4, 2e-4, 3e-4):
        share = yield_within(found.errors[:, 0], limit, confidence=0.9999)
        true = 2.0 * stats.norm.cdf(limit / 1e-4) - 1.0
        assert share.low < true < share.high
        assert share.share == pytest.approx(share.count_within / SAMPLES)


@pytest.mark.parametrize("method", ["exact", "wilson"])
def test_confidence_interval_covers_the_true_yield_as_often_as_it_says(method: Any) -> None:
    random = np.random.default_rng(6)
    true, runs = 0.95, 150
    hits = 0
    for _ in range(runs):
        found = yield_within(random.random(200), true, confidence=0.9, method=method)
        hits += found.low <= true <= found.high
    # Clopper and Pearson cover at least 90 %; both scatter by sqrt(0.9 x 0.1 / 150) = 2.4 %.
    assert 0.83 < hits / runs < 0.99


def test_clopper_pearson_interval_of_no_failures_has_its_closed_form() -> None:
    found = yield_within(np.zeros(100), 0.0, confidence=0.95)
    assert found.high == 1.0
    assert found.low == pytest.approx(0.025 ** (1.0 / 100.0), rel=1e-9)


def test_first_order_exact_and_simulation_agree_on_case_four() -> None:
    """With normal errors cut at the limits: the exact worst case bounds all, the first order within its remainder."""
    of = error_distribution("truncated normal")
    found = simulate_machines_with_errors(
        PUBLISHED, SUPPORT, TURN, seed=7, spreads=Spreads(crank=of, rod=of, offset=of, crank_angle=of)
    )
    one, exact = (
        first_order_position_errors(PUBLISHED, SUPPORT, TURN),
        position_deviation_extremes(PUBLISHED, SUPPORT, TURN),
    )
    assert np.all(np.abs(found.errors).max(axis=0) <= exact.largest_magnitude)
    assert np.all(np.abs(exact.largest_magnitude - one.worst_case) <= one.remainder)
    # Normal but for the remainder: the share within a root-sum-square, three standard deviations, cut at three.
    for n in range(len(TURN)):
        share = yield_within(found.errors[:, n], one.root_sum_square[n] / 3.0, confidence=0.9999)
        cut = float(of.std()) * 3.0
        near = [2.0 * stats.norm.cdf(1.0 / cut + shift) - 1.0 for shift in (-0.02, 0.02)]
        assert share.low < near[1]
        assert share.high > near[0]


def test_the_same_seed_gives_the_same_machines_and_more_begin_alike() -> None:
    one = simulate_machines_with_errors(PUBLISHED, SUPPORT, TURN, samples=CHUNK + 5, seed=8)
    two = simulate_machines_with_errors(PUBLISHED, SUPPORT, TURN, samples=CHUNK + 700, seed=8)
    np.testing.assert_array_equal(one.errors, two.errors[: CHUNK + 5])
    np.testing.assert_array_equal(one.greatest, two.greatest[: CHUNK + 5])
    other = simulate_machines_with_errors(PUBLISHED, SUPPORT, TURN, samples=CHUNK, seed=9)
    assert not np.any(one.errors[:CHUNK] == other.errors)


def test_greatest_error_counts_in_the_window_only() -> None:
    window = Window(during="outward stroke", start=0.9, end=1.0)
    windowed = dataclasses.replace(
        PUBLISHED, speed=1.0, tolerances=dataclasses.replace(PUBLISHED.tolerances, window=window)
    )
    whole = simulate_machines_with_errors(PUBLISHED, SUPPORT, samples=500).greatest
    part = simulate_machines_with_errors(windowed, SUPPORT, samples=500).greatest
    assert np.all(part <= whole * (1.0 + 1e-3))  # other sampled angles
    assert part.mean() < 0.95 * whole.mean()


def test_sampled_greatest_error_is_that_of_many_more_angles() -> None:
    for mechanism, linkage in CASES[:4]:
        coarse = simulate_machines_with_errors(mechanism, linkage, samples=200).greatest
        fine = simulate_machines_with_errors(mechanism, linkage, samples=200, angles=2048).greatest
        assert np.all(coarse <= fine * (1.0 + 1e-12))
        np.testing.assert_allclose(coarse, fine, rtol=1e-3)


def test_progress_is_told_and_cancelling_keeps_what_is_done() -> None:
    told: list[tuple[int, int]] = []
    found = simulate_machines_with_errors(
        PUBLISHED,
        SUPPORT,
        TURN,
        samples=5 * CHUNK,
        progress=lambda done, total: told.append((done, total)),
        cancelled=lambda: len(told) == 2,
    )
    assert told == [(CHUNK, 5 * CHUNK), (2 * CHUNK, 5 * CHUNK)]
    assert found.errors.shape == (2 * CHUNK, len(TURN))
    assert len(found.greatest) == 2 * CHUNK


def test_machines_that_do_not_turn_are_counted_and_never_within_a_limit() -> None:
    close = Linkage(0.04, 0.0601, 0.02)
    mechanism = Mechanism(tolerances=Tolerances(rod=Tolerance(absolute=3e-4)))
    found = simulate_machines_with_errors(mechanism, close, TURN, samples=4000)
    # The rod is 1 standard deviation longer than crank + offset: 15.87 % stick.
    assert yield_within(found.greatest, 1e3, confidence=0.9999).low < stats.norm.cdf(1.0)
    assert yield_within(found.greatest, 1e3, confidence=0.9999).high > stats.norm.cdf(1.0)
    assert found.stuck == np.isnan(found.greatest).sum() > 0
    assert np.isfinite(summarise_sample(found.greatest).mean)


def test_summary_is_that_of_the_sample() -> None:
    found = summarise_sample(np.arange(101.0), percents=(10.0, 50.0))
    assert found.mean == 50.0
    assert found.deviation == pytest.approx(np.arange(101.0).std(ddof=1))
    assert found.percentiles == ((10.0, 10.0), (50.0, 50.0))


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"samples": 0}, "samples must be a whole number of at least 1; got 0"),
        ({"samples": 2.5}, "samples must be a whole number"),
        ({"seed": -1}, "seed must be a whole number of at least 0; got -1"),
        ({"crank_angle": [math.nan]}, "crank angles must be a list of finite numbers"),
        ({"samples": 10**8, "crank_angle": [0.0, 1.0]}, "reduce one"),
    ],
)
def test_wrong_arguments_are_refused(arguments: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        simulate_machines_with_errors(PUBLISHED, SUPPORT, **arguments)


def test_wrong_distributions_and_limits_are_refused() -> None:
    for wrong, message in (
        (lambda: error_distribution("gaussian"), "shape must be 'normal' or"),  # type: ignore[arg-type]
        (lambda: error_distribution(sigmas=0.0), "sigmas, standard deviations within the limit, must be positive"),
        (lambda: Spreads(contact="nowhere"), "contact must be"),  # type: ignore[arg-type]
        (lambda: Spreads(rod="uniform"), "rod must be a distribution"),
        (lambda: yield_within([0.0], math.nan), "must be zero or more and finite"),
        (lambda: yield_within([0.0], 1.0, confidence=1.0), "confidence must be between 0 and 1; got 1"),
        (lambda: yield_within([], 1.0), "at least one number"),
        (lambda: summarise_sample([math.nan, 1.0]), "needs at least two machines that rotate fully; got 1"),
    ):
        with pytest.raises(InputError, match=message):
            wrong()
