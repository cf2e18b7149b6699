"""Budget of a job being solved, and what remains of it."""

from __future__ import annotations

import time
from dataclasses import dataclass, field, replace

from ..runs.result import Result
from ..store import Limits


@dataclass
class Budget:
    """Time and evaluations that a search may still use; it begins now. A search ends at the next look after either.

    limits: the one of memory is not looked at here.
    """

    limits: Limits
    _began: float = field(default_factory=time.monotonic, init=False)
    _evaluations: int = field(default=0, init=False)

    def count(self, evaluations: int) -> None:
        """Take note of how many designs have been evaluated so far."""
        self._evaluations = evaluations

    def spent(self) -> bool:
        """Whether the search is to end with what it has."""
        return bool(self.reason())

    def explained(self, result: Result) -> Result:
        """Return a result with the limit that ended its search in its message, if one did."""
        reason = self.reason() if result.status == "cancelled" else ""
        return replace(result, message=f"{result.message}; {reason}") if reason else result

    def reason(self) -> str:
        """Return which limit is reached, in words; nothing if none is."""
        seconds, evaluations = self.limits.seconds, self.limits.evaluations
        if seconds is not None and time.monotonic() - self._began >= seconds:
            return f"its search took longer than its limit of {seconds:g} s"
        if evaluations is not None and self._evaluations >= evaluations:
            return f"its search reached its limit of {evaluations} evaluations"
        return ""
