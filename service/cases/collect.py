"""All published cases with the values of the model."""

from __future__ import annotations

from collections.abc import Sequence

from . import case_1, case_2, case_3, case_4, case_5
from .published import CASES, Case, read_case

_OF = dict(zip(CASES, (case_1, case_2, case_3, case_4, case_5), strict=True))


def collect(numbers: Sequence[int] = CASES) -> list[Case]:
    """Return the cases of these numbers."""
    return [read_case(number, _OF[number].numbers()) for number in numbers]
