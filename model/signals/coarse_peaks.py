"""Location of the peaks of very many designs: curves sampled in single precision, and their highest samples.

The sweep only has to find the cell that contains a peak; `fast_torque_and_error` refines the peak in double precision,
with the formulas from `signals`. Single precision is twice as fast and is sufficient. Near locking its rounding error
grows to 1e-7 l / (l - r - |e|), but the drop from a peak to the next sample grows to spacing^2 / 4 times the same
factor, a thousand times as much at 360 angles. A second peak that is equally high to rounding could still mislead, so
it is refined as well. Lengths are scaled by the rod, and curves to about one, so that nothing overflows in any unit.

For the same reason, the torque comes from virtual work here, with half the operations of the joint forces in
`dynamics`; tests compare the two. Let S be the rod's first moment about the crank pin, C that of the crank, to which
the rod's mass at the crank pin is added, a = phi'' w^2 + phi' alpha, and u, v = r times the components of S along and
across the crank,

    T = a (I phi' + u) + phi' (w^2 (1 - phi') v + alpha u - S x G) + x' F + I_O alpha - C x G,

where F = m_s (x'' w^2 + x' alpha - G_x) minus the load along x.
"""

import math
from typing import Any

import numpy as np

from ..kernel.arithmetic import analytic
from ..machine.design import design_at
from .signals import Signal

LANES = 64
"""Designs per block: its working arrays stay in the first-level cache."""
# Rows of the numbers that the curves need.
_R, _E, _BRANCH, _KAPPA, _DOUBT, _W2, _ALPHA, _INERTIA, _ALONG, _ACROSS = range(10)
_MASS, _DAMPING, _STIFFNESS, _STIFFNESS_LESS_MASS, _FORCE_POSITIVE, _FORCE_NEGATIVE = range(10, 16)
_ROD_ALONG, _ROD_ACROSS, _CRANK_COSINE, _CRANK_SINE, _CONSTANT = range(16, 21)
_OF_CRANK, _OF_ROD, _OF_OFFSET, _OF_ANGLE = range(21, 25)
ROWS = 25
_TORQUE, _WORST = int(Signal.TORQUE), int(Signal.POSITION_ERROR)
_ZERO, _EIGHTH, _HALF, _ONE, _TWO = (np.float32(x) for x in (0.0, 0.125, 0.5, 1.0, 2.0))
_LOCKED = np.float32(2.0**-22)  # minimum square of cos(phi); below this, rounding could make it negative
_ROUNDING = 2.0**-20  # rounding error of a sample, with a margin, for a linkage far from locking


