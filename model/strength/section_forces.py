"""Stress along crank and rod at one crank angle, from the joint forces and the links' own inertia and weight.

A link is a round-ended `Bar`: width w in the plane, depth t, density rho. Sections are counted from the crank pin A, x
along the unit vector to the other pin (slider pin of the rod, crank pivot of the crank), y across. The part on the
crank pin's side of a section, including the half-disc beyond the pin, has the acceleration (less gravity)

    a_t(x, y) = a_t0 - omega^2 x - alpha y,    a_n(x, y) = a_n0 + alpha x - omega^2 y

and is in equilibrium with the pin force F, the couple C of the pin's friction, and the section. Let m = rho t w and,
for the half-disc, m_c = pi rho t w^2 / 8, first moment s = rho t w^3 / 12, and second moments j = pi rho t w^4 / 128
each. D'Alembert's equations for that part then give axial force (tension positive) and moment, exactly for a rigid bar:

    N(x) = -F_t + a_t0 (m_c + m x) + omega^2 (s - m x^2 / 2)
    M(x) = -C + F_n x - a_n0 (s + m_c x + m x^2 / 2) + alpha (2 j + 2 s x - m x^3 / 6)

The moment causes linear elastic bending (Shigley, "Mechanical Engineering Design", 9th ed., sec. 3-10): the stress at
the faces is N / (w t) +- 6 M / (t w^2), two cubics along the bar.
"""

import math
from typing import Any, NamedTuple

from ..dynamics.torque import Forces
from ..kernel.arithmetic import analytic, inverse, root
from ..kinematics.position import Motion
from ..machine.design import Design

ROD, CRANK = 0, 1


class Stress(NamedTuple):
    """Stress along a bar, Pa, over the fraction xi = x / L of its length from the crank pin.

    Axial n0 + n1 xi + n2 xi^2, and bending b0 + b1 xi + b2 xi^2 + b3 xi^3 at the face where it adds to tension.
    """

    n0: Any
    n1: Any
    n2: Any
    b0: Any
    b1: Any
    b2: Any
    b3: Any


@analytic
def stress_coefficients_of_link(
    part: Any, sine: Any, cosine: Any, m: Motion, d: Design, f: Forces, turn: Any, bar: tuple[Any, Any, Any]
) -> Stress:
    """Return the `Stress` in the rod (`ROD`) or the crank under joint forces.

    turn: `turn` of `rubbing.Sides`. bar: width, m, depth, m, density, kg/m^3.
    """
    width, depth, density = bar
    w2 = d.speed * d.speed
    pin_x = -d.r * (cosine * w2 + sine * d.acceleration) - d.gravity_x
    pin_y = -d.r * (sine * w2 - cosine * d.acceleration) - d.gravity_y
    couple = d.crank_pin_circle * turn * root(f.crank_pin_x * f.crank_pin_x + f.crank_pin_y * f.crank_pin_y)
    if part == ROD:
        length, per = d.l, inverse(d.l)
        tx, ty = m.l_cos * per, m.l_sin * per
        fx, fy = f.crank_pin_x, f.crank_pin_y
        spin, spun = m.rod_1 * m.rod_1 * w2, m.rod_2 * w2 + m.rod_1 * d.acceleration
    else:
        length = 1.0 * d.r
        tx, ty = -cosine + 0.0 * d.r, -sine + 0.0 * d.r
        fx, fy, couple = -f.crank_pin_x, -f.crank_pin_y, -couple
        spin, spun = w2 + 0.0 * d.r, d.acceleration + 0.0 * d.r
    pin_t, pin_n = pin_x * tx + pin_y * ty, pin_y * tx - pin_x * ty
    force_t, force_n = fx * tx + fy * ty, fy * tx - fx * ty
    web = density * depth * width * length
    cap = density * depth * width * width * (math.pi / 8.0)
    first = density * depth * width * width * width * (1.0 / 12.0)
    second = cap * width * width * (1.0 / 16.0)
    of_force = inverse(width * depth)
    of_moment = 6.0 * of_force * inverse(width)
    return Stress(
        (pin_t * cap + spin * first - force_t) * of_force,
        pin_t * web * of_force,
        -0.5 * spin * web * length * of_force,
        (2.0 * spun * second - pin_n * first - couple) * of_moment,
        (force_n - pin_n * cap + 2.0 * spun * first) * length * of_moment,
        -0.5 * pin_n * web * length * of_moment,
        (-1.0 / 6.0) * spun * web * length * length * of_moment,
    )


@analytic
def stress_at_length_fraction(c: Stress, side: Any, xi: Any) -> Any:
    """Return the stress at a fraction of the length. side: 1 or -1, or 0 for the axial stress alone."""
    return c.n0 + xi * (c.n1 + xi * c.n2) + side * (c.b0 + xi * (c.b1 + xi * (c.b2 + xi * c.b3)))
