"""Jobs that leave nothing free against enumeration by brute force."""

from __future__ import annotations

import pytest

from slidercrank.optimise.job import parse_job
from slidercrank.optimise.solve import solve
from tests.optimise.catalogues import brute_force, distance, pairs, random_job

JOBS, AT_ONCE = 200, 20


@pytest.mark.parametrize("first", range(0, JOBS, AT_ONCE))
def test_random_catalogue_jobs_give_the_front_of_brute_force(first: int) -> None:
    wrong = []
    for seed in range(first, first + AT_ONCE):
        problem = parse_job(random_job(seed))
        front, expected = solve(problem), brute_force(problem)
        found = front.values
        if len(found) != len(expected) or distance(found, expected) > 1e-9 or pairs(found):
            wrong.append((seed, len(found), len(expected), distance(found, expected), front.message))
    assert wrong == []
