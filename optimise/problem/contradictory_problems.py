"""Contradictory problems that a search would not notice, such as objectives that are zero for every design."""

from ...model.errors import InfeasibleError, InputError
from ...objectives.lengths_and_time_ratio import TIME_RATIO
from ...objectives.stroke_times import STROKE_TIME_RATIOS
from .problem import Problem
from .question_registry import Change, Remark


def require_possible_problem(problem: Problem) -> None:
    """Raise `InfeasibleError` if no option of a choice is left, or if a slow stroke is required to be faster."""
    if problem.left_out and not problem.variants:
        raise no_option_error(problem.left_out)
    if all(part.slow_stroke is not None for part in problem.parts()):
        require_longer_slow_stroke(problem)


def no_option_error(left_out: tuple[tuple[str, str], ...]) -> InfeasibleError:
    """Return the error for choices whose options are all excluded. left_out: labels and reasons."""
    label, why = left_out[0]
    return InfeasibleError(
        f"choice: at least one option must meet [constraints]; none does: {label} has {why}; relax the constraint, or "
        "add another option"
    )


def require_longer_slow_stroke(problem: Problem) -> None:
    """Raise `InfeasibleError` if bounds on ratios of stroke times prevent the slow stroke from taking longer.

    All parts of the problem must have a slow stroke.
    """
    ratio = next((c for c in problem.constraints if c.quantity == TIME_RATIO.name), None)
    if ratio is not None and ratio.upper is not None and ratio.upper <= 1.0:
        raise InfeasibleError(
            "constraints.slow_stroke: a slow stroke needs a time ratio above 1; got "
            f"constraints.{TIME_RATIO.name} with {'equals' if ratio.equality else 'max'} {ratio.upper:.6g}; raise it, "
            "or leave out slow_stroke"
        )
    for part in problem.parts():
        _require_consistent_stroke_ratios(part)


def _require_consistent_stroke_ratios(part: Problem) -> None:
    """Raise `InfeasibleError` for a bound on a ratio of stroke times that requires the other stroke to be slow."""
    for stroke, quantity in STROKE_TIME_RATIOS.items():
        is_slow = stroke == part.slow_stroke
        for item in part.constraints:
            for word, bound in item.sides if item.quantity == quantity.name else ():
                if (bound <= 1.0 and word != "min") if is_slow else (bound >= 1.0 and word != "max"):
                    raise InfeasibleError(
                        f"constraints.slow_stroke: if the {part.slow_stroke} stroke is slow, {quantity.name} must be "
                        f"{'above' if is_slow else 'below'} 1; got constraints.{quantity.name} with {word} "
                        f"{bound:.6g}; leave out one of the two"
                    )


def require_nonzero_quantities(problem: Problem) -> None:
    """Raise an error for a quantity that is zero for every design, robust or not, in all variants.

    `InputError` for an objective, `InfeasibleError` for a constraint that zero violates.
    """
    machines = [part.mechanism for part in problem.parts()]
    for objective in problem.objectives:
        reason = problem.quantity(objective.quantity).zero_because(machines)
        if reason:
            raise InputError(f"objectives.{objective.quantity}: {reason}")
    for constraint in problem.constraints:
        quantity = problem.quantity(constraint.quantity)
        for word, bound in constraint.sides:
            excluding = {"min": bound > 0.0, "max": bound < 0.0, "equals": bound != 0.0}[word]
            reason = quantity.zero_because(machines) if excluding else None
            if reason:
                raise InfeasibleError(
                    f"constraints.{quantity.name}: {word} {bound * quantity.unit.factor:.6g} {quantity.unit.symbol} "
                    f"excludes zero, and it is zero for every design of this job: {reason}"
                )


def idle_constraint_warnings(problem: Problem) -> list[str]:
    """Return a warning for each constraint on a quantity that is zero, and so meets it, for every design."""
    machines = [part.mechanism for part in problem.parts()]
    reasons = {
        sentence.quantity: problem.quantity(sentence.quantity).zero_because(machines)
        for sentence in problem.constraints
    }
    return [
        Remark(
            f"constraints.{name} excludes no design: it is zero for every design of this job; {reason}",
            Change(f"constraints.{name}", None, "Remove the requirement"),
        )
        for name, reason in reasons.items()
        if reason
    ]
