"""Exact worst case: the maximum and the minimum slider position that the tolerances allow.

On the open branch, with the crank pin at (a, b) = r (cos theta, sin theta),

    x = a + sqrt(l^2 - (e - b)^2),

to be maximised and minimised over the box of crank r, rod l, offset e and crank angle theta (clearances widen the box,
exactly: see `position_error`). The crossed branch is its mirror image, x(theta) -> -x(pi - theta).

1. dx/dl = 1 / cos(phi) > 0: the maximum x has the longest rod, the minimum x the shortest rod. 2. x is concave in (a,
b, e) together, so at a fixed crank angle it is concave in (r, e) together.
   - Minimum x: at a corner of (r, e).
   - Maximum x: possibly in the interior. dx/de = 0 where the rod lies along the line, e = r sin(theta), and dx/dr = 0
     where the crank is normal to the rod, r = e / sin(theta) + l cos(theta) / |sin(theta)|. Both together need
     cos(theta) = 0; x = l is then the same all along e = r sin(theta), also on an edge. 3. dx/dtheta = 0 only at the
     dead centres of a fully rotating linkage. At the outer one, theta = asin(e / (l + r)), x has its maximum over the
     turn; at the inner one, theta = pi + asin(e / (l - r)), its minimum.
   - At a dead centre, crank and rod are in line, so dx/dr is not 0. With dx/de = 0 as well, e = 0 and theta = 0.

So the maximum x is at one of 8 corners in (r, e, theta), 4 points with only e in the interior, 4 with only r, 4 with
only theta, and one with e and theta. The minimum x is at one of 8 corners or 4 points with only theta in the interior.
All are evaluated; those outside are moved into the box. Each is then a position that does occur, and the extreme is
among them.

First-order position errors: worst case, root-sum-square, contributions, and a bound on their inaccuracy.
"""

from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array
from ..cycle.cycle import cycle
from ..errors import InputError
from ..linkage.linkage import Linkage
from ..linkage.require_single_linkage import require_single_rotating_linkage
from ..machine.mechanism import Mechanism
from ..signals.panel_polynomials import wrap_into_cycle
from .error_distributions import angle_ranges_where_error_counts, limit_box, limits_of_sources, source_influences


@dataclass(frozen=True)
class FirstOrder:
    """First-order position errors at crank angles (m,), rad.

    worst_case, root_sum_square: (m,), m. contributions: |influence| times limit of each source, (8, m), m.
    share_of_worst_case, share_of_variance: fractions, (8, m); NaN if nothing contributes. remainder: (m,), m, bound on
    the contribution from second and higher orders, anywhere within the limits.
    """

    crank_angle: Array
    worst_case: Array
    root_sum_square: Array
    contributions: Array
    share_of_worst_case: Array
    share_of_variance: Array
    remainder: Array


def first_order_position_errors(mechanism: Mechanism, linkage: Linkage, crank_angle: ArrayLike) -> FirstOrder:
    """Return the first-order position errors of one linkage at crank angles (m,), rad.

    The fractions of the variance assume that all limits are the same number of standard deviations. They are squares of
    the contributions divided by the square of the root-sum-square.
    """
    linkage = require_single_rotating_linkage(mechanism, linkage)
    angles = np.atleast_1d(np.asarray(crank_angle, dtype=np.float64))
    curves = cycle(mechanism, linkage, angles)
    parts = np.abs(source_influences(mechanism, linkage, angles)) * limits_of_sources(mechanism, linkage)[:, None]
    return FirstOrder(
        angles,
        curves.position_error,
        curves.position_error_rss,
        parts,
        fractions_of_sum(parts),
        fractions_of_sum(parts * parts),
        higher_order_bound(mechanism, linkage, angles),
    )


def fractions_of_sum(parts: Array) -> Array:
    """Return parts (n, m) divided by their sum (m,); NaN if all are zero."""
    total = parts.sum(axis=0)
    fractions: Array = np.divide(parts, total, out=np.full(parts.shape, np.nan), where=total > 0.0)
    return fractions


def higher_order_bound(mechanism: Mechanism, linkage: Linkage, crank_angle: ArrayLike) -> Array:
    """Return a bound (m,), m, on |x - x_0 - first order| within the limits, at crank angles (m,).

    Taylor's theorem: half the sum over pairs of |second derivative| T_i T_j, with bounds on the second derivatives over
    the whole box. With q = e - r sin(theta) and h = sqrt(l^2 - q^2), x = r cos(theta) + h, those of h are h_qq = -l^2 /
    h^3, h_ll = -q^2 / h^3, h_lq = l q / h^3; |q| is bounded by |q_0| + T_e + T_r + r T_theta, l and r by their limits,
    |sin| and |cos| by 1.
    """
    linkage = require_single_rotating_linkage(mechanism, linkage)
    angles = np.atleast_1d(np.asarray(crank_angle, dtype=np.float64))
    box = limit_box(mechanism, linkage)
    t = 0.5 * (box[:, 1] - box[:, 0])
    r, l_least, l = box[0, 1], box[1, 0], box[1, 1]
    greatest = r + np.abs(box[2]).max()
    q = np.abs(linkage.offset - linkage.crank * np.sin(angles)) + t[2] + t[0] + r * t[3]
    q = np.minimum(q, greatest)
    h = np.sqrt(l_least * l_least - q * q)
    sine = np.minimum(1.0, np.abs(np.sin(angles)) + t[3])
    cosine = np.minimum(1.0, np.abs(np.cos(angles)) + t[3])
    h_q, h_qq, h_ll, h_lq = q / h, l * l / h**3, q * q / h**3, l * q / h**3
    # The crank changes q by sin, the offset by 1, the crank angle by r cos: first derivatives of q times the limits.
    q_step = sine * t[0] + t[2] + r * cosine * t[3]
    of_q = h_qq * q_step**2 + 2.0 * h_lq * q_step * t[1] + h_ll * t[1] ** 2
    of_angle = 2.0 * (sine + h_q * cosine) * t[0] * t[3] + (r * cosine + h_q * r * sine) * t[3] ** 2
    bound: Array = 0.5 * (of_q + of_angle)
    return bound


