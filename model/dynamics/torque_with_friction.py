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

Friction over the cycle: signs of sliding in each segment, and angles at which the guide force changes sides.

Friction reverses with the slider (dead centres), with the rod (where the crank is normal to the slider line) and with
the guide force. The first two are cuts from `segments.cut_cycle`. The third, a kink in every curve, is located here.

Torques of loads on the crank are subtracted from the drive torque. By virtual work, a torque M on the crank changes the
drive torque by -M and leaves all joint forces unchanged: T = T_linkage - M(theta). If the slider drives, -M adds to the
couple of weight and inertia in the crank's moments about the pivot.
"""

import math
from typing import Any, NamedTuple

from ..kernel.arithmetic import STEP, analytic, inverse, root
from ..kinematics.position import Motion, motion
from ..machine.design import AREA, DESIGN, LOAD_ROWS, Design
from ..machine.loads.load import Enters
from ..machine.mechanism import Mechanism
from .segments import (
    Cuts,
    CycleWindow,
    Segment,
    add_cut,
    angle_identifying_segment,
    crank_angle_from_crowded,
    crowded_from_crank_angle,
    crowding_parameter,
    find_segment_pieces,
    frictionless_cut_imaginary_shift,
    load_on_slider,
)
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


CONTACT = 5
"""Code of a cut at which the guide force changes sides."""
_SAMPLES = 192
_BISECTIONS = 60
_TURN = 2.0 * math.pi


def needs_friction_kernel(mechanism: Mechanism) -> bool:
    """Whether kernels must include friction."""
    return bool(mechanism.with_largest_variables.friction.acts)


@analytic
def _guide_side_function(theta: Any, d: Any, segment: Segment, grip: Any, swing: Any) -> Any:
    sine, cosine = math.sin(theta), math.cos(theta)
    m = motion(sine, cosine, d.r, d.l, d.e, d.branch)
    load = load_on_slider(m, d, theta, segment)
    return guide_side_function(sine, cosine, m, d, load, grip, swing)


@analytic
def _rotation_signs(probe: Any, d: Any) -> Any:
    """Rotation signs of crank, rod, and crank relative to rod, 1 or -1."""
    turn = 1.0 if d.speed >= 0.0 else -1.0
    m = motion(math.sin(probe), math.cos(probe), d.r, d.l, d.e, d.branch)
    return turn, 1.0 if m.rod_1 * turn > 0.0 else -1.0, turn if m.rod_1 < 1.0 else -turn


@analytic
def friction_signs_in_segment(probe: Any, d: Any, segment: Segment, rubbing: Any) -> Any:
    """Return the `Sides` for the segment around the crank angle `probe`."""
    if not rubbing:
        return Sides(0.0, 0.0, 0.0, 0.0, 0.0)
    turn, swing, grip = _rotation_signs(probe, d)
    slide = d.branch.real * (1.0 if segment.outward else -1.0)
    guide = _guide_side_function(probe, d, segment, grip, swing)
    return Sides(turn, slide, swing, -1.0 if guide > 0.0 else 1.0, grip)


@analytic
def add_guide_force_change_cuts(
    d: Any, block: Any, loads: Any, watch: CycleWindow, cuts: Cuts, count: int, piece: Any, shift: Any
) -> int:
    """Add cuts at which the guide force changes sides to the first `count` cuts; return their new number.

    Changes are found between neighbouring samples: two changes within one spacing, where the force is almost zero, are
    ignored. The curves there follow one side, with an error of at most the friction due to that force.
    """
    kappa = crowding_parameter(d.r, d.l, d.e)
    first, ahead, n = cuts.angle[0], 0, count
    for s in range(count - 1, -1, -1):  # backwards, so that insertions move only cuts that have already been processed
        while cuts.angle[ahead] < first:  # except those after the last cut that lie before the first one
            ahead += 1
        a = cuts.angle[ahead + s]
        b = cuts.angle[ahead + s + 1] if s + 1 < count else first + _TURN
        if b - a < 1e-12:
            continue
        probe = angle_identifying_segment(a, b)
        _, outward = find_segment_pieces(d, block, 0, probe, loads, watch, piece, shift)
        segment = Segment(block, loads, outward, piece, shift)
        _, swing, grip = _rotation_signs(probe, d)
        low, high = crowded_from_crank_angle(a, kappa), crowded_from_crank_angle(b, kappa)
        points = max(3, int(_SAMPLES * (high - low) / _TURN) + 1)
        left, before, right, after = a, 0.0, a, 0.0
        p, q, halvings, i = a, a, 0, 0
        # Samples and bisection share one call site, into which all loads are inlined.
        while i <= points:
            sampled = (
                a if i == 0 else b if i == points else crank_angle_from_crowded(low + (high - low) * i / points, kappa)
            )
            theta = sampled if halvings == 0 else 0.5 * (p + q)
            now = _guide_side_function(theta, d, segment, grip, swing)
            if halvings > 0:
                halvings += 1
                if now * before > 0.0:
                    p = theta
                else:
                    q = theta
            else:
                right, after = theta, now
                if i > 0 and now * before < 0.0 and n < cuts.angle.shape[0] - 2:
                    p, q, halvings = left, right, 1
            at = 0.5 * (p + q)
            if 0 < halvings <= _BISECTIONS and p < at < q:
                continue
            if halvings > 0 and at - a > 1e-12 and b - at > 1e-12:
                n = add_cut(cuts, n, at, CONTACT, 0.0, -1)
            left, before, halvings = right, after, 0
            i += 1
    return n


@analytic
def contact_cut_imaginary_shift(z: Any, stepped: Segment, d: Any, segment: Segment, theta: Any, sides: Any) -> float:
    """Return the imaginary part of such a cut's angle when the design `z` carries an imaginary step; `d` is without."""
    moved = _guide_side_function(theta, z, stepped, sides.grip, sides.swing).imag
    sine, cosine = math.sin(theta), math.cos(theta)
    s, c = complex(sine, cosine * STEP), complex(cosine, -sine * STEP)
    m = motion(s, c, d.r, d.l, d.e, d.branch)
    load = load_on_slider(m, d, complex(theta, STEP), segment)
    rise = guide_side_function(s, c, m, d, load, sides.grip, sides.swing).imag / STEP
    return float(-moved / rise)


