"""The table [sections] of a job file: material, pins and safety factors of the crank and the rod as bars."""

from __future__ import annotations

from typing import Annotated

from ...model.machine.strength import Criterion, Material, Strength
from ...objectives.kinds import PRESSURE
from ..problem.section_limits import SectionLimits
from .value_types import (
    Checked,
    Density,
    Limited,
    Part,
    PhysicalWithin,
    PositiveLength,
    PositiveRange,
    PositiveRatio,
    WearCoefficient,
    optional_entry,
    required_entry,
)

EXAMPLE = {
    "material": {
        "density": "7850 kg/m^3",
        "elasticity": "207 GPa",
        "yield_strength": "350 MPa",
        "ultimate_strength": "520 MPa",
        "endurance": "150 MPa",
        "bearing_pressure": "20 MPa",
    },
    "pins": dict.fromkeys(("crank_pivot", "crank_pin", "slider_pin"), "15 mm"),
}
"""Minimum content of the table. The pins are half as wide as their bars, which are 30 mm wide in the other examples."""


_OF_STRENGTH = ("criterion", "eye_concentration", "wear_coefficient")


_Raised = Annotated[
    PositiveRatio, Limited("at least 1, the mean stress", "a pin in an eye has about 2.5 to 4", least=1.0)
]
_Safety = Annotated[PositiveRatio, Limited("at least 1", "below 1 the part fails", least=1.0)]


_CORRECT = "correct the number or its unit"
_Elasticity = Annotated[
    float,
    PhysicalWithin(
        PRESSURE,
        "positive",
        rule="from 10 MPa to 2 TPa",
        hint=f"steel has 207 GPa; {_CORRECT}",
        least=1e7,
        greatest=2e12,
    ),
]
_Strength = Annotated[
    float,
    PhysicalWithin(
        PRESSURE,
        "positive",
        rule="from 1 MPa to 20 GPa",
        hint=f"steels have 200 to 2,000 MPa; {_CORRECT}",
        least=1e6,
        greatest=2e10,
    ),
]
_Bearing = Annotated[
    float,
    PhysicalWithin(
        PRESSURE,
        "positive",
        rule="from 10 kPa to 5 GPa",
        hint=f"bushes bear 1 to 100 MPa; {_CORRECT}",
        least=1e4,
        greatest=5e9,
    ),
]
"""Solid bars of any material, from soft plastics to fibres, lie well within; a value beyond has another unit."""


class MaterialPart(Checked[Material]):
    """Material of the crank and the rod."""

    makes = Material

    density: Density = required_entry("of the material", "7850 kg/m^3")
    elasticity: _Elasticity = required_entry("Young's modulus", "207 GPa")
    yield_strength: _Strength = required_entry("in tension and compression", "350 MPa")
    ultimate_strength: _Strength = required_entry("in tension", "520 MPa")
    endurance: _Strength = required_entry(
        "fully reversed strength of the finished bar, without eye_concentration", "150 MPa"
    )
    bearing_pressure: _Bearing = required_entry("permissible at the pins, on their projected area", "20 MPa")


class PinsPart(Part):
    """Diameters of the three pins. Half the bar's width is a usual start."""

    crank_pivot: PositiveLength = required_entry("between frame and crank", "15 mm")
    crank_pin: PositiveLength = required_entry("between crank and connecting rod", "15 mm")
    slider_pin: PositiveLength = required_entry("between connecting rod and slider", "15 mm")


class SectionsPart(Checked[SectionLimits]):
    """Material, pins, available sizes and safety factors of crank and rod as rectangular bars."""

    material: MaterialPart = required_entry("of crank and rod", EXAMPLE["material"])
    pins: PinsPart = required_entry("diameters, usually about half the width of the bar", EXAMPLE["pins"])
    width: PositiveRange = optional_entry(
        "in the plane of motion: range that can be made", ["10 mm", "80 mm"], default=(5e-3, 0.2)
    )
    depth: PositiveRange = optional_entry("normal to the plane", ["5 mm", "40 mm"], default=(3e-3, 0.1))
    static_safety: _Safety = optional_entry("against yield", 2.0, default=2.0)
    fatigue_safety: _Safety = optional_entry("against fatigue", 1.5, default=1.5)
    buckling_safety: _Safety = optional_entry("against Euler's load", 3.0, default=3.0)
    criterion: Criterion = optional_entry("fatigue criterion for mean stresses", "goodman", default="goodman")
    eye_concentration: _Raised = optional_entry(
        "greatest divided by mean stress in the net section of an eye; see a chart such as Shigley's fig. A-15-12",
        2.5,
        default=1.0,
    )

    wear_coefficient: WearCoefficient | None = optional_entry(
        "wear coefficient: worn volume per force and sliding distance, for the softer of pin and bearing",
        "1e-9 mm^2/N",
    )

    def build(self) -> SectionLimits:
        """Return the limits in the form that the sizing uses."""
        entries = dict(self)
        for name in ("material", "pins", "wear_coefficient"):
            entries.pop(name)
        return SectionLimits(**dict(self.pins), **entries)

    def strength(self) -> Strength:
        """Return material and pins in the form that quantities use."""
        return Strength(
            material=self.material.build(), **dict(self.pins), **{name: getattr(self, name) for name in _OF_STRENGTH}
        )
