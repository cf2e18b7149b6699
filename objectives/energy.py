"""Energy per cycle of one or two turns: work of the drive, friction heat, and efficiency."""

import math

import numpy as np

from ..model.machine.cylinders_and_turns import cycle_turns
from ..model.machine.mechanism import Mechanism
from ..model.machine.raw_machine_vector import Raw
from ..model.machine.raw_numbers_of_designs import evaluate_formula_of_raw_numbers
from ..model.machine.work_absorption import without_masses_and_friction
from ..model.signals.averages import torque_averages
from ..model.signals.turn_work import CRANK_PIN, CRANK_PIVOT, GUIDE, LOAD, SLIDER_PIN, TurnWork, turn_work
from .kinds import ENERGY, RATIO
from .machine_needs import DRIVEN, HEAT, LOAD_WORK, LOSSES, WORK
from .quantity import Array, Domain, Formula, Group, Quantity, Values, undefined_values
from .torque_and_power import MEAN_TORQUE

_TURN = 2.0 * math.pi
_ROUNDING = 1e-12  # fraction of the friction heat; useful work below it is rounding error


def _friction_circle_radius(slot: int) -> Formula:
    """Return the formula for the radius of a friction circle, m. slot: slot of the pin radius."""
    return lambda number: number(slot) * number(slot + 1)


_COEFFICIENTS: dict[int, Formula] = {
    GUIDE: lambda number: number(Raw.GUIDE_FRICTION),
    CRANK_PIVOT: _friction_circle_radius(Raw.CRANK_PIVOT_RADIUS),
    CRANK_PIN: _friction_circle_radius(Raw.CRANK_PIN_RADIUS),
    SLIDER_PIN: _friction_circle_radius(Raw.SLIDER_PIN_RADIUS),
}


def _friction_heat(mechanism: Mechanism, designs: Array, work: TurnWork) -> tuple[Array, Array | None]:
    """Return the friction heat over a turn, J (n,), and its derivatives (n, 3 + k).

    Infinite where friction locks the linkage.
    """
    heat = np.zeros(len(designs))
    slopes = None if work.gradients is None else np.zeros(designs.shape)
    for place, formula in _COEFFICIENTS.items():
        factor, factor_slopes = evaluate_formula_of_raw_numbers(
            mechanism, designs, formula, gradients=slopes is not None
        )
        mean = np.where(np.isinf(work.mean[:, place]), 0.0, work.mean[:, place])
        heat += _TURN * factor * mean
        if slopes is not None and factor_slopes is not None and work.gradients is not None:
            slopes += _TURN * (factor[:, None] * work.gradients[:, place] + mean[:, None] * factor_slopes)
    return np.where(np.isinf(work.mean[:, 0]), np.inf, heat), slopes


def _useful_work(mechanism: Mechanism, designs: Array, work: TurnWork) -> tuple[Array, Array | None]:
    """Return the work done against the loads over a turn, J (n,), and its derivatives (n, 3 + k).

    A torque on the crank has no path: with such loads, the work that drives the loads alone is used instead.
    """
    if not any(load.on_crank for load in mechanism.loads):
        return _TURN * work.mean[:, LOAD], None if work.gradients is None else _TURN * work.gradients[:, LOAD]
    alone, factor = without_masses_and_friction(mechanism), _TURN * mechanism.direction
    averages = torque_averages(alone, designs, gradients=work.gradients is not None)
    return factor * averages.mean, None if averages.mean_gradients is None else factor * averages.mean_gradients


def _drive_work(mechanism: Mechanism, designs: Array, gradients: bool) -> tuple[Array, Array | None]:
    """Return the work of the drive torque over a cycle, J (n,), and its derivatives.

    NaN where friction locks the linkage.
    """
    averages = torque_averages(mechanism, designs, gradients=gradients)
    factor = _TURN * cycle_turns(mechanism) * mechanism.direction
    return factor * averages.mean, None if averages.mean_gradients is None else factor * averages.mean_gradients


class EnergyPerCycle(Quantity):
    """Work of the drive torque over a cycle in the direction of rotation; infinite where friction locks the linkage."""

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); see `Quantity`."""
        work, slopes = _drive_work(mechanism, dimensions, gradients)
        locks = np.isnan(work)
        if slopes is not None:
            slopes = np.where(locks[:, None], 0.0, slopes)
        return Values(np.where(locks, np.inf, work + 0.0), slopes)  # no negative zero


class DeliveredWork(Quantity):
    """Minus the work of the drive torque over a cycle, in the direction of rotation: the work delivered."""

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); see `Quantity`."""
        work, slopes = _drive_work(mechanism, dimensions, gradients)
        return Values(-work + 0.0, None if slopes is None else -slopes)  # no negative zero