@analytic
def fill_curve_numbers(block: Any, kappa: Any, direction: Any, b: Any) -> None:
    """Fill `b` (ROWS, LANES), single precision, from derived designs, kappa of the crowded angle, sense of rotation."""
    for j in range(LANES):
        d = design_at(block, j)
        w2, l = d.speed * d.speed, d.l
        pace = w2 + abs(d.acceleration)
        pace = pace if pace > 0.0 else 1.0
        crank_along, crank_across = d.crank_along + d.rod_mass * d.r, d.crank_across
        inertia = pace * d.rod_inertia
        rod_along, rod_across = pace * d.r * l * d.rod_along, pace * d.r * l * d.rod_across
        mass, damping = d.moving_mass * w2 * l * l, (d.moving_mass * d.acceleration + d.viscous * d.speed) * l * l
        stiffness = d.stiffness * l * l
        steady = d.slider_mass * d.gravity_x + d.branch * d.spring_force
        outward = -(steady + d.branch * d.outward_force) * l
        inward = -(steady + d.branch * d.inward_force) * l
        fall_along = (d.rod_along * d.gravity_y - d.rod_across * d.gravity_x) * l
        fall_across = (d.rod_across * d.gravity_y + d.rod_along * d.gravity_x) * l
        fall_cosine, fall_sine = (
            crank_along * d.gravity_y - crank_across * d.gravity_x,
            crank_across * d.gravity_y + crank_along * d.gravity_x,
        )
        constant = (d.crank_inertia + d.rod_mass * d.r * d.r) * d.acceleration
        size = abs(inertia) + abs(rod_along) + abs(rod_across) + abs(mass) + abs(damping) + abs(stiffness)
        size += abs(outward) + abs(inward) + abs(fall_along) + abs(fall_across) + abs(fall_cosine) + abs(fall_sine)
        size += abs(constant)
        per_size = 1.0 / (size if size > 0.0 else 1.0)
        angle = d.angle_error * l
        errors = d.crank_error + d.rod_error + d.offset_error + angle
        per = 1.0 / (errors if errors > 0.0 else 1.0)
        b[_R, j], b[_E, j], b[_BRANCH, j] = d.r / l, d.e / l, d.branch
        b[_KAPPA, j], b[_DOUBT, j] = kappa[j], min(1.0, _ROUNDING * l / (l - d.r - abs(d.e)))
        b[_W2, j], b[_ALPHA, j], b[_INERTIA, j] = w2 / pace, d.acceleration / pace, per_size * inertia
        b[_ALONG, j], b[_ACROSS, j], b[_MASS, j] = per_size * rod_along, per_size * rod_across, per_size * mass
        b[_DAMPING, j], b[_STIFFNESS, j] = per_size * damping, per_size * stiffness
        b[_STIFFNESS_LESS_MASS, j] = per_size * (stiffness - mass)
        # Determines which force acts while x' is positive.
        b[_FORCE_POSITIVE, j] = per_size * (outward if d.branch * direction > 0.0 else inward)
        b[_FORCE_NEGATIVE, j] = per_size * (inward if d.branch * direction > 0.0 else outward)
        b[_ROD_ALONG, j], b[_ROD_ACROSS, j] = per_size * fall_along, per_size * fall_across
        b[_CRANK_COSINE, j], b[_CRANK_SINE, j], b[_CONSTANT, j] = (
            per_size * fall_cosine,
            per_size * fall_sine,
            per_size * constant,
        )
        b[_OF_CRANK, j], b[_OF_ROD, j] = per * d.crank_error, per * d.rod_error
        b[_OF_OFFSET, j], b[_OF_ANGLE, j] = per * d.offset_error, per * angle


@analytic
def _crank_sine_and_cosine(sine_tau: Any, cosine_tau: Any, crowd: Any, kappa: Any) -> Any:
    """Sine and cosine of the crank angle at tau: tan(theta - pi/2) = kappa tan(tau)."""
    if crowd:
        y = kappa * sine_tau
        q = _ONE / math.sqrt(cosine_tau * cosine_tau + y * y)
        return cosine_tau * q, -y * q
    return cosine_tau, -sine_tau


@analytic
def _torque_and_position_errors(b: Any, j: Any, sine: Any, cosine: Any) -> Any:
    """Torque, worst case and square of the root-sum-square, each at theta and at pi - theta, which share the motion.

    Terms marked `odd` change sign between the two, as the cosine does; x_1 and the like belong to theta, y_1 to pi -
    theta. `turn` is -phi' at theta.
    """
    rs, rc = b[_R, j] * sine, b[_R, j] * cosine
    l_sin = b[_E, j] - rs
    square = max(_ONE - l_sin * l_sin, _LOCKED)
    secant = _ONE / math.sqrt(square)  # one instruction and a Newton step
    per_l_cos = b[_BRANCH, j] * secant
    l_cos = square * per_l_cos
    tangent = l_sin * per_l_cos
    turn = rc * per_l_cos
    turn_2 = turn * turn
    rod_2 = rs * per_l_cos + turn_2 * tangent
    centripetal = l_cos * turn_2 + l_sin * rod_2
    swing = l_sin * turn
    x_1, y_1 = swing - rs, -swing - rs
    w_rod_2, w_turn = b[_W2, j] * rod_2, b[_W2, j] * turn
    w_turn_2, speeding, spin = w_turn * turn, b[_ALPHA, j] * turn, b[_INERTIA, j] * turn
    sx = b[_ALONG, j] * l_cos - b[_ACROSS, j] * l_sin
    sy = b[_ALONG, j] * l_sin + b[_ACROSS, j] * l_cos
    u_even, u_odd, v_even, v_odd = sine * sy, cosine * sx, sine * sx, cosine * sy
    even = b[_CONSTANT, j] + b[_CRANK_SINE, j] * sine
    even += w_rod_2 * u_even + speeding * (spin - _TWO * u_odd) + w_turn_2 * v_even - w_turn * v_odd
    odd = turn * (b[_ROD_ALONG, j] * l_cos - b[_ROD_ACROSS, j] * l_sin) - b[_CRANK_COSINE, j] * cosine
    odd += w_rod_2 * (u_odd - spin) - _TWO * speeding * u_even + w_turn * v_even - w_turn_2 * v_odd
    force_even = b[_STIFFNESS, j] * l_cos - b[_MASS, j] * centripetal - b[_DAMPING, j] * rs
    force_odd = b[_STIFFNESS_LESS_MASS, j] * rc + b[_DAMPING, j] * swing
    positive, negative = b[_FORCE_POSITIVE, j], b[_FORCE_NEGATIVE, j]
    x_force = force_even + force_odd + (positive if x_1 > _ZERO else negative)
    y_force = force_even - force_odd + (positive if y_1 > _ZERO else negative)
    lean = tangent * sine
    x_crank, y_crank = lean + cosine, lean - cosine
    of_crank, of_angle = b[_OF_CRANK, j], b[_OF_ANGLE, j]
    rod, offset = b[_OF_ROD, j] * secant, b[_OF_OFFSET, j] * tangent
    rod_and_offset, squares = rod + abs(offset), rod * rod + offset * offset
    x_square, y_square = of_crank * of_crank * x_crank * x_crank, of_crank * of_crank * y_crank * y_crank
    return (
        abs(x_1 * x_force + (even + odd)),
        abs(y_1 * y_force + (even - odd)),
        of_crank * abs(x_crank) + of_angle * abs(x_1) + rod_and_offset,
        of_crank * abs(y_crank) + of_angle * abs(y_1) + rod_and_offset,
        x_square + of_angle * of_angle * x_1 * x_1 + squares,
        y_square + of_angle * of_angle * y_1 * y_1 + squares,
    )


