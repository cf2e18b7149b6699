"""SciPy's global methods for one objective."""

from functools import partial
from typing import Any

import numpy as np

from ...model.arrays import Array
from ..problem.constraint_violation import FEASIBLE
from ..problem.problem import Problem
from ..search.assemble_front import objective_ranges
from ..search.evaluation import Evaluator
from ..search.sample_and_zoom import Archive, Run
from ..search.sampling import random_generator
from .local import archive_optimum, by_slsqp
from .registry import Method, evaluation_budget
from .scalar_objective import Form, Programme

_POPULATION = 20  # members per unknown, in differential evolution
_RECOMBINATION = 0.9  # high, because such valleys are not aligned with an axis
_CONVERGED = 1e-12  # relative to the objective: spread at which a population has converged
_REPORT_EVERY = 20  # generations between two entries of the history
_FAR = 1e3  # violation where no linkage rotates fully
_STREAM = 3500  # of the seed
_SAMPLED = 256  # points per iteration of SHGO
_ITERATIONS = 3
_ROUGH = 5  # steps of SHGO's own descent, which cannot handle kinks; the epigraph form continues
_BASINS = 12


class _ExactEvaluation:
    """Objective and violation on one branch for a solver that requests them in turn.

    Values are exact, because the error of a screened peak may exceed the remaining gain near the optimum.
    """

    def __init__(self, index: int, evaluator: Evaluator, improvements: Archive) -> None:
        """Evaluate the branch with this index; the archive collects improvements."""
        self.index, self.evaluator, self.improvements = index, evaluator, improvements
        self.known: dict[bytes, float] = {}
        self.best = np.inf

    def violation(self, u: Array) -> Array:
        """Return the greatest relative violation (n,) of points (n, k), zero where all constraints hold."""
        u = np.ascontiguousarray(u)
        values, violation = self.evaluator.recorded_step("points", (u,), lambda: self._evaluate(u))
        self.known = {
            point.tobytes(): value
            for point, value, feasible in zip(u, values.tolist(), violation <= FEASIBLE, strict=True)
            if feasible and np.isfinite(value)
        }
        best = min(self.known, key=self.known.__getitem__, default=b"")
        if best and self.known[best] < self.best:
            self.best = self.known[best]
            self.improvements.add_points(self.index, np.frombuffer(best)[None], np.array([[self.best]]))
        return np.where(violation <= FEASIBLE, 0.0, violation)

    def _evaluate(self, u: Array) -> tuple[Array, Array]:
        """Return objective and violation (n,) of points; infinite and `_FAR` where no linkage rotates fully."""
        values, violation = np.full(len(u), np.inf), np.full(len(u), _FAR)
        valid = np.flatnonzero(self.evaluator.can_evaluate(u))
        if len(valid):
            goals, limits = self.evaluator.objective_and_constraint_rows(u[valid])
            values[valid] = goals.values.max(axis=1)
            violation[valid] = np.minimum(limits.values.max(axis=1, initial=0.0), _FAR)
        return values, violation

    def objective(self, u: Array) -> Array:
        """Return the minimised objective (n,) of points that were found feasible."""
        u = np.ascontiguousarray(u)
        if not all(point.tobytes() in self.known for point in u):
            self.violation(u)
        return np.array([self.known.get(point.tobytes(), np.inf) for point in u])


def differential_evolution(problem: Problem, evaluators: list[Evaluator], run: Run) -> Archive:
    """Return the optimum from differential evolution, with part of the budget for each branch.

    Constraints follow the rule that a feasible design beats an infeasible one, and a smaller violation beats a greater
    one (J. Lampinen, "A constraint handling approach for the differential evolution algorithm", CEC 2002), without
    penalties.
    """
    archive, improvements = Archive.empty(1), Archive.empty(1)
    run.archive = improvements
    for index in range(len(evaluators)):
        _evolve_branch(problem, evaluators, index, archive, improvements, run)
    run.report_round("evolving", evaluators, archive)
    return archive


