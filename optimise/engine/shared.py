"""A value that many chunks share, pickled once at its source and unpickled once in every process."""

from __future__ import annotations

import pickle
from functools import cached_property, lru_cache
from typing import Any, Generic, TypeVar

Value = TypeVar("Value")


class Shared(Generic[Value]):
    """A value that goes along with every chunk but is made only once in each process that works on them.

    A problem pickles into some kB, nothing next to a chunk of 50 ms. What costs is making it: functions of your own
    start a process, samples are drawn.
    """

    def __init__(self, value: Value) -> None:
        """Take the value; it is pickled when it first leaves this process."""
        self.value = value

    @cached_property
    def pickled(self) -> bytes:
        """The value as bytes. Raises what pickle does for one that cannot leave this process."""
        return pickle.dumps(self.value, protocol=pickle.HIGHEST_PROTOCOL)

    @property
    def portable(self) -> bool:
        """Whether the value can leave this process: functions given from Python may not."""
        try:
            return bool(self.pickled)
        except (pickle.PicklingError, AttributeError, TypeError):
            return False

    def __reduce__(self) -> tuple[Any, tuple[bytes]]:
        return _known, (self.pickled,)


@lru_cache(maxsize=16)
def _known(pickled: bytes) -> Shared[Any]:
    """Return the value of these bytes, the same one for the same bytes."""
    found = Shared(pickle.loads(pickled))
    found.__dict__["pickled"] = pickled
    return found
