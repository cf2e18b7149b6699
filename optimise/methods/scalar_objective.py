"""One objective composed from several, and its smooth programme for SciPy's solvers.

With objectives f_i scaled by their range over the front and with the ideal at zero, a `Form` stands for

    min over u   max_i w_i (f_i(u) - z_i) + rho sum_i f_i(u)      subject to   f_i(u) <= c_i   and the constraints.

Each f_i is the greatest of smooth pieces, so kinks are no problem for a smooth solver in the form

    min over u, s, t   t + rho sum_i s_i   subject to   p(u) <= s_i for each piece p of objective i,
                                                        w_i (s_i - z_i) <= t where w_i > 0,   s_i <= c_i,

the epigraph form (Boyd and Vandenberghe, "Convex Optimization", 2004, ch. 4.1.3). A small multiple of the sum, rho > 0,
excludes designs that are only weakly optimal (Miettinen, "Nonlinear Multiobjective Optimization", 1999, ch. 3.4.5).

The polish accepts objectives that are the greatest of smooth pieces and, with `hold=False`, lowers their sum. So a
`Form` with m objectives becomes 1 + m objectives: first max_i w_i (f_i - z_i), whose pieces are those of all weighted
objectives, then each rho f_i. Ceilings join the constraints. Kinks stay: nothing is smoothed, and no variable is added.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...model.arrays import Array, IntArray, Mask
from ..search.evaluation import Evaluator
from ..search.piece_rows import Rows, greatest_pieces, rows_of_designs

SUM = 1e-4
"""rho: excludes a design if losing less than 1e-4 of one objective's range would gain the whole range of another."""
_ABSENT = -1.0  # value of a row that a design lacks: fulfilled, without slope
_OUT = 10.0  # violation where no linkage rotates fully, so that a line search turns back
_CLOSE = 0.02  # rad, or a row's number: pieces of neighbouring points closer than this keep their order


@dataclass(frozen=True)
class Form:
    """A scalarisation: weights w, reference z and ceilings c, (m,) each, and the factor rho of the sum."""

    weights: Array
    reference: Array
    ceilings: Array
    rho: float = 0.0

    @classmethod
    def of_single_objective(cls, objectives: int, column: int, *, rho: float = 0.0) -> Form:
        """Return the form that equals one of the objectives."""
        weights = np.zeros(objectives)
        weights[column] = 1.0
        return cls(weights, np.zeros(objectives), np.full(objectives, np.inf), rho)

    def form_value(self, scaled: Array) -> Array:
        """Return the form's value (n,) for scaled objectives (n, m); infinite above a ceiling."""
        is_weighted = self.weights > 0.0
        reached = (self.weights[is_weighted] * (scaled[:, is_weighted] - self.reference[is_weighted])).max(axis=1)
        is_allowed = (scaled <= self.ceilings).all(axis=1)
        return np.where(is_allowed, reached + self.rho * scaled.sum(axis=1), np.inf)


class Programme:
    """A form on one branch as a function of z = (u, s, t): (k + m + 1,).

    It stores its last point, because solvers request it repeatedly.

    ideal, span: (m,), scaling of the objectives.
    """

    def __init__(self, evaluator: Evaluator, form: Form, ideal: Array, span: Array) -> None:
        self.evaluator = evaluator
        self.form = form
        self.ideal, self.span = ideal, span
        self.k, self.m = evaluator.dimension, len(span)
        self.cost = np.concatenate([np.zeros(self.k), np.full(self.m, form.rho), [1.0]])
        self.lower = np.concatenate([np.zeros(self.k), np.full(self.m + 1, -np.inf)])
        self.upper = np.concatenate([np.ones(self.k), form.ceilings, [np.inf]])
        weighted = np.flatnonzero(form.weights > 0.0)
        self._fixed = np.zeros((len(weighted), self.k + self.m + 1))
        self._fixed[np.arange(len(weighted)), self.k + weighted] = form.weights[weighted]
        self._fixed[:, -1] = -1.0
        self._bound = form.weights[weighted] * form.reference[weighted]
        self._u: Array | None = None
        self._goals: Rows
        self._limits: Rows
        self._valid = True

    def start_vector(self, u: Array) -> Array:
        """Return z at a point u (k,) where the evaluator is valid, with the lowest possible s and t.

        An equality holds the piece that is highest here; another one may be highest after a run of the solver.
        """
        self._u = None
        self._evaluate_at(u)
        s = np.minimum(greatest_pieces(self._goals, self.m), self.form.ceilings)
        is_weighted = self.form.weights > 0.0
        t = (self.form.weights[is_weighted] * (s[is_weighted] - self.form.reference[is_weighted])).max()
        return np.concatenate([u, s, [t]])

    def objectives(self, u: Array) -> Array:
        """Return the scaled objectives (m,) at a point."""
        self._evaluate_at(u)
        return greatest_pieces(self._goals, self.m)

    def violation(self, u: Array) -> float:
        """Return the greatest relative violation of the problem's constraints at a point."""
        self._evaluate_at(u)
        return float(self._limits.values.max(initial=0.0)) if self._valid else np.inf

    def inequalities(self, z: Array) -> Array:
        """Return the rows g(z) <= 0, (r,)."""
        self._evaluate_at(z[: self.k])
        goals = self._goals.values - z[self.k + self._goals.owner]
        goals[~np.isfinite(self._goals.values)] = _ABSENT
        limits = self._limits.values[self._unequal]
        limits = np.where(np.isfinite(limits), limits, _ABSENT)
        if not self._valid:
            goals, limits = goals + _OUT, limits + _OUT
        return np.concatenate([goals, limits, self._fixed @ z - self._bound])

    def inequality_slopes(self, z: Array) -> Array:
        """Return the derivatives (r, k + m + 1) of the inequalities."""
        self._evaluate_at(z[: self.k])
        goals = np.zeros((len(self._goals.owner), self.k + self.m + 1))
        goals[:, : self.k] = self._goals.gradients
        goals[np.arange(len(goals)), self.k + self._goals.owner] = -1.0
        goals[~np.isfinite(self._goals.values)] = 0.0
        limits = np.where(np.isfinite(self._limits.values)[:, None], self._limits.gradients, 0.0)[self._unequal]
        return np.concatenate([goals, np.pad(limits, ((0, 0), (0, self.m + 1))), self._fixed])

    def equalities(self, z: Array) -> Array:
        """Return the rows h(z) = 0 of the remaining equalities."""
        self._evaluate_at(z[: self.k])
        return self._limits.values[self._equality_rows()] + (0.0 if self._valid else _OUT)

    def equality_slopes(self, z: Array) -> Array:
        """Return the derivatives of the equalities."""
        self._evaluate_at(z[: self.k])
        return np.pad(self._limits.gradients[self._equality_rows()], ((0, 0), (0, self.m + 1)))

    def _equality_rows(self) -> IntArray:
        """Return the rows that must vanish; for a piece that this design lacks, the row of the highest."""
        highest, instead = self._equal.T
        return np.asarray(np.where(np.isfinite(self._limits.values[highest]), highest, instead))

    def _evaluate_at(self, u: Array) -> None:
        if self._u is not None and np.array_equal(u, self._u):
            return
        first = self._u is None
        self._u = np.array(u)
        clipped = np.clip(self._u, 0.0, 1.0)[None]  # solvers leave the box by rounding errors
        self._valid = bool(self.evaluator.can_evaluate(clipped)[0])
        if not self._valid:
            assert not first  # solvers start at valid points
            return
        goals, limits = (rows_of_designs(rows, 0) for rows in self.evaluator.objective_and_constraint_rows(clipped))
        goals = Rows(
            (goals.values - self.ideal[goals.owner]) / self.span[goals.owner],
            goals.gradients / self.span[goals.owner][:, None],
            goals.labels,
            goals.owner,
        )
        if first:
            self._equal = _row_pairs_of_equalities(self.evaluator, limits)
            self._unequal = np.setdiff1d(np.arange(len(limits.owner)), self._equal)
            self._groups = _columns_of_swapping_peaks(self.evaluator, goals, limits)
        else:
            goals = _align_pieces(goals, self._goals, self._groups[0])
            limits = _align_pieces(limits, self._limits, self._groups[1])
        self._goals, self._limits = goals, limits


