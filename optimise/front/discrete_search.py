"""Answer of a search among discrete values: its extent, and the cost of the values."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class DiscreteSearch:
    """Origin of the front of a problem with discrete numbers.

    exact: whether every combination was judged; else those next to the designs of the continuous front were.
    combinations: number of combinations. judged: number of those judged. rules: rules of the discrete numbers by name,
    in words. continuous: best value of each objective in the continuous front, (m,), as minimised, SI; empty without
    one.
    """

    exact: bool
    combinations: int
    judged: int
    rules: Mapping[str, str]
    continuous: tuple[float, ...]

    @property
    def how(self) -> str:
        """Extent of the search, in words."""
        return "exact" if self.exact else "neighbours of the continuous front"
