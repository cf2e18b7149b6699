"""Energy of a cycle: what the drive gives, what friction takes, and the share of it that reaches the loads."""

from __future__ import annotations

import math

import numpy as np

from ..model.machine.dissipation import with_loads_alone
from ..model.machine.mechanism import Mechanism
from ..model.machine.numbers import of_numbers
from ..model.machine.raw import Raw
from ..model.machine.two_turns import cycle_turns
from ..model.signals.averages import average_torque
from ..model.signals.turn_work import CRANK_PIN, CRANK_PIVOT, GUIDE, LOAD, SLIDER_PIN, TurnWork, turn_work
from .average_torque import MEAN_TORQUE
from .bars import Formula
from .kinds import ENERGY, RATIO
from .needs import DRIVEN, LOAD_WORK, LOSSES, RUBS, WORK
from .quantity import Array, Domain, Group, Quantity, Values, undefined

_TURN = 2.0 * math.pi


def _circle(slot: int) -> Formula:
    """Return the formula of the radius of a friction circle, m. slot: of the pin's radius."""
    return lambda number: number(slot) * number(slot + 1)


_COEFFICIENTS: dict[int, Formula] = {
    GUIDE: lambda number: number(Raw.GUIDE_FRICTION),
    CRANK_PIVOT: _circle(Raw.CRANK_PIVOT_RADIUS),
    CRANK_PIN: _circle(Raw.CRANK_PIN_RADIUS),
    SLIDER_PIN: _circle(Raw.SLIDER_PIN_RADIUS),
}


def _heat(mechanism: Mechanism, designs: Array, work: TurnWork) -> tuple[Array, Array | None]:
    """Return the friction heat of a turn, J (n,), and its derivatives (n, 3 + k); infinite where friction locks."""
    heat = np.zeros(len(designs))
    slopes = None if work.gradients is None else np.zeros(designs.shape)
    for place, formula in _COEFFICIENTS.items():
        factor, by = of_numbers(mechanism, designs, formula, gradients=slopes is not None)
        mean = np.where(np.isinf(work.mean[:, place]), 0.0, work.mean[:, place])
        heat += _TURN * factor * mean
        if slopes is not None and by is not None and work.gradients is not None:
            slopes += _TURN * (factor[:, None] * work.gradients[:, place] + mean[:, None] * by)
    return np.where(np.isinf(work.mean[:, 0]), np.inf, heat), slopes


def _useful(mechanism: Mechanism, designs: Array, work: TurnWork) -> tuple[Array, Array | None]:
    """Return the work done against the loads in a turn, J (n,), and its derivatives (n, 3 + k).

    What a torque on the crank takes is no force on a path: with such loads it is what drives them alone.
    """
    if not any(load.on_crank for load in mechanism.loads):
        return _TURN * work.mean[:, LOAD], None if work.gradients is None else _TURN * work.gradients[:, LOAD]
    alone, factor = with_loads_alone(mechanism), _TURN * mechanism.direction
    found = average_torque(alone, designs, gradients=work.gradients is not None)
    return factor * found.mean, None if found.mean_gradients is None else factor * found.mean_gradients


class EnergyPerCycle(Quantity):
    """Work of the drive torque over a cycle in the sense of rotation; infinite where friction locks."""

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); see `Quantity`."""
        found = average_torque(mechanism, dimensions, gradients=gradients)
        factor = _TURN * cycle_turns(mechanism) * mechanism.direction
        locks = np.isinf(found.rms)
        slopes = None
        if found.mean_gradients is not None:
            slopes = np.where(locks[:, None], 0.0, factor * found.mean_gradients)
        return Values(np.where(locks, np.inf, factor * found.mean + 0.0), slopes)  # no negative zero


class FrictionLoss(Quantity):
    """Heat of all joints over a cycle; infinite where friction locks."""

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); see `Quantity`."""
        work = turn_work(mechanism, dimensions, gradients=gradients)
        values, slopes = _heat(mechanism, dimensions, work)
        turns = cycle_turns(mechanism)
        return Values(turns * values, None if slopes is None else turns * slopes)


class Efficiency(Quantity):
    """U / (U + H), of the work U done against the loads and the friction heat H.

    Loads on the crank count. NaN for a design whose loads take no net work, which has none; -inf where friction locks.
    """

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); see `Quantity`."""
        if self.lacks(mechanism, "undefined"):
            return undefined(dimensions, gradients)
        work = turn_work(mechanism, dimensions, gradients=gradients)
        heat, by_heat = _heat(mechanism, dimensions, work)
        locks = np.isinf(heat)
        useful, by_useful = _useful(mechanism, dimensions, work)
        there = (useful > 0.0) & ~locks
        useful, heat = np.where(there, useful, 1.0), np.where(there, heat, 0.0)
        given = useful + heat
        values = np.where(locks, -np.inf, np.where(there, useful / given, np.nan))
        if by_useful is None or by_heat is None:
            return Values(values, None)
        slopes = ((heat / given)[:, None] * by_useful - (useful / given)[:, None] * by_heat) / given[:, None]
        return Values(values, np.where(there[:, None], slopes, np.where(locks, 0.0, np.nan)[:, None]))


_SECTION = "23. Energy of a cycle"
EFFICIENCY = Efficiency(
    name="efficiency",
    kind=RATIO,
    place=436,
    group=Group.DRIVE,
    sentence="The share of the energy of a cycle that reaches the loads: the rest is heat of guide and pins.",
    advice="Undefined for a design whose loads take no net work over a cycle, such as masses alone.",
    formula="U / (U + H): U = -(integral of F dx + M d theta), M: torques on the crank, H: friction loss, over a cycle",
    section=_SECTION,
    picture="torque",
    example=0.9,
    better="high",
    domain=Domain.share("an efficiency", "0.7 to 0.95"),
    needs=(LOAD_WORK, LOSSES),
)
ENERGY_PER_CYCLE = EnergyPerCycle(
    name="energy_per_cycle",
    kind=ENERGY,
    place=437,
    group=Group.DRIVE,
    sentence=(
        "The net work of the drive over a cycle: what the load takes, and friction; negative where the load drives "
        "the machine."
    ),
    advice="What the drive gives and takes back within the cycle, such as kinetic energy, cancels.",
    formula="(integral of T over the crank angle of a cycle, one turn or two) sgn(omega)",
    section=_SECTION,
    picture="torque",
    signed=True,
    needs=(DRIVEN, WORK),
    instead=MEAN_TORQUE.instead,
    plain=True,
)
FRICTION_LOSS = FrictionLoss(
    name="friction_loss",
    kind=ENERGY,
    place=438,
    group=Group.DRIVE,
    sentence="The heat of guide and pins over a cycle.",
    advice="It is the same at every speed where the load alone makes the forces.",
    formula="integral of mu |N| |x'| + rho_O |P| + rho_A |A| (1 - phi') + rho_B |B| |phi'| over the crank angle",
    section=_SECTION,
    picture="torque",
    example="5 J",
    needs=(RUBS,),
)