@analytic
def _sample_torque_and_worst_case(
    sine_tau: Any, cosine_tau: Any, crowd: Any, b: Any, at_tau: Any, at_minus_tau: Any
) -> None:
    """Torque and worst-case position error for all lanes at tau and -tau."""
    for j in range(LANES):
        sine, cosine = _crank_sine_and_cosine(sine_tau, cosine_tau, crowd, b[_KAPPA, j])
        at_tau[0, j], at_minus_tau[0, j], at_tau[1, j], at_minus_tau[1, j], _, _ = _torque_and_position_errors(
            b, j, sine, cosine
        )


@analytic
def _sample_squared_rss_error(
    sine_tau: Any, cosine_tau: Any, crowd: Any, b: Any, at_tau: Any, at_minus_tau: Any
) -> None:
    """Squares of the root-sum-square for all lanes at tau and -tau."""
    for j in range(LANES):
        sine, cosine = _crank_sine_and_cosine(sine_tau, cosine_tau, crowd, b[_KAPPA, j])
        _, _, _, _, at_tau[2, j], at_minus_tau[2, j] = _torque_and_position_errors(b, j, sine, cosine)


@analytic
def row_number_of_signal(kind: Any) -> Any:
    """Return the row that holds the samples of a signal."""
    return 0 if kind == _TORQUE else (1 if kind == _WORST else 2)


