"""The protocol of what evaluates chunks, this process, several processes or a cluster; and this process."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Protocol, TypeVar

Item = TypeVar("Item")
Found = TypeVar("Found")
Poll = Callable[[], None]


class Engine(Protocol):
    """Applies a function to items, somewhere, and gives the results in the items' order.

    The same function of the same item gives the same bits on every engine, on processors of the same kind.
    """

    @property
    def workers(self) -> int:
        """Number of items that are worked on at once, at least one."""
        ...

    def should_map(self, seconds: float) -> bool:
        """Whether work that takes so long in this process, s, should rather be mapped.

        Asked of all that is heavy: an engine that takes time to start waits until that much of it was refused.
        """
        ...

    def map(self, function: Callable[[Item], Found], items: Sequence[Item], *, poll: Poll | None = None) -> list[Found]:
        """Return function(item) for every item, in order.

        function: of a module, so that another process can import it. poll: called between items and while waiting; what
        it raises ends the map. Raises that, what the function raises, and `EngineError` if the engine is lost. Work
        lost with a worker is repeated without a report.
        """
        ...

    def close(self) -> None:
        """End what the engine has started. It starts again with the next map."""
        ...


LONGEST = 0.5
"""s, that a chunk takes at most, where one row takes no longer: nothing is polled meanwhile."""


class Serial:
    """The engine that is none: nothing is pickled, nothing started."""

    workers = 1

    def should_map(self, seconds: float) -> bool:
        """Return whether something is to be heard meanwhile; see `Engine`."""
        return seconds > LONGEST

    def map(self, function: Callable[[Item], Found], items: Sequence[Item], *, poll: Poll | None = None) -> list[Found]:
        """Return function(item) for every item; see `Engine`."""
        results = []
        for item in items:
            if poll is not None:
                poll()
            results.append(function(item))
        return results

    def close(self) -> None:
        """Do nothing."""
