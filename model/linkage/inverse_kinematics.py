"""Crank motion from slider motion: angle, speed and acceleration of the crank for a given slider motion.

Crank pivot O, crank pin A and slider pin B form a triangle with the sides r, l and d = sqrt(x^2 + e^2). Reflecting A in
the line O-B gives the second crank angle for the same slider position:

    theta = atan2(e, x) -+ beta,   tan(beta) = sqrt((r + l + d)(r + l - d)(d + l - r)(d - l + r)) / (r^2 + d^2 - l^2).

If the crank turns counter-clockwise, the slider moves outward on the upper sign and inward on the lower sign: these are
the two *solutions*. The law of cosines is used in tangent form, because an arc cosine loses half of the digits near the
dead centres.
"""

import math
from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array, Mask
from ..errors import AssemblyError, InputError
from ..kinematics import geometry
from ..kinematics.position import motion
from ..machine.loads.load import require_word
from ..machine.mechanism import Branch
from .linkage_values import first_marked_value, real_or_complex_array

Solution = Literal["outward", "inward"]

ROUNDING = 1e-14
"""Fraction of crank + rod within which a position counts as a dead centre.

Rounding of the position by a relative 1e-16 turns the crank there by the square root of that, about 1e-8 rad. At 1e-14
the angle from the dead centre, about 1e-7 rad, is known to a tenth at best.
"""


class Dimensions(Protocol):
    """Dimensions, m, and branch of one linkage or an array: the part of `linkage.Linkage` that is needed here.

    That class is not imported, because its `from_slider` needs this module.
    """

    @property
    def crank(self) -> Array:
        """Crank, m."""

    @property
    def rod(self) -> Array:
        """Connecting rod, m."""

    @property
    def offset(self) -> Array:
        """Offset of the slider line, m."""

    @property
    def branch(self) -> Branch:
        """Branch: open or crossed."""

    @property
    def sign(self) -> float:
        """+1 on the open branch, -1 on the crossed one."""


@dataclass(frozen=True)
class CrankMotion:
    """Crank angle in [0, 2 pi), rad, with speed, rad/s, and acceleration, rad/s^2; arrays of the broadcast shape."""

    crank_angle: Array
    speed: Array
    acceleration: Array


def crank_angle_at(linkage: Dimensions, slider_position: ArrayLike, *, solution: Solution) -> Array:
    """Return the crank angle, rad in [0, 2 pi), for slider positions, m, signed as x; broadcasts with the dimensions.

    solution: "outward" or "inward", direction of the slider if the crank turns counter-clockwise. At a dead centre both
    coincide.

    Linkages that do not rotate fully are accepted: each solution is on the linkage's own branch. Raises
    `AssemblyError` for a position out of reach, and for one that the solution reaches only on the other branch.
    """
    x, dimensions, d = _reachable_positions(linkage, slider_position)
    r, l, e = dimensions
    require_word("solution", solution, Solution)
    product = (r + l + d) * (r + l - d) * (d + l - r) * (d - l + r)
    half = np.arctan2(np.sqrt(np.maximum(product, 0.0)), r * r + d * d - l * l)
    theta = np.arctan2(e, x) + (half if solution == "inward" else -half)
    # Zero where the rod is normal to the slider line: there both branches meet and neither moves.
    l_cos = linkage.sign * (x - r * np.cos(theta))
    _raise_for_wrong_positions(
        l_cos <= 0.0,
        x,
        dimensions,
        f"the {solution} solution must lie on the {linkage.branch} branch",
        "ask for the other solution or the other branch",
    )
    wrapped = np.mod(theta, 2.0 * math.pi)
    # The remainder of a tiny negative angle is rounded to a whole turn.
    return np.where(wrapped < 2.0 * math.pi, wrapped, 0.0)


