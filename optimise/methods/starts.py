"""Starting points of local solvers: screened samples, and of these the best ones that lie apart."""

from __future__ import annotations

import numpy as np

from ..problem.problem import Problem
from ..search.candidates import Candidates
from ..search.evaluation import FEASIBLE, Evaluator
from ..search.sampling import first_samples
from ..search.search import BANDS

SAMPLES = 16384
"""Samples over all sheets."""
_ENOUGH = 32
_STREAM = 3000  # of the seed


def samples(problem: Problem, evaluators: list[Evaluator]) -> Candidates:
    """Return feasible samples of all sheets; where there are few, with such as violate constraints by up to 16 %.

    Solvers remove the violation. Equalities that are left are met by no sample.
    """
    loose = any(evaluator.loose for evaluator in evaluators)
    for attempt, band in enumerate(BANDS[1:] if loose else BANDS):
        parts = []
        for index, evaluator in enumerate(evaluators):
            count = -(-SAMPLES * 4 ** min(attempt, 1) // len(evaluators))
            u = first_samples(count, evaluator.dimension, problem.settings.seed, _STREAM + 10 * attempt + index)
            _, values, violation = evaluator.screen(u, band=band)
            good = (violation <= band + FEASIBLE) & evaluator.valid(u)
            met = violation[good] <= FEASIBLE
            parts.append(Candidates(np.full(len(met), index), u[good], values[good], met))
        found = parts[0].join(*parts[1:])
        if len(found) >= _ENOUGH:
            break
    return found
