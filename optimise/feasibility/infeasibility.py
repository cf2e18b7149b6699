"""Infeasible problems: which requirements contradict each other, and how close to them a design can get."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ...model.arrays import Array
from ...objectives.stroke_times import STROKE_TIME_RATIOS
from ..engine.engine import Engine
from ..problem.constraint_violation import FEASIBLE, constraints_with_floors
from ..problem.problem import Problem, Settings
from ..search.checkpoints import Checkpoints
from ..search.elimination import elimination_branches
from ..search.evaluation import Evaluator
from ..search.least_violation import least_violation
from ..search.sampling import first_samples
from .best_value import Best
from .impossible_swing_reasons import no_swing_reason
from .quantities_without_value import valueless_quantity_text
from .relaxation import Relaxation, relaxation_of_missed_bound, relaxations

_UNMOVED = "no rod in its range exceeds crank + |offset|, so no crank rotates fully; allow a longer rod"
_SAMPLES = 16384
_RANKED = 2048
_STARTS = 24


@dataclass(frozen=True)
class Diagnosis:
    """Result of a search for feasible designs.

    feasible: designs (n, 3 + v), SI, if any are feasible after all. relaxations: requirements, each of which suffices
    if relaxed. message: explanation of the contradiction.
    """

    feasible: Array
    relaxations: tuple[Relaxation, ...]
    message: str


def diagnose_infeasibility(
    problem: Problem,
    best: Callable[[Problem], Best | None],
    checkpoints: Checkpoints | None = None,
    engine: Engine | None = None,
) -> Diagnosis:
    """Return feasible designs if there are any after all; otherwise the requirements that contradict each other.

    best: returns the best design of a problem with one objective, None if that is infeasible too. checkpoints, engine:
    those of the calling search. First, the greatest relative violation is minimised from many starts, without
    elimination. If it stays positive, each requirement in turn becomes the objective of the problem without it; if it
    can be met after all, the design is feasible. Both searches are local, from many starts, which is strong evidence;
    `certificate.infeasible` gives a proof where possible.
    """
    feasible, turning, nearest = _least_violation(problem, checkpoints, engine)
    if len(feasible):
        return Diagnosis(feasible, (), "")
    if not turning:
        message = nearest or (_UNMOVED if problem.motion is None else no_swing_reason(problem))
        return Diagnosis(feasible, (), message)
    found = []
    stroke = {quantity.name for quantity in STROKE_TIME_RATIOS.values()} - {
        item.quantity for item in problem.constraints
    }
    for constraint in constraints_with_floors(problem):
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
    """Return feasible designs, whether any sample can be judged, and a description of the sample nearest to feasible.

    If none can be judged although some rotate fully, the message names the quantity without a value.
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
            turned = u[evaluator.can_evaluate(u)][:_RANKED]
            blank = blank or (
                valueless_quantity_text(evaluator.problem, branch.dimensions(turned)) if len(turned) else ""
            )
            continue
        turning = True
        dimensions = branch.dimensions(found.u)
        feasible.append(dimensions[found.values[:, 0] <= FEASIBLE])
        row = int(np.argmin(found.values[:, 0]))
        if found.values[row, 0] < least:
            least = float(found.values[row, 0])
            nearest = _nearest_design_text(problem, branch.variant, dimensions[row])
    return np.concatenate(feasible) if feasible else np.zeros((0, 3)), turning, nearest if turning else blank


def _nearest_design_text(problem: Problem, variant: int, design: Array) -> str:
    """Describe a design, and the values it has for the requirements that it misses."""
    part = problem.part(variant)
    found = []
    for constraint in constraints_with_floors(part):
        value = float(part.quantity(constraint.quantity).evaluate(part.mechanism, design[None]).values[0])
        for word, bound in constraint.sides:
            item = relaxation_of_missed_bound(part, constraint, word, bound, value)
            if item is not None:
                found.append(replace(item, alone=constraint.equality).replacement_text())
    labels = problem.variants[variant].labels if problem.variants else ()
    chosen = "".join(f"{name} {label}, " for name, label in zip(problem.choices, labels, strict=True))
    sizes = "crank {:.6g} mm, rod {:.6g} mm, offset {:.6g} mm".format(*(1e3 * design[:3]))
    return f"the nearest design is {chosen}{sizes}; ask for {' and '.join(found)}, or widen the ranges"
