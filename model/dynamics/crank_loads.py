"""Torques of loads on the crank, subtracted from the drive torque.

By virtual work, a torque M on the crank changes the drive torque by -M and leaves all joint forces unchanged: T =
T_linkage - M(theta). If the slider drives, -M adds to the couple of weight and inertia in the crank's moments about the
pivot.
"""

from __future__ import annotations

from typing import Any

from ..kernel.arithmetic import analytic
from ..machine.design import AREA, DESIGN, LOAD_ROWS
from ..machine.loads.load import Enters
from .segments import Segment

_CRANK_TORQUE = int(Enters.CRANK_TORQUE)


@analytic
def torque_without_crank_loads(torque: Any, theta: Any, way: float, segment: Segment) -> Any:
    """Return a torque minus the crank loads' torques, N m, at a crank angle within a segment.

    way: 1 if the crank turns counter-clockwise, -1 clockwise.
    """
    block, loads, _, piece, shift = segment
    if not loads.on_crank:
        return torque
    # Subtracted one by one within the loop, so that results without such a load are unchanged to the last digit.
    for k in range(loads.kind.shape[0]):
        q = DESIGN + LOAD_ROWS * k
        if loads.kind[k] == _CRANK_TORQUE:
            q = q + AREA
            torque = torque - (block[q, 0] - way * block[q + 1, 0] - block[q + 2, 0] * (theta - block[q + 3, 0]))
        elif loads.factor[k, 2] != 0.0:
            i = piece[k]
            first, last = loads.start[k], loads.start[k + 1]
            if i == first:
                torque = torque - loads.force[first]
            elif i == last:
                torque = torque - loads.force[last - 1]
            else:
                slope = (loads.force[i] - loads.force[i - 1]) / (loads.knots[i] - loads.knots[i - 1])
                at = theta - block[q + 1, 0] if loads.datum[k] > 0 else theta
                torque = torque - (loads.force[i - 1] + slope * (at + shift[k] - loads.knots[i - 1]))
    return torque


@analytic
def rotation_sense(d: Any) -> float:
    """Return the sense of rotation of the crank: 1 counter-clockwise or at rest, -1 clockwise."""
    return 1.0 if d.speed.real >= 0.0 else -1.0
