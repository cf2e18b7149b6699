"""A way to compute an unknown of a design from others, so that a requirement holds exactly."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Rule(ABC):
    """A way to compute an unknown: `target` from `sources`. origin: its requirements, joined by "+".

    values: values of the requirements.
    """

    origin: str
    target: str
    sources: tuple[str, ...]
    values: tuple[float, ...]

    @abstractmethod
    def formula(self, *known: Any) -> Any:
        """Return the target computed from the sources."""

    @property
    def solutions(self) -> tuple[Rule, ...]:
        """Return one rule for each solution of its equation; each has a separate branch."""
        return (self,)
