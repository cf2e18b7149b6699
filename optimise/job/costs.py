"""Costs of tolerances in a job file, [costs], and their conversion to the costs of an allocation."""

from __future__ import annotations

from typing import Annotated, ClassVar

from pydantic import Field, model_validator

from ...model.errors import InputError
from ...objectives import kinds
from ..problem.costs import Cost, Costs
from .values import AngleTolerance, Built, Checked, Fraction, Physical, PositiveLength, PositiveRatio, Radius

PositiveAngle = Annotated[float, Physical(kinds.ANGLE, "positive")]


class _CostPart(Checked[Cost]):
    """The fields that all costs have. Any currency, the same in all."""

    makes = Cost
    renamed: ClassVar = {"min": "least", "max": "greatest"}

    cost: PositiveRatio = Field(
        description="of the part that depends on the tolerance, where that is `at`", examples=[8.0]
    )
    fixed: Fraction = Field(0.0, description="the rest of the cost", examples=[5.0])
    exponent: PositiveRatio = Field(
        1.0, description="k of fixed + cost (at / tolerance)^k, 0.25 to 4; 1: reciprocal", examples=[1.0]
    )


class LengthCostPart(_CostPart):
    """Cost of the tolerance of a length: fixed + cost (at / tolerance)^exponent."""

    at: PositiveLength = Field(description="the tolerance that `cost` is for", examples=["0.05 mm"])
    min: Radius = Field(0.0, description="least tolerance that can be made", examples=["0.005 mm"])
    max: PositiveLength | None = Field(None, description="greatest tolerance that is allowed", examples=["0.2 mm"])


class AngleCostPart(_CostPart):
    """Cost of the tolerance of the crank angle: fixed + cost (at / tolerance)^exponent."""

    at: PositiveAngle = Field(description="the tolerance that `cost` is for", examples=["0.1 deg"])
    min: AngleTolerance = Field(0.0, description="least tolerance that can be made", examples=["0.01 deg"])
    max: PositiveAngle | None = Field(None, description="greatest tolerance that is allowed", examples=["1 deg"])


class CostsPart(Built[Costs]):
    """Costs of holding each tolerance, for the allocation of tolerances; one without a cost stays as given."""

    makes = Costs

    crank: LengthCostPart | None = Field(
        None, description="of the crank", examples=[{"cost": 8.0, "at": "0.05 mm", "min": "0.005 mm"}]
    )
    rod: LengthCostPart | None = Field(
        None, description="of the rod", examples=[{"cost": 6.0, "at": "0.05 mm", "fixed": 2.0}]
    )
    offset: LengthCostPart | None = Field(
        None, description="of the offset", examples=[{"cost": 4.0, "at": "0.1 mm", "exponent": 2.0}]
    )
    crank_angle: AngleCostPart | None = Field(
        None, description="of the crank angle", examples=[{"cost": 10.0, "at": "0.1 deg", "max": "1 deg"}]
    )

    @model_validator(mode="after")
    def _some(self) -> CostsPart:
        if not self.model_fields_set:
            raise InputError(
                "must name at least one of crank, rod, offset and crank_angle; got an empty table; "
                'add for example crank = { cost = 8.0, at = "0.05 mm" }'
            )
        return self
