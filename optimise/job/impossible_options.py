"""Options of choices that no design can have, as far as ranges and requirements show before a search."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.errors import InfeasibleError, InputError
from ..problem.problem import Problem
from .reachable_values import SLACK, Box

_MOST = 5  # combinations to report one by one


def require_possible_option(problem: Problem) -> None:
    """Raise InfeasibleError if no combination of options can have a design."""
    impossible = impossible_options(problem)
    if problem.variants and len(impossible) == len(problem.variants):
        label, why = impossible[0]
        raise InfeasibleError(
            f"choice: at least one option must have a design within the ranges; none has: for {label} {why}; widen "
            "the ranges, relax the constraints, or add another option"
        )


def impossible_option_notes(problem: Problem) -> list[str]:
    """Describe which combinations of options no design can have, and why."""
    impossible = [*problem.left_out, *impossible_options(problem)]
    left_over = f", and {len(impossible) - _MOST} more" if len(impossible) > _MOST else ""
    reasons = "; ".join(f"{label}: {why}" for label, why in impossible[:_MOST])
    return [f"the front omits options without any design: {reasons}{left_over}"] if impossible else []


def impossible_options(problem: Problem) -> list[tuple[str, str]]:
    """Return labels of combinations of options that no design can have, each with the reason."""
    return [
        (", ".join(variant.labels) or f"combination {place + 1}", why)
        for place, variant in enumerate(problem.variants)
        if (why := next(_impossibility_reasons(problem, place), None))
    ]


def _impossibility_reasons(problem: Problem, variant: int) -> Iterator[str]:
    try:
        part = problem.part(variant)
    except InputError as error:  # requirements exclude each other
        yield str(error)
        return
    if part.motion is not None:
        return
    box = Box.from_problem(part)
    if not box.turns:
        yield "no rod in its range exceeds crank + |offset|"
        return
    for constraint in part.constraints:
        quantity = part.quantity(constraint.quantity)
        if part.common_bounds(quantity) is None or not quantity.depends_only_on_dimensions:
            continue
        least, greatest = box.possible(quantity)
        rounding = SLACK * max(abs(least), abs(greatest))
        unit = quantity.unit
        for word, bound in constraint.sides:
            exceeds = word != "max" and bound > greatest + rounding, word != "min" and bound + rounding < least
            if any(exceeds):
                end = f"{(greatest if exceeds[0] else least) * unit.factor:.6g} {unit.symbol}".rstrip()
                bound_text = f"{bound * unit.factor:.6g} {unit.symbol}".rstrip()
                side = "at most" if exceeds[0] else "at least"
                yield f"{quantity.title} {word} {bound_text}, where {side} {end} is possible"
