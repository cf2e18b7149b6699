"""Self-locking margin: margin of the transmission angle above the friction angles."""

from __future__ import annotations

import numpy as np

from ..model.cycle.self_locking import locking_margin_with_variables
from ..model.machine.mechanism import Mechanism
from .kinds import ANGLE
from .machine_needs import FRICTION
from .quantity import Array, Domain, Group, Quantity, Values
from .transmission_angle import TRANSMISSION_ANGLE


class SelfLockingMargin(Quantity):
    """Minimum transmission angle minus the friction angles; -inf if the pins alone lock the linkage (no such angle)."""

    def evaluate(self, mechanism: Mechanism, dimensions: Array, *, gradients: bool = False) -> Values:
        """Return the quantity for designs (n, 3 + k); see `Quantity`."""
        values, slopes = locking_margin_with_variables(mechanism, dimensions, gradients=gradients)
        return Values(values, slopes)


SELF_LOCKING_MARGIN = SelfLockingMargin(
    name="self_locking_margin",
    title="self-locking margin",
    kind=ANGLE,
    place=200,
    group=Group.PROPORTIONS,
    sentence=(
        "The margin of the least transmission angle over the angle at which friction locks the linkage, so that no "
        "torque can drive it."
    ),
    advice="It must stay above 0; 10 deg or more is usual. Without friction it is undefined.",
    formula="mu_min - arctan(f) - arcsin((rho_A + rho_B) / l): friction f of the guide, friction circles rho",
    section="15. Self-locking",
    picture="self-locking",
    example="10 deg",
    better="high",
    domain=Domain.of_acute_angle(
        "the self-locking margin must lie between 0, where friction locks, and 90 deg", "10 deg and more"
    ),
    floor=float(np.radians(5.0)),  # forces grow as 1 / sin(margin)
    needs=(FRICTION,),
    instead=TRANSMISSION_ANGLE.name,
)