def _row_pairs_of_equalities(evaluator: Evaluator, limits: Rows) -> IntArray:
    """Return two constraint rows of each equality (e, 2), of which one must vanish: highest piece, opposite row.

    Every piece has a row on one side; only the highest has one on the other side too. Its two rows are equivalent: with
    both, a solver has dependent constraints and ends early. The rows of the other pieces stay inequalities.
    """
    pairs = []
    for owner, constraint in enumerate(evaluator.constraints):
        if constraint.equality:
            rows = np.flatnonzero(limits.owner == owner)
            # The last row is the single one; for the least of pieces, the first.
            pieces, single = (rows[:-1], rows[-1])
            if limits.values[pieces].max() != -limits.values[single]:
                pieces, single = rows[1:], rows[0]
            pairs.append((pieces[np.argmax(limits.values[pieces])], single))
    return np.array(pairs, dtype=np.int64).reshape(-1, 2)


def _columns_of_swapping_peaks(evaluator: Evaluator, goals: Rows, limits: Rows) -> tuple[list[IntArray], ...]:
    """Return the columns of goals and limits that are peaks of one curve and may swap; lower bounds may not."""
    groups_by_kind: tuple[list[IntArray], ...] = ([], [])
    last = [objective.target is not None for objective in evaluator.problem.objectives]
    bounds = [constraint.lower is not None for constraint in evaluator.constraints]
    for rows, has_lower_row, groups in ((goals, last, groups_by_kind[0]), (limits, bounds, groups_by_kind[1])):
        for owner, lower_row in enumerate(has_lower_row):
            columns = np.flatnonzero(rows.owner == owner)
            columns = columns[: len(columns) - lower_row]
            if len(columns) > 1:
                groups.append(columns)
    return groups_by_kind


def _align_pieces(rows: Rows, before: Rows, groups: list[IntArray]) -> Rows:
    """Return the rows with their pieces in the former order; peaks are sorted by height and swap when tied."""
    order = np.arange(len(rows.owner))
    for columns in groups:
        distances = np.abs(rows.labels[columns][:, None] - before.labels[columns])
        distances = np.minimum(distances, np.abs(distances - 2.0 * np.pi))
        is_absent = ~(np.isfinite(rows.values[columns])[:, None] & np.isfinite(before.values[columns]))
        order[columns] = columns[_match_rows_to_places(np.where(is_absent | ~np.isfinite(distances), np.pi, distances))]
    return Rows(rows.values[order], rows.gradients[order], rows.labels[order], rows.owner)


def _match_rows_to_places(distances: Array) -> IntArray:
    """Return the row for each position."""
    from scipy.optimize import linear_sum_assignment

    if (np.diag(distances) < _CLOSE).all():
        return np.arange(len(distances))
    rows, places = linear_sum_assignment(distances)
    return np.asarray(rows[np.argsort(places)])


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

    def objective_and_constraint_rows(self, u: Array) -> tuple[Rows, Rows]:
        """Return the rows of the form's 1 + m objectives, and the rows of constraints and ceilings."""
        goals, limits = self.evaluator.objective_and_constraint_rows(u)
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
