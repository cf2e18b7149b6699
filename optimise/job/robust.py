"""The table [robust] of a job file: objectives and constraints within the tolerances."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import Field

from ...model.errors import InputError, JobError
from ...model.tolerance.error_distributions import Shape
from ...objectives.peak_torque import PEAK_TORQUE
from ...objectives.robust.quantity import SAMPLES, Case
from ...objectives.robust.tolerance_box_points import toleranced_columns
from ...objectives.transmission_angle import TRANSMISSION_ANGLE
from ..problem.problem import Problem
from ..problem.robust_problem import Robust, robust_problem
from .value_types import Checked, optional_entry


class RobustPart(Checked[Robust]):
    """Tolerances within the optimisation, per quantity; equalities, targets and position errors stay unchanged."""

    makes = Robust
    renamed: ClassVar = {"spread": "shape"}

    kind: Case = optional_entry(
        "percentile: value met by a percentage of all machines; worst case: value met by all machines within the "
        "limits",
        "percentile",
        default="percentile",
    )
    share: Annotated[float, Field(strict=True, ge=0.5, lt=1.0)] = optional_entry(
        "percentage of the machines, for a percentile", 0.99, default=0.99
    )
    order: Literal[1, 2] = optional_entry(
        "order of a worst case. 1: linear in the errors; 2: exact at the worst corner", 2, default=2
    )
    spread: Shape = optional_entry(
        "of the errors within the limits, for a percentile; normal: the limit is three standard deviations",
        "normal",
        default="normal",
    )
    samples: Annotated[int, Field(strict=True, ge=64, le=65536)] = optional_entry(
        "machines drawn for a percentile, the same for all designs", SAMPLES, default=SAMPLES
    )
    quantities: Annotated[tuple[str, ...], Field(min_length=1, max_length=50)] | None = optional_entry(
        "objectives and constraints to make robust; default: all for which this is possible",
        [PEAK_TORQUE.name, TRANSMISSION_ANGLE.name],
    )


def make_robust(problem: Problem, part: RobustPart | None) -> Problem:
    """Return the problem made robust if the job requests it. Raises JobError if that is impossible."""
    if part is None:
        return problem
    if problem.motion is not None:
        raise JobError("robust: needs a rotating crank; this crank swings; leave the table out")
    if not toleranced_columns(problem.part(0).mechanism):
        raise JobError(
            "robust: needs tolerances of crank, rod or offset; got none (that of the crank angle affects no quantity "
            'of a whole cycle); add for example [tolerances] crank = "0.05 mm"'
        )
    try:
        return robust_problem(problem, part.build())
    except InputError as error:
        raise JobError(f"robust: {error}") from None
