"""The table [sections] of a job file: material, pins and safety of the bars that `slidercrank sections` sizes."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from ..sizing.section_limits import Material, SectionLimits
from .values import Checked, Density, Part, PositiveLength, PositiveRange, PositiveRatio, Pressure

EXAMPLE = {
    "material": {
        "density": "7850 kg/m^3",
        "elasticity": "207 GPa",
        "yield_strength": "350 MPa",
        "ultimate_strength": "520 MPa",
        "endurance": "150 MPa",
        "bearing_pressure": "20 MPa",
    },
    "pins": {"crank_pivot": "15 mm", "crank_pin": "12 mm", "slider_pin": "10 mm"},
}
"""The least that the table holds."""


class MaterialPart(Checked[Material]):
    """Material of crank and rod."""

    makes = Material

    density: Density = Field(description="of the material", examples=["7850 kg/m^3"])
    elasticity: Pressure = Field(description="Young's modulus", examples=["207 GPa"])
    yield_strength: Pressure = Field(description="in tension and compression", examples=["350 MPa"])
    ultimate_strength: Pressure = Field(description="in tension", examples=["520 MPa"])
    endurance: Pressure = Field(
        description="fully reversed strength of the finished part, stress raisers included", examples=["150 MPa"]
    )
    bearing_pressure: Pressure = Field(
        description="permissible at the pins, on their projected area", examples=["20 MPa"]
    )


class PinsPart(Part):
    """Diameters of the three pins."""

    crank_pivot: PositiveLength = Field(description="between frame and crank", examples=["15 mm"])
    crank_pin: PositiveLength = Field(description="between crank and connecting rod", examples=["12 mm"])
    slider_pin: PositiveLength = Field(description="between connecting rod and slider", examples=["10 mm"])


class SectionsPart(Checked[tuple[Material, SectionLimits]]):
    """Material, pins, sizes that can be made and safety factors of crank and rod as rectangular bars."""

    material: MaterialPart = Field(description="of crank and rod", examples=[EXAMPLE["material"]])
    pins: PinsPart = Field(description="diameters", examples=[EXAMPLE["pins"]])
    width: PositiveRange = Field(
        (5e-3, 0.2), description="in the plane of motion: what can be made", examples=[["10 mm", "80 mm"]]
    )
    depth: PositiveRange = Field((3e-3, 0.1), description="normal to the plane", examples=[["5 mm", "40 mm"]])
    static_safety: PositiveRatio = Field(2.0, description="against yield", examples=[2.0])
    fatigue_safety: PositiveRatio = Field(1.5, description="against fatigue", examples=[1.5])
    buckling_safety: PositiveRatio = Field(3.0, description="against Euler's load", examples=[3.0])
    criterion: Literal["goodman", "soderberg"] = Field(
        "goodman", description="how mean stresses count in fatigue", examples=["goodman"]
    )

    def build(self) -> tuple[Material, SectionLimits]:
        """Return material and limits as the sizing has them."""
        own = dict(self)
        material, pins = own.pop("material"), own.pop("pins")
        return material.build(), SectionLimits(**dict(pins), **own)
