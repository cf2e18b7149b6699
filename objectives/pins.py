"""Loads on the pins: bearing pressure and shear at the maximum force, rubbing and wear over a cycle."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from ..model.machine.cylinders_and_turns import cycle_turns, single_cylinder_machine
from ..model.machine.mechanism import Mechanism
from ..model.machine.raw_machine_vector import Raw
from ..model.machine.raw_numbers_of_designs import PINS, evaluate_formula_of_raw_numbers
from ..model.signals.turn_work import CRANK_PIN, CRANK_PIVOT, SLIDER_PIN, turn_work
from .bar_pieces import LINKS, NEAR, BarPeak, BarPieces, BarQuantity, SectionLoad, material_and_pins
from .kinds import LENGTH, PRESSURE, PRESSURE_SPEED
from .machine_needs import A_BAR, CRANK_BAR, EVEN_SPEED, LOADED, PIVOT_LOADED, ROD_BAR, SPEED, STRENGTH, WEARS, Need
from .quantity import Array, Formula

_CYCLES = 1e6
_RUBS = {"crank_pivot": CRANK_PIVOT, "crank_pin": CRANK_PIN, "slider_pin": SLIDER_PIN}


@dataclass(frozen=True, kw_only=True)
class PinPressure(BarPeak):
    """Maximum pressure of a pin on the projected area D d of its bearing in a bar."""

    pin: str

    def section_loads(self, mechanism: Mechanism) -> list[SectionLoad]:
        """Return the force on each bar that bears on the pin; see `BarPeak`."""
        return [
            SectionLoad(self.pin, projected_area_formula(self.pin, name)) for name in self.links_with_bars(mechanism)
        ]

    def allowable_value(self, mechanism: Mechanism) -> float:
        """Return the allowable bearing pressure of the material, Pa."""
        return material_and_pins(mechanism).material.bearing_pressure


@dataclass(frozen=True, kw_only=True)
class PinShear(BarPeak):
    """Maximum mean shear stress in a pin under single shear."""

    pin: str

    def section_loads(self, mechanism: Mechanism) -> list[SectionLoad]:
        """Return the force on the pin; see `BarPeak`."""
        return [SectionLoad(self.pin, lambda number: 0.25 * math.pi * number(PINS[self.pin]) ** 2)]

    def allowable_value(self, mechanism: Mechanism) -> float:
        """Return the shear yield strength by distortion energy, S_y / sqrt(3), Pa.

        Pins have the same material as the bars.

        Shigley, Mechanical Engineering Design, 9th ed., eq. 5-21.
        """
        return material_and_pins(mechanism).material.yield_strength / math.sqrt(3.0)


def projected_area_formula(pin: str, name: str) -> Formula:
    """Return the formula for the projected bearing area D d of a pin in a link, m^2."""
    return lambda number: number(PINS[pin]) * number(LINKS[name].depth)


_OF_PINS = {
    "crank_pivot": ("pivot force", CRANK_BAR, PIVOT_LOADED),
    "crank_pin": ("crank pin force", A_BAR, LOADED),
    "slider_pin": ("slider pin force", ROD_BAR, LOADED),
}


def facts_of_pin(
    pin: str, needs_before: tuple[Need, ...], needs_after: tuple[Need, ...] = (), *, bears: bool = True
) -> dict[str, Any]:
    """Return the facts that all quantities of a pin share.

    needs_before, needs_after: needs before and after the common ones. bears: whether it depends on the bars that the
    pin joins.
    """
    picture, bar, loaded = _OF_PINS[pin]
    if not bears:
        return {"pin": pin, "picture": picture, "needs": (*needs_before, loaded, *needs_after)}
    links = tuple(name for name, link in LINKS.items() if pin in (NEAR, link.far))
    return {"pin": pin, "links": links, "picture": picture, "needs": (*needs_before, bar, loaded, *needs_after)}


@dataclass(frozen=True, kw_only=True)
class PinRubbing(BarQuantity):
    """A factor divided by twice the bearing length b, times the mean of |F| |d psi / d theta|.

    psi: relative rotation in the pin.

    p = F / (D b) and the rubbing speed is D/2 |d psi / dt|, so the pin diameter D cancels.
    """

    pin: str
    factor: Callable[[Mechanism], Formula]

    def pieces_by_part(
        self, mechanism: Mechanism, designs: Array, piece_count: int, gradients: bool
    ) -> Sequence[BarPieces]:
        """Return the quantity for each bar that bears on the pin; see `BarQuantity`."""
        work, place = turn_work(single_cylinder_machine(mechanism), designs, gradients=gradients), _RUBS[self.pin]
        slopes = None if work.gradients is None else work.gradients[:, place, None]
        mean = BarPieces(work.mean[:, place, None], slopes, np.zeros((len(designs), 1)))
        factor = self.factor(mechanism)
        return [
            mean.multiplied_by(
                evaluate_formula_of_raw_numbers(
                    mechanism, designs, _factor_over_twice_length(factor, LINKS[name].depth), gradients=gradients
                )
            )
            for name in self.links_with_bars(mechanism)
        ]


def _factor_over_twice_length(factor: Formula, depth: int) -> Formula:
    """Return the formula for a factor divided by twice a length, 1/m. depth: slot of the length."""
    return lambda number: factor(number) / (2.0 * number(depth))


def _crank_speed_magnitude_formula(mechanism: Mechanism) -> Formula:
    return lambda number: mechanism.direction * number(Raw.SPEED)


def _wear_factor_formula(mechanism: Mechanism) -> Formula:
    """Return K times the crank angle in a million cycles; `PinRubbing` supplies the rest of K F s / A."""
    assert mechanism.strength is not None
    rate = mechanism.strength.wear_coefficient or math.nan
    return lambda number: rate * _CYCLES * cycle_turns(mechanism) * 2.0 * math.pi + 0.0 * number(Raw.CRANK)


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
    sentence="The greatest pressure of the crank's pivot in a bearing whose length is the depth of the crank.",
    **facts_of_pin("crank_pivot", (STRENGTH,)),
)
PIN_PRESSURE_CRANK_PIN = _pressure(
    name="pin_pressure_crank_pin",
    title="pressure at the crank pin",
    place=461,
    sentence="The greatest pressure of the crank pin on its bearing, in the thinner of crank and rod.",
    **facts_of_pin("crank_pin", (STRENGTH,)),
)
PIN_PRESSURE_SLIDER_PIN = _pressure(
    name="pin_pressure_slider_pin",
    title="pressure at the slider pin",
    place=462,
    sentence="The greatest pressure of the slider pin in a bearing whose length is the depth of the rod.",
    **facts_of_pin("slider_pin", (STRENGTH,)),
)
PIN_SHEAR_CRANK_PIVOT = _shear(
    name="pin_shear_crank_pivot",
    title="shear of the crank pivot",
    place=464,
    sentence="The greatest mean shear stress of the crank's pivot, in single shear; half as much in double shear.",
    **facts_of_pin("crank_pivot", (STRENGTH,), bears=False),
)
PIN_SHEAR_CRANK_PIN = _shear(
    name="pin_shear_crank_pin",
    title="shear of the crank pin",
    place=465,
    sentence="The greatest mean shear stress of the crank pin, in single shear; half as much in double shear.",
    **facts_of_pin("crank_pin", (STRENGTH,), bears=False),
)
PIN_SHEAR_SLIDER_PIN = _shear(
    name="pin_shear_slider_pin",
    title="shear of the slider pin",
    place=466,
    sentence="The greatest mean shear stress of the slider pin, in single shear; half as much in double shear.",
    **facts_of_pin("slider_pin", (STRENGTH,), bears=False),
)
_pv = partial(
    PinRubbing,
    kind=PRESSURE_SPEED,
    factor=_crank_speed_magnitude_formula,
    source="Shigley, Mechanical Engineering Design, 9th ed., sec. 12-15 (boundary-lubricated bearings)",
    advice="It determines how a dry bearing heats and wears; bushing makers state limits of 0.05 to 2 MPa m/s.",
    example="0.5 MPa m/s",
)
_wear = partial(
    PinRubbing,
    kind=LENGTH,
    factor=_wear_factor_formula,
    source="J. F. Archard, Contact and rubbing of flat surfaces, J. Appl. Phys. 24, 1953, 981-988",
    advice="Depth over the bearing's projected area, at the mean of all crank angles.",
    example="0.1 mm",
)
PV_PIVOT = _pv(
    name="pv_pivot",
    title="mean pv of the crank pivot over time",
    short="pv of the crank pivot",
    place=470,
    sentence="The mean over time of pressure times rubbing speed at the crank's pivot, in a bearing whose length is "
    "the depth of the crank.",
    formula="mean of |P| |omega| / (2 b) over time, b depth of the bar",
    **facts_of_pin("crank_pivot", (STRENGTH, EVEN_SPEED), (SPEED,)),
)
PV_CRANK_PIN = _pv(
    name="pv_crank_pin",
    title="mean pv of the crank pin over time",
    short="pv of the crank pin",
    place=471,
    sentence="The mean over time of pressure times rubbing speed at the crank pin, in the thinner of crank and rod.",
    formula="mean of |A| (1 - phi') |omega| / (2 b) over time, b depth of the bar",
    **facts_of_pin("crank_pin", (STRENGTH, EVEN_SPEED), (SPEED,)),
)
PV_SLIDER_PIN = _pv(
    name="pv_slider_pin",
    title="mean pv of the slider pin over time",
    short="pv of the slider pin",
    place=472,
    sentence="The mean over time of pressure times rubbing speed at the slider pin, in a bearing whose length is "
    "the depth of the rod.",
    formula="mean of |B| |phi'| |omega| / (2 b) over time, b depth of the bar",
    **facts_of_pin("slider_pin", (STRENGTH, EVEN_SPEED), (SPEED,)),
)
WEAR_PIVOT = _wear(
    name="wear_pivot",
    title="wear of the crank pivot",
    place=474,
    sentence="The wear depth at the crank's pivot after a million cycles, in a bearing whose length is the depth of "
    "the crank.",
    formula="10^6 K / (2 b) times the integral of |P| over the crank angle of a cycle",
    **facts_of_pin("crank_pivot", (WEARS, EVEN_SPEED)),
)
WEAR_CRANK_PIN = _wear(
    name="wear_crank_pin",
    title="wear of the crank pin",
    place=475,
    sentence="The wear depth in the bearing of the crank pin after a million cycles, in the thinner of crank and rod.",
    formula="10^6 K / (2 b) times the integral of |A| (1 - phi') over the crank angle of a cycle",
    **facts_of_pin("crank_pin", (WEARS, EVEN_SPEED)),
)
WEAR_SLIDER_PIN = _wear(
    name="wear_slider_pin",
    title="wear of the slider pin",
    place=476,
    sentence="The wear depth at the slider pin after a million cycles, in a bearing whose length is the depth of "
    "the rod.",
    formula="10^6 K / (2 b) times the integral of |B| |phi'| over the crank angle of a cycle",
    **facts_of_pin("slider_pin", (WEARS, EVEN_SPEED)),
)
