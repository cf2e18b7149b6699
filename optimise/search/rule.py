"""One way to compute an unknown of a design from others, so that a requirement holds exactly."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Rule(ABC):
    """One way to compute an unknown: `target` from `sources`. origin: the requirements that it is of, joined by "+".

    values: their values.
    """

    origin: str
    target: str
    sources: tuple[str, ...]
    values: tuple[float, ...]

    @abstractmethod
    def formula(self, *known: Any) -> Any:
        """Return the target for the sources."""

    @property
    def solutions(self) -> tuple[Rule, ...]:
        """The rule for each solution that its equation has: a branch each."""
        return (self,)
