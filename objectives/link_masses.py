"""Masses of the crank and the rod, and of all moving parts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from ..model.machine.design import link_properties
from ..model.machine.mechanism import Mechanism
from ..model.machine.raw_machine_vector import Raw
from ..model.machine.raw_numbers_of_designs import LEVER, LEVER_MASSES
from .greatest_of_formulas import GreatestOfFormulas
from .kinds import MASS
from .machine_needs import CRANK_MASS as CRANK_WEIGHS
from .machine_needs import MASSES
from .machine_needs import ROD_MASS as ROD_WEIGHS
from .quantity import Formula, Group, Number


@dataclass(frozen=True, kw_only=True)
class Mass(GreatestOfFormulas):
    """A mass in closed form. closed_form: its function of a machine's raw numbers."""

    closed_form: Formula = field(repr=False)

    def formulas(self, mechanism: Mechanism) -> Sequence[Formula]:
        """Return the formula; see `Quantity`."""
        return [self.closed_form]


def _crank_mass(number: Number) -> Any:
    return _link_mass(number, number(Raw.CRANK), Raw.CRANK_WIDTH)


def _rod_mass(number: Number) -> Any:
    return _link_mass(number, number(Raw.ROD), Raw.ROD_WIDTH)


def _link_mass(number: Number, length: Any, first: int) -> Any:
    return link_properties(length, *(number(first + slot) for slot in range(9)))[0]


_mass = partial(
    Mass, kind=MASS, group=Group.STRENGTH, section="22. Strength of crank and rod", plain=True, turning=False
)
CRANK_MASS = _mass(
    name="crank_mass",
    closed_form=_crank_mass,
    place=430,
    sentence=(
        "The mass of the crank without its counterweight. For a crank given by its section, it follows from the size."
    ),
    formula="rho d (w r + pi w^2 / 4) for a bar",
    picture="crank",
    needs=(CRANK_WEIGHS,),
)
ROD_MASS = _mass(
    name="rod_mass",
    closed_form=_rod_mass,
    place=432,
    sentence="The mass of the connecting rod. For a rod given by its section, it follows from the size.",
    formula="rho d (w l + pi w^2 / 4) for a bar",
    picture="rod",
    needs=(ROD_WEIGHS,),
)


def _moving_mass(number: Number) -> Any:
    bars = _crank_mass(number) + _rod_mass(number) + number(Raw.COUNTERWEIGHT_MASS) + number(Raw.SLIDER_MASS)
    return bars + sum(number(LEVER[name]) for name in LEVER_MASSES)


MOVING_MASS = _mass(
    name="moving_mass",
    closed_form=_moving_mass,
    place=434,
    sentence="The mass of all moving links: crank, counterweight, rod, slider; cylinder, arm and ram of a lever.",
    advice="With variable sections it trades off against their safety; it also affects forces and torque.",
    formula="m_crank + m_counterweight + m_rod + m_slider",
    picture="inertia",
    needs=(MASSES,),
)
