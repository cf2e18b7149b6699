"""Costs of tolerances in a job file, [costs], converted to the costs for an allocation."""

from __future__ import annotations

from typing import Annotated, ClassVar

from pydantic import model_validator

from ...model.errors import InputError
from ...objectives import kinds
from ..problem.tolerance_costs import Cost, Costs
from .value_types import (
    AngleTolerance,
    Built,
    Checked,
    Fraction,
    Limited,
    Physical,
    PositiveLength,
    PositiveRatio,
    Radius,
    optional_entry,
    required_entry,
)

PositiveAngle = Annotated[float, Physical(kinds.ANGLE, "positive")]


_Exponent = Annotated[PositiveRatio, Limited("from 0.25 to 4", "processes have 0.5 to 3", least=0.25, greatest=4.0)]


class _CostPart(Checked[Cost]):
    """Fields common to all costs. Any currency, the same for all."""

    makes = Cost
    renamed: ClassVar = {"min": "least", "max": "greatest"}

    cost: PositiveRatio = required_entry("of the part that depends on the tolerance, at the tolerance `at`", 8.0)
    fixed: Fraction = optional_entry("the rest of the cost", 5.0, default=0.0)
    exponent: _Exponent = optional_entry(
        "k of fixed + cost (at / tolerance)^k, 0.25 to 4; 1: reciprocal", 1.0, default=1.0
    )


class LengthCostPart(_CostPart):
    """Cost of the tolerance of a length: fixed + cost (at / tolerance)^exponent."""

    at: PositiveLength = required_entry("the tolerance at which `cost` applies", "0.05 mm")
    min: Radius = optional_entry("smallest tolerance that can be made", "0.005 mm", default=0.0)
    max: PositiveLength | None = optional_entry("greatest permissible tolerance", "0.2 mm")


class AngleCostPart(_CostPart):
    """Cost of the tolerance of the crank angle: fixed + cost (at / tolerance)^exponent."""

    at: PositiveAngle = required_entry("the tolerance at which `cost` applies", "0.1 deg")
    min: AngleTolerance = optional_entry("smallest tolerance that can be made", "0.01 deg", default=0.0)
    max: PositiveAngle | None = optional_entry("greatest permissible tolerance", "1 deg")


class CostsPart(Built[Costs]):
    """Costs of holding each tolerance, for the allocation of tolerances; a tolerance without a cost stays unchanged."""

    makes = Costs

    crank: LengthCostPart | None = optional_entry("of the crank", {"cost": 8.0, "at": "0.05 mm", "min": "0.005 mm"})
    rod: LengthCostPart | None = optional_entry("of the rod", {"cost": 6.0, "at": "0.05 mm", "fixed": 2.0})
    offset: LengthCostPart | None = optional_entry("of the offset", {"cost": 4.0, "at": "0.1 mm", "exponent": 2.0})
    crank_angle: AngleCostPart | None = optional_entry(
        "of the crank angle", {"cost": 10.0, "at": "0.1 deg", "max": "1 deg"}
    )

    @model_validator(mode="after")
    def _require_any_cost(self) -> CostsPart:
        if not self.model_fields_set:
            raise InputError(
                "must name at least one of crank, rod, offset and crank_angle; got an empty table; "
                'add for example crank = { cost = 8.0, at = "0.05 mm" }'
            )
        return self
