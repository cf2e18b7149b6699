"""Quantities without a value for any design, such as roots of negative numbers or safety factors of unloaded bars."""

from __future__ import annotations

import numpy as np

from ...model.arrays import Array
from ...model.errors import InputError
from ...objectives.count_text import count_with_noun
from ...objectives.formula.quantity import FormulaQuantity
from ..problem.constraint_violation import constraints_with_floors
from ..problem.problem import Problem
from ..search.evaluation import Evaluator
from ..search.sampling import first_samples

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
            designs = evaluator.branch.dimensions(u[evaluator.can_evaluate(u)])
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
