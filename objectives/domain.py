"""Domain of a quantity: the values that some linkage has."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Domain:
    """Values from lower to upper, SI.

    open: whether the ends are excluded. idle: whether a least value below the domain is let pass, as it asks nothing.
    rule, remedy: in words, for a message.
    """

    lower: float
    upper: float = math.inf
    open: bool = True
    idle: bool = False
    rule: str
    remedy: str

    def refuses(self, value: float, *, least: bool) -> bool:
        """Return whether no linkage has a value. least: whether it is asked as a least value."""
        if least and self.idle:
            return False
        return not (self.lower < value < self.upper or (not self.open and value in (self.lower, self.upper)))
