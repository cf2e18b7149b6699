"""The result of a search among discrete values, in words."""

from __future__ import annotations

from ...model.linkage.dimensions import DIMENSIONS
from ...objectives.counted import counted
from ...objectives.tables.varying_column import columns_of_numbers
from ..front.front import ParetoFront
from ..problem.problem import Problem
from ..problem.violation import constraints_of, violated_by
from .combinations import Judged


def rules_text(problem: Problem) -> str:
    """Return the discrete numbers with what they may be."""
    return ", ".join(f"{item.name} ({item.rule})" for item in problem.discrete)


def result_message(front: ParetoFront) -> str:
    """Return how many designs were found among how many combinations, and the best with continuous values."""
    answer, problem = front.discrete, front.problem
    assert answer is not None
    rules = rules_text(problem)
    if not len(front):
        return f"no design among {_count_combinations(answer.judged)} of {rules} meets every requirement"
    count = counted(len(front), "design")
    if len(front) >= problem.settings.designs:
        count += ", as many as requested"
    if answer.exact:
        every = "all " if answer.combinations > 1 else ""
        text = f"{count}, exact: {every}{_count_combinations(answer.combinations)} of {rules} judged"
    else:
        some = f"{answer.judged} of {answer.combinations} combinations of {rules}"
        left = answer.combinations - answer.judged
        text = f"{count}, {answer.how}: {some} evaluated, the other {left} not"
    told = []
    for place, wanted in enumerate(front.objectives if answer.continuous else ()):
        of = problem.quantity(wanted.quantity)
        sign = -1.0 if wanted.sense == "maximise" else 1.0
        here, there = (
            sign * of.unit.factor * best for best in (front.values[:, place].min(), answer.continuous[place])
        )
        near = " from its target" if wanted.sense == "target" else ""
        told.append(f"{of.title} {there:.6g} {of.unit.symbol}".rstrip() + f"{near} (here {here:.6g})")
    return f"{text}; with continuous values the best would be {', '.join(told)}" if told else text


def failure_message(problem: Problem, found: Judged) -> str:
    """Return that no combination keeps every requirement, by how much the nearest misses, and a remedy."""
    rules = rules_text(problem)
    none = (
        f"none of {_count_combinations(found.judged)} of {rules}"
        if found.judged != 1
        else f"not even the one combination of {rules}"
    )
    if found.nearest is None:
        return f"{none} rotates fully and has all required quantities; give smaller steps or wider ranges"
    told_of = {*DIMENSIONS, *(item.name for item in problem.discrete)}
    columns = columns_of_numbers(found.part.mechanism.varying).items()
    sizes = ", ".join(
        f"{name} {value * unit.factor:.6g} {column.rpartition('_')[2]}"
        for (name, (column, unit)), value in zip(columns, found.nearest.tolist(), strict=True)
        if name in told_of
    )
    worst, told, remedy = 0.0, "", ""
    for item in constraints_of(found.part):
        of = found.part.quantity(item.quantity)
        value = found.part.evaluate(found.nearest[None], [item.quantity])[:, 0]
        here, short = float(value[0]), float(violated_by(item, value)[0])
        asked = item.upper if item.upper is not None and here > item.upper else item.lower
        if short > worst and asked is not None:
            worst = short
            shown = f"{here * of.unit.factor:.7g} {of.unit.symbol}".rstrip()
            off = f"{abs(here - asked) * of.unit.factor:.3g} {of.unit.symbol}".rstrip()
            told = f"{of.title} {shown}, {off} {'above' if here > asked else 'below'} what is asked"
            remedy = "ask for a range instead of one value" if item.equality else "relax it"
    remedies = f"{remedy}, or give smaller steps or other ranges"
    return f"{none} meets every requirement; the nearest, {sizes}, has {told}; {remedies}"


def _count_combinations(count: int) -> str:
    return counted(count, "combination")