@analytic
def cut_imaginary_shift(
    z: Any, stepped: Segment, d: Any, segment: Segment, theta: Any, cuts: Cuts, i: Any, sides: Any
) -> float:
    """Return the imaginary part of any cut's angle, at an end of a segment, as in `contact_cut_imaginary_shift`."""
    if cuts.code[i] == CONTACT:
        return contact_cut_imaginary_shift(z, stepped, d, segment, theta, sides)
    return frictionless_cut_imaginary_shift(z, stepped.block, 0, theta, cuts, i)


_CRANK_TORQUE = int(Enters.CRANK_TORQUE)


@analytic
def torque_without_crank_loads(torque: Any, theta: Any, way: float, segment: Segment) -> Any:
    """Return a torque minus the crank loads' torques, N m, at a crank angle within a segment.

    way: 1 if the crank turns counter-clockwise, -1 clockwise.
    """
    block, loads, _, piece, shift = segment
    if not loads.on_crank:
        return torque
    # Subtracted one by one within the loop, so that results without such a load are unchanged to the last digit.
    for k in range(loads.kind.shape[0]):
        q = DESIGN + LOAD_ROWS * k
        if loads.kind[k] == _CRANK_TORQUE:
            q = q + AREA
            torque = torque - (block[q, 0] - way * block[q + 1, 0] - block[q + 2, 0] * (theta - block[q + 3, 0]))
        elif loads.factor[k, 2] != 0.0:
            i = piece[k]
            first, last = loads.start[k], loads.start[k + 1]
            if i == first:
                torque = torque - loads.force[first]
            elif i == last:
                torque = torque - loads.force[last - 1]
            else:
                slope = (loads.force[i] - loads.force[i - 1]) / (loads.knots[i] - loads.knots[i - 1])
                at = theta - block[q + 1, 0] if loads.datum[k] > 0 else theta
                torque = torque - (loads.force[i - 1] + slope * (at + shift[k] - loads.knots[i - 1]))
    return torque


@analytic
def rotation_sense(d: Any) -> float:
    """Return the sense of rotation of the crank: 1 counter-clockwise or at rest, -1 clockwise."""
    return 1.0 if d.speed.real >= 0.0 else -1.0
