"""First-order influence of errors in dimensions and crank angle on the slider position.

dx = (dx/dr) dr + (dx/dl) dl + (dx/de) de + (dx/dtheta) dtheta, with
dx/dr = cos(theta - phi) / cos(phi), dx/dl = 1 / cos(phi), dx/de = -tan(phi),
dx/dtheta = -r sin(theta - phi) / cos(phi).
Source of the approach: Chetana R. and Vineeth Kumar T.V., "Analysis of Position Error in Offset Slider Crank
Mechanism", Eq. (3), whose offset is the mirror image of the one here.

Clearances. A pin with radial clearance c lets the two centres of its joint be apart by any vector u with |u| <= c. At
the crank pivot and the crank pin, u moves the end A of the rod; at the slider pin, it moves the other end. To first
order dx = u . n / cos(phi), where n is the direction of the rod. The maximum is c / cos(phi), with the contact along
the rod, where the force of a massless rod also holds it. This is exact rather than only first order. By the triangle
inequality, the distance between the outer centres lies between l - c and l + c, and every distance in between occurs.
So the clearance of a pin acts as a tolerance of the rod, and that of the guide, across its line, as a tolerance of the
offset. In the root-sum-square each clearance is a separate source whose limit is c, like a tolerance. A pin that the
force presses to either side scatters more widely, with a standard deviation of c instead of a third of it. The Monte
Carlo simulation shows the effect.
"""

from typing import Any, NamedTuple

from ..kernel.arithmetic import analytic, magnitude, root
from ..kinematics.position import Motion
from ..machine.design import Design


class Influences(NamedTuple):
    """Slider displacement per unit error: crank, rod, offset (m/m) and crank angle (m/rad)."""

    crank: Any
    rod: Any
    offset: Any
    crank_angle: Any


@analytic
def influences(sine: Any, cosine: Any, m: Motion, l: Any) -> Influences:
    """Return the exact first-order influences on the slider position."""
    return Influences(cosine + m.tangent * sine, l * m.per_l_cos, -m.tangent, m.x_1)


@analytic
def worst_case(i: Influences, d: Design) -> Any:
    """Return the sum of the absolute contributions of all tolerances and clearances, m."""
    return (
        magnitude(i.crank) * d.crank_error
        + magnitude(i.rod) * d.rod_error
        + magnitude(i.offset) * d.offset_error
        + magnitude(i.crank_angle) * d.angle_error
    )


@analytic
def root_sum_square(i: Influences, d: Design) -> Any:
    """Return the square root of the sum of squared contributions of all tolerances and clearances, m."""
    a, b = i.crank * d.crank_error, i.rod * d.rod_error_rss
    c, f = i.offset * d.offset_error_rss, i.crank_angle * d.angle_error
    return root(a * a + b * b + c * c + f * f)
