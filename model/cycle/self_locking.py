"""Self-locking: friction prevents any crank torque, however large, from driving the slider as prescribed.

From `rubbing`: the rod's moment balance is one equation h(y) = 0, whose slope tends to along + D and along - D for y ->
+-infinity, with

    D = q (rho_B sgn(phi' w) - rho_A sgn(w)) - mu across sgn(x' w),        q = sqrt(1 + mu^2).

Where |D| < |along|, both slopes have the same sign and there is exactly one solution for every load. Where |D| >=
|along|, both ends of h have the same sign, and the number of solutions is even. For resisting loads there is none: the
linkage *locks*, because the harder the crank pushes, the more the guide resists. For loads that drive it there are two
or more: it *may jam*, because both the prescribed motion and a wedged state are in equilibrium, and the forces do not
determine which one occurs. The condition involves no load and no mass; reversing the rotation only changes the sign of
D. Without pin friction, it says that the transmission angle is below arctan(mu).

|D| is largest, and |along| smallest, where the crank is normal to the slider line and points away from it, sin(theta) =
-sgn(e). At that angle, in the limit from one side, locking begins when l cos(phi) = mu l sin(phi) + q (rho_A + rho_B).
The margin is therefore exactly

    minimum transmission angle - arctan(mu) - asin((rho_A + rho_B) / l).
"""

import math
from typing import Any

import numpy as np

from ..arrays import Array
from ..errors import InputError
from ..kernel.arithmetic import STEP
from ..kinematics.geometry import least_transmission_angle
from ..linkage.linkage import Linkage
from ..machine.links_and_joints import Friction
from ..machine.mechanism import Mechanism
from ..machine.raw_machine_vector import Raw
from ..machine.raw_numbers_of_designs import raw_number_at_slot, require_design_columns


def locking_margin(friction: Friction, designs: Array, *, gradients: bool = False) -> tuple[Array, Array | None]:
    """Return the self-locking margin, rad, for designs (n, 3): crank, rod, offset, m, each rotating fully.

    It does not depend on loads and masses: zero or less means that the linkage locks or may jam somewhere (see module).
    -inf if the sum of the friction circle radii is at least the rod length.
    """
    return locking_margin_with_variables(Mechanism(friction=friction), designs, gradients=gradients)


def locking_reason(friction: Friction, linkage: Linkage) -> str:
    """Return why friction locks a linkage, or may jam it, at some crank angle; empty if it does neither."""
    margin = float(locking_margin(friction, np.array([[linkage.crank, linkage.rod, linkage.offset]], float))[0][0])
    if margin > 0.0:
        return ""
    return (
        f"the self-locking margin must be more than zero; got {math.degrees(margin):.4g} deg; "
        "lengthen the rod, or reduce the offset or the friction"
    )


def require_no_locking(friction: Friction, linkage: Linkage) -> None:
    """Raise `InputError` where friction locks one linkage, or may jam it, at some crank angle."""
    reason = locking_reason(friction, linkage)
    if reason:
        raise InputError(reason)


def locking_margin_with_variables(
    mechanism: Mechanism, designs: Array, *, gradients: bool = False
) -> tuple[Array, Array | None]:
    """Return the self-locking margin, like `locking_margin`, for designs (n, 3 + k) of a machine with variables."""
    designs = np.asarray(designs, dtype=np.float64)
    require_design_columns(mechanism, designs)
    friction = mechanism.friction
    guide, circles = (
        friction.guide,
        friction.crank_pin.friction_circle_radius + friction.slider_pin.friction_circle_radius,
    )
    if not mechanism.varying:
        return _margin_with_friction_slopes(designs, guide, circles, gradients)[:2]
    slots = (
        (Raw.GUIDE_FRICTION, guide),
        (Raw.CRANK_PIN_RADIUS, friction.crank_pin.radius),
        (Raw.CRANK_PIN_FRICTION, friction.crank_pin.coefficient),
        (Raw.SLIDER_PIN_RADIUS, friction.slider_pin.radius),
        (Raw.SLIDER_PIN_FRICTION, friction.slider_pin.coefficient),
    )
    (mu, mu_slope), *pins = (raw_number_at_slot(mechanism, slot, designs, otherwise=value) for slot, value in slots)
    (a, a_slope), (b, b_slope), (c, c_slope), (d, d_slope) = pins
    sums = a * b + c * d
    slopes = a[:, None] * b_slope + b[:, None] * a_slope + c[:, None] * d_slope + d[:, None] * c_slope
    values, gradient, rates = _margin_with_friction_slopes(designs[:, :3], mu, sums, gradients)
    if gradient is None or rates is None:
        return values, None
    gradient = np.pad(gradient, ((0, 0), (0, len(mechanism.varying))))
    return values, gradient + rates[:, :1] * mu_slope + rates[:, 1:] * slopes


def _margin_with_friction_slopes(
    designs: Array, guide: Any, circles: Any, gradients: bool
) -> tuple[Array, Array | None, Array | None]:
    """Return the margin (n,), its gradients (n, 3), and those with respect to guide and pin friction (n, 2)."""
    r, l, a = designs[:, 0], designs[:, 1], np.abs(designs[:, 2])
    turns = circles < l
    safe = np.where(turns, l, 2.0 * circles + 1.0)

    def margin(r: Any, l: Any, l_safe: Any, a: Any, guide: Any, circles: Any) -> Any:
        return least_transmission_angle(r, l, a) - np.arctan(guide) - np.arcsin(circles / l_safe)

    values = np.where(turns, margin(r, l, safe, a, guide, circles), -np.inf)
    if not gradients:
        return values, None, None
    step = STEP * 1j
    sign = np.where(designs[:, 2] < 0.0, -1.0, 1.0)
    slopes = np.stack(
        [
            margin(r + step, l, safe, a, guide, circles).imag,
            margin(r, l + step, safe + step, a, guide, circles).imag,
            sign * margin(r, l, safe, a + step, guide, circles).imag,
        ],
        axis=1,
    )
    rates = np.stack(
        [
            margin(r, l, safe, a, guide + step, circles).imag,
            margin(r, l, safe, a, guide, circles + step).imag,
        ],
        axis=1,
    )
    is_finite = turns[:, None]
    return values, np.where(is_finite, slopes / STEP, 0.0), np.where(is_finite, rates / STEP, 0.0)
