"""Least greatest-of-pieces over the designs of a problem, by sequential convex programming: least peak torque first.

A peak over the cycle is the greatest of its local peaks, max_p f_p(u), over continuous crank angle; at the optimum
several are often equally high, where the peak has a kink and no gradient. Nothing is smoothed: each iteration
linearises every local peak and every constraint at the present design (exact values and gradients; a local peak's
gradient is that at its crank angle, by the envelope theorem) and solves the convex programme of `subproblem` within a
trust region. The step is judged by actual over predicted decrease of the exact penalty function

    max_p f_p(u) + w max(0, max_j c_j(u)),

and corrected to second order before it is refused (Conn, Gould and Toint, "Trust-Region Methods", 2000, ch. 11 and
15.3). Where as many pieces and constraints hold the optimum as there are unknowns, first-order steps converge
quadratically; where fewer do, the curvature of the Lagrangian, by differences of exact gradients with the multipliers
of the step before, keeps them fast.

What proves the optimum are the multipliers of the last programme: weights of the pieces that add up to one and prices
of the constraints, for which

    sum_p lambda_p grad f_p + sum_j mu_j grad c_j + bounds = 0,   lambda_p (max f - f_p) = 0,   mu_j c_j = 0

to the residual (Karush-Kuhn-Tucker). The proof is local; that no other valley is deeper rests on the starts.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ....model.errors import InputError
from ....objectives.cycle_peak import CyclePeak
from ...front.stationarity import Array
from ...problem.problem import Problem
from ...search.checkpoints import floats
from ...search.elimination import sheets
from ...search.evaluation import FEASIBLE, Evaluator
from ...search.sampling import apart, first_samples
from ...search.search import SAMPLES, Archive, Run, explore
from ..method import Method
from ..registry import budget
from .scp import Descent, Point

STARTS = 12
"""Designs that the programme starts from, the best screened ones that are apart."""
OPTIMAL = 1e-6
"""Residual that counts as optimal."""
_LAST = 4096  # samples for the starts where none is feasible
_CARRIES = 1e-7  # multipliers below it are the solver's rounding


@dataclass(frozen=True)
class ActivePiece:
    """A piece that ties for the greatest: crank angle, rad (None: no peak over the cycle), SI value, weight."""

    crank_angle: float | None
    value: float
    weight: float


@dataclass(frozen=True)
class MinimaxResult:
    """The least greatest-of-pieces of a problem, and what proves it.

    dimensions: (3,) crank, rod, offset, m. value: of the objective as it is minimised, SI. pieces: those that carry the
    optimum, highest weight first; weights add up to one. rates: derivatives of the value by the bounds that hold
    it, SI over SI, by constraint, and by dimension at an end of its range (of the offset by its size). residual: norm
    of what the multipliers leave of the gradients, plus complementarity gap, plus violation; value and unit box scaled
    to one. iterations: of all starts. values: (n,) that the starts ended with.
    """

    dimensions: Array
    value: float
    pieces: tuple[ActivePiece, ...]
    rates: dict[str, float]
    residual: float
    violation: float
    iterations: int
    evaluations: int
    values: Array

    @property
    def optimal(self) -> bool:
        """Whether the multipliers prove a local optimum to 1e-6."""
        return self.residual <= OPTIMAL

    @property
    def active_angles(self) -> Array:
        """Crank angles of the peaks that tie, rad."""
        return np.array([piece.crank_angle for piece in self.pieces if piece.crank_angle is not None])


def minimise_peak(problem: Problem, *, starts: int = STARTS) -> MinimaxResult:
    """Return the least value of a problem's only objective with its active crank angles, multipliers and residual.

    Any quantity can be the objective; one that is the greatest of pieces is what this is for. starts: designs to start
    from. Raises `InputError` for several objectives, and where no start becomes feasible.
    """
    if len(problem.objectives) != 1:
        names = ", ".join(objective.quantity for objective in problem.objectives)
        raise InputError(f"the minimax takes one objective; got {names}; keep one and constrain the others")
    evaluators = [Evaluator(problem, sheet) for sheet in sheets(problem)]
    archive = explore(problem, evaluators)
    scale, begin = _starts(problem, evaluators, archive, starts)
    descents = [Descent(evaluator, scale) for evaluator in evaluators]
    ends = ((index, descents[index].run(u)) for index, u in begin)
    found = [(index, end) for index, end in ends if end.violation <= FEASIBLE]
    if not found:
        raise InputError(
            f"no design of {problem.name!r} that meets all requirements was found; widen the ranges or the limits"
        )
    index, best = min(found, key=lambda item: item[1].top)
    return _result(evaluators[index], best, scale, found, sum(evaluator.evaluations for evaluator in evaluators))


def minimax(problem: Problem, evaluators: list[Evaluator], run: Run) -> Archive:
    """Return the optima that the descents ended in, each a local one; the method "minimax" of a job."""
    screened = explore(_within_budget(problem), evaluators, run)
    scale, begin = _starts(problem, evaluators, screened, STARTS)
    run.rounds = len(run.told) + len(begin)
    descents = [Descent(evaluator, scale) for evaluator in evaluators]
    archive = Archive.empty(1)
    for index, u in begin:
        if sum(evaluator.evaluations for evaluator in evaluators) >= budget(problem):
            break
        end, top, violation = _end(evaluators[index], descents[index], u)
        if violation <= FEASIBLE:
            archive.take(index, end[None], np.array([[top * scale]]))
        run.tell("descending", evaluators, archive)
    return archive


def _end(evaluator: Evaluator, descent: Descent, u: Array) -> tuple[Array, float, float]:
    """Return where the descent from a point ends, with its greatest piece and its violation; a recorded step."""

    def compute() -> tuple[Array, Array]:
        point = descent.run(u)
        return point.u, np.array([point.top, point.violation])

    end, measures = evaluator.step("descent", (u, np.array([descent.scale])), compute)
    top, violation = floats(measures).tolist()
    return floats(end), top, violation


def _within_budget(problem: Problem) -> Problem:
    """Return the problem with samples that leave evaluations to the descents: exploring takes 5 to 25 times them."""
    allowed = problem.settings.evaluations
    if allowed is None:
        return problem
    samples = min(problem.settings.samples or SAMPLES, max(16, allowed // 32))
    return replace(problem, settings=replace(problem.settings, samples=samples))


def _starts(
    problem: Problem, evaluators: list[Evaluator], archive: Archive, count: int
) -> tuple[float, list[tuple[int, Array]]]:
    """Return the objective's scale, and sheet and point of the designs to start from.

    They are the best designs of an archive that are apart, or where it is empty what violates least.
    """
    rows = apart(archive.values[:, 0], archive.u, archive.sheet, count)
    begin = [(int(archive.sheet[row]), archive.u[row]) for row in rows]
    begin = begin or _nearest(evaluators, count)
    begin = [(index, u[: evaluators[index].dimension]) for index, u in begin]
    values = archive.values[:, 0]
    if not len(values):
        values = np.array([_top(evaluators[index], u) for index, u in begin])
    return _scale(problem, values), begin


def _top(evaluator: Evaluator, u: Array) -> float:
    """Return the greatest piece at a point; a recorded step."""
    found = evaluator.step("top", (u,), lambda: (evaluator.exact(u[None])[0].values.max(axis=1),))
    return float(found[0][0])


def _scale(problem: Problem, values: Array) -> float:
    """Return the scale of the objective: its best size, or its spread where a target can be met."""
    if not len(values):
        return 1.0
    target = abs(problem.objectives[0].target or 0.0)
    return float(max(abs(values.min()), target) or np.ptp(values) or 1.0)


def _nearest(evaluators: list[Evaluator], count: int) -> list[tuple[int, Array]]:
    """Return sheets and points that violate the constraints least, where no sample comes near to meeting them."""
    found: list[tuple[float, int, Array]] = []
    for index, evaluator in enumerate(evaluators):
        u = first_samples(_LAST, evaluator.dimension, evaluator.problem.settings.seed, 400 + index)
        violation = evaluator.screen(u)[2]
        rows = np.argsort(violation, kind="stable")[:count]
        found += [(float(violation[row]), index, u[row]) for row in rows[np.isfinite(violation[rows])].tolist()]
    return [(index, u) for _, index, u in sorted(found, key=lambda item: item[0])[:count]]


def _result(
    evaluator: Evaluator, point: Point, scale: float, found: list[tuple[int, Point]], evaluations: int
) -> MinimaxResult:
    objective = evaluator.problem.objectives[0]
    peaks = isinstance(evaluator.problem.quantity(objective.quantity), CyclePeak)
    weights = point.step.goals if point.step is not None else (point.goals.values == point.top).astype(np.float64)
    pieces = [
        ActivePiece(
            float(point.goals.labels[row]) if peaks else None,
            float(point.goals.values[row]) * scale,
            float(weights[row] / weights.sum()),
        )
        for row in np.flatnonzero(weights > _CARRIES).tolist()
    ]
    return MinimaxResult(
        dimensions=evaluator.sheet.dimensions(point.u)[0],
        value=point.top * scale,
        pieces=tuple(sorted(pieces, key=lambda piece: -piece.weight)),
        rates=_rates(evaluator, point, scale),
        residual=point.residual,
        violation=point.violation,
        iterations=sum(end.iterations for _, end in found),
        evaluations=evaluations,
        values=np.array([end.top for _, end in found]) * scale,
    )


def _rates(evaluator: Evaluator, point: Point, scale: float) -> dict[str, float]:
    """Return the derivatives of the value by the bounds that hold it; an equality has one for both its rows."""
    rates: dict[str, float] = {}
    if point.step is None:
        return rates
    owners = point.limits.owner
    for row in np.flatnonzero(point.step.limits > _CARRIES).tolist():
        owner = int(owners[row])
        # The rows of an upper bound come first; a lower bound has one row, the last.
        last = row == int(np.flatnonzero(owners == owner)[-1])
        side, _, unit = evaluator.sides(owner)[-1 if last else 0]
        name = evaluator.owner_name(owner)
        rates[name] = rates.get(name, 0.0) + -side * float(point.step.limits[row]) * scale / unit
    sheet, below, above = evaluator.sheet, point.step.below, point.step.above
    for column in np.flatnonzero(np.maximum(below, above) > _CARRIES).tolist():
        width = float(sheet.upper[column] - sheet.lower[column])
        rates[sheet.free[column]] = float(below[column] - above[column]) * scale / width
    return rates


MINIMAX = Method(
    name="minimax",
    title="Minimax",
    help="Sequential convex programming on all peaks over the cycle at once, without smoothing.",
    family="gradient",
    objectives="one",
    search=minimax,
    budget=50_000,
    uses=("cvxpy",),
)
