"""Past generations of a method that goes generation by generation: everything that the next one is bred from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..front.stationarity import Array

Rows = NDArray[np.int64]


@dataclass(frozen=True)
class Brood:
    """Points to be evaluated together.

    sheet: (n,), index of each point's sheet. u: (n, k), points of the unit box; columns beyond a sheet's own dimension
    do not count. parents: (p,), rows that the brood was bred from, counted over the points of all generations; empty
    where a method has none.
    """

    sheet: Rows
    u: Array
    parents: Rows

    def __len__(self) -> int:
        return len(self.u)


@dataclass(frozen=True)
class Generation(Brood):
    """A brood and what its points turned out to be.

    values: (n, m) objectives as they are minimised, SI; NaN where a constraint is violated. violation: (n,), the
    greatest relative one beyond what is tolerated (see `population.BAND`), infinite where no linkage turns fully.
    """

    values: Array
    violation: Array


@dataclass(frozen=True)
class History:
    """The generations so far, end to end: the fields of `Generation` over all points. last: rows of the last one."""

    sheet: Rows
    u: Array
    values: Array
    violation: Array
    last: Rows

    @classmethod
    def of(cls, past: Sequence[Generation]) -> History:
        """Return one or more generations joined end to end."""
        count = sum(len(generation) for generation in past)
        return cls(
            np.concatenate([generation.sheet for generation in past]),
            np.concatenate([generation.u for generation in past]),
            np.concatenate([generation.values for generation in past]),
            np.concatenate([generation.violation for generation in past]),
            np.arange(count - len(past[-1]), count),
        )


def generation_seed(seed: int, generation: int) -> int:
    """Return the seed of one generation, independent of all others, so that a run may resume at any."""
    return int(np.random.SeedSequence([seed, generation]).generate_state(1)[0])
