"""Quantities that no design has a value of, in words: roots of less than zero, forces where friction locks."""

from __future__ import annotations

import numpy as np

from ...model.arrays import Array
from ...objectives.formula.quantity import FormulaQuantity
from ..problem.problem import Problem
from ..problem.violation import constraints_of


def valueless(part: Problem, designs: Array) -> str:
    """Return the quantity without a value for any of some designs (n, 3 + v), with a remedy, or "".

    part: a problem without choices. The designs must move as asked.
    """
    names = [*(item.quantity for item in part.objectives), *(item.quantity for item in constraints_of(part))]
    for name in dict.fromkeys(names):
        of = part.quantity(name)
        if np.isfinite(of.evaluate(part.mechanism, designs).values).any():
            continue
        remedy = "correct the formula, or change the ranges" if isinstance(of, FormulaQuantity) else "change the ranges"
        return f"{of.title} has no value for any of {len(designs)} designs of the ranges; {remedy}"
    return ""


def valueless_in_all(problem: Problem, designs: Array) -> str:
    """Return the answer of `valueless` if there is one in every variant of a problem."""
    said = [valueless(part, designs) for part in problem.parts()] if len(designs) else []
    return said[0] if said and all(said) else ""
