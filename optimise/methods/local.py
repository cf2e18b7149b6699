"""SciPy's gradient methods for one objective, from many starts; and its local solvers on a scalar programme."""

import warnings
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from ...model.arrays import Array
from ..problem.constraint_violation import FEASIBLE
from ..problem.problem import Problem
from ..search.assemble_front import objective_ranges
from ..search.candidates import Candidates
from ..search.evaluation import Evaluator
from ..search.sample_and_zoom import BANDS, Archive, Run
from ..search.sampling import first_samples
from .registry import Method, evaluation_budget
from .scalar_objective import Form, Programme

SAMPLES = 16384
"""Samples over all branches."""
_ENOUGH = 32
_STREAM = 3000  # of the seed
VIOLATION = 1e-6
"""Relative violation that a solver may leave: the delivery moves the design onto the constraints."""
_STEPS = 100
_AGAIN = 6
_STAYS = 1e-8  # distance in the unit box within which a run ends where it started
_BARRIER_STEPS = 100
_ATTEMPTS = 3
_MARGIN, _NEARER = 0.1, 0.3  # relative to the objectives' range: initial barrier margin, and its reduction factor
_INSIDE = 1e-6  # distance in the unit box: a barrier cannot start on a bound
_EXACT = 1e-12  # relative to the objective's range

Local = Callable[[Programme, Array], Array | None]


