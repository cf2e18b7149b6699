"""Ends of fronts against each objective alone: what is told as the best in an objective is the best.

All hundred jobs: `python -m benchmarks.ends` in the project's folder.
"""

from __future__ import annotations

import pytest

from benchmarks import same_fronts
from benchmarks.ends import NEAR, ends, random_job
from slidercrank.optimise.job import parse_job
from slidercrank.optimise.solve import solve


@pytest.mark.slow
@pytest.mark.parametrize("seed", [8, 57, 60, 76])
def test_each_end_of_a_front_is_the_best_of_its_objective_alone(seed: int) -> None:
    """An objective at its best inside the ranges has no slope: a weight alone held it only to some 1e-3."""
    found = ends(parse_job(random_job(seed)), seed)
    assert len(found) >= 3
    assert {end.objective: end.missed for end in found if end.missed > NEAR} == {}


@pytest.mark.slow
@pytest.mark.parametrize(("seed", "volume"), [(17, 0.4613), (49, 0.705)])
def test_a_front_has_designs_beside_its_ends_and_in_its_gaps(seed: int, volume: float) -> None:
    """The other objective gains 8 % of its range beside an end whose slope vanishes, for 0.5 %.

    With ends alone, and gaps filled up to the asked number only, the hypervolumes are 0.46112 and 0.70118.
    """
    front = solve(parse_job(same_fronts.random_job(seed)))
    assert len(front) == 20
    assert front.hypervolume > volume
