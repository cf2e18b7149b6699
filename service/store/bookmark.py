"""Bookmark of a design with its history: notes, reasons and decisions."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

Action = Literal["note", "reason", "decided", "withdrawn", "deleted"]
"""What happened to a bookmark. withdrawn: its decision was revoked and not replaced."""
_SAME = 1e-9  # relative tolerance of a dimension: addresses and forms give it with fewer digits


@dataclass(frozen=True, kw_only=True)
class HistoryEntry:
    """Change to a bookmark. number: number within its job, increasing. bookmark: None once the bookmark is deleted.

    name: name of the design at that time. text: the note or reason, if the action has one. author: name that the author
    gave, or empty. at: s since 1970.
    """

    number: int
    bookmark: int | None
    name: str
    action: Action
    text: str
    author: str
    at: float


@dataclass(frozen=True, kw_only=True)
class Bookmark:
    """Bookmarked design. number: number within its job, from 1. at: time of bookmarking, s since 1970.

    design: number of the front design that it is or is derived from; None for neither. variant: variant of the job's
    choices. dimensions: crank, rod, offset, m, and each extra variable, SI. decided: whether it was chosen, at most one
    per job. reason: reason for or against it. allowed: deviations from requirements that somebody allows for it, by
    column. history: its notes, reasons and decisions, oldest first.
    """

    job: int
    number: int
    name: str
    note: str
    star: bool
    decided: bool
    reason: str
    design: int | None
    variant: int
    dimensions: tuple[float, ...]
    at: float
    allowed: Mapping[str, float]
    history: tuple[HistoryEntry, ...] = ()

    @property
    def notes(self) -> list[str]:
        """Its notes, oldest first, each with its author if known."""
        notes = (entry for entry in self.history if entry.action == "note" and entry.text)
        return [f"{entry.author}: {entry.text}" if entry.author else entry.text for entry in notes]

    def is_of(self, variant: int, dimensions: Sequence[float]) -> bool:
        """Whether it is the bookmark of the design with these dimensions, within rounding."""
        pairs = zip(self.dimensions, dimensions, strict=True) if variant == self.variant else [(0.0, 1.0)]
        return all(math.isclose(own, other, rel_tol=_SAME, abs_tol=_SAME**2) for own, other in pairs)

    def decision(self, faults: Sequence[str]) -> str:
        """Return the decision for this design in words, with reason, faults and deviations; empty if there is none."""
        reason = f" ({self.reason})" if self.reason else ""
        return "; ".join((f"Decided: {self.name}{reason}", *faults)) * self.decided
