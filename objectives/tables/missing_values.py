"""Why a design has no value for a quantity that is defined for its machine."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...model.cycle.self_locking import locking_reason
from ...model.linkage.linkage import Linkage
from ...model.machine.friction import Friction
from ...model.machine.mechanism import Mechanism
from ..quantity import Quantity


def missing_value_reason(quantity: Quantity, mechanism: Mechanism, linkage: Linkage) -> str:
    """Return why a fully rotating linkage has no value for a quantity that is defined for its machine, variables fixed.

    Friction is the reason if it locks the linkage and the quantity has a value without friction.
    """
    locks = locking_reason(mechanism.friction, linkage)
    if locks:
        design = np.array([[linkage.crank, linkage.rod, linkage.offset]], dtype=np.float64)
        without = quantity.evaluate(replace(mechanism, friction=Friction()), design).values[0]
        if not np.isnan(without):
            return f"friction locks this design: {locks}"
    return quantity.blank
