"""Infeasible problems: which requirements contradict each other, and how close to them a design can get.

A quantity may also have no value for any design, such as the root of a negative number.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ...model.arrays import Array
from ...model.errors import InputError
from ...objectives.formula.quantity import FormulaQuantity
from ...objectives.kinds import count_with_noun
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
from .relaxation import Relaxation, relaxation_of_missed_bound, relaxations

_TRIED = 256  # designs of each branch that are checked for an infinite objective


def valueless_quantity_text(part: Problem, designs: Array) -> str:
    """Return a message on a quantity without a value for any of the designs (n, 3 + v), or "".

    part: a problem without choices. The designs must be able to move as required.
    """
    names = [*(item.quantity for item in part.objectives), *(item.quantity for item in constraints_with_floors(part))]
    for name in dict.fromkeys(names):
        quantity = part.quantity(name)
        if np.isfinite(quantity.evaluate(part.mechanism, designs).values).any():
            continue
        remedy = (
            "correct the formula, or change the ranges"
            if isinstance(quantity, FormulaQuantity)
            else "change the ranges"
        )
        why = f": {quantity.no_value_reason}" if quantity.no_value_reason else ""
        count = count_with_noun(len(designs), "design")
        return f"{quantity.title} has no value for any of {count} within the ranges{why}; {remedy}"
    return ""


def valueless_quantity_text_of_variants(problem: Problem, designs: Array) -> str:
    """Return the answer of `valueless_quantity_text` if every variant of a problem has one."""
    said = [valueless_quantity_text(part, designs) for part in problem.parts()] if len(designs) else []
    return said[0] if said and all(said) else ""


def require_finite(problem: Problem, evaluators: list[Evaluator]) -> None:
    """Raise `InputError` for an objective that is infinite for every sampled design within the ranges.

    That objective could then not rank any designs. Designs without a value are ignored.
    """
    for name in [item.quantity for item in problem.objectives if problem.quantity(item.quantity).endless]:
        found = []
        for index, evaluator in enumerate(evaluators):
            u = first_samples(_TRIED, evaluator.dimension, problem.settings.seed, 200 + index)
            designs = evaluator.branch.designs_at_points(u[evaluator.can_evaluate(u)])
            found.append(evaluator.problem.quantity(name).evaluate(evaluator.problem.mechanism, designs).values)
        values = np.concatenate([np.zeros(0), *found])
        values = values[~np.isnan(values)]
        if len(values) and np.isposinf(values).all():
            of = problem.quantity(name)
            count = f"all {len(values)} designs" if len(values) > 1 else "the only design"
            raise InputError(
                f"objectives.{name}: {of.title} is infinite for {count} tried within the ranges: {of.endless}; leave "
                "it out"
            )


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
        if constraint.quantity in stroke:  # the slow stroke with a speed profile is reported below
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
                valueless_quantity_text(evaluator.problem, branch.designs_at_points(turned)) if len(turned) else ""
            )
            continue
        turning = True
        dimensions = branch.designs_at_points(found.u)
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
