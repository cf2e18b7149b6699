"""What the ranges of a job do not allow, in words."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .possible import Ends, Possible

if TYPE_CHECKING:
    from ...optimise.problem import Constraint, Problem

_NEAR = 0.005
"""Relative: samples find the ends to within this, so that what is asked so near to them may be had."""
_REST = "with all other requirements on the dimensions"


def said(problem: Problem, found: Possible) -> list[str]:
    """Return a sentence for each requirement that is out of reach, and one if no sample meets everything."""
    sentences = []
    asked = {constraint.quantity: constraint for constraint in problem.constraints}
    for name in ("stroke", "time_ratio", "transmission_angle"):
        ends: Ends | None = getattr(found, name)
        if name in asked and ends is not None:
            sentences += _beyond(asked[name], ends)
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


def _beyond(constraint: Constraint, ends: Ends) -> list[str]:
    from ...objectives.registry import QUANTITIES

    of = QUANTITIES[constraint.quantity]

    def shown(value: float) -> str:
        return f"{value * of.unit.factor:.4g} {of.unit.symbol}".rstrip()

    lower, upper = constraint.lower, constraint.upper
    if lower is not None and lower > ends[1] * (1.0 + _NEAR):
        word = "exactly" if constraint.equality else "at least"
        return [f"{of.title}: {word} {shown(lower)} is asked, about {shown(ends[1])} at most can be had {_REST}"]
    if upper is not None and upper * (1.0 + _NEAR) < ends[0]:
        word = "exactly" if constraint.equality else "at most"
        return [f"{of.title}: {word} {shown(upper)} is asked, about {shown(ends[0])} at least must be had {_REST}"]
    return []


def _percent(share: float) -> str:
    return f"{100.0 * share:.0f} %" if share >= 0.01 or share == 0.0 else "less than 1 %"
