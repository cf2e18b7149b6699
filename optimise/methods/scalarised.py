"""Fronts by scalarisation: many problems with one objective each, whose optima are Pareto-optimal.

All methods begin with the optimum of each objective alone. These optima form the payoff table, whose ranges scale the
objectives. Each further problem starts from the sample or the optimum that is best for it, and is solved by SLSQP. The
first round distributes its aims evenly. Fronts with more objectives than free unknowns are thin, so many aims lead to
the same designs; later rounds aim at the gaps between optima.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from math import comb

import numpy as np

from ...model.arrays import Array
from ..front.dominance import nondominated
from ..front.hypervolume import ideal_and_range
from ..problem.problem import Problem
from ..search.candidates import Candidates
from ..search.evaluation import Evaluator
from ..search.sample_and_zoom import Archive, Run
from .local import archive_optimum, by_slsqp, is_budget_spent, starting_samples
from .registry import Method
from .scalar_objective import SUM, Form, Programme

_FIRST = 0.5  # problems in the first round per delivered design, because many share an optimum
_MORE = 3.0  # optima per delivered design, from which the best are selected
_ROUNDS = 6  # rounds that aim at gaps
_POOL = 2000  # samples to search for gaps
_STARTS = 4  # starts for each objective alone
_WORSE = 0.1  # relative to the ranges: a branch whose best start is worse by less is also tried
_UTOPIAN = 1e-3  # relative to the ranges: distance of Chebyshev's reference below the ideal
_SLIVER = 1e-3  # least weight of an objective in a direction, so that its reciprocal stays finite
_ROUND_SIZE = 16  # problems per round
_SLACK = 0.005  # relative to the ranges: samples above a ceiling by less may lead below it
_CELLS = 20_000  # maximum number of cells in the grid of ceilings
_WIDER = 1.5  # factor by which points extend beyond the triangle


Aims = tuple[list[Form], Callable[[Array], Form]]
"""The forms that a method solves first, and the form that aims at scaled objectives (m,) in a gap."""


def epsilon_constraint(front: _Front) -> Aims:
    """Return aims that minimise the first objective with ceilings on all others, on a grid over the payoff table.

    Ceilings far from every sample and optimum are omitted; the grid is refined until enough others remain. With the
    sum, see `scalar_objective`, this is the augmented epsilon-constraint method (G. Mavrotas, "Effective implementation
    of the epsilon-constraint method in multi-objective mathematical programming problems", Appl. Math. Comput. 213(2),
    2009).
    """
    m, scaled = len(front.payoff), front.scaled(np.concatenate([front.samples.values, front.archive.values]))
    ceilings = np.zeros((0, m - 1))
    parts = 2
    while len(ceilings) < _aims_per_round(front.problem) and parts ** (m - 1) <= _CELLS:
        cells = grid_points(np.zeros(m - 1), np.ones(m - 1), parts)
        # Only non-dominated designs decide which ceilings can be met.
        edge = scaled[nondominated(scaled[:, 1:]), 1:] if m > 2 else scaled[:, 1:].min(keepdims=True)
        ceilings = cells[[bool((edge <= row + _SLACK).all(axis=1).any()) for row in cells]]
        parts += max(1, parts // 4)
    only = Form.of_single_objective(m, 0, rho=SUM)
    forms = [Form(only.weights, only.reference, np.concatenate([[np.inf], row]), SUM) for row in ceilings]
    return forms, lambda aim: Form(only.weights, only.reference, np.concatenate([[np.inf], aim[1:]]), SUM)


def chebyshev(front: _Front) -> Aims:
    """Return aims by the augmented weighted Chebyshev norm from a utopian point, in evenly spread directions.

    R. E. Steuer and E.-U. Choo, "An interactive weighted Tchebycheff procedure for multiple objective programming",
    Math. Program. 26(3), 1983.
    """
    m = len(front.payoff)
    no_ceilings = np.full(m, np.inf)

    def form_towards(direction: Array) -> Form:
        direction = np.maximum(direction, _SLIVER)
        return Form(direction.min() / direction, np.full(m, -_UTOPIAN), no_ceilings, SUM)

    return [form_towards(direction) for direction in simplex_weights(m, _aims_per_round(front.problem))], form_towards


def nbi(front: _Front) -> Aims:
    """Return aims by normal-boundary intersection.

    Points Phi beta are spread over the plane through the optima of the single objectives, the columns of Phi. From
    each, a design moves as far as possible along the plane's quasi-normal n = -Phi e (Das and Dennis 1998, see
    `simplex_weights`). Where the front is not met, some design is better than the point reached, so F <= Phi beta + t n
    is required rather than equality (A. Pascoletti and P. Serafini, "Scalarizing vector optimization problems", JOTA
    42(4), 1984): every result is Pareto-optimal, even on a folded front. With three or more objectives, the plane's
    triangle does not cover the whole front, so points outside it are used as well.
    """
    m = len(front.payoff)
    payoff = front.scaled(front.payoff)
    normal = np.maximum(payoff.sum(axis=0), _SLIVER)
    shares = simplex_weights(m, _aims_per_round(front.problem))
    if m > 2:
        shares = 1.0 / m + (shares - 1.0 / m) * _WIDER
    no_ceilings = np.full(m, np.inf)

    def form_through(point: Array) -> Form:
        return Form(normal.min() / normal, point, no_ceilings, SUM)

    return [form_through(share @ payoff) for share in shares], form_through


@dataclass
class _Front:
    """State that the scalarised problems share.

    payoff: (m, m), objectives (columns) at the optimum of each objective (rows), SI. aimed: (n, m), scaled aims of
    later rounds.
    """

    problem: Problem
    evaluators: list[Evaluator]
    run: Run
    samples: Candidates
    archive: Archive
    ideal: Array
    span: Array
    payoff: Array
    aimed: Array

    def scaled(self, values: Array) -> Array:
        return np.asarray((values - self.ideal) / self.span)

    def archive_optimum_of_form(self, form: Form, index: int, u: Array) -> Array | None:
        """Archive the optimum of the form near a point; return its objectives (m,), SI, or None if there is none."""
        programme = Programme(self.evaluators[index], form, self.ideal, self.span)
        return archive_optimum(by_slsqp, programme, u, self.archive, index)

    def solve_forms(self, forms: list[Form], aimed: Callable[[Array], Form]) -> Archive:
        """Return the archive with the optima of the forms, and of those aimed at scaled objectives (m,) in gaps."""
        for _ in range(1 + _ROUNDS):
            self.run.expect_rounds(-(-len(forms) // _ROUND_SIZE))
            for begin in range(0, len(forms), _ROUND_SIZE):
                if is_budget_spent(self.problem, self.evaluators):
                    return self.archive
                for form in forms[begin : begin + _ROUND_SIZE]:
                    for index, u in self._best_starts_per_branch(form):
                        self.archive_optimum_of_form(form, index, u)
                self.run.report_round("scalarising", self.evaluators, self.archive)
            forms = [aimed(aim) for aim in self._gap_points()]
            if not forms:
                break
        return self.archive

    def _gap_points(self) -> Array:
        """Return scaled objectives (n, m) in gaps between optima, farthest from all first; empty if there are none.

        They are non-dominated samples, and midpoints between neighbouring optima: those with no other optimum in the
        ball between them (K. R. Gabriel and R. R. Sokal, "A new statistical approach to geographic variation analysis",
        Syst. Zool. 18(3), 1969). No point is aimed at twice, because its optimum may lie elsewhere.
        """
        from scipy.spatial import distance_matrix

        optima = self.scaled(self.archive.values)
        missing = int(_MORE * self.problem.settings.designs) - len(optima)
        if missing <= 0:
            return optima[:0]
        sampled = self.scaled(self.samples.values)
        sampled = sampled[nondominated(sampled)]
        aims = np.concatenate([sampled[:: 1 + len(sampled) // _POOL], _gabriel_middles(optima)])
        away = distance_matrix(aims, np.concatenate([optima, self.aimed])).min(axis=1)
        picked: list[int] = []
        while len(picked) < min(missing, len(aims)):
            picked.append(int(np.argmax(away)))
            away = np.minimum(away, np.linalg.norm(aims - aims[picked[-1]], axis=1))
        self.aimed = np.concatenate([self.aimed, aims[picked]])
        return np.asarray(aims[picked])

    def _best_starts_per_branch(self, form: Form) -> list[tuple[int, Array]]:
        """Return the best point on every branch, unless it is clearly worse than that on another."""
        points = self.archive.join(self.samples)
        scaled = self.scaled(points.values)
        excess = np.maximum(scaled - form.ceilings, 0.0).max(axis=1)
        merits = replace(form, ceilings=np.full(len(form.weights), np.inf)).form_value(scaled) + 10.0 * excess
        starts: list[tuple[float, int, Array]] = []
        for index in np.unique(points.branch).tolist():
            on_branch = np.flatnonzero(points.branch == index)
            row = on_branch[np.argmin(merits[on_branch])]
            starts.append((float(merits[row]), index, points.u[row]))
        least = min(value for value, _, _ in starts)
        return [(index, u) for value, index, u in starts if value <= least + _WORSE]


def simplex_weights(objectives: int, least: int) -> Array:
    """Return at least `least` points (n, m) of the unit simplex: all sums of m multiples of 1 / p.

    I. Das and J. E. Dennis, "Normal-boundary intersection: a new method for generating the Pareto surface in nonlinear
    multicriteria optimization problems", SIAM J. Optim. 8(3), 1998, sec. 4.
    """
    parts = 1
    while comb(parts + objectives - 1, objectives - 1) < least:
        parts += 1
    bars = itertools.combinations(range(parts + objectives - 1), objectives - 1)
    ends = np.array([(-1, *bar, parts + objectives - 1) for bar in bars])
    return np.asarray((np.diff(ends, axis=1) - 1) / parts)


def grid_points(lower: Array, upper: Array, parts: int) -> Array:
    """Return the (parts^m, m) points at the upper ends of equal intervals between bounds (m,) each."""
    steps = np.arange(1, parts + 1) / parts
    places = np.array(list(itertools.product(steps, repeat=len(lower))))
    return np.asarray(lower + places * (upper - lower))


def _gabriel_middles(points: Array) -> Array:
    """Return the midpoints (n, m) of the edges in the Gabriel graph of points."""
    from scipy.spatial import distance_matrix

    first, second = np.triu_indices(len(points), 1)
    middles = 0.5 * (points[first] + points[second])
    is_crowded = (
        distance_matrix(middles, points) < 0.5 * np.linalg.norm(points[first] - points[second], axis=1)[:, None]
    )
    is_crowded[np.arange(len(first)), first] = is_crowded[np.arange(len(first)), second] = False
    return np.asarray(middles[~is_crowded.any(axis=1)])


def _aims_per_round(problem: Problem) -> int:
    """Return the number of evenly distributed aims. With two objectives the front is a line, and all optima differ."""
    share = _MORE if len(problem.objectives) == 2 else _FIRST
    return max(1, int(share * problem.settings.designs))


def _payoff_front(problem: Problem, evaluators: list[Evaluator], run: Run) -> _Front | None:
    """Return samples and payoff table; None if there are no starts."""
    m = len(problem.objectives)
    sampled = starting_samples(problem, evaluators)
    front = Archive.empty(m)
    run.archive.add_designs(sampled[sampled.is_feasible])
    if not len(sampled):
        run.report_round("sampling", evaluators, front)
        return None
    ideal, span = ideal_and_range(sampled.values[nondominated(sampled.values)])
    shared = _Front(problem, evaluators, run, sampled, front, ideal, span, np.zeros((m, m)), np.zeros((0, m)))
    run.rounds = 1 + m
    run.report_round("sampling", evaluators, front)
    for column in range(m):
        best = np.full(m, np.inf)
        for row in sampled.leading_rows(column, _STARTS):
            values = shared.archive_optimum_of_form(
                Form.of_single_objective(m, column, rho=SUM), int(sampled.branch[row]), sampled.u[row]
            )
            if values is not None and values[column] < best[column]:
                best = values
        if not np.isfinite(best).all():
            return None
        shared.payoff[column] = best
        run.report_round("finding the best design for each objective", evaluators, front)
    shared.ideal, shared.span = ideal_and_range(shared.payoff)
    return shared


def scalarised(problem: Problem, evaluators: list[Evaluator], run: Run, *, aims: Callable[[_Front], Aims]) -> Archive:
    """Return the front found with the forms of a method."""
    front = _payoff_front(problem, evaluators, run)
    return Archive.empty(len(problem.objectives)) if front is None else front.solve_forms(*aims(front))


_scalarisation = partial(Method, family="scalarisation", objectives="several", budget=100_000, uses=("scipy",))
EPSILON_CONSTRAINT = _scalarisation(
    name="epsilon_constraint",
    title="Epsilon-constraint",
    help="Minimises the first objective with upper limits on all others, over a grid of limits.",
    search=partial(scalarised, aims=epsilon_constraint),
)
CHEBYSHEV = _scalarisation(
    name="chebyshev",
    title="Weighted Chebyshev",
    help="Minimises the greatest weighted distance from a point below all designs, in evenly spread directions.",
    search=partial(scalarised, aims=chebyshev),
)
NBI = _scalarisation(
    name="nbi",
    title="Normal-boundary intersection",
    help="Moves as far as possible along the normal to the plane through the optima of the single objectives.",
    search=partial(scalarised, aims=nbi),
)
