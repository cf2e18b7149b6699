"""The choice by hypervolume and the search for dominating points, against plain formulas, ties and holes included."""

from __future__ import annotations

import moocore
import numpy as np
import pytest
from numpy.typing import NDArray

from slidercrank.optimise.front.dominance import dominating, nondominated
from slidercrank.optimise.front.hypervolume import REFERENCE, choose_designs_by_hypervolume, ideal_and_range

Array = NDArray[np.float64]


def points(random: np.random.Generator, kind: str) -> Array:
    """Return non-dominated points (n, m)."""
    n, m = int(random.integers(3, 90)), int(random.integers(2, 7))
    values: Array = np.abs(random.normal(size=(n, m)))
    values = 1.0 - values / np.linalg.norm(values, axis=1, keepdims=True)
    if kind == "grid":
        values = np.round(values, 1)
    return values[nondominated(values)]


def greedily(values: Array, count: int, always: list[int]) -> float:
    """Return the hypervolume of a greedy choice that computes every volume anew, in scaled values."""
    ideal, span = ideal_and_range(values)
    scaled = np.ascontiguousarray((values - ideal) / span)
    picked = list(dict.fromkeys(always))[:count]
    while len(picked) < count:
        rest = [index for index in range(len(values)) if index not in picked]
        volumes = [moocore.hypervolume(scaled[[*picked, index]], ref=REFERENCE) for index in rest]
        picked.append(rest[int(np.argmax(volumes))])
    return float(moocore.hypervolume(scaled[picked], ref=REFERENCE))


@pytest.mark.parametrize("kind", ["sphere", "grid"])
def test_a_choice_is_worth_what_the_greedy_one_is(kind: str) -> None:
    random = np.random.default_rng(3)
    for _ in range(60):
        values = points(random, kind)
        count = int(random.integers(1, len(values) + 1))
        always = random.integers(0, len(values), int(random.integers(0, 3))).tolist()
        chosen = choose_designs_by_hypervolume(values, count, always=tuple(always))
        assert len(chosen) == len(set(chosen.tolist())) == count
        assert set(list(dict.fromkeys(always))[:count]) <= set(chosen.tolist())
        ideal, span = ideal_and_range(values)
        volume = moocore.hypervolume(np.ascontiguousarray(((values - ideal) / span)[chosen]), ref=REFERENCE)
        # Of designs that gain the same, the one or the other is taken, and what follows may differ.
        assert volume == pytest.approx(greedily(values, count, always), rel=1e-12 if kind == "sphere" else 0.03)


def test_beating_points_are_those_of_the_plain_comparison() -> None:
    random = np.random.default_rng(8)
    for _ in range(100):
        m = int(random.integers(1, 6))
        one, others = random.random((int(random.integers(0, 50)), m)), random.random((int(random.integers(0, 20)), m))
        if len(others):
            near = others[random.integers(0, len(others), len(one[::2]))]
            one[::2] = near + random.choice([0.0, 1e-9, -1e-9, 1e-4, -1e-4], size=near.shape)
        one[1:2], one[3:4, 0], one[5:6] = np.nan, np.inf, -np.inf
        clearly, slightly = 1e-9, float(random.choice([1e-5, np.inf]))
        expected = np.zeros(len(one), dtype=bool)
        with np.errstate(invalid="ignore"):
            for other in others:
                worst, gain = (one - other).max(axis=1), (other - one).max(axis=1)
                expected |= (worst <= 0.0) & (gain > clearly) | (worst <= clearly) & (gain > slightly)
        np.testing.assert_array_equal(dominating(one, others, clearly=clearly, slightly=slightly), expected)