def crank_motion(
    linkage: Dimensions,
    slider_position: ArrayLike,
    *,
    velocity: ArrayLike,
    acceleration: ArrayLike,
    solution: Solution,
) -> CrankMotion:
    """Return the crank motion for slider position (m), velocity (m/s) and acceleration (m/s^2) along +x.

    speed = v / x', acceleration = (a - x'' speed^2) / x', with x' and x'' at the angle from `crank_angle_at`. All
    arguments broadcast with the dimensions. The rod's motion follows from `Linkage.at`.

    Raises `InputError` at a dead centre, where x' = 0 and any crank speed leaves the slider at rest, and
    `AssemblyError` as `crank_angle_at` does.
    """
    v, a = (require_finite(name, value) for name, value in (("velocity", velocity), ("acceleration", acceleration)))
    x, dimensions, d = _reachable_positions(linkage, slider_position)
    r, l, _ = dimensions
    margin = np.minimum(r + l - d, d - np.abs(l - r))
    _raise_for_wrong_positions(
        margin <= ROUNDING * (r + l),
        x,
        dimensions,
        "slider positions must lie off the dead centres, where the crank motion is undetermined",
        "request only the crank angle, or choose a position farther away",
        kind=InputError,
    )
    theta = crank_angle_at(linkage, x, solution=solution)
    m = motion(np.sin(theta), np.cos(theta), *dimensions, linkage.sign)
    speed = v / m.x_1
    result = (theta, speed, (a - m.x_2 * speed * speed) / m.x_1)
    shape = np.broadcast_shapes(*(np.shape(value) for value in result))
    return CrankMotion(*(np.broadcast_to(value, shape) for value in result))


def _reachable_positions(
    linkage: Dimensions, slider_position: ArrayLike
) -> tuple[Array, tuple[Array, Array, Array], Array]:
    """Return position, dimensions and distance of the slider pin from the crank pivot, in one shape."""
    x, r, l, e = np.broadcast_arrays(
        require_finite("slider position", slider_position), linkage.crank, linkage.rod, linkage.offset
    )
    d = np.hypot(x, e)
    excess = np.maximum(d - (r + l), np.abs(l - r) - d)
    # A position computed for a dead centre may lie a rounding error beyond it.
    _raise_for_wrong_positions(
        (excess > ROUNDING * (r + l)) | (d == 0.0),
        x,
        (r, l, e),
        "slider positions must be within reach, |rod - crank| <= sqrt(position^2 + offset^2) <= rod + crank",
        "move the position into the stroke",
    )
    return x, (r, l, e), d


def require_finite(name: str, value: ArrayLike) -> Array:
    """Return real, finite numbers. Raises `InputError` with the argument's name."""
    if np.iscomplexobj(value):
        raise InputError(f"{name} must be real; got {value!r}; leave out the imaginary part")
    try:
        array = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError(f"{name} must be a number or an array of numbers; got {value!r}") from None
    if not np.all(np.isfinite(array)):
        raise InputError(f"{name} must be finite; got {array[~np.isfinite(array)].flat[0]}")
    return array


def _raise_for_wrong_positions(
    wrong: Mask,
    x: Array,
    dimensions: tuple[Array, Array, Array],
    rule: str,
    remedy: str,
    kind: type[InputError] = AssemblyError,
) -> None:
    if np.any(wrong):
        at, r, l, e = (1e3 * float(value[wrong].flat[0]) for value in (x, *dimensions))
        raise kind(f"{rule}; got position {at:.9g} mm with crank {r:g} mm, rod {l:g} mm, offset {e:g} mm; {remedy}")


def crank_from_stroke(stroke: ArrayLike, *, rod: ArrayLike, offset: ArrayLike = 0.0) -> Array:
    """Return the crank, m, for a stroke, a rod and an offset, m; arrays broadcast.

    r^2 = S^2 (l^2 - e^2 - S^2/4) / (4 l^2 - S^2). Raises `AssemblyError` where no fully rotating linkage has this
    stroke.
    """
    arguments = (("stroke", stroke), ("rod", rod), ("offset", offset))
    s, l, e = np.broadcast_arrays(*(real_or_complex_array(value, name) for name, value in arguments))
    with np.errstate(invalid="ignore", divide="ignore"):
        r: Array = geometry.crank_from_stroke(s, l, e)
        real, rod_, off, crank = s.real, l.real, e.real, r.real
        wrong = ~((real > 0.0) & (crank > 0.0) & (rod_ > crank + np.abs(off)) & (4.0 * rod_ * crank >= real * real))
    if np.any(wrong):
        remedy = (
            "lengthen the rod or reduce the offset"
            if first_marked_value(real, wrong) > 0.0
            else "give a stroke above 0"
        )
        raise AssemblyError(
            "no crank gives this stroke with full rotation; "
            f"got stroke {1e3 * first_marked_value(s.real, wrong):g} mm, "
            f"rod {1e3 * first_marked_value(l.real, wrong):g} mm, "
            f"offset {1e3 * first_marked_value(e.real, wrong):g} mm; {remedy}"
        )
    return r
