"""Curves of one linkage over a swing: motion, forces, and the required drive.

If the crank is driven, torque and forces are those of `dynamics`. If the slider is driven, its driver applies a force P
along the slider line and the crank torque is zero:

- rod, moments about the crank pin: along B_y - across B_x + moment - rho_A s_A |A| + rho_B s_B |B| = 0;
- crank, moments about the pivot: couple - M + r (cos(theta) A_y - sin(theta) A_x) + rho_A s_A |A| + rho_O s_O |P_O|
  = 0;
- slider: P = pull + mu |N| sgn(x' w) - B_x, N = -(B_y + m_s G_y);

with `balance_before_pin_force` and the names of `dynamics.torque`, M of `dynamics.crank_loads`,
and s_A, s_B, s_O the senses of (1 - phi') w, phi' w and w. Without friction the first two are linear in B, with the
determinant r l sin(theta - phi), which is zero at a dead point. Friction in the pins makes them nonlinear. It rotates
the rows of the Jacobian, whose lengths are l and r, by at most asin((rho_A + rho_B) / l) and asin((rho_A + rho_O) / r).
If the angle between rod and crank exceeds their sum, the determinant cannot vanish. Exactly one force then exists for
any load, and Newton's method started at the frictionless force finds it. Elsewhere friction may lock the linkage, and
the force is NaN.

If the slider is pushed and the crank is free, equilibrium gives the force in the slider pin. The equations are those of
`torque`, written for numbers of one design, for arrays, and for kernels.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from ..arrays import Array
from ..cycle.cycle import MotionAndForces, cycle_at_speeds, derived_design
from ..dynamics.torque import Balance, add_crank_couple, balance_before_pin_force
from ..kernel.arithmetic import analytic, inverse, root
from ..kinematics.position import Motion, motion
from ..linkage.linkage import Linkage
from ..machine.design import Design
from ..machine.mechanism import Mechanism
from ..signals.position_error import influences
from .law import travel_speed_acceleration as way_of
from .swing import Swing

_NO_FORCE = 1e-300


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
    per_a, per_b, per_p = inverse(size_a + _NO_FORCE), inverse(size_b + _NO_FORCE), inverse(size_p + _NO_FORCE)
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


_STILL = 1e-200
"""A crank speed, rad/s, that only gives the sense of rotation, with negligible inertia forces."""
_NOTHING = 1e-150
_ITERATIONS = 50
_CONVERGED = 1e-14


@dataclass(frozen=True, kw_only=True)
class SwingCurves(MotionAndForces):
    """Curves over one stroke of a swing, each (n,), SI and radians.

    share: fraction of the time of one stroke. crank_angle continues beyond a turn if the swing does. drive: torque on
    the crank, N m, counter-clockwise, or force on the slider along +x, N. power: power of the drive, W, 0 for a slow
    swing. rate: derivative of the driver position with respect to `share`, rad or m. driven_angle: transmission angle
    at the driven side. It is between the rod and the normal of the slider line if the crank drives, and between rod and
    crank if the slider drives. driven_error: worst case for the position of the driven side, m at the slider or rad at
    the crank. rod_rate: phi'. The load excludes the drive.
    """

    share: Array
    crank_speed: Array
    crank_acceleration: Array
    drive: Array
    power: Array
    rate: Array
    driven_angle: Array
    driven_error: Array
    rod_rate: Array

    @property
    def pivot(self) -> Array:
        """Magnitude of the force in the crank pivot, N."""
        return np.hypot(self.pivot_x, self.pivot_y)

    @property
    def crank_pin(self) -> Array:
        """Magnitude of the force in the crank pin, N."""
        return np.hypot(self.crank_pin_x, self.crank_pin_y)

    @property
    def slider_pin(self) -> Array:
        """Magnitude of the force in the slider pin, N."""
        return np.hypot(self.slider_pin_x, self.slider_pin_y)


def swing_curves(
    mechanism: Mechanism, linkage: Linkage, swing: Swing, share: Array, *, back: bool = False
) -> SwingCurves:
    """Return the curves of a linkage accepted by `require_swing`, at fractions (n,) of the time of one stroke."""
    share = np.atleast_1d(np.asarray(share, dtype=np.float64))
    s, s_1, s_2 = way_of(swing.law, share, swing.law_pieces)
    s_1 = np.maximum(s_1, 0.0)  # at rest, rounding may give a speed of the opposite sign, which would reverse friction
    s, s_1, s_2 = (1.0 - s, -s_1, -s_2) if back else (s, s_1, s_2)
    first, last = driver_start_and_end(linkage, swing)
    # Exact at the ends, where a rounded angle might lie beyond a dead point or the reach of the rod.
    place = np.where(s == 1.0, last, first + (last - first) * s)
    rate = (last - first) * s_1
    time = swing.duration or np.inf
    velocity, acceleration = rate / time, (last - first) * s_2 / time**2
    if swing.driver == "crank":
        theta, speed, rise = place, velocity, acceleration
        m = _motion_at(linkage, theta)
    else:
        theta = crank_angles_at_slider(linkage, swing, place)
        m = _motion_at(linkage, theta)
        speed = velocity / m.x_1
        rise = (acceleration - m.x_2 * speed**2) / m.x_1
    turning = swing.forward_direction * (-1.0 if back else 1.0)
    slowly = np.where(speed == 0.0, turning * _STILL, speed)
    cycle_curves = cycle_at_speeds(mechanism, linkage, theta, slowly, rise)
    d = derived_design(mechanism, linkage)._replace(speed=slowly, acceleration=rise)
    if swing.driver == "crank":
        drive, power, angle, error = (
            cycle_curves.torque,
            cycle_curves.torque * speed,
            cycle_curves.transmission_angle,
            cycle_curves.position_error,
        )
        joints = {name: getattr(cycle_curves, name) for name in JOINTS}
    else:
        drive, joints = _forces_with_undriven_crank(theta, m, d, cycle_curves.load, cycle_curves.crank_load)
        power = drive * m.x_1 * speed
        angle = np.arcsin(
            np.clip(np.abs(pin_distance_from_crank_line(np.sin(theta), np.cos(theta), m)) / linkage.rod, 0.0, 1.0)
        )
        error = _worst_case_crank_error(theta, m, d, swing.actuator_tolerance)
    # Remove values that only come from the negligible crank speed.
    load, drive, power = (np.where(np.abs(curve) < _NOTHING, 0.0, curve) for curve in (cycle_curves.load, drive, power))
    return SwingCurves(
        share=share,
        crank_angle=theta,
        crank_speed=speed,
        crank_acceleration=rise,
        slider_position=m.x,
        slider_velocity=m.x_1 * speed,
        slider_acceleration=m.x_2 * speed**2 + m.x_1 * rise,
        load=load,
        drive=drive,
        power=power,
        rate=rate,
        driven_angle=angle,
        driven_error=error,
        rod_rate=m.rod_1,
        **joints,
    )


JOINTS = ("pivot_x", "pivot_y", "crank_pin_x", "crank_pin_y", "slider_pin_x", "slider_pin_y", "guide")


def driver_start_and_end(linkage: Linkage, swing: Swing) -> tuple[float, float]:
    """Return the driver position at start and end: crank angle, rad, or slider position, m."""
    if swing.driver == "crank":
        return swing.start, swing.end
    x = _motion_at(linkage, np.array([swing.start, swing.end])).x
    return float(x[0]), float(x[1])


def _motion_at(linkage: Linkage, theta: Array) -> Motion:
    m: Motion = motion(np.sin(theta), np.cos(theta), linkage.crank, linkage.rod, linkage.offset, linkage.sign)
    return m


def crank_angles_at_slider(linkage: Linkage, swing: Swing, x: Array) -> Array:
    """Return the crank angles (n,) in a swing without dead point that put the slider at x (n,).

    theta = atan2(e, x) -+ acos((r^2 + d^2 - l^2) / (2 r d)), d^2 = x^2 + e^2, then one Newton step, as acos is
    inaccurate near the ends of its domain.
    """
    r, l, e = float(linkage.crank), float(linkage.rod), float(linkage.offset)
    d = np.hypot(x, e)
    half = np.arccos(np.clip((r * r + d * d - l * l) / (2.0 * r * d), -1.0, 1.0))
    # sin(theta - phi) distinguishes the two solutions: between dead points it keeps the sign that it has mid-swing.
    middle = np.array([0.5 * (swing.start + swing.end)])
    side = float(pin_distance_from_crank_line(np.sin(middle), np.cos(middle), _motion_at(linkage, middle))[0])
    theta = np.arctan2(e, x) + (half if side > 0.0 else -half)
    low, high = sorted((swing.start, swing.end))
    theta = theta + 2.0 * np.pi * np.round((0.5 * (low + high) - theta) / (2.0 * np.pi))
    for _ in range(2):
        m = _motion_at(linkage, theta)
        theta = np.clip(theta - (m.x - x) / m.x_1, low, high)
    return np.asarray(theta)


def _forces_with_undriven_crank(
    theta: Array, m: Motion, d: Design, load: Array, on_crank: Array
) -> tuple[Array, dict[str, Array]]:
    """Return the force on the slider that turns a free crank, along +x, and the joint forces."""
    sine, cosine = np.sin(theta), np.cos(theta)
    b: Balance = add_crank_couple(balance_before_pin_force(sine, cosine, m, d, load), -on_crank)
    sides = PinSides(
        d.crank_pin_circle * np.sign((1.0 - m.rod_1) * d.speed),
        d.slider_pin_circle * np.sign(m.rod_1 * d.speed),
        d.crank_pivot_circle * np.sign(d.speed),
    )
    with np.errstate(divide="ignore", invalid="ignore"):
        bx, by = frictionless_pin_force(sine, cosine, m, d, b)
        if any(np.any(side) for side in sides):
            bx, by = _pin_force_with_friction(
                bx, by, partial(rod_and_crank_residuals, sine=sine, cosine=cosine, m=m, d=d, b=b, sides=sides)
            )
            sure = np.abs(pin_distance_from_crank_line(sine, cosine, m)) > d.l * np.sin(
                angle_above_which_pins_cannot_lock(d)
            )
            bx, by = np.where(sure, bx, np.nan), np.where(sure, by, np.nan)
    guide = -by - d.slider_mass * d.gravity_y
    slide = np.sign(m.x_1 * d.speed)
    drive = b.pull + d.guide_friction * np.abs(guide) * slide - bx
    ax, ay = bx + b.rod_x, by + b.rod_y
    joints = (ax + b.crank_x, ay + b.crank_y, ax, ay, bx, by, guide)
    return np.asarray(drive), dict(zip(JOINTS, joints, strict=True))


def _pin_force_with_friction(bx: Array, by: Array, rows: Callable[[Array, Array], PinRows]) -> tuple[Array, Array]:
    """Return B with friction in the pins, starting from B without it."""
    for _ in range(_ITERATIONS):
        step_x, step_y = newton_step(rows(bx, by))
        bx, by = bx + step_x, by + step_y
        size = np.hypot(step_x, step_y)
        if np.all((size <= _CONVERGED * np.hypot(bx, by)) | ~np.isfinite(size)):
            break
    near = size <= 1e-9 * np.hypot(bx, by)  # rounding may prevent the last steps from decreasing further
    return np.where(near, bx, np.nan), np.where(near, by, np.nan)


def angle_above_which_pins_cannot_lock(d: Design) -> Any:
    """Return the angle between rod and crank, rad, above which friction in the pins cannot lock; at most 90 deg.

    The pins in a row rotate it by no more than the sum of their friction circles divided by its length.
    """
    at_rod = np.minimum(1.0, (d.crank_pin_circle + d.slider_pin_circle) / d.l)
    at_crank = np.minimum(1.0, (d.crank_pin_circle + d.crank_pivot_circle) / d.r)
    return np.minimum(0.5 * np.pi, np.arcsin(at_rod) + np.arcsin(at_crank))


def _worst_case_crank_error(theta: Array, m: Motion, d: Design, actuator: float) -> Array:
    """Return the worst case for the crank angle, rad: (sum of |dx/di| T_i + T_x) / |x'|."""
    i = influences(np.sin(theta), np.cos(theta), m, d.l)
    off = np.abs(i.crank) * d.crank_error + np.abs(i.rod) * d.rod_error + np.abs(i.offset) * d.offset_error
    return np.asarray((off + actuator) / np.abs(m.x_1))
