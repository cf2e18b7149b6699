"""Distributions of errors within their limits, from which a Monte Carlo simulation draws.

Sources of a position error: each dimension, the crank angle and each clearance are one source.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array
from ..dynamics.segments import crank_angle_at, crank_angle_from_crowded, crowded_from_crank_angle, crowding_parameter
from ..errors import AssemblyError, InputError
from ..linkage.linkage import Linkage
from ..linkage.require_single_linkage import require_single_linkage, require_single_rotating_linkage
from ..machine.loads.load import require_word
from ..machine.mechanism import Mechanism

SOURCES = (
    *("crank", "rod", "offset", "crank angle"),
    *("crank pivot clearance", "crank pin clearance", "slider pin clearance", "guide clearance"),
)
"""Names of the sources, in the order of all arrays here."""
PINS = slice(4, 7)
GUIDE = 7
ANGLES = 256
"""Crank angles per turn from which a search starts."""
_TURN = 2.0 * math.pi


def limits_of_sources(mechanism: Mechanism, linkage: Linkage) -> Array:
    """Return the limit of each source, (8,), m; that of the crank angle in rad."""
    linkage, t = require_single_linkage(mechanism, linkage), mechanism.tolerances
    lengths = (
        tolerance.deviation_limit(float(length))
        for tolerance, length in ((t.crank, linkage.crank), (t.rod, linkage.rod), (t.offset, linkage.offset))
    )
    gap = t.clearances
    return np.array([*lengths, t.crank_angle.absolute, gap.crank_pivot, gap.crank_pin, gap.slider_pin, gap.guide])


def source_influences(mechanism: Mechanism, linkage: Linkage, crank_angle: ArrayLike) -> Array:
    """Return the slider displacement per unit of each source, (8, m), m/m and m/rad, at crank angles (m,), rad.

    A pin's clearance acts as an error in the rod, that of the guide as an error in the offset: see `position_error`.
    """
    angles = np.atleast_1d(np.asarray(crank_angle, dtype=np.float64))
    i = require_single_rotating_linkage(mechanism, linkage).error_influences(angles)
    return np.stack([i.crank, i.rod, i.offset, i.crank_angle, i.rod, i.rod, i.rod, i.offset])


def limit_box(mechanism: Mechanism, linkage: Linkage) -> Array:
    """Return the minimum and maximum of crank, rod, offset (m) and crank angle deviation (rad), (4, 2).

    Clearances widen the range of the rod (pins) and of the offset (guide). Raises `AssemblyError` unless every linkage
    in the box rotates fully, `InputError` if the crank angle may be off by half a turn.
    """
    linkage, limits = require_single_rotating_linkage(mechanism, linkage), limits_of_sources(mechanism, linkage)
    half = np.add(limits[:4], [0.0, limits[PINS].sum(), limits[GUIDE], 0.0])
    if half[3] >= math.pi:
        raise InputError(
            f"the tolerance of the crank angle must be below 180 deg; got {math.degrees(half[3]):g} deg; reduce it"
        )
    middle = np.array([linkage.crank, linkage.rod, linkage.offset, 0.0])
    box = np.stack([middle - half, middle + half], axis=1)
    if box[0, 0] <= 0.0 or box[1, 0] <= box[0, 1] + np.abs(box[2]).max():
        mm = 1e3 * box
        raise AssemblyError(
            "every linkage within tolerances and clearances must rotate fully, rod > crank + |offset|; got at "
            f"worst rod {mm[1, 0]:g} mm, crank {mm[0, 0]:g} to {mm[0, 1]:g} mm, offset {np.abs(mm[2]).max():g} mm; "
            "tighten the tolerances"
        )
    return box


def angle_ranges_where_error_counts(mechanism: Mechanism, linkage: Linkage, *, count: int = ANGLES) -> list[Array]:
    """Return the crank angles, rad, over which the position error counts: an ascending array for each connected part.

    count: angles per turn, concentrated where the linkage is close to locking. The ends of a part are among its angles;
    the whole cycle is one part that ends one turn after its start.
    """
    linkage, window = require_single_rotating_linkage(mechanism, linkage), mechanism.tolerances.window
    r, l, e = float(linkage.crank), float(linkage.rod), float(linkage.offset)
    kappa = crowding_parameter(r, l, e)

    def part(first: float, last: float) -> Array:
        low, high = crowded_from_crank_angle(first, kappa), crowded_from_crank_angle(last, kappa)
        points = max(5, math.ceil(count * (high - low) / _TURN) + 1)
        inner_angles = [crank_angle_from_crowded(tau, kappa) for tau in np.linspace(low, high, points)[1:-1]]
        return np.array([first, *inner_angles, last])

    if window.during == "cycle" and window.start == 0.0 and window.end == 1.0:
        return [part(0.0, _TURN)]
    inner, outer = (float(angle) for angle in linkage.dead_centre_angles)
    near, far = (float(x) for x in linkage.dead_centres)

    def angle_at_stroke_fraction(fraction: float, first: float, span: float) -> float:
        """Crank angle, from `first` on, at which the slider has covered a fraction of one stroke."""
        if fraction in (0.0, 1.0):
            return first + (span if (fraction == 1.0) == (first == inner) else 0.0)
        angles = (crank_angle_at(near + fraction * (far - near), r, l, e, second) for second in (False, True))
        return first + min((angle - first) % _TURN for angle in angles)

    parts = []
    for first, last in ((inner, outer), (outer, inner)):
        # Counter-clockwise from the inner to the outer dead centre is the outward stroke, clockwise the inward one.
        outward = (first == inner) == (mechanism.speed >= 0.0)
        if window.during == "cycle" or (window.during == "outward stroke") == outward:
            ends = sorted(
                angle_at_stroke_fraction(fraction, first, (last - first) % _TURN)
                for fraction in (window.start, window.end)
            )
            parts.append(part(*ends))
    return parts


Shape = Literal["normal", "truncated normal", "uniform", "triangular"]
Contact = Literal["along the rod", "any direction", "anywhere"]


def error_distribution(shape: Shape = "normal", *, sigmas: float = 3.0) -> Any:
    """Return the distribution of an error in units of its limit, as a frozen distribution of `scipy.stats`.

    normal: the limit is `sigmas` standard deviations; truncated normal: the same, with nothing beyond the limit.
    uniform and triangular (peak in the middle) end at the limits and ignore `sigmas`.
    """
    from scipy import stats

    require_word("shape", shape, Shape)
    if not (math.isfinite(sigmas) and sigmas > 0.0):
        raise InputError(f"sigmas, standard deviations within the limit, must be positive and finite; got {sigmas:g}")
    match shape:
        case "normal":
            return stats.norm(scale=1.0 / sigmas)
        case "truncated normal":
            return stats.truncnorm(-sigmas, sigmas, scale=1.0 / sigmas)
        case "uniform":
            return stats.uniform(-1.0, 2.0)
        case "triangular":
            return stats.triang(0.5, -1.0, 2.0)


@dataclass(frozen=True, kw_only=True)
class Spreads:
    """The distributions of all sources; errors of different sources are independent.

    crank, rod, offset, crank_angle: distributions in units of the limit, from `error_distribution` or any frozen
    distribution of `scipy.stats`. contact: position of a pin in its clearance c. "along the rod": pressed to either
    side with equal probability by the force in the rod (variance of its addition to the rod: c^2). "any direction": in
    contact, in a uniformly distributed direction (c^2 / 2). "anywhere" within the clearance circle, uniform over its
    area (c^2 / 4). The slider touches either side of its guide (c^2) or, with "anywhere", is uniform between them (c^2
    / 3).
    """

    crank: Any = field(default_factory=error_distribution)
    rod: Any = field(default_factory=error_distribution)
    offset: Any = field(default_factory=error_distribution)
    crank_angle: Any = field(default_factory=error_distribution)
    contact: Contact = "along the rod"

    def __post_init__(self) -> None:
        require_word("contact", self.contact, Contact)
        for name in ("crank", "rod", "offset", "crank_angle"):
            distribution = getattr(self, name)
            if not (hasattr(distribution, "rvs") and hasattr(distribution, "var")):
                raise InputError(
                    f'{name} must be a distribution, such as error_distribution("uniform"); got {distribution!r}'
                )

    @property
    def variances_per_squared_limit(self) -> Array:
        """Variance of each source, (8,), in units of its squared limit; for a pin, the component along the rod."""
        pin, guide = {"along the rod": (1.0, 1.0), "any direction": (0.5, 1.0), "anywhere": (0.25, 1.0 / 3.0)}[
            self.contact
        ]
        dimensions = (
            float(distribution.var()) for distribution in (self.crank, self.rod, self.offset, self.crank_angle)
        )
        return np.array([*dimensions, pin, pin, pin, guide])

    def draw_errors(self, limits: Array, count: int, random: np.random.Generator) -> Draw:
        """Return errors of `count` machines for the limits (8,) of the sources."""
        dimensions = [
            limit * np.asarray(distribution.rvs(count, random_state=random))
            for limit, distribution in zip(limits, (self.crank, self.rod, self.offset, self.crank_angle), strict=False)
        ]
        crank, rod, offset, angle = dimensions
        x, y = np.zeros(count), np.zeros(count)
        gaps = limits[PINS]
        if self.contact == "along the rod":
            rod = rod + gaps @ random.choice([-1.0, 1.0], (3, count))
        else:
            direction = random.uniform(0.0, 2.0 * math.pi, (3, count))
            share = np.sqrt(random.random((3, count))) if self.contact == "anywhere" else np.ones((3, count))
            x, y = gaps @ (share * np.cos(direction)), gaps @ (share * np.sin(direction))
        side = random.uniform(-1.0, 1.0, count) if self.contact == "anywhere" else random.choice([-1.0, 1.0], count)
        return Draw(crank, rod, offset + limits[GUIDE] * side, angle, x, y)


@dataclass(frozen=True)
class Draw:
    """Errors of n machines, each (n,): crank, rod, offset, m; crank angle, rad; crank pin position, m."""

    crank: Array
    rod: Array
    offset: Array
    crank_angle: Array
    pin_x: Array
    pin_y: Array
