"""Interface of engines that evaluate chunks (this process, several processes or a cluster), and the serial engine."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Protocol, TypeVar

Item = TypeVar("Item")
Found = TypeVar("Found")
Poll = Callable[[], None]


class Engine(Protocol):
    """Applies a function to items on some computer, and returns the results in the order of the items.

    On processors of the same kind, every engine returns the same bits for an item.
    """

    @property
    def workers(self) -> int:
        """Number of items that are processed concurrently, at least one."""
        ...

    def should_map(self, seconds: float) -> bool:
        """Whether to map work that takes this long, s, in this process.

        Called for all expensive work: an engine that is slow to start declines until the declined work outweighs its
        start.
        """
        ...

    def map(self, function: Callable[[Item], Found], items: Sequence[Item], *, poll: Poll | None = None) -> list[Found]:
        """Return function(item) for every item, in order.

        function: at module level, so that another process can import it. poll: called between items and while waiting;
        any error that it raises ends the map. Raises that error, the errors of the function, and `EngineError` if the
        engine is lost. Work lost with a worker is repeated silently.
        """
        ...

    def close(self) -> None:
        """Stop everything that the engine has started. It starts again with the next map."""
        ...


LONGEST = 0.5
"""s, maximum duration of a chunk if rows are short enough: nothing is polled meanwhile."""


class Serial:
    """Engine that runs work directly: it pickles nothing and starts nothing."""

    workers = 1

    def should_map(self, seconds: float) -> bool:
        """Return whether the work is long enough to need polling; see `Engine`."""
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
