"""A loose joint in a job file, [clearance], and how it becomes a part of the model."""

from __future__ import annotations

from typing import Annotated

from pydantic import AfterValidator, Field, model_validator

from ...model.errors import InputError
from ...model.machine.clearance import Clearance, Joint, Law
from .values import Fraction, Part, PositiveLength, Pressure


def _restitution(e: float) -> float:
    if not 0.0 < e <= 1.0:
        raise InputError(f"must be above 0 and at most 1; got {e:g}; steel on steel has about 0.9")
    return e


def _poisson(nu: float) -> float:
    if nu > 0.5:
        raise InputError(f"must be from 0 to 0.5; got {nu:g}; steel has 0.3")
    return nu


class ClearancePart(Part):
    """A pin joint whose journal is loose in its bearing."""

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

    @model_validator(mode="after")
    def _possible(self) -> ClearancePart:
        self.build()
        return self

    def build(self) -> Clearance:
        """Return the joint as the model has it."""
        return Clearance(
            joint=self.joint,
            radius=self.radial_clearance,
            journal_radius=self.journal_radius,
            restitution=self.restitution,
            friction=self.friction,
            law=self.law,
            elastic_modulus=self.elastic_modulus,
            poisson=self.poisson,
        )
