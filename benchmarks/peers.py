"""Peers of the search: NSGA-II and NSGA-III of pymoo, MOEA/D of pygmo, on the same kernel and reduced problem."""

from __future__ import annotations

from collections.abc import Callable
from time import process_time
from typing import Any

import numpy as np
from pymoo.algorithms.moo.nsga2 import NSGA2
from pymoo.algorithms.moo.nsga3 import NSGA3
from pymoo.core.callback import Callback
from pymoo.core.problem import Problem as PymooProblem
from pymoo.optimize import minimize
from pymoo.util.ref_dirs import get_reference_directions

from slidercrank.optimise.problem.constraint_violation import FEASIBLE
from slidercrank.optimise.problem.problem import Problem
from slidercrank.optimise.search.elimination import elimination_branches
from slidercrank.optimise.search.evaluation import Evaluator

from .machines import Array

EVALUATIONS = 20_000
"""Of a peer; ours take their own budgets."""
NSGA2_, NSGA3_, MOEAD = "pymoo NSGA-II", "pymoo NSGA-III", "pygmo MOEA/D"
PEERS = (NSGA2_, NSGA3_, MOEAD)
_PENALTY = 1e3  # of the objectives' range: MOEA/D takes no constraints, so that a violation is added to all objectives


class Reduced(PymooProblem):  # type: ignore[misc]
    """The reduced problem as pymoo wants it, of the first branch: the shipped jobs have one.

    penalised: the objectives' range where a violation is added to them. seen: feasible objectives of all evaluations;
    keeping: the seconds that this took.
    """

    def __init__(self, problem: Problem, *, penalised: Array | None = None) -> None:
        self.evaluator = Evaluator(problem, elimination_branches(problem)[0])
        self.penalised = penalised
        self.seen: list[Array] = []
        self.keeping = 0.0
        limits = 0 if penalised is not None else 1
        super().__init__(
            n_var=self.evaluator.dimension, n_obj=len(problem.objectives), n_ieq_constr=limits, xl=0.0, xu=1.0
        )

    def _evaluate(self, x: Array, out: dict[str, Any], *args: Any, **kwargs: Any) -> None:
        _, objectives, violation = self.evaluator.screen_designs_objectives_violation(x)
        begin = process_time()
        self.seen.append(objectives[violation <= FEASIBLE])
        self.keeping += process_time() - begin
        violation = np.where(np.isfinite(violation), np.maximum(violation, 0.0), 1e3)
        if self.penalised is None:
            out["F"] = np.where(np.isfinite(objectives), objectives, 1e9)
            out["G"] = (violation - FEASIBLE)[:, None]
        else:
            worse = (1.0 + violation)[:, None] * _PENALTY * self.penalised
            out["F"] = np.where((violation <= FEASIBLE)[:, None], objectives, worse)


class _Pygmo:
    """The reduced problem as pygmo wants it, penalised, and a generation at once."""

    def __init__(self, reduced: Reduced) -> None:
        self.reduced = reduced

    def fitness(self, x: Array) -> Array:
        return self.batch_fitness(x)

    def batch_fitness(self, x: Array) -> Array:
        out: dict[str, Any] = {}
        self.reduced._evaluate(np.asarray(x).reshape(-1, self.reduced.n_var), out)
        return np.asarray(out["F"]).ravel()

    def get_nobj(self) -> int:
        return int(self.reduced.n_obj)

    def get_bounds(self) -> tuple[list[float], list[float]]:
        return [0.0] * self.reduced.n_var, [1.0] * self.reduced.n_var

    def __deepcopy__(self, memo: object) -> _Pygmo:
        return _Pygmo(self.reduced)  # pygmo copies its problems; what they have seen stays in one place


class _Generations(Callback):  # type: ignore[misc]
    def __init__(self, generation: Callable[[Array], None]) -> None:
        super().__init__()
        self.generation = generation

    def notify(self, algorithm: Any) -> None:
        self.generation(algorithm.pop.get("F")[algorithm.pop.get("CV")[:, 0] <= 0.0])


def _directions(objectives: int, partitions: int = 7) -> Array:
    return np.asarray(get_reference_directions("das-dennis", objectives, n_partitions=partitions))


def run_peer(
    name: str,
    problem: Problem,
    span: Array,
    generation: Callable[[Array], None],
    *,
    seed: int,
    evaluations: int = EVALUATIONS,
) -> Reduced:
    """Run a peer and return its problem; span: the objectives' range.

    generation: called after each with the objectives of its population, those of pymoo feasible.
    """
    reduced = Reduced(problem, penalised=span if name == MOEAD else None)
    if name != MOEAD:
        method = NSGA2(pop_size=100) if name == NSGA2_ else NSGA3(_directions(reduced.n_obj))
        watch = _Generations(generation)
        minimize(reduced, method, ("n_eval", evaluations), seed=seed, callback=watch, verbose=False)
        return reduced
    import pygmo

    size = len(_directions(reduced.n_obj))
    population = pygmo.population(pygmo.problem(_Pygmo(reduced)), size=size, seed=seed, b=pygmo.bfe())
    method = pygmo.moead_gen(gen=1, seed=seed)
    method.set_bfe(pygmo.bfe())
    algorithm = pygmo.algorithm(method)
    while population.problem.get_fevals() < evaluations:
        population = algorithm.evolve(population)
        generation(population.get_f())
    return reduced