class FrictionLoss(Quantity):
    """Heat from all joints over a cycle; infinite where friction locks the linkage."""

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); see `Quantity`."""
        work = turn_work(mechanism, dimensions, gradients=gradients)
        values, slopes = _friction_heat(mechanism, dimensions, work)
        turns = cycle_turns(mechanism)
        return Values(turns * values, None if slopes is None else turns * slopes)


class Efficiency(Quantity):
    """Work output divided by work input, from the work U against the loads and the friction heat H.

    U / (U + H) if the loads absorb work; 1 - H / -U if they supply it and the crank delivers the rest; 0 if friction
    absorbs all of it. Loads on the crank are included. NaN for a design whose loads neither absorb nor supply net work;
    -inf where friction locks the linkage.
    """

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); see `Quantity`."""
        if self.unmet_need(mechanism, "undefined"):
            return undefined_values(dimensions, gradients)
        work = turn_work(mechanism, dimensions, gradients=gradients)
        heat, by_heat = _friction_heat(mechanism, dimensions, work)
        locks = np.isinf(heat)
        useful, by_useful = _useful_work(mechanism, dimensions, work)
        heat = np.where(locks, 0.0, heat)
        has_work = (np.abs(useful) > _ROUNDING * heat) & ~locks
        useful = np.where(has_work, useful, 1.0)
        driven, drives = has_work & (useful > 0.0), has_work & (useful < 0.0) & (useful + heat < 0.0)
        total = useful + heat
        total = np.where(total != 0.0, total, 1.0)
        values = np.where(driven, useful / total, np.where(drives, total / useful, 0.0))
        values = np.where(locks, -np.inf, np.where(has_work, values, np.nan))
        if by_useful is None or by_heat is None:
            return Values(values, None)
        slopes = ((heat / total)[:, None] * by_useful - (useful / total)[:, None] * by_heat) / total[:, None]
        driving = (by_heat - (heat / useful)[:, None] * by_useful) / useful[:, None]
        slopes = np.where(driven[:, None], slopes, np.where(drives[:, None], driving, 0.0))
        return Values(values, np.where((has_work | locks)[:, None], slopes, np.nan))


_SECTION = "23. Energy of a cycle"
EFFICIENCY = Efficiency(
    name="efficiency",
    kind=RATIO,
    place=436,
    group=Group.DRIVE,
    sentence=(
        "Work output divided by work input over a cycle. The output is the work done on the loads if the crank is "
        "driven, "
        "or the work at the crank if the loads drive it, as in an engine. The rest is friction heat in guide and pins."
    ),
    advice=(
        "It is 0 if friction absorbs all the work of the loads, and undefined for a design whose loads do no net work, "
        "such as masses alone."
    ),
    formula=(
        "U / (U + H) for U > 0, max(0, 1 + H / U) for U < 0: U = -(integral of F dx + M d theta), M torques on the "
        "crank, H friction loss, over a cycle"
    ),
    section=_SECTION,
    picture="torque",
    example=0.9,
    better="high",
    domain=Domain.of_fraction("an efficiency", "0.7 to 0.95"),
    needs=(LOAD_WORK, *LOSSES),
)
ENERGY_PER_CYCLE = EnergyPerCycle(
    name="energy_per_cycle",
    kind=ENERGY,
    place=437,
    group=Group.DRIVE,
    sentence=(
        "The net work of the drive over a cycle of one turn or two: the work on the load plus friction; negative if "
        "the load drives the machine."
    ),
    advice="Energy that the drive supplies and recovers within the cycle, such as kinetic energy, cancels out.",
    formula="(integral of T over the crank angle of a cycle, one turn or two) sgn(omega)",
    section=_SECTION,
    picture="torque",
    signed=True,
    instead_of_quotient=EFFICIENCY.name,
    needs=(DRIVEN, WORK),
    instead=MEAN_TORQUE.instead,
    plain=True,
)
DELIVERED_WORK = DeliveredWork(
    name="delivered_work",
    title="delivered work per cycle",
    short="delivered work",
    kind=ENERGY,
    place=435,
    group=Group.DRIVE,
    sentence=(
        "The work that the crank delivers to whatever it drives over a cycle of one turn or two; negative for a "
        "machine that must be driven."
    ),
    advice="Its sign distinguishes driving from driven machines; maximise it in both cases.",
    formula="-(integral of T over the crank angle of a cycle, one turn or two) sgn(omega)",
    section="10. Motor and balance",
    picture="torque",
    example="-60 J",
    better="high",
    signed=True,
    instead_of_quotient=EFFICIENCY.name,
    needs=(DRIVEN, WORK),
    instead=MEAN_TORQUE.instead,
    plain=True,
)
FRICTION_LOSS = FrictionLoss(
    name="friction_loss",
    title="friction loss per cycle",
    short="friction loss",
    kind=ENERGY,
    place=438,
    group=Group.DRIVE,
    sentence="The friction heat in guide and pins over a cycle: one turn, or two if the cycle has 720 deg.",
    advice="If only loads cause forces, it is the same at every speed.",
    formula="integral of mu |N| |x'| + rho_O |P| + rho_A |A| (1 - phi') + rho_B |B| |phi'| over the crank angle",
    section=_SECTION,
    picture="torque",
    example="5 J",
    needs=HEAT,
)
