"""Answer of a search among discrete values: how far it goes, and what the values cost."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class DiscreteAnswer:
    """How the front of a problem with discrete numbers was found.

    exact: whether every combination was judged; else those next to the designs of the continuous front were.
    combinations: how many there are. judged: how many of them were looked at. rules: of the discrete numbers by name,
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
        """How far the answer goes, in words."""
        return "exact" if self.exact else "neighbours of the continuous front"
