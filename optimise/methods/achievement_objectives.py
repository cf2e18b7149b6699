"""A form as objectives for the polish: least weighted distance from a reference, plus a small multiple of the sum.

The polish accepts objectives that are the greatest of smooth pieces and, with `hold=False`, lowers their sum. So a
`Form` with m objectives becomes 1 + m objectives: first max_i w_i (f_i - z_i), whose pieces are those of all weighted
objectives, then each rho f_i. Ceilings join the constraints. Kinks stay: nothing is smoothed, and no variable is added.
"""

from __future__ import annotations

import numpy as np

from ...model.arrays import Array, Mask
from ..search.evaluation import Evaluator
from ..search.piece_rows import Rows
from .scalar_objective import Form

_LABEL_STEP = (
    100.0  # offset between the labels of two objectives' pieces, so that peaks of different curves are not confused
)


class Achievement:
    """A form on one branch, which satisfies `polish.Evaluates`. ideal, span: (m,), scaling of the objectives."""

    def __init__(self, evaluator: Evaluator, form: Form, ideal: Array, span: Array) -> None:
        self.evaluator, self.form = evaluator, form
        self.ideal, self.span = ideal, span

    def can_evaluate(self, u: Array) -> Mask:
        """Return which points give a linkage that rotates fully."""
        return self.evaluator.can_evaluate(u)

    def exact_rows(self, u: Array) -> tuple[Rows, Rows]:
        """Return the rows of the form's 1 + m objectives, and the rows of constraints and ceilings."""
        goals, limits = self.evaluator.exact_rows(u)
        owner, form = goals.owner, self.form
        values = (goals.values - self.ideal[owner]) / self.span[owner]
        slopes = goals.gradients / self.span[owner][:, None]
        labels = goals.labels + _LABEL_STEP * owner
        is_weighted, capped = form.weights[owner] > 0.0, np.isfinite(form.ceilings[owner])
        weights, weighted_owner = form.weights[owner[is_weighted]], owner[is_weighted]
        aims = Rows(
            np.concatenate(
                [weights * (values[:, is_weighted] - form.reference[weighted_owner]), form.rho * values], axis=1
            ),
            np.concatenate([weights[:, None] * slopes[:, is_weighted], form.rho * slopes], axis=1),
            np.concatenate([labels[:, is_weighted], labels], axis=1),
            np.concatenate([np.zeros_like(weighted_owner), 1 + owner]),
        )
        capped_owner, first = owner[capped], 1 + int(limits.owner.max(initial=-1))
        constraints = Rows(
            np.concatenate([limits.values, values[:, capped] - form.ceilings[capped_owner]], axis=1),
            np.concatenate([limits.gradients, slopes[:, capped]], axis=1),
            np.concatenate([limits.labels, labels[:, capped]], axis=1),
            np.concatenate([limits.owner, first + capped_owner]),
        )
        return aims, constraints
