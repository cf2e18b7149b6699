"""Least-cost tolerances as numbers and text, compared with the cost and error of the original tolerances."""

from __future__ import annotations

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
from ..record_types import Note, Record

OfLength = Annotated[float | None, Note("null for the crank angle")]
OfAngle = Annotated[float | None, Note("of the crank angle; null for lengths")]
Before = Annotated[float | None, Note("null unless the job states every tolerance that has a cost")]

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ....objectives.kinds import System


class Tolerance(Record):
    """Tolerance of a length or of the crank angle."""

    name: str
    tolerance_mm: OfLength
    tolerance_deg: OfAngle
    cost: float
    share_of_cost_percent: float
    bound: Annotated[
        Literal["least", "greatest"] | None, Note("of the permitted range, if the tolerance is at it; otherwise null")
    ]
    bound_saving_per_um: OfLength
    """Saving if the bound moves; null for the crank angle."""
    bound_saving_per_mdeg: OfAngle


class ActiveAngle(Record):
    """Crank angle at which the error limit is active."""

    crank_angle_deg: float
    saving_per_um: float


class Tolerances(Record):
    """Least-cost tolerances within a position error limit."""

    kind: Kind
    """How errors combine."""
    limit_mm: float
    cost: float
    error_mm: float
    """Maximum over the counted part of the cycle."""
    exact_worst_case_mm: Annotated[
        float | None, Note("null where a linkage within the tolerances does not rotate fully")
    ]
    saving_per_um: float
    """Saving if the limit is raised."""
    tolerances: list[Tolerance]
    active_angles: list[ActiveAngle]
    cost_before: Before
    error_before_mm: Before
    rounds: int
    residual: float
    """Residual of the optimality conditions."""
    converged: bool
    """Whether the cost is proven to be minimal."""


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
            "allocation needs the costs of the tolerances; this job has no [costs]; for example, add [costs] crank = { "
            'cost = 8.0, at = "0.05 mm" }'
        )
    allocation = allocate_tolerances(linkage, problem.costs, limit, kind, mechanism=mechanism)
    return {"allocation": allocation, "costs": problem.costs}


def numbers(before: Mechanism, linkage: Linkage, *, allocation: Allocation, costs: Costs, **_: Any) -> Tolerances:
    """Return an allocation, ready for JSON.

    before: original mechanism; cost and error of its tolerances are None unless it has all tolerances and their costs.
    The exact worst case is None if a linkage within the tolerances does not rotate fully.
    """
    try:
        exact = 1e3 * worst_position_error(allocation.mechanism, linkage).size
    except AssemblyError:
        exact = None
    tolerances: list[Tolerance] = []
    for part in allocation.parts:
        angle = part.name == "crank_angle"
        unit = float(np.degrees(1.0)) if angle else 1e3
        tolerances.append(
            {
                "name": part.name,
                "tolerance_mm": None if angle else unit * part.tolerance,
                "tolerance_deg": unit * part.tolerance if angle else None,
                "cost": part.cost,
                "share_of_cost_percent": 100.0 * part.cost / allocation.cost,
                "bound": part.bound,
                "bound_saving_per_um": None if angle else 1e-6 * part.saving,
                "bound_saving_per_mdeg": 1e-3 * part.saving / unit if angle else None,
            }
        )
    was = costs_of_tolerances(costs, linkage, before)
    error = Signal.POSITION_ERROR if allocation.kind == "worst case" else Signal.POSITION_ERROR_RSS
    return {
        "kind": allocation.kind,
        "limit_mm": 1e3 * allocation.limit,
        "cost": allocation.cost,
        "error_mm": 1e3 * allocation.error,
        "exact_worst_case_mm": exact,
        "saving_per_um": 1e-6 * allocation.saving,
        "tolerances": tolerances,
        "active_angles": [
            {"crank_angle_deg": float(np.degrees(angle)), "saving_per_um": 1e-6 * float(saving)}
            for angle, saving in zip(allocation.angles, allocation.savings, strict=True)
        ],
        "cost_before": None if was is None else sum(was.values()),
        "error_before_mm": None if was is None else 1e3 * peak(before, error, linkage).value,
        "rounds": allocation.rounds,
        "residual": allocation.residual,
        "converged": allocation.converged,
    }


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
