"""Equilibrium of a linkage whose slider is pushed and whose crank is free: the force in the slider pin.

The equations are those of `torque`, written for numbers of one design, for arrays, and for kernels.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from ..dynamics.torque import Balance
from ..kernel.arithmetic import analytic, inverse, root
from ..kinematics.position import Motion
from ..machine.design import Design

_NOTHING = 1e-300


class PinRows(NamedTuple):
    """Residual moments of the rod and the crank, N m, and their slopes by B_x and B_y, m."""

    rod: Any
    crank: Any
    rod_x: Any
    rod_y: Any
    crank_x: Any
    crank_y: Any


class PinSides(NamedTuple):
    """Radii of the friction circles of crank pin, slider pin and crank pivot, m, with their senses of rotation."""

    crank_pin: Any
    slider_pin: Any
    crank_pivot: Any


@analytic
def pin_distance_from_crank_line(sine: Any, cosine: Any, m: Motion) -> Any:
    """Distance of the slider pin from the crank line, l sin(theta - phi), m."""
    return sine * m.l_cos - cosine * m.l_sin


@analytic
def frictionless_pin_force(sine: Any, cosine: Any, m: Motion, d: Design, b: Balance) -> tuple[Any, Any]:
    """Return B without friction in the pins, N."""
    crank = b.couple + d.r * (cosine * b.rod_y - sine * b.rod_x)
    per = inverse(d.r * pin_distance_from_crank_line(sine, cosine, m))
    return (m.l_cos * crank - d.r * cosine * b.moment) * per, (m.l_sin * crank - d.r * sine * b.moment) * per


@analytic
def rod_and_crank_residuals(
    bx: Any, by: Any, sine: Any, cosine: Any, m: Motion, d: Design, b: Balance, sides: PinSides
) -> PinRows:
    """Return the moments on rod and crank for a force in the slider pin, with friction in the pins."""
    ax, ay = bx + b.rod_x, by + b.rod_y
    px, py = ax + b.crank_x, ay + b.crank_y
    size_a, size_b, size_p = root(ax * ax + ay * ay), root(bx * bx + by * by), root(px * px + py * py)
    # Without a force there is no direction, hence no friction.
    per_a, per_b, per_p = inverse(size_a + _NOTHING), inverse(size_b + _NOTHING), inverse(size_p + _NOTHING)
    a, q, o = sides.crank_pin, sides.slider_pin, sides.crank_pivot
    return PinRows(
        m.l_cos * by - m.l_sin * bx + b.moment - a * size_a + q * size_b,
        b.couple + d.r * (cosine * ay - sine * ax) + a * size_a + o * size_p,
        -m.l_sin - a * ax * per_a + q * bx * per_b,
        m.l_cos - a * ay * per_a + q * by * per_b,
        -d.r * sine + a * ax * per_a + o * px * per_p,
        d.r * cosine + a * ay * per_a + o * py * per_p,
    )


@analytic
def newton_step(rows: PinRows) -> tuple[Any, Any]:
    """Return the Newton step for B."""
    per = inverse(rows.rod_x * rows.crank_y - rows.rod_y * rows.crank_x)
    return (rows.rod_y * rows.crank - rows.crank_y * rows.rod) * per, (
        rows.crank_x * rows.rod - rows.rod_x * rows.crank
    ) * per
