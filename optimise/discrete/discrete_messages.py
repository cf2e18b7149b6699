"""Messages about a search among discrete values: its result, and requirements that no combination of them meets."""

from dataclasses import replace

import numpy as np

from ...model.errors import InfeasibleError
from ...model.linkage.dimensions import DIMENSIONS
from ...objectives.kinds import count_with_noun
from ...objectives.tables.design_input import columns_of_design_numbers
from ..front.front import ParetoFront
from ..problem.constraint_violation import constraints_with_floors, relative_violation
from ..problem.problem import Problem
from .combinations import Axes, FeasibleDesigns, best_of_all_combinations


def choices_text(problem: Problem) -> str:
    """Describe the choices with the number of their options, and the discrete numbers with their possible values."""
    options = [len({variant.labels[place] for variant in problem.variants}) for place in range(len(problem.choices))]
    choices = [
        f"{name} ({count_with_noun(count, 'option')})" for name, count in zip(problem.choices, options, strict=True)
    ]
    return ", ".join([*choices, *(f"{item.name} ({item.rule})" for item in problem.discrete)])


def result_message(front: ParetoFront) -> str:
    """Describe how many designs and combinations there are, and the best values with continuous numbers."""
    summary, problem = front.discrete, front.problem
    assert summary is not None
    rules = choices_text(problem)
    if not len(front):
        return f"no design among {_count_combinations(summary.judged)} of {rules} meets every requirement"
    count = count_with_noun(len(front), "design")
    if len(front) >= problem.settings.designs:
        count += ", as many as requested"
    if summary.exact:
        every = "all " if summary.combinations > 1 else ""
        text = f"{count}, exact: {every}{_count_combinations(summary.combinations)} of {rules} judged"
    else:
        part = f"{summary.judged} of {summary.combinations} combinations of {rules}"
        left = summary.combinations - summary.judged
        text = f"{count}, {summary.extent_text}: {part} evaluated, the other {left} not"
    costs = []
    for place, objective in enumerate(front.objectives if summary.continuous else ()):
        quantity = problem.quantity(objective.quantity)
        sign = -1.0 if objective.sense == "maximise" else 1.0
        discrete_best, continuous_best = (
            sign * quantity.unit.factor * best for best in (front.values[:, place].min(), summary.continuous[place])
        )
        near = " from its target" if objective.sense == "target" else ""
        costs.append(
            f"{quantity.title} {continuous_best:.6g} {quantity.unit.symbol}".rstrip()
            + f"{near} (here {discrete_best:.6g})"
        )
    return f"{text}; with continuous values the best would be {', '.join(costs)}" if costs else text


def failure_message(problem: Problem, judged: FeasibleDesigns) -> str:
    """Return the message that no combination is feasible, with the deviations of the nearest one and a remedy."""
    rules = choices_text(problem)
    subject = (
        f"none of {_count_combinations(judged.judged)} of {rules}"
        if judged.judged != 1
        else f"not even the one combination of {rules}"
    )
    if judged.nearest is None:
        return f"{subject} rotates fully and has all required quantities; give smaller steps or wider ranges"
    listed_names = {*DIMENSIONS, *(item.name for item in problem.discrete)}
    columns = columns_of_design_numbers(judged.part.mechanism.varying).items()
    sizes = ", ".join(
        f"{name} {value * unit.factor:.6g} {column.rpartition('_')[2]}"
        for (name, (column, unit)), value in zip(columns, judged.nearest.tolist(), strict=True)
        if name in listed_names
    )
    worst, shortfall, remedy = 0.0, "", ""
    for item in constraints_with_floors(judged.part):
        quantity = judged.part.quantity(item.quantity)
        value = judged.part.evaluate(judged.nearest[None], [item.quantity])[:, 0]
        value_of_nearest, short = float(value[0]), float(relative_violation(item, value)[0])
        bound = item.upper if item.upper is not None and value_of_nearest > item.upper else item.lower
        if short > worst and bound is not None:
            worst = short
            text = f"{value_of_nearest * quantity.unit.factor:.7g} {quantity.unit.symbol}".rstrip()
            off = f"{abs(value_of_nearest - bound) * quantity.unit.factor:.3g} {quantity.unit.symbol}".rstrip()
            shortfall = (
                f"{quantity.title} {text}, {off} {'above' if value_of_nearest > bound else 'below'} the required value"
            )
            remedy = "ask for a range instead of one value" if item.equality else "relax it"
    remedies = f"{remedy}, or give smaller steps or other ranges"
    return f"{subject} meets every requirement; the nearest, {sizes}, has {shortfall}; {remedies}"


def _count_combinations(count: int) -> str:
    return count_with_noun(count, "combination")


MOST = 200_000
"""Maximum number of combinations to check."""


def require_meetable_requirements(problem: Problem) -> None:
    """Raise InfeasibleError, naming the nearest, if no combination of three discrete dimensions meets the requirements.

    Checks only requirements that need no cycle, and at most `MOST` combinations; the search handles the rest.
    """
    if not problem.discrete:
        return
    axes = [_dimension_axes(Axes.of_problem(part)) for part in problem.parts()]
    if not all(axis.has_no_free_number for axis in axes) or sum(axis.combination_count for axis in axes) > MOST:
        return
    judged = FeasibleDesigns.empty(axes[0].part)
    for axis in axes:
        judged = judged.merge(best_of_all_combinations(axis, dimensions_only=True))
        if len(judged.dimensions):
            return
    sizes = tuple(item for item in problem.discrete if item.name in DIMENSIONS)
    if sizes:
        raise InfeasibleError(f"variables.{sizes[0].name}: {failure_message(replace(problem, discrete=sizes), judged)}")


def _dimension_axes(axes: Axes) -> Axes:
    """Return axes with a single value for each other number; these requirements depend only on the dimensions."""
    fixed_values = [np.array([item.lower]) for item in axes.part.mechanism.varying]
    return Axes(axes.part, (*axes.values[:3], *fixed_values))
