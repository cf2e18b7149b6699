"""Joints in a job file: what rubs, [friction], and the pin that is loose, [clearance]."""

from __future__ import annotations

from typing import Annotated, ClassVar

from pydantic import AfterValidator, Field

from ...model.errors import InputError
from ...model.machine.clearance import Clearance, Joint, Law
from ...model.machine.friction import Friction, Pin
from .values import Built, Checked, Fraction, PositiveLength, Pressure

_MOST = 2.0


def _believable(coefficient: float) -> float:
    if coefficient > _MOST:
        raise InputError(
            f"must be a coefficient of friction of at most {_MOST:g}; got {coefficient:g}; "
            "greased steel on bronze has about 0.1"
        )
    return coefficient


Coefficient = Annotated[Fraction, AfterValidator(_believable)]


class PinPart(Built[Pin]):
    """A pin in its bearing: the friction moment is coefficient times radius times force."""

    makes = Pin

    radius: PositiveLength = Field(description="of the pin", examples=["10 mm"])
    coefficient: Coefficient = Field(description="of friction, on the pin's surface", examples=[0.08])


class FrictionPart(Built[Friction]):
    """Coulomb friction; a joint that is left out has none."""

    makes = Friction

    guide: Coefficient = Field(0.0, description="coefficient of the slider in its guide", examples=[0.1])
    crank_pivot: PinPart | None = Field(
        None, description="between frame and crank", examples=[{"radius": "15 mm", "coefficient": 0.08}]
    )
    crank_pin: PinPart | None = Field(
        None, description="between crank and connecting rod", examples=[{"radius": "10 mm", "coefficient": 0.08}]
    )
    slider_pin: PinPart | None = Field(
        None, description="between connecting rod and slider", examples=[{"radius": "8 mm", "coefficient": 0.08}]
    )


def _restitution(e: float) -> float:
    if not 0.0 < e <= 1.0:
        raise InputError(f"must be above 0 and at most 1; got {e:g}; steel on steel has about 0.9")
    return e


def _poisson(nu: float) -> float:
    if nu > 0.5:
        raise InputError(f"must be from 0 to 0.5; got {nu:g}; steel has 0.3")
    return nu


class ClearancePart(Checked[Clearance]):
    """A pin joint whose journal is loose in its bearing."""

    makes = Clearance
    renamed: ClassVar = {"radial_clearance": "radius"}

    joint: Joint = Field(description="which pin is loose", examples=["crank pin"])
    radial_clearance: PositiveLength = Field(
        description="radius of the bearing less radius of the journal: half the difference of the diameters",
        examples=["0.2 mm"],
    )
    journal_radius: PositiveLength = Field(description="of the pin", examples=["10 mm"])
    restitution: Annotated[Fraction, AfterValidator(_restitution)] = Field(
        0.9, description="speed after an impact over speed before, above 0 and at most 1", examples=[0.9]
    )
    friction: Fraction = Field(0.0, description="coefficient between journal and bearing", examples=[0.1])
    law: Law = Field("flores", description="of the damping in a contact", examples=["flores"])
    elastic_modulus: Pressure = Field(
        207e9, description="of journal and bearing; steel if left out", examples=["207 GPa"]
    )
    poisson: Annotated[Fraction, AfterValidator(_poisson)] = Field(
        0.3, description="Poisson's ratio of journal and bearing", examples=[0.3]
    )
