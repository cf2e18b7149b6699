"""Loads on the pins: bearing pressure and shear at the greatest force in a turn."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from ..model.machine.mechanism import Mechanism
from ..model.machine.numbers import PINS, formula_of_numbers
from .bars import LINKS, NEAR, Formula, OfBars, Part, force_over_area, pin_force, strength_of
from .kinds import PRESSURE
from .machine_needs import A_BAR, CRANK_BAR, LOADED, PIVOT_LOADED, ROD_BAR, STRENGTH, Need
from .quantity import Array


@dataclass(frozen=True, kw_only=True)
class PinPressure(OfBars):
    """The greatest pressure of a pin on the projected area D d of its bearing in a bar."""

    pin: str

    def parts(self, mechanism: Mechanism, designs: Array, piece_count: int, gradients: bool) -> Sequence[Part]:
        """Return the pressure in each bar that bears on the pin; see `OfBars`."""
        force = pin_force(mechanism, designs, self.pin, piece_count, gradients)
        areas = [projected(self.pin, name) for name in self.bars(mechanism)]
        return [
            force_over_area(force, formula_of_numbers(mechanism, designs, area, gradients=gradients)) for area in areas
        ]

    def allowable(self, mechanism: Mechanism) -> float:
        """Return the bearing pressure of the material, Pa."""
        return strength_of(mechanism).material.bearing_pressure


@dataclass(frozen=True, kw_only=True)
class PinShear(OfBars):
    """The greatest mean shear stress of a pin in single shear."""

    pin: str

    def parts(self, mechanism: Mechanism, designs: Array, piece_count: int, gradients: bool) -> Sequence[Part]:
        """Return the stress; see `OfBars`."""
        slot = PINS[self.pin]
        force = pin_force(mechanism, designs, self.pin, piece_count, gradients)
        area = formula_of_numbers(
            mechanism, designs, lambda number: 0.25 * math.pi * number(slot) ** 2, gradients=gradients
        )
        return [force_over_area(force, area)]

    def allowable(self, mechanism: Mechanism) -> float:
        """Return the shear yield strength by distortion energy, S_y / sqrt(3), Pa; pins have the bars' material.

        Shigley, Mechanical Engineering Design, 9th ed., eq. 5-21.
        """
        return strength_of(mechanism).material.yield_strength / math.sqrt(3.0)


def projected(pin: str, name: str) -> Formula:
    """Return the formula for the projected bearing area D d of a pin in a link, m^2."""
    return lambda number: number(PINS[pin]) * number(LINKS[name].depth)


_OF_PINS = {
    "crank_pivot": ("pivot force", CRANK_BAR, PIVOT_LOADED),
    "crank_pin": ("crank pin force", A_BAR, LOADED),
    "slider_pin": ("slider pin force", ROD_BAR, LOADED),
}


def of_pin(
    pin: str, needs_before: tuple[Need, ...], needs_after: tuple[Need, ...] = (), *, bears: bool = True
) -> dict[str, Any]:
    """Return the facts that quantities of a pin share.

    needs_before, needs_after: needs besides its own. bears: whether it bears on the bars that it joins.
    """
    picture, bar, loaded = _OF_PINS[pin]
    if not bears:
        return {"pin": pin, "picture": picture, "needs": (*needs_before, loaded, *needs_after)}
    links = tuple(name for name, link in LINKS.items() if pin in (NEAR, link.far))
    return {"pin": pin, "links": links, "picture": picture, "needs": (*needs_before, bar, loaded, *needs_after)}


_pressure = partial(
    PinPressure,
    kind=PRESSURE,
    formula="max F / (D d) over the crank angle",
    allowed_by="bearing pressure of the material",
    source="Shigley, Mechanical Engineering Design, 9th ed., sec. 12-5 (projected area)",
    example="15 MPa",
)
_shear = partial(
    PinShear,
    kind=PRESSURE,
    formula="max F / (pi D^2 / 4) over the crank angle, in one section",
    allowed_by="shear yield strength of the material",
    source="Shigley, Mechanical Engineering Design, 9th ed., sec. 3-11",
    example="40 MPa",
)
PIN_PRESSURE_CRANK_PIVOT = _pressure(
    name="pin_pressure_crank_pivot",
    title="pressure at the crank pivot",
    place=460,
    sentence="The greatest pressure of the crank's pivot on its bearing over the depth of the crank.",
    **of_pin("crank_pivot", (STRENGTH,)),
)
PIN_PRESSURE_CRANK_PIN = _pressure(
    name="pin_pressure_crank_pin",
    title="pressure at the crank pin",
    place=461,
    sentence="The greatest pressure of the crank pin on its bearing, in the thinner of crank and rod.",
    **of_pin("crank_pin", (STRENGTH,)),
)
PIN_PRESSURE_SLIDER_PIN = _pressure(
    name="pin_pressure_slider_pin",
    title="pressure at the slider pin",
    place=462,
    sentence="The greatest pressure of the slider pin on its bearing over the depth of the rod.",
    **of_pin("slider_pin", (STRENGTH,)),
)
PIN_SHEAR_CRANK_PIVOT = _shear(
    name="pin_shear_crank_pivot",
    title="shear of the crank pivot",
    place=464,
    sentence="The greatest mean shear stress of the crank's pivot, in single shear; half as much in double shear.",
    **of_pin("crank_pivot", (STRENGTH,), bears=False),
)
PIN_SHEAR_CRANK_PIN = _shear(
    name="pin_shear_crank_pin",
    title="shear of the crank pin",
    place=465,
    sentence="The greatest mean shear stress of the crank pin, in single shear; half as much in double shear.",
    **of_pin("crank_pin", (STRENGTH,), bears=False),
)
PIN_SHEAR_SLIDER_PIN = _shear(
    name="pin_shear_slider_pin",
    title="shear of the slider pin",
    place=466,
    sentence="The greatest mean shear stress of the slider pin, in single shear; half as much in double shear.",
    **of_pin("slider_pin", (STRENGTH,), bears=False),
)
