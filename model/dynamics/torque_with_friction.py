"""Inverse dynamics with Coulomb friction, solved consistently in all four joints.

Friction adds terms to the equations in `dynamics` (mu: the guide's coefficient, rho: radius of a pin's friction circle,
w the crank speed):

- slider: B_x = pull + mu |N| sgn(x' w), N = -(B_y + W), W = m_s G_y;
- rod, moments about the crank pin: along B_y - across B_x + moment - rho_A s_A |A| + rho_B sgn(phi' w) |B| = 0;
- crank, moments about the pivot: T gains rho_A s_A |A| + rho_O sgn(w) |P|, with s_A = sgn((1 - phi') w).

|phi'| < 1 if l > r + |e|, so s_A = sgn(w); on a swing the rod may turn faster than the crank, where x is on the other
side of the pivot.

With B_x eliminated, and A - B known, the moment balance is one equation h(y) = 0 for y = B_y. Where y > -W or y < -W
its slope is along -+ mu across, plus a term of magnitude at most (rho_A + rho_B) sqrt(1 + mu^2), since d|A|/dy and
d|B|/dy are at most |(mu, 1)|. Hence, with q = sqrt(1 + mu^2),

    |along| > mu |across| + q (rho_A + rho_B)                                                             (*)

makes h monotone: there is one solution, and the sign of h(-W) shows on which side of -W it lies. Divided by l q, (*)
says that the transmission angle exceeds arctan(mu) + asin((rho_A + rho_B) / l). Where it does not hold, no forces are
returned.

On the known side h is smooth. Every slope between two points is within the bounds above, so one point gives a bracket
for the root; Newton's method, with bisection whenever it would leave the bracket, converges. One further step, in the
design's arithmetic, propagates an imaginary part by the implicit function theorem.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from ..kernel.arithmetic import analytic, inverse, root
from ..kinematics.position import Motion
from ..machine.design import Design
from .torque import Forces, balance_before_pin_force, forces_from_slider_pin_force, forces_without_friction

_ITERATIONS = 100
_CONVERGED = 1e-15


class Sides(NamedTuple):
    """Signs, each +1 or -1, constant within a segment of the cycle; all 0 if there is no friction.

    turn: sign of the crank speed (+1 at rest). slide: sign of the slider velocity along x. swing: sign of the rod's
    angular velocity. press: sign of B_y + W, opposite to the guide force. grip: sign of the crank's angular velocity
    relative to the rod.
    """

    turn: float
    slide: float
    swing: float
    press: float
    grip: float


@analytic
def determinacy_margin(l_cos: Any, l_sin: Any, d: Design) -> Any:
    """Return the margin in condition (*), m: positive where the forces are determined for any load."""
    mu = d.guide_friction
    return abs(l_cos) - mu * abs(l_sin) - root(1.0 + mu * mu) * (d.crank_pin_circle + d.slider_pin_circle)


@analytic
def least_determinacy_margin(d: Design) -> Any:
    """Return the minimum of `determinacy_margin` over the cycle, at sin(theta) = -sgn(e)."""
    pin_distance = d.r + abs(d.e)
    return determinacy_margin(root(d.l * d.l - pin_distance * pin_distance), pin_distance, d)


@analytic
def guide_side_function(sine: Any, cosine: Any, m: Motion, d: Design, load: Any, grip: Any, swing: Any) -> Any:
    """Return h(-W) times the branch: it has the sign of the guide force, and is smooth between other breakpoints."""
    b = balance_before_pin_force(sine, cosine, m, d, load)
    y = -d.slider_mass * d.gravity_y
    ax, ay = b.pull + b.rod_x, y + b.rod_y
    pins = d.slider_pin_circle * swing * root(b.pull * b.pull + y * y)
    pins = pins - d.crank_pin_circle * grip * root(ax * ax + ay * ay)
    return d.branch.real * (m.l_cos * y - m.l_sin * b.pull + b.moment + pins)


@analytic
def _rod_moment_residual(
    y: Any, slope: Any, rest: Any, mu: Any, pull: Any, rod_x: Any, rod_y: Any, p: Any, q: Any
) -> Any:
    """Return h(y) and h'(y); `pull` is B_x at y = 0."""
    bx = pull + mu * y
    ax, ay = bx + rod_x, y + rod_y
    a, b = root(ax * ax + ay * ay), root(bx * bx + y * y)
    by_a = (mu * ax + ay) * inverse(a) if a.real > 0.0 else 0.0 * a
    by_b = (mu * bx + y) * inverse(b) if b.real > 0.0 else 0.0 * b
    return slope * y + rest + p * a + q * b, slope + p * by_a + q * by_b


@analytic
def forces_with_friction(sine: Any, cosine: Any, m: Motion, d: Design, load: Any, s: Sides) -> Forces:
    """Return drive torque and reactions with friction; all NaN where they are not determined."""
    b = balance_before_pin_force(sine, cosine, m, d, load)
    weight = d.slider_mass * d.gravity_y
    mu = d.guide_friction * (s.slide * s.press)
    slope = m.l_cos - m.l_sin * mu
    pull = b.pull + mu * weight
    rest = b.moment - m.l_sin * pull
    p, q = -d.crank_pin_circle * s.grip, d.slider_pin_circle * s.swing
    least = determinacy_margin(m.l_cos.real, m.l_sin.real, d)
    y = math.nan
    if least.real > 0.0:
        steep, still = slope.real, rest.real
        y = -still / steep
        if p.real != 0.0 or q.real != 0.0:
            sign = 1.0 if steep > 0.0 else -1.0
            low, high = -math.inf, math.inf
            for _ in range(_ITERATIONS):
                h, rate = _rod_moment_residual(
                    y, steep, still, mu.real, pull.real, b.rod_x.real, b.rod_y.real, p.real, q.real
                )
                if h * sign > 0.0:
                    high = y
                    low = max(low, y - h * sign / least.real)
                else:
                    low = y
                    high = min(high, y - h * sign / least.real)
                new = y - h / rate
                if not low <= new <= high:
                    new = 0.5 * (low + high)
                step = abs(new - y)
                y = new
                if step <= _CONVERGED * (abs(y) + abs(pull.real)):
                    break
    h, rate = _rod_moment_residual(y, slope, rest, mu, pull, b.rod_x, b.rod_y, p, q)
    by = y - h * inverse(rate)
    f = forces_from_slider_pin_force(sine, cosine, d, b, pull + mu * by, by)
    pin = root(f.crank_pin_x * f.crank_pin_x + f.crank_pin_y * f.crank_pin_y)
    pivot = root(f.pivot_x * f.pivot_x + f.pivot_y * f.pivot_y)
    torque = f.torque + (s.grip * d.crank_pin_circle * pin + s.turn * d.crank_pivot_circle * pivot)
    return Forces(torque, f.pivot_x, f.pivot_y, f.crank_pin_x, f.crank_pin_y, f.slider_pin_x, f.slider_pin_y, f.guide)


@analytic
def joint_forces_with_optional_friction(sine: Any, cosine: Any, m: Motion, d: Design, load: Any, sides: Any) -> Forces:
    """Return drive torque and reactions, with friction unless `sides` are 0, or None if friction is not compiled."""
    if sides is None:
        return forces_without_friction(sine, cosine, m, d, load)
    if sides.turn == 0.0:
        return forces_without_friction(sine, cosine, m, d, load)
    return forces_with_friction(sine, cosine, m, d, load, sides)
