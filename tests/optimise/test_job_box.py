"""Bounds claimed within the ranges: no design lies beyond them, and they are sharp."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from slidercrank.model.kinematics import geometry
from slidercrank.objectives.registry import quantity
from slidercrank.optimise.job.reachable_values import Box, greatest_time_ratio
from slidercrank.optimise.problem.requirements import Range

ANY = Range(lower=0.0, upper=1.0)
SIZES = st.floats(0.01, 1.0)
QUANTITIES: dict[str, Callable[..., Any]] = {
    "stroke": geometry.stroke,
    "time_ratio": geometry.time_ratio,
    "transmission_angle": geometry.least_transmission_angle,
    "rod_to_crank": lambda r, l, a: l / r,
    "rod_to_offset": lambda r, l, a: l / a,
}


def ranges(ends: list[float]) -> tuple[Range, Range, Range]:
    pairs = [sorted(ends[i : i + 2]) for i in (0, 2, 4)]
    crank, rod, offset = (Range(lower=low, upper=high) for low, high in pairs)
    return crank, Range(lower=rod.lower * 2.0, upper=rod.upper * 2.0), offset


@given(st.lists(SIZES, min_size=6, max_size=6), st.integers(0, 2**32))
def test_no_design_within_the_ranges_lies_outside_the_bounds(ends: list[float], seed: int) -> None:
    crank, rod, offset = ranges(ends)
    box = Box(crank=crank, rod=rod, offset=offset)
    random = np.random.default_rng(seed)
    r, l, a = (random.uniform(x.lower, x.upper, 4000) for x in (crank, rod, offset))
    r[:8], l[:8], a[:8] = (
        np.array([(x.lower, x.upper)[n >> shift & 1] for n in range(8)]) for shift, x in enumerate((crank, rod, offset))
    )
    turning = l > (r + a) * (1.0 + 1e-9)
    assert box.may_rotate_fully or not turning.any()
    assume(turning.any())
    for name, formula in QUANTITIES.items():
        values = formula(r[turning], l[turning], a[turning])
        least, greatest = box.bounds_on_quantity(quantity(name))
        assert least * (1.0 - 1e-9) <= values.min()
        assert values.max() <= greatest * (1.0 + 1e-9)


@pytest.mark.parametrize(
    "ends",
    [
        (0.02, 0.04, 0.1, 0.2, 0.0, 0.03),  # every corner turns
        (0.08, 0.16, 0.2, 0.6, 0.0, 0.2),  # the corner of the longest crank does not
        (0.1, 0.9, 0.2, 0.5, 0.05, 0.3),  # the crank is limited by the rod
        (0.1, 0.2, 0.2, 0.5, 0.0, 0.0),  # no offset
    ],
)
def test_the_bounds_are_approached_by_designs_within_the_ranges(ends: tuple[float, ...]) -> None:
    crank, rod, offset = (Range(lower=ends[i], upper=ends[i + 1]) for i in (0, 2, 4))
    box = Box(crank=crank, rod=rod, offset=offset)
    axes = [np.linspace(x.lower, x.upper, 101) for x in (crank, rod, offset)]
    r, l, a = (x.ravel() for x in np.meshgrid(*axes))
    # Beside the edge of rotation, for what is reached only there.
    edge = np.clip((r + a) * (1.0 + 1e-7), rod.lower, rod.upper)
    r, l, a = np.concatenate([r, r]), np.concatenate([l, edge]), np.concatenate([a, a])
    turning = l > (r + a) * (1.0 + 5e-8)
    for name in ("stroke", "time_ratio", "transmission_angle"):
        values = QUANTITIES[name](r[turning], l[turning], a[turning])
        least, greatest = box.bounds_on_quantity(quantity(name))
        assert values.min() == pytest.approx(least, rel=5e-3, abs=2e-3)
        assert values.max() == pytest.approx(greatest, rel=2e-2)


def test_a_time_ratio_of_one_and_a_half_caps_the_transmission_angle_at_27_46_degrees() -> None:
    """Against the exact greatest excess angle on (r + |e|) / l = cos(mu), searched on a fine grid."""
    for angle in (15.0, 27.46, 40.0, 60.0):
        cosine = math.cos(math.radians(angle))
        p = np.linspace(0.0, cosine, 400_001)
        b = (np.arcsin((cosine - p) / (1.0 - p)) - np.arcsin((cosine - p) / (1.0 + p))).max()
        exact = (math.pi + b) / (math.pi - b)
        bound = greatest_time_ratio(cosine, ANY)
        assert exact <= bound <= exact * 1.0006
    assert greatest_time_ratio(math.cos(math.radians(27.46)), ANY) == pytest.approx(1.5, rel=1e-3)


def test_the_time_ratio_stays_below_three() -> None:
    assert 2.9 < greatest_time_ratio(1.0, ANY) <= 3.0 * (1.0 + 1e-12)


def test_a_given_share_of_the_offset_lowers_the_greatest_time_ratio() -> None:
    """Rod = 3.2 |offset| leaves one proportion, r / l = cos(mu) - 1 / 3.2."""
    cosine, q = math.cos(math.radians(25.0)), 1.0 / 3.2
    p = cosine - q
    b = math.asin(q / (1.0 - p)) - math.asin(q / (1.0 + p))
    exact = (math.pi + b) / (math.pi - b)
    bound = greatest_time_ratio(cosine, Range(lower=q, upper=q))
    assert exact <= bound <= exact * 1.0006
