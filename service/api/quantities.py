"""What the quantities mean."""

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
