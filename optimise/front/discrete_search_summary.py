"""Summary of a search among discrete values: its extent, and what the values cost."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class DiscreteSearch:
    """How the front of a problem with discrete numbers was found.

    exact: whether every combination was judged; otherwise only those next to designs of the continuous front.
    combinations: number of combinations. judged: number of those judged. rules: rules for the discrete numbers by name,
    in words. continuous: best value of each objective on the continuous front, (m,), as minimised, SI; empty without
    one.
    """

    exact: bool
    combinations: int
    judged: int
    rules: Mapping[str, str]
    continuous: tuple[float, ...]

    @property
    def extent_text(self) -> str:
        """Extent of the search, in words."""
        return "exact" if self.exact else "neighbours of the continuous front"
