"""Tests in the order for several workers: shares of equal size, files with slow tests first in each, files together."""

from __future__ import annotations

from itertools import groupby

import numpy as np
import pytest

from tests.order import shared_out


def file_of(test: str) -> str:
    return test.partition("::")[0]


def made_up(seed: int) -> tuple[list[str], dict[str, bool]]:
    """Return tests of files of 1 to 60 tests, and which of them are slow."""
    random = np.random.default_rng(seed)
    folders = ("model", "service", "optimise")
    files = [f"tests/{folders[n % 3]}/test_{n}.py" for n in range(40)]
    tests = [f"{file}::test_{k}" for file in files for k in range(random.integers(1, 60))]
    return tests, dict.fromkeys([tests[n] for n in sorted(random.choice(len(tests), 13, replace=False))], True)


@pytest.mark.parametrize("workers", [2, 3, 4, 8])
@pytest.mark.parametrize("seed", range(3))
def test_each_share_begins_with_its_part_of_the_files_with_slow_tests(seed: int, workers: int) -> None:
    tests, slow = made_up(seed)
    first = {file_of(test) for test in slow}
    found = shared_out(tests, workers, file_of, slow)
    assert sorted(found) == sorted(tests)
    begin = 0
    for n in range(workers):
        share = found[begin : begin + (len(tests) - begin) // (workers - n)]  # as xdist's `worksteal` has it
        begun = [file in first for file, _ in groupby(share, key=file_of)]
        count = sum(begun)
        assert count in (len(first) // workers, -(-len(first) // workers))
        assert all(begun[:count])
        begin += len(share)


def test_files_stay_together_but_where_shares_are_made_even() -> None:
    tests, slow = made_up(5)
    pieces = [file for file, _ in groupby(shared_out(tests, 4, file_of, slow), key=file_of)]
    assert len(pieces) <= len(set(pieces)) + 2 * 4


def test_the_last_tests_wait_for_nothing() -> None:
    tests, slow = made_up(6)
    found = shared_out(tests, 1, file_of, slow)
    assert "service" not in "".join(found[-len(tests) // 12 :])
