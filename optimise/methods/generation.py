"""Past generations of a method that goes generation by generation: everything that the next one is bred from."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ..front.stationarity import Array
from ..search.candidates import Table

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


@dataclass
class Generation(Table):
    """The points of a brood and what they turned out to be.

    sheet, u: see `Brood`. values: (n, m) objectives as they are minimised, SI; NaN where a constraint is violated.
    violation: (n,), the greatest relative one beyond what is tolerated (see `population.BAND`), infinite where no
    linkage turns fully. parents: of the brood.
    """

    sheet: Rows
    u: Array
    values: Array
    violation: Array
    parents: Rows = field(kw_only=True)


def generation_seed(seed: int, generation: int) -> int:
    """Return the seed of one generation, independent of all others, so that a run may resume at any."""
    return int(np.random.SeedSequence([seed, generation]).generate_state(1)[0])
