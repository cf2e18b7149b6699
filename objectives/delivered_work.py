"""Delivered work: what the crank gives to whatever it drives over a turn, negative where it must be driven."""

from __future__ import annotations

import math

from ..model.machine.mechanism import Mechanism
from ..model.signals.averages import average_torque
from .average_torque import MEAN_TORQUE
from .kinds import ENERGY
from .needs import DRIVEN, WORK
from .quantity import Array, Group, Quantity, Values


class DeliveredWork(Quantity):
    """Minus the work of the drive torque over a turn in the sense of rotation."""

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); see `Quantity`."""
        found = average_torque(mechanism, dimensions, gradients=gradients)
        factor = -2.0 * math.pi * mechanism.direction
        slopes = None if found.mean_gradients is None else factor * found.mean_gradients
        return Values(factor * found.mean + 0.0, slopes)  # no negative zero


DELIVERED_WORK = DeliveredWork(
    name="delivered_work",
    kind=ENERGY,
    place=435,
    group=Group.DRIVE,
    sentence=(
        "The work that the crank gives over a turn to whatever it drives; negative for a machine that must be driven."
    ),
    advice="It tells a driving machine from a driven one: maximise it in either case.",
    formula="-2 pi (mean of T over the crank angle) sgn(omega)",
    section="10. Motor and balance",
    picture="torque",
    example="-60 J",
    better="high",
    signed=True,
    needs=(DRIVEN, WORK),
    instead=MEAN_TORQUE.instead,
    plain=True,
)
