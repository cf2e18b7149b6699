"""Options of choices that no design can have, as far as ranges and requirements tell before a search."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.errors import InfeasibleError, InputError
from ..problem.problem import Problem
from .box import SLACK, Box

_MOST = 5  # told one by one


def require_options(problem: Problem) -> None:
    """Raise InfeasibleError if no combination of options can have a design."""
    found = impossible_options(problem)
    if problem.variants and len(found) == len(problem.variants):
        label, why = found[0]
        raise InfeasibleError(
            f"choice: at least one option must have a design within the ranges; none has: for {label} {why}; widen "
            "the ranges, relax the constraints, or add another option"
        )


def idle_options(problem: Problem) -> list[str]:
    """Return in words which combinations of options no design can have, and why."""
    found = [*problem.left_out, *impossible_options(problem)]
    more = f", and {len(found) - _MOST} more" if len(found) > _MOST else ""
    told = "; ".join(f"{label}: {why}" for label, why in found[:_MOST])
    return [f"the front omits options without any design: {told}{more}"] if found else []


def impossible_options(problem: Problem) -> list[tuple[str, str]]:
    """Return labels of combinations of options that no design can have, each with the reason."""
    return [
        (", ".join(variant.labels) or f"combination {place + 1}", why)
        for place, variant in enumerate(problem.variants)
        if (why := next(_reasons(problem, place), None))
    ]


def _reasons(problem: Problem, variant: int) -> Iterator[str]:
    try:
        part = problem.part(variant)
    except InputError as error:  # of requirements that leave nothing together
        yield str(error)
        return
    if part.motion is not None:
        return
    box = Box.from_problem(part)
    if not box.turns:
        yield "no rod in its range exceeds crank + |offset|"
        return
    for constraint in part.constraints:
        of = part.quantity(constraint.quantity)
        if part.reach_of(of) is None or not of.of_dimensions:
            continue
        least, greatest = box.possible(of)
        room = SLACK * max(abs(least), abs(greatest))
        face = of.unit
        for word, bound in constraint.sides:
            beyond = word != "max" and bound > greatest + room, word != "min" and bound + room < least
            if any(beyond):
                end = f"{(greatest if beyond[0] else least) * face.factor:.6g} {face.symbol}".rstrip()
                asked = f"{bound * face.factor:.6g} {face.symbol}".rstrip()
                yield f"{of.title} {word} {asked}, where {'at most' if beyond[0] else 'at least'} {end} is possible"
