"""Closed-form formulas for full rotation: dead centres, stroke, time ratio, transmission angle, inverse relations.

Every function accepts floats, arrays and complex numbers. `magnitude_of_offset` is |e|; passing it separately keeps the
functions free from the kink at e = 0. They hold for full rotation, l > r + |e|, which the caller has checked. Notation
and signs: `kinematics`.

Offsets that are only rounding errors: such a linkage is in-line.
"""

import math
from typing import Any

import numpy as np

from ..kernel.arithmetic import analytic, arcsine, inverse, root


@analytic
def outer_dead_centre(r: Any, l: Any, e: Any) -> Any:
    """Return the maximum distance of the slider along its line, sqrt((l + r)^2 - e^2), m."""
    return root((l + r) * (l + r) - e * e)


@analytic
def inner_dead_centre(r: Any, l: Any, e: Any) -> Any:
    """Return the minimum distance of the slider along its line, sqrt((l - r)^2 - e^2), m."""
    return root((l - r) * (l - r) - e * e)


@analytic
def stroke(r: Any, l: Any, e: Any) -> Any:
    """Return the distance between the dead centres, m; 2 r only if there is no offset.

    Written as 4 l r / (x_out + x_in), which equals x_out - x_in without cancellation.
    """
    return 4.0 * l * r * inverse(outer_dead_centre(r, l, e) + inner_dead_centre(r, l, e))


@analytic
def outer_crank_angle(r: Any, l: Any, e: Any) -> Any:
    """Return the crank angle of the outer dead centre on the open branch, asin(e / (l + r)), rad."""
    return arcsine(e * inverse(l + r))


@analytic
def inner_crank_angle(r: Any, l: Any, e: Any) -> Any:
    """Return the inner dead centre's crank angle, open branch, pi + asin(e / (l - r)), rad."""
    return math.pi + arcsine(e * inverse(l - r))


@analytic
def excess_stroke_angle(r: Any, l: Any, e: Any) -> Any:
    """Return the excess of a stroke's crank angle over pi, asin(e/(l - r)) - asin(e/(l + r)), rad. Sign of e."""
    return arcsine(e * inverse(l - r)) - arcsine(e * inverse(l + r))


@analytic
def time_ratio(r: Any, l: Any, e: Any) -> Any:
    """Return slower over faster stroke duration, (pi + b) / (pi - b), for offset e >= 0."""
    b = excess_stroke_angle(r, l, e)
    return (math.pi + b) * inverse(math.pi - b)


@analytic
def cosine_of_transmission_angle(r: Any, l: Any, magnitude_of_offset: Any) -> Any:
    """Return the cosine of the minimum transmission angle over the cycle, (r + |e|) / l."""
    return (r + magnitude_of_offset) * inverse(l)


@analytic
def least_transmission_angle(r: Any, l: Any, magnitude_of_offset: Any) -> Any:
    """Return the minimum angle between the rod and the normal of the slider line over the cycle, rad.

    mu = 90 deg - |phi| has its minimum where the crank is normal to the slider line: cos(mu_min) = (r + |e|) / l.
    """
    return 0.5 * math.pi - arcsine(cosine_of_transmission_angle(r, l, magnitude_of_offset))


@analytic
def crank_from_stroke(stroke: Any, l: Any, e: Any) -> Any:
    """Return the crank, m, that gives a stroke with rod l and offset e.

    r^2 = S^2 (l^2 - e^2 - S^2/4) / (4 l^2 - S^2).

    From e^2 + S^2/4 + 4 l^2 r^2 / S^2 = l^2 + r^2 with 4 l r >= S^2 (otherwise the root belongs to x_out + x_in = S
    and is spurious; the caller checks).
    """
    s2 = stroke * stroke
    return stroke * root((l * l - e * e - 0.25 * s2) * inverse(4.0 * l * l - s2))


@analytic
def rod_from_stroke(stroke: Any, r: Any, e: Any) -> Any:
    """Return the rod, m, that gives a stroke with crank r and offset e; same relation, solved for l.

    l^2 = S^2 (S^2/4 + e^2 - r^2) / (S^2 - 4 r^2); needs S > 2 r, hence an offset.
    """
    s2 = stroke * stroke
    return stroke * root((0.25 * s2 + e * e - r * r) * inverse(s2 - 4.0 * r * r))


@analytic
def offset_from_stroke(stroke: Any, r: Any, l: Any) -> Any:
    """Return the offset >= 0, m, that gives a stroke with crank r and rod l; same relation.

    e^2 = l^2 + r^2 - S^2/4 - 4 l^2 r^2 / S^2 = (S^2/4 - r^2) (4 l^2 / S^2 - 1).
    """
    s2 = stroke * stroke
    return root((0.25 * s2 - r * r) * (4.0 * l * l * inverse(s2) - 1.0))


@analytic
def offset_from_excess_angle(r: Any, l: Any, sine: Any, cosine: Any) -> Any:
    """Return the offset, m, for dead-centre directions that differ by b (given by sine and cosine).

    In the triangle formed by the crank pivot and the two dead centres, the sides l - r and l + r enclose b, and the
    stroke lies opposite. The offset is the height: e = (l^2 - r^2) sin(b) / S.
    """
    s2 = 2.0 * (l * l + r * r) - 2.0 * (l * l - r * r) * cosine
    return (l * l - r * r) * sine * inverse(root(s2))


_ROUNDING = 1e-15
"""Fraction of the rod. An offset this small changes closed-form values and positions only within rounding."""


def is_in_line(rod: Any, offset: Any) -> Any:
    """Return whether linkages have no offset beyond rounding, |e| <= 1e-15 l; arguments in m, broadcast."""
    return np.abs(offset) <= _ROUNDING * np.asarray(rod)


def offset_without_rounding(rod: Any, offset: Any) -> Any:
    """Return offsets, m, with those below rounding set to zero; arguments broadcast."""
    return np.where(is_in_line(rod, offset), 0.0, offset)
