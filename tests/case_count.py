"""Number of random cases in a test: enough to notice faults, or all with the variable SLIDERCRANK_CASES=full."""

from __future__ import annotations

import os
from collections.abc import Iterable
from itertools import product
from typing import Any

ALL_CASES = os.environ.get("SLIDERCRANK_CASES") == "full"
_SEEDS = 12
"""Number of usual cases of a test whose parameter is a seed: twice all combinations of two and three kinds."""


def is_usual(case: Any) -> bool:
    """Whether a case of a test is among the first seeds, if these alone are tried."""
    return ALL_CASES or case is None or case.indices.get("seed", 0) < _SEEDS


def case_count(usual: int, full: int) -> int:
    """Return how many random cases a test tries; the usual ones come first among all."""
    return full if ALL_CASES else usual


def in_turn(every: int, first: Iterable[Any], *others: Iterable[Any]) -> list[tuple[Any, ...]]:
    """Return combinations of a value of each list: one in `every`, so that each value has its turn, or all."""
    rest = [*product(*others)]
    places = product(enumerate(first), enumerate(rest))
    return [(one, *more) for (row, one), (column, more) in places if ALL_CASES or (row + column) % every == 0]