def starting_samples(problem: Problem, evaluators: list[Evaluator]) -> Candidates:
    """Return feasible samples from all branches; if there are few, also samples with violations of up to 16 %.

    Solvers remove the violation. No sample meets the remaining equalities.
    """
    loose = any(evaluator.loose for evaluator in evaluators)
    for attempt, band in enumerate(BANDS[1:] if loose else BANDS):
        parts = []
        for index, evaluator in enumerate(evaluators):
            count = -(-SAMPLES * 4 ** min(attempt, 1) // len(evaluators))
            u = first_samples(count, evaluator.dimension, problem.settings.seed, _STREAM + 10 * attempt + index)
            _, values, violation = evaluator.screen_designs_objectives_violation(u, band=band)
            good = (violation <= band + FEASIBLE) & evaluator.can_evaluate(u)
            feasible = violation[good] <= FEASIBLE
            parts.append(Candidates(np.full(len(feasible), index), u[good], values[good], feasible))
        sampled = parts[0].join(*parts[1:])
        if len(sampled) >= _ENOUGH:
            break
    return sampled


def search_from_starts(
    problem: Problem, evaluators: list[Evaluator], run: Run, *, solve: Local, starts: int
) -> Archive:
    """Return the local optima that a solver finds from `starts` starts, which are the best distant samples."""
    sampled = starting_samples(problem, evaluators)
    archive = Archive.empty(1)
    run.archive.add_designs(sampled[sampled.is_feasible])
    if not len(sampled):
        run.report_round("sampling", evaluators, archive)
        return archive
    ideal, span = sampled.values.min(axis=0), objective_ranges(problem, sampled.values)
    rows = sampled.leading_rows(0, starts)
    run.rounds = 1 + len(rows)
    run.report_round("sampling", evaluators, archive)
    for row in rows:
        if len(archive) and is_budget_spent(problem, evaluators):
            break
        index = int(sampled.branch[row])
        programme = Programme(evaluators[index], Form.of_single_objective(1, 0), ideal, span)
        archive_optimum(solve, programme, sampled.u[row], archive, index)
        run.report_round("descending", evaluators, archive)
    return archive


def is_budget_spent(problem: Problem, evaluators: list[Evaluator]) -> bool:
    """Whether the evaluation budget is used up."""
    return bool(np.sum([evaluator.evaluations for evaluator in evaluators]) >= evaluation_budget(problem))


def archive_optimum(solve: Local, programme: Programme, u: Array, archive: Archive, index: int) -> Array | None:
    """Add the optimum near u (k,), a recorded step, to an archive; return its objectives (m,), SI, or None."""
    form, scaling, u = programme.form, (programme.ideal, programme.span), u[: programme.k]
    inputs = (u, form.weights, form.reference, form.ceilings, np.array([form.rho]), *scaling)

    def compute() -> tuple[Array, ...]:
        optimum = solve(programme, u)
        return () if optimum is None else (optimum, programme.objectives(optimum))

    optimum_and_values = programme.evaluator.recorded_step("descent", inputs, compute)
    if not optimum_and_values:
        return None
    values = np.asarray(optimum_and_values[1] * programme.span + programme.ideal)
    archive.add_points(index, optimum_and_values[0][None], values[None])
    archive.feasible += 1
    return values


def by_slsqp(programme: Programme, u: Array) -> Array | None:
    """Return the optimum near u (k,) by sequential least squares programming, None if it is not feasible.

    D. Kraft, "A software package for sequential quadratic programming", DFVLR-FB 88-28, 1988. It mistakes a short step
    for an optimum. So it restarts at its end point, without the learnt curvature and with the pieces that are highest
    there, until it no longer moves.
    """
    best = None
    for _ in range(_AGAIN):
        optimum = _feasible_point(programme, _slsqp_run(programme, u))
        if optimum is None:
            break
        moved = np.abs(optimum - u).max(initial=0.0)
        best = u = optimum
        if moved <= _STAYS:
            break
    return best


def _slsqp_run(programme: Programme, u: Array) -> Array:
    from scipy.optimize import minimize

    minimised: Any = minimize  # its stubs do not allow mixed arguments
    constraints: list[dict[str, Any]] = [
        {"type": "ineq", "fun": lambda z: -programme.inequalities(z), "jac": lambda z: -programme.inequality_slopes(z)}
    ]
    begin = programme.start_vector(u)
    if len(programme.equalities(begin)):
        constraints.append({"type": "eq", "fun": programme.equalities, "jac": programme.equality_slopes})
    solution = minimised(
        lambda z: programme.cost @ z,
        begin,
        jac=lambda z: programme.cost,
        method="SLSQP",
        bounds=list(zip(programme.lower, programme.upper, strict=True)),
        constraints=constraints,
        options={"ftol": _EXACT, "maxiter": _STEPS},
    )
    return np.asarray(solution.x)


def by_trust_constr(programme: Programme, u: Array) -> Array | None:
    """Return the optimum near u (k,) by the trust-region interior-point method, None if it is not feasible.

    R. H. Byrd, M. E. Hribar and J. Nocedal, "An interior point algorithm for large-scale nonlinear programming", SIAM
    J. Optim. 9(4), 1999. A peak that appears or vanishes makes a slack jump, which may end the search early: the search
    then restarts, closer to the limits. It stays within the inequalities, unless u lies on one. It does not support
    equalities.
    """
    for attempt in range(_ATTEMPTS):
        end, converged = _interior_point_run(programme, u, _MARGIN * _NEARER**attempt)
        best = _feasible_point(programme, end)
        if best is None or converged:
            break
        u = best
    return best


def _interior_point_run(programme: Programme, u: Array, margin: float) -> tuple[Array, bool]:
    """Return the end of one interior-point run, and whether it is an optimum. margin: distance between s and t."""
    from scipy.optimize import BFGS, Bounds, NonlinearConstraint, minimize

    minimised: Any = minimize
    begin = programme.start_vector(np.clip(u, _INSIDE, 1.0 - _INSIDE))
    begin[programme.k :] += margin
    begin[-1] += margin * programme.form.weights.max()
    starts_inside = bool((programme.inequalities(begin) < 0.0).all() and (begin < programme.upper).all())
    limits = [
        NonlinearConstraint(programme.inequalities, -np.inf, 0.0, programme.inequality_slopes, BFGS(), starts_inside)
    ]
    no_curvature = np.zeros((len(begin), len(begin)))
    with warnings.catch_warnings():
        # Intermediate rows may be dependent and slopes constant, which SciPy can handle.
        warnings.simplefilter("ignore", UserWarning)
        solution = minimised(
            lambda z: programme.cost @ z,
            begin,
            jac=lambda z: programme.cost,
            hess=lambda z: no_curvature,
            method="trust-constr",
            bounds=Bounds(programme.lower, programme.upper, keep_feasible=starts_inside),
            constraints=limits,
            options={"gtol": 0.0, "xtol": 1e-10, "barrier_tol": 1e-10, "maxiter": _BARRIER_STEPS},
        )
    return np.asarray(solution.x), solution.status == 2


def _feasible_point(programme: Programme, z: Array) -> Array | None:
    u = np.clip(z[: programme.k], 0.0, 1.0)
    if not np.isfinite(u).all():
        return None
    return u if programme.violation(u) <= VIOLATION + FEASIBLE else None


_gradient = partial(Method, family="gradient", objectives="one", budget=20_000, uses=("scipy",))
SLSQP = _gradient(
    name="slsqp",
    title="SLSQP",
    help="SciPy's sequential least-squares programming from many starts; peaks are rows of the epigraph form.",
    search=partial(search_from_starts, solve=by_slsqp, starts=24),
)
TRUST_CONSTR = _gradient(
    name="trust_constr",
    title="trust-constr",
    help="SciPy's interior-point method from a few starts; peaks are rows of the epigraph form.",
    search=partial(search_from_starts, solve=by_trust_constr, starts=8),
    equalities=False,
)
