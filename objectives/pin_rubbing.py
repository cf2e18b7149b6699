"""Rubbing of the pins: mean over time of pressure times rubbing speed, and wear depth."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from ..model.machine.mechanism import Mechanism
from ..model.machine.members import single_cylinder
from ..model.machine.numbers import formula_of_numbers
from ..model.machine.raw import Raw
from ..model.machine.two_turns import cycle_turns
from ..model.signals.turn_work import CRANK_PIN, CRANK_PIVOT, SLIDER_PIN, turn_work
from .bars import LINKS, Formula, OfBars, Part
from .kinds import LENGTH, PRESSURE_SPEED
from .machine_needs import EVEN_SPEED, SPEED, STRENGTH, WEARS
from .pin_load import of_pin
from .quantity import Array

_CYCLES = 1e6
_RUBS = {"crank_pivot": CRANK_PIVOT, "crank_pin": CRANK_PIN, "slider_pin": SLIDER_PIN}


@dataclass(frozen=True, kw_only=True)
class PinRubbing(OfBars):
    """A factor over twice the bearing's length b times the mean of |F| |d psi / d theta|.

    psi: relative rotation in the pin.

    p = F / (D b) and a rubbing speed of D/2 |d psi / dt|: the pin's diameter D cancels.
    """

    pin: str
    factor: Callable[[Mechanism], Formula]

    def parts(self, mechanism: Mechanism, designs: Array, piece_count: int, gradients: bool) -> Sequence[Part]:
        """Return the quantity for each bar that bears on the pin; see `OfBars`."""
        work, place = turn_work(single_cylinder(mechanism), designs, gradients=gradients), _RUBS[self.pin]
        slopes = None if work.gradients is None else work.gradients[:, place, None]
        mean = Part(work.mean[:, place, None], slopes, np.zeros((len(designs), 1)))
        factor = self.factor(mechanism)
        return [
            mean.times(
                formula_of_numbers(mechanism, designs, _per_length(factor, LINKS[name].depth), gradients=gradients)
            )
            for name in self.bars(mechanism)
        ]


def _per_length(factor: Formula, depth: int) -> Formula:
    """Return the formula of a factor over twice a length, 1/m. depth: slot of the length."""
    return lambda number: factor(number) / (2.0 * number(depth))


def _speed(mechanism: Mechanism) -> Formula:
    return lambda number: mechanism.direction * number(Raw.SPEED)


def _worn(mechanism: Mechanism) -> Formula:
    """Return K times the crank angle of a million cycles; `PinRubbing` supplies the rest of K F s / A."""
    assert mechanism.strength is not None
    rate = mechanism.strength.wear_coefficient or math.nan
    return lambda number: rate * _CYCLES * cycle_turns(mechanism) * 2.0 * math.pi + 0.0 * number(Raw.CRANK)


_pv = partial(
    PinRubbing,
    kind=PRESSURE_SPEED,
    factor=_speed,
    source="Shigley, Mechanical Engineering Design, 9th ed., sec. 12-15 (boundary-lubricated bearings)",
    advice="It decides how a dry bearing heats and wears; makers of bushings state a limit of 0.05 to 2 MPa m/s.",
    example="0.5 MPa m/s",
)
_wear = partial(
    PinRubbing,
    kind=LENGTH,
    factor=_worn,
    source="J. F. Archard, Contact and rubbing of flat surfaces, J. Appl. Phys. 24, 1953, 981-988",
    advice="Depth over the bearing's projected area, at the mean of all crank angles.",
    example="0.1 mm",
)
PV_PIVOT = _pv(
    name="pv_pivot",
    title="mean pv of the crank pivot over time",
    short="pv of the crank pivot",
    place=470,
    sentence="The mean over time of pressure times rubbing speed at the crank's pivot, over the depth of the crank.",
    formula="mean of |P| |omega| / (2 b) over time, b depth of the bar",
    **of_pin("crank_pivot", (STRENGTH, EVEN_SPEED), (SPEED,)),
)
PV_CRANK_PIN = _pv(
    name="pv_crank_pin",
    title="mean pv of the crank pin over time",
    short="pv of the crank pin",
    place=471,
    sentence="The mean over time of pressure times rubbing speed at the crank pin, in the thinner of crank and rod.",
    formula="mean of |A| (1 - phi') |omega| / (2 b) over time, b depth of the bar",
    **of_pin("crank_pin", (STRENGTH, EVEN_SPEED), (SPEED,)),
)
PV_SLIDER_PIN = _pv(
    name="pv_slider_pin",
    title="mean pv of the slider pin over time",
    short="pv of the slider pin",
    place=472,
    sentence="The mean over time of pressure times rubbing speed at the slider pin, over the depth of the rod.",
    formula="mean of |B| |phi'| |omega| / (2 b) over time, b depth of the bar",
    **of_pin("slider_pin", (STRENGTH, EVEN_SPEED), (SPEED,)),
)
WEAR_PIVOT = _wear(
    name="wear_pivot",
    title="wear of the crank pivot",
    place=474,
    sentence="The depth that a million cycles wear off the bearing of the crank's pivot, over the depth of the crank.",
    formula="10^6 K / (2 b) times the integral of |P| over the crank angle of a cycle",
    **of_pin("crank_pivot", (WEARS, EVEN_SPEED)),
)
WEAR_CRANK_PIN = _wear(
    name="wear_crank_pin",
    title="wear of the crank pin",
    place=475,
    sentence="The depth that a million cycles wear off the bearing of the crank pin, in the thinner of crank and rod.",
    formula="10^6 K / (2 b) times the integral of |A| (1 - phi') over the crank angle of a cycle",
    **of_pin("crank_pin", (WEARS, EVEN_SPEED)),
)
WEAR_SLIDER_PIN = _wear(
    name="wear_slider_pin",
    title="wear of the slider pin",
    place=476,
    sentence="The depth that a million cycles wear off the bearing of the slider pin, over the depth of the rod.",
    formula="10^6 K / (2 b) times the integral of |B| |phi'| over the crank angle of a cycle",
    **of_pin("slider_pin", (WEARS, EVEN_SPEED)),
)
