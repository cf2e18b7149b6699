"""All published cases with the values of the model."""

from __future__ import annotations

from collections.abc import Sequence

from . import case_1, case_2, case_3, case_4, case_5
from .published import CASES, Case, read_case

_NUMBERS = {
    1: case_1.numbers,
    2: case_2.numbers,
    3: case_3.numbers,
    4: case_4.numbers,
    5: case_5.numbers,
}


def collect(numbers: Sequence[int] = CASES) -> list[Case]:
    """Return the cases of these numbers."""
    return [read_case(number, _NUMBERS[number]()) for number in numbers]