@analytic
def sample_curves(kinds: Any, tau: Any, crowd: Any, b: Any, samples: Any) -> None:
    """Fill the samples (3, angles + 2, LANES) at `tau` (2, angles): rows 1 to angles, and the wrapped ends.

    Torque and worst case are always computed together. Two ways of computing a curve would round differently, and
    results would depend on what else was requested.
    """
    angles = tau.shape[1]
    for squares in (False, True):
        is_needed = False
        for kind in kinds:
            is_needed = is_needed or (row_number_of_signal(kind) == 2) == squares
        for k in range(angles // 2 + 1 if is_needed else 0):
            # If an angle is its own mirror image, the other row is a spare one, because writing one row twice would be
            # slow.
            w = angles - k + 1 if 2 * k < angles else 0
            if squares:
                _sample_squared_rss_error(tau[0, k], tau[1, k], crowd, b, samples[:, k + 1], samples[:, w])
            else:
                _sample_torque_and_worst_case(tau[0, k], tau[1, k], crowd, b, samples[:, k + 1], samples[:, w])
    for kind in kinds:
        q = row_number_of_signal(kind)
        for j in range(LANES):
            samples[q, 0, j] = samples[q, angles, j]


@analytic
def _is_rival_maximum(low: Any, middle: Any, high: Any, floor: Any, place: Any, at: Any) -> Any:
    """Return 1 at a local maximum, other than the highest sample, near which the curve may exceed the floor.

    A parabola through three samples rises above the middle one by at most a quarter of their half difference.
    """
    bound = middle + _EIGHTH * abs(high - low)
    return _ONE if (middle >= low) & (middle > high) & (bound > floor) & (place != at) else _ZERO


@analytic
def _fill_parabola_vertex(samples: Any, i: Any, mark: Any, top: Any) -> None:
    """Fill three rows in `top` from the samples around each lane's first (i = 0) or second maximum."""
    for j in range(LANES):
        place = int(mark[2 * i + 1, j])
        top[3 * i, j] = place - 1
        place = max(place, 1)
        mark[4, j], mark[5, j], mark[6, j] = samples[place - 1, j], samples[place, j], samples[place + 1, j]
    for j in range(LANES):
        low, middle, high = mark[4, j], mark[5, j], mark[6, j]
        second = (high - middle) - (middle - low)
        top[3 * i + 1, j] = _HALF * (low - high) / second if second < _ZERO else _ZERO
        top[3 * i + 2, j] = second / middle if middle > _ZERO else _ZERO


@analytic
def find_two_highest(samples: Any, b: Any, mark: Any, top: Any) -> bool:
    """Find each lane's highest sample, and the highest other local maximum that could exceed it between samples.

    samples: samples of one signal. `top` (6, LANES) receives three values for each of both maxima: the index, the
    vertex of the parabola through the samples (in spacings from there), and their second difference divided by the
    middle sample. The index is -1 if there is no second maximum. Returns whether any lane has a second maximum. mark:
    work space, (7, LANES).
    """
    angles = samples.shape[0] - 2
    for j in range(LANES):
        mark[0, j], mark[1, j], mark[2, j], mark[3, j] = -_ONE, _ONE, -_ONE, _ZERO
    for k in range(1, angles + 1, 4):
        k_0, k_1, k_2, k_3 = np.float32(k), np.float32(k + 1), np.float32(k + 2), np.float32(k + 3)
        for j in range(LANES):
            best, place = mark[0, j], mark[1, j]
            f_0, f_1, f_2, f_3 = samples[k, j], samples[k + 1, j], samples[k + 2, j], samples[k + 3, j]
            place = k_0 if f_0 > best else place
            best = max(best, f_0)
            place = k_1 if f_1 > best else place
            best = max(best, f_1)
            place = k_2 if f_2 > best else place
            best = max(best, f_2)
            mark[1, j] = k_3 if f_3 > best else place
            mark[0, j] = max(best, f_3)
    for j in range(LANES):
        mark[0, j] -= mark[0, j] * b[_DOUBT, j]
    any_rival = False
    for k in range(1, angles + 1, 4):
        k_0, k_1, k_2, k_3 = np.float32(k), np.float32(k + 1), np.float32(k + 2), np.float32(k + 3)
        rivals = _ZERO
        for j in range(LANES):
            floor, place, f_0, f_1 = mark[0, j], mark[1, j], samples[k - 1, j], samples[k, j]
            f_2, f_3, f_4, f_5 = samples[k + 1, j], samples[k + 2, j], samples[k + 3, j], samples[k + 4, j]
            rivals += _is_rival_maximum(f_0, f_1, f_2, floor, place, k_0) + _is_rival_maximum(
                f_1, f_2, f_3, floor, place, k_1
            )
            rivals += _is_rival_maximum(f_2, f_3, f_4, floor, place, k_2) + _is_rival_maximum(
                f_3, f_4, f_5, floor, place, k_3
            )
        if rivals > _ZERO:
            any_rival = True
            for i in range(k, k + 4):
                for j in range(LANES):
                    low, middle, high = samples[i - 1, j], samples[i, j], samples[i + 1, j]
                    if _is_rival_maximum(low, middle, high, mark[0, j], mark[1, j], i) > _ZERO and middle > mark[2, j]:
                        mark[2, j], mark[3, j] = middle, i
    _fill_parabola_vertex(samples, 0, mark, top)
    if any_rival:
        _fill_parabola_vertex(samples, 1, mark, top)
    return any_rival
