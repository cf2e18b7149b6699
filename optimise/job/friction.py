"""The table [friction] of a job file: what rubs, and how each part becomes one of the model."""

from __future__ import annotations

from typing import Annotated

from pydantic import AfterValidator, Field

from ...model.errors import InputError
from ...model.machine.friction import Friction, Pin
from .values import Fraction, Part, PositiveLength

_MOST = 2.0


def _believable(coefficient: float) -> float:
    if coefficient > _MOST:
        raise InputError(
            f"must be a coefficient of friction of at most {_MOST:g}; got {coefficient:g}; "
            "greased steel on bronze has about 0.1"
        )
    return coefficient


Coefficient = Annotated[Fraction, AfterValidator(_believable)]


class PinPart(Part):
    """A pin in its bearing: the friction moment is coefficient times radius times force."""

    radius: PositiveLength = Field(description="of the pin", examples=["10 mm"])
    coefficient: Coefficient = Field(description="of friction, on the pin's surface", examples=[0.08])

    def build(self) -> Pin:
        """Return the pin as the model has it."""
        return Pin(radius=self.radius, coefficient=self.coefficient)


class FrictionPart(Part):
    """Coulomb friction; a joint that is left out has none."""

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

    def build(self) -> Friction:
        """Return the friction as the model has it."""
        pins = {"crank_pivot": self.crank_pivot, "crank_pin": self.crank_pin, "slider_pin": self.slider_pin}
        return Friction(guide=self.guide, **{name: pin.build() for name, pin in pins.items() if pin is not None})
