"""Number of random cases in a test: enough to notice faults, or all with the variable SLIDERCRANK_CASES=full."""

from __future__ import annotations

import os

ALL_CASES = os.environ.get("SLIDERCRANK_CASES") == "full"


def case_count(usual: int, full: int) -> int:
    """Return how many random cases a test tries; the usual ones come first among all."""
    return full if ALL_CASES else usual
