"""Non-dominance against comparing all pairs."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from slidercrank.optimise.front import dominance
from slidercrank.optimise.front.dominance import nondominated

Array = NDArray[np.float64]


def _by_pairs(values: Array) -> list[int]:
    """Return the indices of rows that none dominates, of equal ones the first, by comparing all with all."""
    as_good = (values[:, None] <= values[None]).all(axis=2)
    equal = as_good & as_good.T
    before = np.tri(len(values), k=-1, dtype=bool).T
    return np.flatnonzero(~((as_good & ~equal) | (equal & before)).any(axis=0)).tolist()


def _random_values(random: np.random.Generator) -> Array:
    """Return a cloud, a front, few different numbers, a front of two parameters with equal rows, or a constant."""
    count, objectives = int(random.integers(0, 400)), int(random.integers(2, 7))
    values = random.random((count, objectives))
    match int(random.integers(0, 5)):
        case 0:
            values[:, 0] = -values[:, 1:].sum(axis=1)
        case 1:
            values = np.round(int(random.integers(1, 5)) * values)
        case 2:
            values = np.sin(values[:, :2] @ random.normal(size=(2, objectives)))
            values[random.random(count) < 0.3] = values[:1]
        case 3:
            values[:, int(random.integers(0, objectives))] = -0.0
    return values


def test_random_sets_keep_the_rows_that_all_pairs_keep() -> None:
    random = np.random.default_rng(4)
    for _ in range(400):
        values = _random_values(random)
        assert nondominated(values).tolist() == _by_pairs(values)


def test_sets_at_the_ends_of_words() -> None:
    random = np.random.default_rng(5)
    for count in (0, 1, 2, 62, 63, 64, 125, 126, 127, 2047, 2048, 2049):
        values = random.random((count, 4))
        values[:, 0] = 1.0 - values[:, 1:].sum(axis=1) + (random.random(count) < 0.5)
        assert nondominated(values).tolist() == _by_pairs(values)


def test_infinite_values_and_large_sets_have_the_other_filter(monkeypatch: pytest.MonkeyPatch) -> None:
    random = np.random.default_rng(6)
    values = random.random((300, 5))
    values[random.random(values.shape) < 0.05] = np.inf
    assert nondominated(values).tolist() == _by_pairs(values)
    values = random.random((300, 5))
    monkeypatch.setattr(dominance, "_MANY", 299)
    assert nondominated(values).tolist() == _by_pairs(values)
