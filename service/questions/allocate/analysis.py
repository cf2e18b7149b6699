"""Least-cost tolerances as numbers and text, compared with the cost and error of the original tolerances."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np

from ....model.errors import AssemblyError, InputError
from ....model.linkage.linkage import Linkage
from ....model.machine.mechanism import Mechanism
from ....model.signals.signals import Signal
from ....model.tolerance.exact_worst_case import worst_position_error
from ....objectives.kinds import ANGLE, LENGTH, display_unit
from ....optimise.problem.problem import Problem
from ....optimise.problem.tolerance_costs import Costs, costs_of_tolerances
from ....optimise.sizing.input_words import Kind
from ....optimise.sizing.tolerance_allocation import Allocation, allocate_tolerances
from ...render.blocks import (
    Block,
    Table,
    Text,
    Unit,
    Value,
    column,
    heading,
    joined,
    sentence,
    value_from_record,
    words,
)
from ..peaks import peak
from ..record_types import Keys, Note

OfAngle = Annotated[float | None, Note("of the crank angle; null for lengths")]
Before = Annotated[float | None, Note("null unless the job has all tolerances that have a cost")]

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ....objectives.kinds import System


def _of_length(value: Callable[[Any], float], note: str = "null for the crank angle") -> tuple[Any, Any]:
    return Annotated[float | None, Note(note)], lambda part, _: None if part.name == "crank_angle" else value(part)


def _of_angle(value: Callable[[Any], float]) -> tuple[Any, Any]:
    return OfAngle, lambda part, _: value(part) if part.name == "crank_angle" else None


_TOLERANCE = Keys(
    "Tolerance",
    "Tolerance of a length or of the crank angle.",
    {
        "name": (str, lambda part, _: part.name),
        "tolerance_mm": _of_length(lambda part: 1e3 * part.tolerance),
        "tolerance_deg": _of_angle(lambda part: float(np.degrees(1.0)) * part.tolerance),
        "cost": (float, lambda part, _: part.cost),
        "share_of_cost_percent": (float, lambda part, allocation: 100.0 * part.cost / allocation.cost),
        "bound": (
            Annotated[Literal["least", "greatest"] | None, Note("of what is possible, if it is at one; else null")],
            lambda part, _: part.bound,
        ),
        "bound_saving_per_um": _of_length(
            lambda part: 1e-6 * part.saving, "Saving if the bound moves; null for the crank angle."
        ),
        "bound_saving_per_mdeg": _of_angle(lambda part: 1e-3 * part.saving / float(np.degrees(1.0))),
    },
)
Tolerance = Annotated[dict[str, Any], _TOLERANCE]
_ACTIVE_ANGLE = Keys(
    "ActiveAngle",
    "Crank angle at which the error limit is active.",
    {
        "crank_angle_deg": (float, lambda angle, _: float(np.degrees(angle))),
        "saving_per_um": (float, lambda _, saving: 1e-6 * float(saving)),
    },
)
ActiveAngle = Annotated[dict[str, Any], _ACTIVE_ANGLE]
_TOLERANCES = Keys(
    "Tolerances",
    "Least-cost tolerances within a position error limit.",
    {
        "kind": (Annotated[Kind, Note("How errors combine.")], lambda allocation, *_: allocation.kind),
        "limit_mm": (float, lambda allocation, *_: 1e3 * allocation.limit),
        "cost": (float, lambda allocation, *_: allocation.cost),
        "error_mm": (
            Annotated[float, Note("Maximum over the counted part of the cycle.")],
            lambda allocation, *_: 1e3 * allocation.error,
        ),
        "exact_worst_case_mm": (
            Annotated[float | None, Note("null where a linkage within the tolerances does not turn")],
            lambda allocation, _, linkage, __: _exact_worst_case(allocation.mechanism, linkage),
        ),
        "saving_per_um": (
            Annotated[float, Note("Saving if the limit is raised.")],
            lambda allocation, *_: 1e-6 * allocation.saving,
        ),
        "tolerances": (
            list[Tolerance],
            lambda allocation, *_: [_TOLERANCE.of(part, allocation) for part in allocation.parts],
        ),
        "active_angles": (
            list[ActiveAngle],
            lambda allocation, *_: [
                _ACTIVE_ANGLE.of(*pair) for pair in zip(allocation.angles, allocation.savings, strict=True)
            ],
        ),
        "cost_before": (Before, lambda _, __, ___, was: None if was is None else sum(was.values())),
        "error_before_mm": (
            Before,
            lambda allocation, before, linkage, was: (
                None if was is None else 1e3 * peak(before, _ERRORS[allocation.kind], linkage).value
            ),
        ),
        "rounds": (int, lambda allocation, *_: allocation.rounds),
        "residual": (
            Annotated[float, Note("Residual of the optimality conditions.")],
            lambda allocation, *_: allocation.residual,
        ),
        "converged": (
            Annotated[bool, Note("Whether the cost is proven to be minimal.")],
            lambda allocation, *_: allocation.converged,
        ),
    },
)
Tolerances = Annotated[dict[str, Any], _TOLERANCES]
_ERRORS = {"worst case": Signal.POSITION_ERROR, "rss": Signal.POSITION_ERROR_RSS}
_STEP = replace(
    LENGTH, metric=display_unit("1 µm", 1e6), inch=display_unit("0.0001 in", 1e4 * LENGTH.display_unit("inch").factor)
)
"""A length step to which a saving refers, as a unit of its own."""


def compute_shared_options(
    mechanism: Mechanism,
    linkage: Linkage,
    *,
    problem: Problem | None,
    limit: float,
    kind: Kind = "worst case",
    **_: Any,
) -> dict[str, Any]:
    """Return the allocation that numbers and figure share, and the costs. Raises `InputError` if [costs] is missing."""
    if problem is None or problem.costs is None:
        raise InputError(
            "allocation needs the costs of the tolerances; this job has no [costs]; add for example [costs] crank = { "
            'cost = 8.0, at = "0.05 mm" }'
        )
    allocation = allocate_tolerances(linkage, problem.costs, limit, kind, mechanism=mechanism)
    return {"allocation": allocation, "costs": problem.costs}


def numbers(before: Mechanism, linkage: Linkage, *, allocation: Allocation, costs: Costs, **_: Any) -> Tolerances:
    """Return an allocation, ready for JSON.

    before: original mechanism; cost and error of its tolerances are None unless it has all tolerances and their costs.
    The exact worst case is None if a linkage within the tolerances does not rotate fully.
    """
    return _TOLERANCES.of(allocation, before, linkage, costs_of_tolerances(costs, linkage, before))


def _exact_worst_case(mechanism: Mechanism, linkage: Linkage) -> float | None:
    try:
        return 1e3 * worst_position_error(mechanism, linkage).size
    except AssemblyError:
        return None


def notes(numbers: Tolerances) -> list[str]:
    """Return a note for an unproven optimum."""
    residual = f"the optimality conditions are only met to {numbers['residual']:.1e}"
    return [] if numbers["converged"] else [f"not proven to be the cheapest: {residual}"]


def figure(
    before: Mechanism, linkage: Linkage, *, allocation: Allocation, costs: Costs, units: System, **_: Any
) -> Figure:
    """Return the panels for error and costs over the cycle."""
    from .figure import allocation_curves, allocation_figure

    return allocation_figure(allocation_curves(allocation, linkage, costs, before), units)


def blocks(numbers: Tolerances) -> list[Block]:
    """Return the answer in human-readable form."""
    kind = "worst case" if numbers["kind"] == "worst case" else "root-sum-square"
    rows = [_tolerance_row(tolerance) for tolerance in numbers["tolerances"]]
    rows.append(("together", "", value_from_record(numbers, "cost", digits=5), "", _job_cost_text(numbers)))
    columns = column("tolerance of", left=True), column("±"), column("costs"), column("share"), column(left=True)
    limit = value_from_record(numbers, "limit_mm")
    exact: Text = ""
    if numbers["exact_worst_case_mm"] is not None:
        exact = words("; exact worst case {size}", size=value_from_record(numbers, "exact_worst_case_mm"))
    holds = sentence("the limit is not active: every tolerance is at its upper bound")
    if numbers["active_angles"]:
        holds = sentence(
            "the limit is reached at {angles} {unit}; raising it by {step} saves {saving}",
            angles=joined(
                [value_from_record(at, "crank_angle_deg", digits=4, bare=True) for at in numbers["active_angles"]]
            ),
            unit=Unit(ANGLE),
            step=Unit(_STEP),
            saving=_saving_per_step(numbers["saving_per_um"]),
        )
    return [
        heading(f"Least-cost tolerances for a position error of {{limit}}, {kind}", limit=limit),
        Table(columns, tuple(rows)),
        sentence("largest error {error}{exact}", error=value_from_record(numbers, "error_mm"), exact=exact),
        holds,
    ]


def _tolerance_row(tolerance: Tolerance) -> tuple[Text, ...]:
    length = tolerance["tolerance_deg"] is None
    remark: Text = ""
    if tolerance["bound"]:
        saved = Value(tolerance["bound_saving_per_mdeg"], digits=4)
        remark = words(
            f"the {tolerance['bound']} bound; moving it further by {{step}} would save {{saving}}",
            saving=_saving_per_step(tolerance["bound_saving_per_um"]) if length else saved,
            step=Unit(_STEP) if length else "0.001 deg",
        )
    size = value_from_record(tolerance, "tolerance_mm" if length else "tolerance_deg", digits=5)
    cost = value_from_record(tolerance, "cost", digits=5)
    share = f"{tolerance['share_of_cost_percent']:.1f} %"
    return tolerance["name"].replace("_", " "), (size,), cost, share, remark


def _saving_per_step(per_um: float | None) -> Value:
    """Return the saving for one step of length."""
    per = replace(_STEP, metric=display_unit("", 1e-6), inch=display_unit("", 1.0 / _STEP.display_unit("inch").factor))
    return Value(None if per_um is None else 1e6 * per_um, per, 4)


def _job_cost_text(numbers: Tolerances) -> Text:
    if numbers["cost_before"] is None:
        return ""
    cost, error = (
        value_from_record(numbers, "cost_before", digits=5),
        value_from_record(numbers, "error_before_mm", digits=4),
    )
    return words("in the job: cost {cost}, error {error}", cost=cost, error=error)
