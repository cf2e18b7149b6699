"""What the quantities mean, and the units that they are shown in."""

from __future__ import annotations

from fastapi import APIRouter
from pydantic import BaseModel, Field

router = APIRouter(tags=["designs"])


class QuantityModel(BaseModel):
    """A quantity, explained.

    name: as in job files. column: the key in tables and JSON. unit: of the column. picture: what a picture of the
    linkage points out for it. section: of docs/theory.md, where it is derived. source: of the equations.
    """

    name: str = Field(examples=["stroke"])
    column: str = Field(examples=["stroke_mm"])
    title: str = Field(examples=["stroke"])
    unit: str = Field(examples=["mm"])
    sentence: str = Field(examples=["The stroke is the way of the slider from one dead centre to the other."])
    advice: str = Field(description='what is usual; "" if there is nothing to say')
    formula: str = Field(examples=["S = sqrt((l+r)^2 - e^2) - sqrt((l-r)^2 - e^2)"])
    section: str = Field(examples=["2. Closed forms"])
    source: str
    picture: str = Field(examples=["stroke"])


class QuantityList(BaseModel):
    """All quantities: dimensions, those of designs, those of wanted motions."""

    quantities: list[QuantityModel]


class ShownUnit(BaseModel):
    """A unit that the API speaks in another system. factor: what one of the API's unit is in it."""

    unit: str = Field(examples=["in"])
    factor: float = Field(examples=[1 / 25.4])


class UnitTable(BaseModel):
    """By the unit that the API speaks, the unit of US customary units; the others are the same there."""

    inch: dict[str, ShownUnit] = Field(examples=[{"mm": {"unit": "in", "factor": 1 / 25.4}}])


@router.get("/units")
def list_units() -> UnitTable:
    """Give what values of the API are in inches, pounds and what is made of them."""
    from ...objectives.kinds import SHOWN, shown_in

    told = [(kind.metric.symbol, shown_in(kind.metric.symbol, "inch")) for kind in SHOWN if kind.metric and kind.inch]
    return UnitTable(inch={symbol: ShownUnit(unit=unit, factor=factor) for symbol, (unit, factor) in told})


@router.get("/quantities")
def list_quantities() -> QuantityList:
    """Explain every quantity in a sentence, with its formula and where it comes from."""
    from ..explained.explained import explained

    return QuantityList(
        quantities=[
            QuantityModel(
                name=item.text.name,
                column=item.column,
                title=item.title,
                unit=item.unit,
                sentence=item.text.sentence,
                advice=item.text.advice,
                formula=item.text.formula,
                section=item.text.section,
                source=item.text.source,
                picture=item.text.picture,
            )
            for item in explained()
        ]
    )
