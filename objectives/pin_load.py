"""Loads of the pins: bearing pressure and shear at the greatest force of a turn."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

from ..model.machine.mechanism import Mechanism
from ..model.machine.numbers import PINS
from .bars import LINKS, NEAR, Formula, OfBars, Part, closed, over, pin_force
from .kinds import PRESSURE
from .needs import A_BAR, CRANK_BAR, LOADED, PIVOT_LOADED, ROD_BAR, STRENGTH
from .quantity import Array, Group


@dataclass(frozen=True, kw_only=True)
class PinPressure(OfBars):
    """The greatest pressure of a pin on the projected area D d of its bearing in a bar."""

    pin: str

    def parts(self, mechanism: Mechanism, designs: Array, kept: int, gradients: bool) -> Sequence[Part]:
        """Return the pressure in each bar that the pin bears in; see `OfBars`."""
        force = pin_force(mechanism, designs, self.pin, kept, gradients)
        areas = [projected(self.pin, name) for name in self.bars(mechanism)]
        return [over(force, closed(mechanism, designs, area, gradients)) for area in areas]


@dataclass(frozen=True, kw_only=True)
class PinShear(OfBars):
    """The greatest mean shear stress of a pin that is cut in one section."""

    pin: str

    def parts(self, mechanism: Mechanism, designs: Array, kept: int, gradients: bool) -> Sequence[Part]:
        """Return the stress; see `OfBars`."""
        slot = PINS[self.pin]
        force = pin_force(mechanism, designs, self.pin, kept, gradients)
        area = closed(mechanism, designs, lambda number: 0.25 * math.pi * number(slot) ** 2, gradients)
        return [over(force, area)]


def projected(pin: str, name: str) -> Formula:
    """Return the formula of the area D d that a pin bears on in a link, m^2."""
    return lambda number: number(PINS[pin]) * number(LINKS[name].depth)


JOINED = {pin: tuple(name for name, link in LINKS.items() if pin in (NEAR, link.far)) for pin in PINS}
"""Links that each pin bears in."""
_pressure = partial(
    PinPressure,
    kind=PRESSURE,
    group=Group.STRENGTH,
    section="22. Strength of crank and rod",
    formula="max F / (D d) over the crank angle",
    source="Shigley, Mechanical Engineering Design, 9th ed., sec. 12-5 (projected area)",
    example="15 MPa",
)
_shear = partial(
    PinShear,
    kind=PRESSURE,
    group=Group.STRENGTH,
    section="22. Strength of crank and rod",
    formula="max F / (pi D^2 / 4) over the crank angle, in one section",
    source="Shigley, Mechanical Engineering Design, 9th ed., sec. 3-11",
    example="40 MPa",
)
PIN_PRESSURE_CRANK_PIVOT = _pressure(
    name="pin_pressure_crank_pivot",
    title="pressure at the crank pivot",
    pin="crank_pivot",
    links=JOINED["crank_pivot"],
    place=460,
    sentence="The greatest pressure of the crank's pivot on its bearing over the depth of the crank.",
    picture="pivot force",
    needs=(STRENGTH, CRANK_BAR, PIVOT_LOADED),
)
PIN_PRESSURE_CRANK_PIN = _pressure(
    name="pin_pressure_crank_pin",
    title="pressure at the crank pin",
    pin="crank_pin",
    links=JOINED["crank_pin"],
    place=461,
    sentence="The greatest pressure of the crank pin on its bearing, in the thinner of crank and rod.",
    picture="crank pin force",
    needs=(STRENGTH, A_BAR, LOADED),
)
PIN_PRESSURE_SLIDER_PIN = _pressure(
    name="pin_pressure_slider_pin",
    title="pressure at the slider pin",
    pin="slider_pin",
    links=JOINED["slider_pin"],
    place=462,
    sentence="The greatest pressure of the slider pin on its bearing over the depth of the rod.",
    picture="slider pin force",
    needs=(STRENGTH, ROD_BAR, LOADED),
)
PIN_SHEAR_CRANK_PIVOT = _shear(
    name="pin_shear_crank_pivot",
    title="shear of the crank pivot",
    pin="crank_pivot",
    place=464,
    sentence="The greatest mean shear stress of the crank's pivot, cut once; half of it where it is held twice.",
    picture="pivot force",
    needs=(STRENGTH, PIVOT_LOADED),
)
PIN_SHEAR_CRANK_PIN = _shear(
    name="pin_shear_crank_pin",
    title="shear of the crank pin",
    pin="crank_pin",
    place=465,
    sentence="The greatest mean shear stress of the crank pin, cut once; half of it where it is held twice.",
    picture="crank pin force",
    needs=(STRENGTH, LOADED),
)
PIN_SHEAR_SLIDER_PIN = _shear(
    name="pin_shear_slider_pin",
    title="shear of the slider pin",
    pin="slider_pin",
    place=466,
    sentence="The greatest mean shear stress of the slider pin, cut once; half of it where it is held twice.",
    picture="slider pin force",
    needs=(STRENGTH, LOADED),
)