_CELLS = 4  # highest samples around which the maximum deviation is refined
_TURN = 2.0 * np.pi


@dataclass(frozen=True)
class Extremes:
    """Minimum and maximum deviation of the slider position, m, at crank angles, rad: each (m,)."""

    crank_angle: Array
    least: Array
    greatest: Array

    @property
    def largest_magnitude(self) -> Array:
        """Larger of the two magnitudes, (m,), m: the exact worst case."""
        return np.maximum(-self.least, self.greatest)


@dataclass(frozen=True)
class Worst:
    """The exact worst case over the part of the cycle that counts: its magnitude, m, and the crank angle, rad."""

    size: float
    crank_angle: float


def position_deviation_extremes(mechanism: Mechanism, linkage: Linkage, crank_angle: ArrayLike) -> Extremes:
    """Return the exact extremes of the slider's deviation at crank angles (m,), rad, for one linkage.

    Along +x, from the position of the nominal linkage at the nominal angle. Raises `AssemblyError` unless every linkage
    within the tolerances rotates fully.
    """
    linkage = require_single_rotating_linkage(mechanism, linkage)
    angles = np.atleast_1d(np.asarray(crank_angle, dtype=np.float64))
    if angles.ndim != 1:
        raise InputError(f"crank angles must be one number or a list of them; got an array of shape {angles.shape}")
    ideal = linkage.at(angles).slider_position
    (r, l, e, turn) = limit_box(mechanism, linkage)
    if linkage.branch == "open":
        return Extremes(
            angles,
            _least_position(r, l[0], e, angles, turn) - ideal,
            _greatest_position(r, l[1], e, angles, turn) - ideal,
        )
    mirrored = np.pi - angles
    least, greatest = -_greatest_position(r, l[1], e, mirrored, turn), -_least_position(r, l[0], e, mirrored, turn)
    return Extremes(angles, least - ideal, greatest - ideal)


def worst_position_error(mechanism: Mechanism, linkage: Linkage) -> Worst:
    """Return the exact worst case over the part of the cycle in which the position error counts.

    Continuous crank angle: the highest samples are refined until the value is exact to rounding.
    """
    from scipy.optimize import minimize_scalar

    best = Worst(0.0, 0.0)

    def negative_size(angle: float) -> float:
        return -float(position_deviation_extremes(mechanism, linkage, angle).largest_magnitude[0])

    for angles in angle_ranges_where_error_counts(mechanism, linkage):
        sizes = position_deviation_extremes(mechanism, linkage, angles).largest_magnitude
        padded = np.concatenate([[-1.0], sizes, [-1.0]])
        tops = np.flatnonzero((sizes >= padded[:-2]) & (sizes >= padded[2:]))
        for i in tops[np.argsort(sizes[tops])[-_CELLS:]]:
            low, high = angles[max(i - 1, 0)], angles[min(i + 1, len(angles) - 1)]
            optimum = minimize_scalar(negative_size, bounds=(low, high), method="bounded", options={"xatol": 1e-10})
            for size, angle in ((sizes[i], angles[i]), (-optimum.fun, optimum.x)):
                if size > best.size:
                    best = Worst(float(size), wrap_into_cycle(float(angle), _TURN))
    return best


def _slider_position(r: Array, l: float, e: Array, angles: Array) -> Array:
    l_sin = e - r * np.sin(angles)
    return r * np.cos(angles) + np.sqrt(l * l - l_sin * l_sin)


def _greatest_position(r: Array, l: float, e: Array, middle: Array, turn: Array) -> Array:
    """Maximum position on the open branch for ranges r, e (2,) and middle + turn (2,) of the crank angle."""
    ends = middle + turn[:, None]
    best = np.full(middle.shape, -np.inf)

    def take(crank: Array | float, offset: Array | float, angles: Array) -> None:
        crank, offset = np.clip(crank, *r), np.clip(offset, *e)
        np.maximum(best, _slider_position(crank, l, offset, angles), out=best)

    for angles in ends:
        sine, cosine = np.sin(angles), np.cos(angles)
        for crank in r:
            take(crank, crank * sine, angles)
        safe = np.where(sine == 0.0, 1.0, sine)
        for offset in e:
            take(np.where(sine == 0.0, r[0], offset / safe + l * cosine / np.abs(safe)), offset, angles)
        for crank, offset in product(r, e):
            take(crank, offset, angles)
    for crank, offset in product(r, e):
        take(crank, offset, _clip_angle(np.arcsin(offset / (l + crank)), middle, turn))
    take(r[1], 0.0, _clip_angle(0.0, middle, turn))
    return best


def _least_position(r: Array, l: float, e: Array, middle: Array, turn: Array) -> Array:
    """Minimum position on the open branch; arguments as for `_greatest_position`."""
    best = np.full(middle.shape, np.inf)
    for crank, offset in product(r, e):
        dead = _clip_angle(np.pi + np.arcsin(offset / (l - crank)), middle, turn)
        for angles in (*(middle + turn[:, None]), dead):
            np.minimum(best, _slider_position(crank, l, offset, angles), out=best)
    return best


def _clip_angle(angle: float, middle: Array, turn: Array) -> Array:
    """Return a crank angle clipped to middle + turn, up to whole turns."""
    away = angle - middle
    return middle + np.clip(away - _TURN * np.round(away / _TURN), *turn)
