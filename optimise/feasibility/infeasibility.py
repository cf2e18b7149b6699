"""Nothing feasible: which requirements contradict each other, and how near one can get."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ...model.arrays import Array
from ...objectives.stroke_times import STROKE_TIME_RATIOS
from ..engine.engine import Engine
from ..problem.problem import Problem, Settings
from ..problem.violation import FEASIBLE, constraints_of
from ..search.checkpoints import Checkpoints
from ..search.elimination import elimination_branches
from ..search.evaluation import Evaluator
from ..search.sampling import first_samples
from ..search.violation import least_violation
from .best import Best
from .relaxation import Relaxation, missed, relaxations
from .swinging import unswung
from .valueless import valueless

_UNMOVED = "no rod in its range exceeds crank + |offset|, so no crank rotates fully; allow a longer rod"
_SAMPLES = 16384
_RANKED = 2048
_STARTS = 24


@dataclass(frozen=True)
class Diagnosis:
    """Result of a search for feasible designs.

    feasible: designs (n, 3 + v), SI, that are feasible if there are any after all. relaxations: requirements of which
    giving up any one is enough. message: the contradiction in words.
    """

    feasible: Array
    relaxations: tuple[Relaxation, ...]
    message: str


def diagnose(
    problem: Problem,
    best: Callable[[Problem], Best | None],
    checkpoints: Checkpoints | None = None,
    engine: Engine | None = None,
) -> Diagnosis:
    """Return feasible designs after all, or which requirements contradict each other.

    best: gives the best of a problem with one objective, None if it is infeasible too. checkpoints, engine: of the
    search that wants to know it. First the greatest relative violation is minimised from many starts, without
    eliminating anything. If it stays positive, each requirement in turn becomes the objective of the problem without
    it; one that is met after all gives a feasible design. Both searches are local from many starts: strong evidence;
    `certificate.infeasible` gives the proof where it can.
    """
    feasible, turning, nearest = _least_violation(problem, checkpoints, engine)
    if len(feasible):
        return Diagnosis(feasible, (), "")
    if not turning:
        message = nearest or (_UNMOVED if problem.motion is None else unswung(problem))
        return Diagnosis(feasible, (), message)
    found = []
    stroke = {quantity.name for quantity in STROKE_TIME_RATIOS.values()} - {
        item.quantity for item in problem.constraints
    }
    for constraint in constraints_of(problem):
        if constraint.quantity in stroke:  # the slow stroke along a speed profile is reported below
            continue
        for item in relaxations(problem, constraint, best):
            if not isinstance(item, Relaxation):
                return Diagnosis(item[None], (), "")
            found.append(item)
    sentences = [item.sentence() for item in found]
    if problem.slow_stroke is not None:
        loose = replace(
            problem,
            slow_stroke=None,
            objectives=problem.objectives[:1],
            settings=Settings(designs=1, seed=problem.settings.seed),
        )
        if best(loose) is not None:
            others_left = "inward" if problem.slow_stroke == "outward" else "outward"
            sentences.append(
                f"slow stroke {problem.slow_stroke} is required; all other requirements can be met if the "
                f"{others_left} "
                "stroke is slow, or neither"
            )
    if sentences:
        message = "no design meets all requirements: " + "; ".join(sentences)
    else:
        message = f"no design meets all requirements, and dropping any single one is not enough; {nearest}"
    return Diagnosis(feasible, tuple(found), message)


def _least_violation(
    problem: Problem, checkpoints: Checkpoints | None, engine: Engine | None
) -> tuple[Array, bool, str]:
    """Return feasible designs, whether any sampled design can be judged, and the one nearest to feasible in words.

    Where none can be judged though some turn fully, the words say which quantity has no value for any of them.
    """
    feasible = []
    turning = False
    nearest, least = "", np.inf
    blank = ""
    for index, branch in enumerate(elimination_branches(problem, eliminate=False)):
        evaluator = Evaluator(problem, branch, checkpoints, engine)
        u = first_samples(_SAMPLES, evaluator.dimension, problem.settings.seed, 100 + index)
        found = least_violation(evaluator, u, ranked=_RANKED, starts=_STARTS)
        if not len(found):
            turned = u[evaluator.valid(u)][:_RANKED]
            blank = blank or (valueless(evaluator.problem, branch.dimensions(turned)) if len(turned) else "")
            continue
        turning = True
        dimensions = branch.dimensions(found.u)
        feasible.append(dimensions[found.values[:, 0] <= FEASIBLE])
        row = int(np.argmin(found.values[:, 0]))
        if found.values[row, 0] < least:
            least = float(found.values[row, 0])
            nearest = _jointly_possible(problem, branch.variant, dimensions[row])
    return np.concatenate(feasible) if feasible else np.zeros((0, 3)), turning, nearest if turning else blank


def _jointly_possible(problem: Problem, variant: int, design: Array) -> str:
    """Return a design and what it meets in place of the requirements that it misses, in words."""
    part = problem.part(variant)
    found = []
    for constraint in constraints_of(part):
        value = float(part.quantity(constraint.quantity).evaluate(part.mechanism, design[None]).values[0])
        for word, bound in constraint.sides:
            item = missed(part, constraint, word, bound, value)
            if item is not None:
                found.append(replace(item, alone=constraint.equality).instead())
    labels = problem.variants[variant].labels if problem.variants else ()
    chosen = "".join(f"{name} {label}, " for name, label in zip(problem.choices, labels, strict=True))
    sizes = "crank {:.6g} mm, rod {:.6g} mm, offset {:.6g} mm".format(*(1e3 * design[:3]))
    return f"the nearest design is {chosen}{sizes}; ask for {' and '.join(found)}, or widen the ranges"
