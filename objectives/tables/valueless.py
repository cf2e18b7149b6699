"""Why a design has no value of a quantity that its machine defines."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...model.cycle.self_locking import locks_because
from ...model.linkage.linkage import Linkage
from ...model.machine.friction import Friction
from ...model.machine.mechanism import Mechanism
from ..quantity import Quantity


def valueless_because(quantity: Quantity, mechanism: Mechanism, linkage: Linkage) -> str:
    """Return why a fully turning linkage has no value of a quantity that its machine, with nothing varying, defines.

    Friction is why where it locks the linkage and the quantity has a value without it.
    """
    locks = locks_because(mechanism.friction, linkage)
    if locks:
        design = np.array([[linkage.crank, linkage.rod, linkage.offset]], dtype=np.float64)
        without = quantity.evaluate(replace(mechanism, friction=Friction()), design).values[0]
        if not np.isnan(without):
            return f"friction locks this design: {locks}"
    return quantity.blank
