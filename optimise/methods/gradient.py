"""Gradient methods of scipy for one objective, from many starts."""

from __future__ import annotations

import numpy as np

from ..problem.problem import Problem
from ..search.assemble import span_of
from ..search.evaluation import Evaluator
from ..search.search import Archive, Run
from .local import Local, by_slsqp, by_trust_constr, keep
from .method import Method
from .registry import budget
from .scalar import Form, Programme
from .starts import samples

_STARTS = {"slsqp": 24, "trust_constr": 8}


def slsqp(problem: Problem, evaluators: list[Evaluator], run: Run) -> Archive:
    """Return the local optima that SLSQP finds from up to 24 starts; see `local.by_slsqp`."""
    return _many(problem, evaluators, run, by_slsqp)


def trust_constr(problem: Problem, evaluators: list[Evaluator], run: Run) -> Archive:
    """Return the local optima that trust-constr finds from up to 8 starts; see `local.by_trust_constr`."""
    return _many(problem, evaluators, run, by_trust_constr)


def _many(problem: Problem, evaluators: list[Evaluator], run: Run, solve: Local) -> Archive:
    begun = samples(problem, evaluators)
    run.archive, archive = Archive.empty(1), Archive.empty(1)
    run.archive.put(begun[begun.met])
    if not len(begun):
        run.tell("sampling", evaluators, archive)
        return archive
    ideal, span = begun.values.min(axis=0), span_of(problem, begun.values)
    rows = begun.leading(0, _STARTS[problem.settings.method])
    run.rounds = 1 + len(rows)
    run.tell("sampling", evaluators, archive)
    for row in rows:
        if len(archive) and spent(problem, evaluators):
            break
        index = int(begun.sheet[row])
        programme = Programme(evaluators[index], Form.single(1, 0), ideal, span)
        keep(solve, programme, begun.u[row], archive, index)
        run.tell("descending", evaluators, archive)
    return archive


def spent(problem: Problem, evaluators: list[Evaluator]) -> bool:
    """Whether the budget of evaluations is used up."""
    return bool(np.sum([evaluator.evaluations for evaluator in evaluators]) >= budget(problem))


SLSQP = Method(
    name="slsqp",
    title="SLSQP",
    help="Sequential least squares programming of scipy from many starts; peaks are rows of the epigraph form.",
    family="gradient",
    objectives="one",
    search=slsqp,
    budget=20_000,
    uses=("scipy",),
)
TRUST_CONSTR = Method(
    name="trust_constr",
    title="trust-constr",
    help="Interior-point method of scipy from a few starts; peaks are rows of the epigraph form.",
    family="gradient",
    objectives="one",
    search=trust_constr,
    budget=20_000,
    uses=("scipy",),
    equalities=False,
)
