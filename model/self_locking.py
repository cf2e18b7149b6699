"""Self-locking: where friction lets no crank torque, however great, drive the slider as prescribed.

From `rubbing`: the force balance of the rod is one equation h(y) = 0, whose slope tends to along + D and along - D
for y -> +-infinity, with

    D = q (rho_B sgn(phi' w) - rho_A sgn(w)) - mu across sgn(x' w),        q = sqrt(1 + mu^2).

Where |D| < |along| both slopes have one sign and there is a solution for every load. Where |D| >= |along| both ends of
h point the same way, and the number of solutions is even: none for loads that resist (the linkage *locks*: the harder
the crank pushes, the more the guide holds), two or more for loads that drive it (it *may jam*: the prescribed motion
and a wedged state both balance, and which one comes about the forces do not tell). The condition knows no load and no
mass; turning the other way changes the sign of D alone. Without pins it says that the transmission angle is below
arctan(mu).

|D| is greatest, and |along| least, where the crank is normal to the slider line and points away from it,
sin(theta) = -sgn(e); there l cos(phi) = mu l sin(phi) + q (rho_A + rho_B) in the limit from one side. The margin is
therefore exactly

    least transmission angle - arctan(mu) - asin((rho_A + rho_B) / l).
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .arithmetic import STEP
from .friction import Friction
from .geometry import least_transmission_angle

Array = NDArray[np.float64]


def locking_margin(friction: Friction, designs: Array, *, gradients: bool = False) -> tuple[Array, Array | None]:
    """Return the self-locking margin, rad, of designs (n, 3): crank, rod, offset, m, each turning fully.

    It does not depend on loads and masses: zero or less means that the linkage locks or may jam somewhere (see module).
    -inf where the friction circles' sum is the rod or more.
    """
    designs = np.asarray(designs, dtype=np.float64)
    r, l, a = designs[:, 0], designs[:, 1], np.abs(designs[:, 2])
    circles = friction.crank_pin.circle + friction.slider_pin.circle
    turns = circles < l
    safe = np.where(turns, l, 2.0 * circles + 1.0)

    def margin(r: Any, l: Any, l_safe: Any, a: Any) -> Any:
        return least_transmission_angle(r, l, a) - np.arctan(friction.guide) - np.arcsin(circles / l_safe)

    values = np.where(turns, margin(r, l, safe, a), -np.inf)
    if not gradients:
        return values, None
    step = STEP * 1j
    sign = np.where(designs[:, 2] < 0.0, -1.0, 1.0)
    slopes = np.stack(
        [
            margin(r + step, l, safe, a).imag,
            margin(r, l + step, safe + step, a).imag,
            sign * margin(r, l, safe, a + step).imag,
        ],
        axis=1,
    )
    return values, np.where(turns[:, None], slopes / STEP, 0.0)
