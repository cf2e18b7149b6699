"""Scrambled Sobol points against SciPy's."""

import numpy as np
import pytest
from scipy.stats import qmc

from slidercrank.optimise.search.sampling import sobol_points


@pytest.mark.parametrize("dimension", range(1, 13))
def test_points_are_those_of_scipy_to_the_bit(dimension: int) -> None:
    for seed in range(20):
        for power in (1, 2, 5, 10):
            ours, theirs = (np.random.default_rng([seed, power]) for _ in range(2))
            found = sobol_points(power, dimension, ours)
            assert np.array_equal(found, qmc.Sobol(dimension, rng=theirs).random_base2(power))
            assert ours.random() == theirs.random()
