"""Starting points of local solvers: screened samples, and of these the best ones that lie apart."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..front.stationarity import Array
from ..problem.problem import Problem
from ..search.evaluation import FEASIBLE, Evaluator
from ..search.sampling import apart, first_samples
from ..search.search import BANDS, Archive

SAMPLES = 16384
"""Samples over all sheets."""
_ENOUGH = 32
_STREAM = 3000  # of the seed


@dataclass(frozen=True)
class Samples:
    """Screened points.

    sheet: (n,), index. u: (n, k), of the unit box, padded. values: (n, m), SI, as minimised. feasible: (n,), whether
    they meet all constraints.
    """

    sheet: NDArray[np.int64]
    u: Array
    values: Array
    feasible: NDArray[np.bool_]

    def __len__(self) -> int:
        return len(self.sheet)

    def archive(self) -> Archive:
        """Return those that meet all constraints as an archive: what there is before any optimum."""
        found = Archive.empty(self.values.shape[1])
        for index in np.unique(self.sheet).tolist():
            rows = np.flatnonzero((self.sheet == index) & self.feasible)
            found.take(index, self.u[rows], self.values[rows])
        return found

    def best(self, column: int, count: int) -> NDArray[np.int64]:
        """Return at most `count` rows, the best in an objective first, each apart from the better ones.

        And as many of those that do not meet all constraints: none of these takes the place of one that does.
        """
        groups = [np.flatnonzero(self.feasible), np.flatnonzero(~self.feasible)]
        return np.concatenate(
            [rows[apart(self.values[rows, column], self.u[rows], self.sheet[rows], count)] for rows in groups]
        )


def samples(problem: Problem, evaluators: list[Evaluator]) -> Samples:
    """Return feasible samples of all sheets; where there are few, with such as violate constraints by up to 16 %.

    Solvers remove the violation. Equalities that are left are met by no sample.
    """
    loose = any(evaluator.loose for evaluator in evaluators)
    widest = max(evaluator.dimension for evaluator in evaluators)
    for attempt, band in enumerate(BANDS[1:] if loose else BANDS):
        parts = []
        for index, evaluator in enumerate(evaluators):
            count = -(-SAMPLES * 4 ** min(attempt, 1) // len(evaluators))
            u = first_samples(count, evaluator.dimension, problem.settings.seed, _STREAM + 10 * attempt + index)
            _, values, violation = evaluator.screen(u, band=band)
            good = (violation <= band + FEASIBLE) & evaluator.valid(u)
            padded = np.zeros((int(good.sum()), widest))
            padded[:, : u.shape[1]] = u[good]
            parts.append((np.full(len(padded), index), padded, values[good], violation[good] <= FEASIBLE))
        found = Samples(*(np.concatenate(part) for part in zip(*parts, strict=True)))
        if len(found) >= _ENOUGH:
            break
    return found