def _evolve_branch(
    problem: Problem, evaluators: list[Evaluator], index: int, archive: Archive, improvements: Archive, run: Run
) -> None:
    """Add the optimum on one branch to the archive, and every improvement to `improvements`."""
    from scipy.optimize import NonlinearConstraint
    from scipy.optimize import differential_evolution as evolve

    evaluator = evaluators[index]
    k, count = evaluator.dimension, 0
    members = 1 << (_POPULATION * k - 1).bit_length()  # SciPy generates Sobol points in powers of two
    generations = max(1, evaluation_budget(problem) // (len(evaluators) * members) - 1)
    run.expect_rounds(1 + generations // _REPORT_EVERY)
    exact = _ExactEvaluation(index, evaluator, improvements)

    def report_generation(intermediate_result: Any) -> bool:
        nonlocal count
        count += 1
        if count % _REPORT_EVERY:
            return False
        archive.screen(index, evaluator, np.asarray(intermediate_result.x)[None])
        run.report_round("evolving", evaluators, archive)
        return False

    minimised: Any = evolve  # its stubs do not allow a function of many points
    optimum = minimised(
        lambda x: exact.objective(x.T),
        [(0.0, 1.0)] * k,
        constraints=NonlinearConstraint(
            lambda x: exact.violation(np.atleast_2d(x.T)).reshape(1, *x.shape[1:]), -np.inf, FEASIBLE
        ),
        maxiter=generations,
        strategy="rand1bin",  # best1bin loses diversity in valleys along the kink of two peaks
        recombination=_RECOMBINATION,
        popsize=_POPULATION,
        tol=_CONVERGED,
        init="sobol",
        rng=random_generator(problem.settings.seed, _STREAM, index),
        polish=False,
        updating="deferred",
        vectorized=True,
        callback=report_generation,
    )
    archive.screen(index, evaluator, np.clip(optimum.x, 0.0, 1.0)[None])


def shgo(problem: Problem, evaluators: list[Evaluator], run: Run) -> Archive:
    """Return the optima of the basins found by simplicial homology, with part of the budget for each branch.

    S. C. Endres, C. Sandrock and W. W. Focke, "A simplicial homology algorithm for Lipschitz optimisation", J. Glob.
    Optim. 72, 2018. It identifies basins from feasible Sobol points and descends into each. If a peak has a kink, the
    descent ends short of the optimum, so the epigraph form (`scalar_objective`) continues from there.
    """
    archive, improvements = Archive.empty(1), Archive.empty(1)
    run.archive = improvements
    run.rounds = 1 + len(evaluators)
    for index in range(len(evaluators)):
        _search_basins(problem, evaluators, index, archive, improvements)
        run.report_round("descending", evaluators, archive)
    return archive


def _search_basins(
    problem: Problem, evaluators: list[Evaluator], index: int, archive: Archive, improvements: Archive
) -> None:
    """Add the optima of one branch's basins to the archive, and every improvement to `improvements`."""
    from scipy.optimize import shgo as homology

    evaluator = evaluators[index]
    exact = _ExactEvaluation(index, evaluator, improvements)
    points = max(16, min(_SAMPLED, evaluation_budget(problem) // (4 * len(evaluators))))
    searched: Any = homology
    optima = searched(
        lambda u: float(exact.objective(u[None])[0]),
        [(0.0, 1.0)] * evaluator.dimension,
        constraints={"type": "ineq", "fun": lambda u: -exact.violation(u[None])},
        n=points,
        iters=_ITERATIONS,
        sampling_method="sobol",
        minimizer_kwargs={"method": "SLSQP", "options": {"maxiter": _ROUGH}},
        options={"minimize_every_iter": False},
    )
    basins = np.clip(np.atleast_2d(getattr(optima, "xl", np.zeros((0, evaluator.dimension)))), 0.0, 1.0)
    basins = basins[evaluator.can_evaluate(basins)][:_BASINS] if len(basins) else basins
    if not len(basins):
        return
    values = evaluator.screen_designs_objectives_violation(basins, band=np.inf)[1]
    ideal, span = np.nanmin(values, axis=0), objective_ranges(problem, values)
    for start in basins:
        archive_optimum(
            by_slsqp, Programme(evaluator, Form.of_single_objective(1, 0), ideal, span), start, archive, index
        )


_global = partial(Method, family="global", objectives="one", budget=50_000, uses=("scipy",), equalities=False)
DIFFERENTIAL_EVOLUTION = _global(
    name="differential_evolution",
    title="Differential evolution",
    help="SciPy's population search, which moves each member along differences between members; SLSQP improves the "
    "best one.",
    search=differential_evolution,
)
SHGO = _global(
    name="shgo",
    title="SHGO",
    help="SciPy's simplicial homology: finds the basins of the objective and descends into each with SLSQP.",
    search=shgo,
)
