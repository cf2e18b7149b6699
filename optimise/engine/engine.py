"""Protocol of engines that evaluate chunks (this process, several processes or a cluster), and this process."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Protocol, TypeVar

Item = TypeVar("Item")
Found = TypeVar("Found")
Poll = Callable[[], None]


class Engine(Protocol):
    """Applies a function to items, wherever that runs, and returns the results in the order of the items.

    A function of an item has the same bits on every engine, on processors of the same kind.
    """

    @property
    def workers(self) -> int:
        """Number of items that are processed concurrently, at least one."""
        ...

    def should_map(self, seconds: float) -> bool:
        """Whether work that takes this time, s, in this process should rather be mapped.

        Called for all expensive work: an engine that is slow to start declines until the work declined outweighs that.
        """
        ...

    def map(self, function: Callable[[Item], Found], items: Sequence[Item], *, poll: Poll | None = None) -> list[Found]:
        """Return function(item) for every item, in order.

        function: of a module, so that another process can import it. poll: called between items and while waiting; an
        error that it raises ends the map. Raises that, the errors of the function, and `EngineError` if the engine is
        lost. Work lost with a worker is silently repeated.
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
