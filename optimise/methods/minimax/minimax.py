"""Minimise the greatest of smooth pieces by sequential convex programming, such as the peak torque.

A peak over the cycle is the greatest of its local peaks, max_p f_p(u), over continuous crank angle. At the optimum,
several are often equally high; there the peak has a kink and no gradient. Nothing is smoothed. Each iteration
linearises every local peak and every constraint at the current design, and solves the convex programme of `subproblem`
within a trust region. Values and gradients are exact; a local peak's gradient is that at its crank angle, by the
envelope theorem. The step is judged by actual over predicted decrease of the exact penalty function

    max_p f_p(u) + w max(0, max_j c_j(u)),

and corrected to second order before it is rejected (Conn, Gould and Toint, "Trust-Region Methods", 2000, ch. 11 and
15.3). If as many pieces and constraints as unknowns determine the optimum, first-order steps converge quadratically. If
fewer do, the curvature of the Lagrangian keeps them fast; it comes from differences of exact gradients with the
previous step's multipliers.

The multipliers of the last programme prove the optimum: weights of the pieces that add up to one, and prices of the
constraints, with

    sum_p lambda_p grad f_p + sum_j mu_j grad c_j + bounds = 0,   lambda_p (max f - f_p) = 0,   mu_j c_j = 0

to within the residual (Karush-Kuhn-Tucker). The proof is local; only more starts can show that no other valley is
deeper.
"""

from dataclasses import replace

import numpy as np

from ....model.arrays import Array
from ...problem.constraint_violation import FEASIBLE
from ...problem.problem import Problem
from ...search.evaluation import Evaluator
from ...search.sample_and_zoom import SAMPLES, Archive, Run, sample_and_zoom
from ...search.sampling import distant_rows, first_samples
from ..local import is_budget_spent
from ..registry import Method
from .scp import Descent

STARTS = 12
"""Number of starting points for the programme: the best screened designs that are far enough apart."""
_LAST = 4096  # samples for the starts if none is feasible


def minimax(problem: Problem, evaluators: list[Evaluator], run: Run) -> Archive:
    """Return the local optima at which the descents ended."""
    screened = sample_and_zoom(_limit_samples(problem), evaluators, run)
    scale, begin = descent_starts(problem, evaluators, screened)
    run.expect_rounds(len(begin))
    descents = [Descent(evaluator, scale) for evaluator in evaluators]
    archive = Archive.empty(1)
    for index, u in begin:
        if is_budget_spent(problem, evaluators):
            break
        end, top, violation = _descend_recorded(evaluators[index], descents[index], u)
        if violation <= FEASIBLE:
            archive.add_points(index, end[None], np.array([[top * scale]]))
        run.report_round("descending", evaluators, archive)
    return archive


def _descend_recorded(evaluator: Evaluator, descent: Descent, u: Array) -> tuple[Array, float, float]:
    """Return the end of the descent from a point, with its greatest piece and its violation; a recorded step."""

    def compute() -> tuple[Array, Array]:
        point = descent.descend_from(u)
        return point.u, np.array([point.greatest_piece, point.violation])

    end, measures = evaluator.recorded_step("descent", (u, np.array([descent.scale])), compute)
    top, violation = measures.tolist()
    return end, top, violation


def _limit_samples(problem: Problem) -> Problem:
    """Return the problem with fewer samples to leave evaluations to descents; exploring takes 5 to 25 times more."""
    allowed = problem.settings.evaluations
    if allowed is None:
        return problem
    samples = min(problem.settings.samples or SAMPLES, max(16, allowed // 32))
    return replace(problem, settings=replace(problem.settings, samples=samples))


def descent_starts(
    problem: Problem, evaluators: list[Evaluator], archive: Archive
) -> tuple[float, list[tuple[int, Array]]]:
    """Return the objective's scale, and branch and point of each start.

    They are the best distinct designs of an archive, or the least violating points if it is empty.
    """
    rows = distant_rows(archive.values[:, 0], archive.u, archive.branch, STARTS)
    begin = [(int(archive.branch[row]), archive.u[row]) for row in rows]
    begin = begin or _least_violating_points(evaluators)
    begin = [(index, u[: evaluators[index].dimension]) for index, u in begin]
    values = archive.values[:, 0]
    if not len(values):
        values = np.array([_highest_piece(evaluators[index], u) for index, u in begin])
    return _objective_scale(problem, values), begin


def _highest_piece(evaluator: Evaluator, u: Array) -> float:
    """Return the greatest piece at a point; a recorded step."""
    heights = evaluator.recorded_step(
        "top", (u,), lambda: (evaluator.objective_and_constraint_rows(u[None])[0].values.max(axis=1),)
    )
    return float(heights[0][0])


def _objective_scale(problem: Problem, values: Array) -> float:
    """Return the scale of the objective: its best magnitude, or its spread if a target can be met."""
    if not len(values):
        return 1.0
    target = abs(problem.objectives[0].target or 0.0)
    return float(max(abs(values.min()), target) or np.ptp(values) or 1.0)


def _least_violating_points(evaluators: list[Evaluator]) -> list[tuple[int, Array]]:
    """Return the branches and points that violate the constraints least, if no sample comes close to meeting them."""
    ranked: list[tuple[float, int, Array]] = []
    for index, evaluator in enumerate(evaluators):
        u = first_samples(_LAST, evaluator.dimension, evaluator.problem.settings.seed, 400 + index)
        violation = evaluator.screen_designs_objectives_violation(u)[2]
        rows = np.argsort(violation, kind="stable")[:STARTS]
        ranked += [(float(violation[row]), index, u[row]) for row in rows[np.isfinite(violation[rows])].tolist()]
    return [(index, u) for _, index, u in sorted(ranked, key=lambda item: item[0])[:STARTS]]


MINIMAX = Method(
    name="minimax",
    title="Minimax",
    help="Sequential convex programming on all peaks over the cycle simultaneously, without smoothing.",
    family="gradient",
    objectives="one",
    search=minimax,
    budget=50_000,
    uses=("cvxpy",),
)
