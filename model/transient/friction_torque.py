"""Torque and heat for a crank at any speed and acceleration, with friction in all joints.

Joint forces contain inertia terms. Friction therefore makes the torque T(a) for an acceleration a piecewise smooth
rather than affine. Each of the magnitudes |A|, |B|, |P| and |N| in the equations of `dynamics.rubbing` has a slope of
at most one. With these slopes arbitrary, y = B_y eliminated, and primes for the two derivatives,

    dT/da = T_a - T_y h_a / h_y,

    h_y = along - nu across + (rho_A + rho_B) q,
    h_a = moment_a - across pull_a + rho_A |A_a| + rho_B |pull_a|,
    T_y = r (cos - nu sin) + (rho_A + rho_O) q,
    T_a = couple_a + r (cos A_ay - sin A_ax) + rho_A |A_a| + rho_O |P_a|,

where every rho stands for itself times a number from -1 to 1, nu for mu times such a number, and q = sqrt(1 + mu^2).
T_y / h_y is monotone in nu, so its minimum is at nu = mu or nu = -mu. If this minimum plus the drive's inertia is
positive, every motor torque has exactly one acceleration: the root of T_motor - J_drive a - T(a). By that bound, every
a gives a bracket for the root. Newton's method, with bisection whenever it would leave the bracket, converges even
across the kinks where the guide force changes sides.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from ..arrays import Array
from ..dynamics.segments import Segment, load_on_slider
from ..dynamics.torque import balance_before_pin_force
from ..dynamics.torque_with_friction import (
    Sides,
    guide_side_function,
    joint_forces_with_optional_friction,
    torque_without_crank_loads,
)
from ..errors import InputError
from ..kernel.arithmetic import analytic, root
from ..kernel.kernel import ComplexTable, Integers, Row, Table, rarely_used_kernel
from ..kinematics.position import Motion
from ..machine.design import Design, design_at
from ..machine.raw_machine_vector import Loads
from ..signals.signals import design_motion

ITERATIONS = 100
"""Maximum number of Newton steps."""
_CONVERGED, _ROUNDING = 1e-15, 1e-9
"""Step sizes that end the iteration: below the first value, or below the second and not much smaller than the previous
step, which indicates rounding errors."""
_STEP = 1e-170
"""Imaginary step whose square is zero: where no force acts, its magnitude must not be the root of a negative number."""
_SPEED, _ACCELERATION = Design._fields.index("speed"), Design._fields.index("acceleration")


class Senses(NamedTuple):
    """Signs of crank speed, slider velocity along x, and rod rotation within a span, +1 or -1."""

    turn: float
    slide: float
    swing: float


class FrictionState(NamedTuple):
    """State of motion at crank angles (n,), with friction.

    torque: torque on the crank, N m, without the drive's inertia. by_acceleration: its derivative, kg m^2. by_speed:
    its derivative, N m s, if requested. least: lower bound on by_acceleration at any acceleration. heat: friction power
    in all joints, W. guides: forces from the guides on their sliders, N, (cylinders, n).
    """

    torque: Array
    by_acceleration: Array
    by_speed: Array
    least: Array
    heat: Array
    guides: Array


@analytic
def least_inertia_with_friction(sine: Any, cosine: Any, m: Motion, push: Design, mu: Any) -> Any:
    """Return the minimum of dT/da, kg m^2, on one side of the guide, if friction does not lock the linkage.

    push: the design at speed 0 and acceleration 1, without gravity. mu: the guide's friction coefficient, or its
    negative.
    """
    b = balance_before_pin_force(sine, cosine, m, push, 0.0)
    ax, ay = b.pull + b.rod_x, b.rod_y
    px, py = ax + b.crank_x, ay + b.crank_y
    pin, pivot = root(ax * ax + ay * ay), root(px * px + py * py)
    q = root(1.0 + mu * mu)
    h_y, h_a = m.l_cos - mu * m.l_sin, b.moment - m.l_sin * b.pull
    t_y, t_a = push.r * (cosine - mu * sine), b.couple + push.r * (cosine * ay - sine * ax)
    off_h_y = q * (push.crank_pin_circle + push.slider_pin_circle)
    off_h_a = push.crank_pin_circle * pin + push.slider_pin_circle * abs(b.pull)
    off_t_y = q * (push.crank_pin_circle + push.crank_pivot_circle)
    off_t_a = push.crank_pin_circle * pin + push.crank_pivot_circle * pivot
    ratio, steep = h_a / h_y, abs(h_y) - off_h_y
    off_ratio = (off_h_a + abs(ratio) * off_h_y) / steep
    off = off_t_a + abs(t_y) * off_ratio + off_t_y * (abs(ratio) + off_ratio)
    return t_a - t_y * ratio - off


@analytic
def has_converged(step: Any, last: Any) -> bool:
    """Return whether the iteration has converged.

    step, last: this step and the previous one divided by the acceleration.
    """
    return bool(step <= _CONVERGED or (step <= _ROUNDING and step >= 0.5 * last))


@analytic
def next_acceleration(a: Any, excess: Any, slope: Any, least: Any, low: Any, high: Any) -> Any:
    """Return the next acceleration in Newton's method, and the bracket of its root.

    excess: motor torque minus the torque that the motion requires at a, N m. slope, least: slope of the latter and its
    lower bound, with the drive's inertia.
    """
    bound = a + excess / least
    low, high = np.maximum(low, np.minimum(a, bound)), np.minimum(high, np.maximum(a, bound))
    new = a + excess / slope
    outside = 1.0 - 1.0 * ((low <= new) & (new <= high))
    return new + outside * (0.5 * (low + high) - new), low, high


class _SpanCase(NamedTuple):
    """A design within a span.

    stepped: its numbers, whose speed and acceleration are overwritten. block: its columns; push: the one at speed 0 and
    acceleration 1, without gravity. piece, shift: pieces and shifts of the loads there.
    """

    stepped: ComplexTable
    block: Table
    push: int
    loads: Loads
    outward: bool
    senses: Senses
    piece: Integers
    shift: Row


class _Motor(NamedTuple):
    """A motor.

    torques: (n,), N m. inertia: that of the drive, kg m^2. step_limit: maximum number of steps for solving.
    """

    torques: Row
    inertia: float
    step_limit: int


@analytic
def _friction_heat_per_angle(f: Any, m: Motion, d: Any) -> float:
    """Return the friction heat per crank angle, J, from the forces in all joints."""
    pivot = d.crank_pivot_circle.real * math.hypot(f.pivot_x.real, f.pivot_y.real)
    in_crank = d.crank_pin_circle.real * math.hypot(f.crank_pin_x.real, f.crank_pin_y.real)
    in_slider = d.slider_pin_circle.real * math.hypot(f.slider_pin_x.real, f.slider_pin_y.real)
    pins = pivot + in_crank * (1.0 - m.rod_1.real) + in_slider * abs(m.rod_1.real)
    return float(pins + d.guide_friction.real * abs(f.guide.real * m.x_1.real))


@rarely_used_kernel
def _fill_friction_states(
    case: _SpanCase, angles: Row, speeds: Row, accelerations: Row, motor: _Motor, by_speed: bool, out: Table
) -> None:
    """Fill the rows of `out` (6, n): those of `FrictionState`, in order.

    accelerations: solved for, in place, under the motor, unless its number of steps is 0.
    """
    stepped, senses, inertia = case.stepped, case.senses, motor.inertia
    unit = design_at(case.block, case.push)
    mu = unit.guide_friction
    segment = Segment(stepped, case.loads, case.outward, case.piece, case.shift)
    for i in range(angles.shape[0]):
        theta, w, a = angles[i], speeds[i], accelerations[i]
        sine, cosine = math.sin(theta), math.cos(theta)
        still = design_motion(sine, cosine, unit)
        least = least_inertia_with_friction(sine, cosine, still, unit, mu)
        least = min(least, least_inertia_with_friction(sine, cosine, still, unit, -mu))
        low, high, last, steps, derivative = -math.inf, math.inf, math.inf, 0, 0
        while True:
            stepped[_SPEED, 0] = complex(w, _STEP if derivative == 1 else 0.0)
            stepped[_ACCELERATION, 0] = complex(a, _STEP if derivative == 0 else 0.0)
            d = design_at(stepped, 0)
            m = design_motion(sine, cosine, d)
            load = load_on_slider(m, d, theta, segment)
            guide = guide_side_function(sine, cosine, m, d, load, senses.turn, senses.swing)
            press = -1.0 if guide.real > 0.0 else 1.0
            sides = Sides(senses.turn, senses.slide, senses.swing, press, senses.turn)
            f = joint_forces_with_optional_friction(sine, cosine, m, d, load, sides)
            torque = torque_without_crank_loads(f.torque, theta, senses.turn, segment)
            rate = torque.imag / _STEP
            out[1 + derivative, i] = rate
            if derivative == 1:
                break
            if steps < motor.step_limit and least + inertia > 0.0:
                excess = motor.torques[i] - inertia * a - torque.real
                new, low, high = next_acceleration(a, excess, rate + inertia, least + inertia, low, high)
                size = abs(new) + (abs(motor.torques[i]) + abs(torque.real)) / (least + inertia)
                step = abs(new - a) / size if size > 0.0 else 0.0
                a, steps = new, steps + 1
                if not has_converged(step, last):
                    last = step
                    continue
            accelerations[i] = a
            out[0, i] = torque.real
            out[3, i] = least
            out[4, i] = _friction_heat_per_angle(f, m, d) * senses.turn * w
            out[5, i] = f.guide.real
            if not by_speed:
                break
            derivative = 1


class CylinderFriction:
    """Friction of one cylinder between two breakpoints.

    block: columns of the design; push: the one at speed 0 and acceleration 1, without gravity. piece, shift: pieces and
    shifts of the loads there.
    """

    def __init__(
        self, block: Table, push: int, loads: Loads, outward: bool, senses: Senses, piece: Integers, shift: Row
    ) -> None:
        stepped = np.array(block[:, :1], dtype=np.complex128)
        self._case = _SpanCase(stepped, block, push, loads, outward, senses, piece, shift)

    def state_at(self, crank_angle: Array, speed: Array, acceleration: Array) -> FrictionState:
        """Return torque and heat for a motion (n,)."""
        return self._fill_states(crank_angle, speed, acceleration, _Motor(np.empty(0), 0.0, 0), by_speed=True)

    def solve_acceleration(
        self, crank_angle: Array, speed: Array, torque: Array, inertia: float, guess: Array, *, by_speed: bool
    ) -> tuple[Array, FrictionState]:
        """Return the accelerations under a motor torque, and torque and heat of the resulting motion."""
        accelerations, motor = np.array(guess), _Motor(torque, inertia, ITERATIONS)
        state = self._fill_states(crank_angle, speed, accelerations, motor, by_speed=by_speed)
        require_inertia_left(crank_angle, state.least + inertia)
        return accelerations, state

    def _fill_states(
        self, angle: Array, speed: Array, accelerations: Array, motor: _Motor, *, by_speed: bool
    ) -> FrictionState:
        out = np.empty((6, len(angle)))
        _fill_friction_states(self._case, angle, speed, accelerations, motor, by_speed, out)
        torque, by_acceleration, rate, least, heat, _ = out
        return FrictionState(torque, by_acceleration, rate, least, heat, out[5:])


def require_inertia_left(angle: Array, inertia: Array) -> None:
    """Raise `InputError` if friction may jam a crank. angle: rad. inertia: inertia that friction leaves, kg m^2."""
    if not (inertia > 0.0).all():
        raise jamming_error(angle, inertia)


def jamming_error(angle: Array, inertia: Array) -> InputError:
    """Return the error for a crank that friction may jam where the least inertia remains.

    See `require_inertia_left`.
    """
    worst = int(np.argmin(np.where(np.isnan(inertia), -np.inf, inertia)))
    return InputError(
        "the inertia must exceed the part that friction cancels at every crank angle, so that the torque determines "
        "the "
        f"acceleration; got {inertia[worst]:.3g} kg m^2 left at {math.degrees(angle[worst]) % 360.0:.4g} deg; give "
        "the drive a flywheel, the crank a mass, or reduce the friction"
    )


def sum_cylinders(parts: list[FrictionState]) -> FrictionState:
    """Return the state of a shaft from the states of its cylinders."""
    guides = np.concatenate([part.guides for part in parts])
    torque, by_acceleration, by_speed, least, heat = np.sum([part[:-1] for part in parts], axis=0)
    return FrictionState(torque, by_acceleration, by_speed, least, heat, guides)
