"""Certificate for a front: the result and steps of a search for a proof."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
import pandas as pd

from ...model.arrays import Array

Status = Literal["proven", "out of budget", "cancelled"]


@dataclass(frozen=True)
class Step:
    """State of the proof. epsilon: proven so far for the completed set, infinite at first."""

    epsilon: float
    boxes: int
    open: int
    added: int
    seconds: float


@dataclass(frozen=True)
class Certificate:
    """A proof of the greatest distance from a front to the true one.

    requested: epsilon to prove. epsilon: proven for the front completed by the added designs. delivered: proven for the
    front alone. gap: certain gap in the front alone, the excess of the design `hole` (3 + v,) (None if no design lies
    beyond the front). All in units of the objectives' ranges `span` (m,), SI. hypervolume_gap: upper bound on the
    excess of the true front's hypervolume over the front's, in its units, including volume beyond the front's ideal
    point. added: (n, 3 + v), SI, designs that complete the front; added_values: (n, m), SI, minimised; table: all their
    quantities. boxes: number of bounded boxes. open: number of open boxes. remaining: their fraction of the design box.
    worst_open_box: ranges of a design's numbers, SI, in the open box with the largest excess, (3 + v, 2); None if no
    box is open. notes: requirements that the bounds did not use. The proof holds without them, but is harder to find.
    """

    status: Status
    requested: float
    epsilon: float
    delivered: float
    gap: float
    hole: Array | None
    hypervolume_gap: float
    span: Array
    added: Array
    added_values: Array
    table: pd.DataFrame
    boxes: int
    open: int
    remaining: float
    worst_open_box: Array | None
    notes: tuple[str, ...]
    seconds: float
    message: str

    @property
    def proven(self) -> bool:
        """Whether the requested epsilon is proven."""
        return self.epsilon <= self.requested


def certificate_message(
    status: Status, requested: float, proven: float, delivered: float, gap: float, designs: int, added: int
) -> str:
    """Describe the proof in words."""

    def share(value: float) -> str:
        return f"{100.0 * value:.3g} %"

    if not np.isfinite(proven):
        return "nothing is proven yet: part of the design box has no bound; allow more time"
    if proven >= 1.0 and proven > requested:
        text = (
            f"nothing useful is proven yet: according to the bound so far, a design could be better by "
            f"{share(proven)} of each objective's range over the front, which is more than the whole front; allow more "
            "time or narrow the ranges"
        )
        return f"interrupted; {text}" if status == "cancelled" else text
    delivered_set = f"the {designs} designs" if designs > 1 else "the design"
    completed_set = f"{delivered_set} and {added} added ones" if added else delivered_set
    worst_loss = f"at most {share(proven)} of each objective's range"
    text = f"proven: for every feasible design, one of {completed_set} is worse by {worst_loss}"
    if added:
        text += f"; {delivered_set} alone: {share(delivered)}"
        if gap > requested:
            text += f", and a design that is better by {share(gap)} is known"
    if status == "out of budget":
        text += f"; {share(requested)} was requested; allow more time or a larger epsilon"
    return f"interrupted; {text}" if status == "cancelled" else text
