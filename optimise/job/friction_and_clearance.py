"""Joints in a job file: their friction, [friction], and the pin with clearance, [clearance]."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated, ClassVar

from ...model.errors import JobError
from ...model.machine.clearance import Clearance, Joint, Law
from ...model.machine.friction import Friction, Pin
from .sections_table import PinsPart
from .value_types import (
    Built,
    Checked,
    Fraction,
    Limited,
    PositiveClearance,
    PositiveLength,
    Pressure,
    optional_entry,
    required_entry,
)

Coefficient = Annotated[
    Fraction,
    Limited("a coefficient of friction of at most 2", "greased steel on bronze has about 0.1", greatest=2.0),
]
_Restitution = Annotated[
    Fraction, Limited("above 0 and at most 1", "steel on steel has about 0.9", greater_than=0.0, greatest=1.0)
]
_Poisson = Annotated[Fraction, Limited("from 0 to 0.5", "steel has 0.3", greatest=0.5)]


class PinPart(Built[Pin]):
    """A pin in its bearing: the friction moment is coefficient times radius times force."""

    makes = Pin

    radius: PositiveLength | None = optional_entry(
        "radius of the pin; default half its diameter in [sections]", "10 mm"
    )
    coefficient: Coefficient = required_entry("of friction, on the pin's surface", 0.08)


class FrictionPart(Built[Friction]):
    """Coulomb friction; an omitted joint has none."""

    makes = Friction

    guide: Coefficient = optional_entry("coefficient of the slider in its guide", 0.1, default=0.0)
    crank_pivot: PinPart | None = optional_entry("between frame and crank", {"radius": "15 mm", "coefficient": 0.08})
    crank_pin: PinPart | None = optional_entry(
        "between crank and connecting rod", {"radius": "10 mm", "coefficient": 0.08}
    )
    slider_pin: PinPart | None = optional_entry(
        "between connecting rod and slider", {"radius": "8 mm", "coefficient": 0.08}
    )

    def with_pins(self, pins: PinsPart | None) -> Friction:
        """Return the friction; pins without a radius have the diameters of [sections].

        Raises JobError if it then needs [sections] and that is missing.
        """
        friction = self.build()
        for name in PinsPart.model_fields:
            part: PinPart | None = getattr(self, name)
            if part is None or part.radius is not None:
                continue
            if pins is None:
                raise JobError(
                    f"friction.{name}.radius: is missing, but required without [sections], which has the pins; add for "
                    'example radius = "10 mm"'
                )
            pin = replace(getattr(friction, name), radius=0.5 * getattr(pins, name))
            friction = replace(friction, **{name: pin})
        return friction


class ClearancePart(Checked[Clearance]):
    """A pin joint with a loose journal in its bearing."""

    makes = Clearance
    renamed: ClassVar = {"radial_clearance": "radius"}

    joint: Joint = required_entry("pin with clearance", "crank pin")
    radial_clearance: PositiveClearance = required_entry(
        "radius of the bearing minus radius of the journal: half the difference of the diameters", "0.2 mm"
    )
    journal_radius: PositiveLength = required_entry("of the pin", "10 mm")
    restitution: _Restitution = optional_entry(
        "speed after an impact over speed before, above 0 and at most 1", 0.9, default=0.9
    )
    friction: Fraction = optional_entry("coefficient between journal and bearing", 0.1, default=0.0)
    law: Law = optional_entry("of the damping in a contact", "flores", default="flores")
    elastic_modulus: Pressure = optional_entry("of journal and bearing; default steel", "207 GPa", default=207e9)
    poisson: _Poisson = optional_entry("Poisson's ratio of journal and bearing", 0.3, default=0.3)
