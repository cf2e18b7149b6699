"""Designs of a front exactly as the search left them: what a table in shown units leaves out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ...optimise.front.front import ParetoFront
    from ...optimise.front.stationarity import Array


@dataclass(frozen=True)
class Exact:
    """Dimensions and slopes of the designs of a front, SI, in their order; the fields are those of `ParetoFront`.

    dimensions: (n, 3 + v). variants: n, empty if nothing was to be chosen. goals: for each design, objective index (p,)
    and gradient (p, f) of every active piece. active: gradients (a, f) of its active constraints.
    """

    dimensions: Array
    variants: tuple[int, ...]
    goals: tuple[tuple[Array, Array], ...]
    active: tuple[Array, ...]

    def __post_init__(self) -> None:
        """Refuse, with ValueError, parts of fronts of different length."""
        count = len(self.dimensions)
        if not count == len(self.goals) == len(self.active) or len(self.variants) not in (0, count):
            raise ValueError(f"dimensions of {count} designs, slopes of {len(self.goals)}, {len(self.active)}")

    def of(self, rows: Sequence[int]) -> Exact:
        """Return those of some designs, in the order given."""
        return Exact(
            self.dimensions[list(rows)],
            tuple(self.variants[row] for row in rows) if self.variants else (),
            tuple(self.goals[row] for row in rows),
            tuple(self.active[row] for row in rows),
        )


def exact_of(front: ParetoFront) -> Exact:
    """Return the exact dimensions, variants and slopes of a front's designs."""
    return Exact(front.dimensions, front.variants, front.goals, front.active)
