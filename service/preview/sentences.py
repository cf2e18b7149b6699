"""Sentences on the requirements of a job that its ranges do not allow."""

from __future__ import annotations

from dataclasses import replace

from ...optimise.feasibility.relaxation import missed, sides
from ...optimise.front.constant import is_constant
from ...optimise.problem.problem import Constraint, Problem
from .feasibility import Ends, Possible

_REST = "all other requirements on the dimensions"


def said(problem: Problem, found: Possible) -> list[str]:
    """Return a sentence for each requirement that is out of reach, and one if no sample meets everything."""
    sentences = []
    asked = {constraint.quantity: constraint for constraint in problem.constraints}
    for name in ("stroke", "time_ratio", "transmission_angle"):
        ends: Ends | None = getattr(found, name)
        if name in asked and ends is not None:
            sentences += _beyond(problem, asked[name], ends)
    if found.turning == 0.0:
        sentences.append("no crank of these ranges turns fully: the rod must be longer than crank and offset together")
    elif found.sampled and found.feasible == 0.0 and not sentences:
        hardest = ""
        if found.hardest is not None and found.hardest[1] < 1.0:
            title = problem.quantity(found.hardest[0]).title
            hardest = f"; on its own, {title} is met by {_percent(found.hardest[1])} of those that turn"
        sentences.append(
            f"none of {found.sampled} designs tried meets every requirement{hardest}; the search looks more closely"
        )
    return sentences


def _beyond(problem: Problem, constraint: Constraint, ends: Ends) -> list[str]:
    """Return, in words, the nearest possible value for a requirement beyond the ends of the possible range."""
    found = []
    for relation, _, bound in sides(constraint):
        nearest = min(max(bound, ends[0]), ends[1])
        beyond = {"at least": bound > nearest, "at most": bound < nearest, "exactly": True}[relation]
        item = missed(problem, constraint, relation, bound, nearest) if beyond else None
        if item is not None:
            found.append(replace(item, alone=bool(is_constant(ends))).sentence(kept=_REST))
    return found


def _percent(share: float) -> str:
    return f"{100.0 * share:.0f} %" if share >= 0.01 or share == 0.0 else "less than 1 %"
