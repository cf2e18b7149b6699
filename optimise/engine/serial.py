"""Evaluation in this process, one item after the other."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from .engine import Found, Item, Poll

LONGEST = 0.5
"""s, that a chunk takes at most, where one row takes no longer: nothing is polled meanwhile."""


class Serial:
    """The engine that is none: nothing is pickled, nothing started."""

    workers = 1

    def worth(self, seconds: float) -> bool:
        """Return whether something is to be heard meanwhile; see `Engine`."""
        return seconds > LONGEST

    def map(self, function: Callable[[Item], Found], items: Sequence[Item], *, poll: Poll | None = None) -> list[Found]:
        """Return function(item) for every item; see `Engine`."""
        found = []
        for item in items:
            if poll is not None:
                poll()
            found.append(function(item))
        return found

    def close(self) -> None:
        """Do nothing."""
