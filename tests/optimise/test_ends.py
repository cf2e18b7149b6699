"""Ends of fronts against each objective alone: what is told as the best in an objective is the best.

All hundred jobs: `python -m benchmarks.ends` in the project's folder.
"""

from __future__ import annotations

import pytest

from benchmarks.ends import NEAR, ends, random_job
from slidercrank.optimise.job import parse_job


@pytest.mark.slow
@pytest.mark.parametrize("seed", [8, 57, 60, 76])
def test_each_end_of_a_front_is_the_best_of_its_objective_alone(seed: int) -> None:
    """Where an objective is at its best inside the ranges its slope vanishes: a weight held it to some 1e-3 alone."""
    found = ends(parse_job(random_job(seed)), seed)
    assert len(found) >= 3
    assert {end.objective: end.missed for end in found if end.missed > NEAR} == {}
