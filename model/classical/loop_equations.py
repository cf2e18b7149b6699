r"""The two loop equations solved by Newton-Raphson iteration: an independent check of the closed form.

    f_1 = r cos(theta) + l cos(phi) - x = 0        J = d(f_1, f_2) / d(x, phi) = | -1   -l sin(phi) |
    f_2 = r sin(theta) + l sin(phi) - e = 0                                      |  0    l cos(phi) |

Linear solves with the same matrix give the rates: J (x', phi') = -df/dtheta, and again for the second derivatives.
Source of the approach: J. Gupta, "Offset-Slider Crank Mechanism", course report ME748, section 3.1, whose rod points
the other way and whose offset is the mirror image.

Vertices of the position, velocity and acceleration polygons, constructed as with ruler and compasses.

    position       O, A, B            B on the slider line and on the circle around A
    velocity       o, a, b            o-a normal to the crank; b on the line of the slider's velocity and on the normal
                                      to the rod through a
    acceleration   o1, a11, a1, b11, b1    a11: normal acceleration of A; a1: plus its tangential one; b11: plus the
                                      normal one of B relative to A; b1 on the slider's line and on the normal to the
                                      rod through b11

No equation from `kinematics` is used: slider and rod motion are read off the polygons. Source: W. P. Boyle and K. Liu,
"The Offset Slider Crank: Kinematic Pseudographic Analysis", IJEE 13(3), Fig. 2 and Fig. 6; names of vertices as there.

Static forces of the massless linkage under a load on the slider, without friction.

Equilibrium of the slider, the rod and the crank under a load P along the slider line, positive outward as for all
loads:

    rod force (compression)      F = -P / |cos(phi)|
    guide on the slider (+y)     N = P tan(phi) on the open branch, -P tan(phi) on the crossed one
    crank torque                 T = -P r (cos(theta) tan(phi) - sin(theta)) on the open branch, P on the crossed one

T is the required drive torque, counter-clockwise. Without offset, with phi' = -phi = asin(r sin(theta) / l) and a load
p = -P towards the crank, F = p / cos(phi'), N = p tan(phi') and T = -p r (sin(theta) + cos(theta) tan(phi')): Eqs. 12
and 13 of the report "In-line Slider Crank Mechanism" (Amrita School of Engineering, 2021).

Mechanical advantage: load on the slider divided by the tangential crank pin force that balances it, r / |x'|. It grows
without bound towards the dead centres, where no crank torque is needed and the advantage is infinite.
"""

import math
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array, IntArray, Mask
from ..errors import InputError
from ..linkage.linkage import Linkage
from ..linkage.linkage_values import Kinematics

_LAST_STEP = 1e-10
"""A step that ends the iteration, in rad and fractions of the rod: the remaining error is half its square times
tan(phi)."""


@dataclass(frozen=True)
class LoopSolution(Kinematics):
    """Motion found by iteration. iterations: steps taken at each angle."""

    iterations: IntArray


def solve_loop(
    linkage: Linkage,
    crank_angle: ArrayLike,
    *,
    speed: ArrayLike = 0.0,
    acceleration: ArrayLike = 0.0,
    start: tuple[ArrayLike, ArrayLike] | None = None,
    iteration_limit: int = 60,
) -> LoopSolution:
    """Return the motion at crank angles (rad) for crank speed (rad/s) and acceleration (rad/s^2); all broadcast.

    start: initial slider position (m) and rod angle (rad). By default the rod lies along the slider line on the
    linkage's branch. From there the rod angle converges without overshooting, because the sine is concave up to a
    quarter turn. From another start the iteration may converge to the other branch. iteration_limit: maximum number of
    iterations.

    Raises `AssemblyError` where the linkage cannot be assembled, `InputError` where the iteration does not converge.
    """
    linkage.at(crank_angle, speed=speed, acceleration=acceleration)  # rejects linkages that cannot be assembled
    theta, w, alpha, r, l, e = np.broadcast_arrays(
        *(np.asarray(value, dtype=np.float64) for value in (crank_angle, speed, acceleration)),
        linkage.crank,
        linkage.rod,
        linkage.offset,
    )
    pin = r * np.stack([np.cos(theta), np.sin(theta)])
    if start is None:
        start = (pin[0] + linkage.sign * l, 0.0 if linkage.sign > 0.0 else math.pi)
    x, phi = (np.broadcast_to(np.asarray(value, dtype=np.float64), theta.shape).copy() for value in start)
    if not (np.all(np.isfinite(x)) and np.all(np.isfinite(phi))):
        raise InputError("the starting point must be finite; give a slider position and a rod angle")
    iterations = np.zeros(theta.shape, dtype=np.int64)
    moving = np.ones(theta.shape, dtype=np.bool_)
    for _ in range(iteration_limit):
        residual = np.stack([pin[0] + l * np.cos(phi) - x, pin[1] + l * np.sin(phi) - e], axis=-1)
        step = _solve_linear_system(_jacobian(l, phi), -residual, moving, theta)
        x, phi = x + np.where(moving, step[..., 0], 0.0), phi + np.where(moving, step[..., 1], 0.0)
        iterations += moving
        moving = moving & (np.maximum(np.abs(step[..., 0]) / l, np.abs(step[..., 1])) > _LAST_STEP)
        if not np.any(moving):
            break
    else:
        raise InputError(
            f"the iteration must converge within {iteration_limit} steps; it did not at crank angle "
            f"{_first_marked_angle_deg(moving, theta):.6g} deg; start nearer to the solution or allow more steps"
        )
    first, second = _time_derivatives(theta, pin, l, phi, w, alpha)
    return LoopSolution(
        theta,
        x,
        first[..., 0],
        second[..., 0],
        np.arctan2(np.sin(phi), np.cos(phi)),
        first[..., 1],
        second[..., 1],
        np.arccos(np.abs(np.sin(phi))),
        iterations,
    )


def _time_derivatives(theta: Array, pin: Array, l: Array, phi: Array, w: Array, alpha: Array) -> tuple[Array, Array]:
    """Return the first and second time derivatives of slider position and rod angle, (..., 2) each."""
    jacobian = _jacobian(l, phi)
    everywhere = np.ones(theta.shape, dtype=np.bool_)
    turned = np.stack([-pin[1], pin[0]], axis=-1)  # d(pin)/dtheta
    first = _solve_linear_system(jacobian, -turned * w[..., None], everywhere, theta)
    # Differentiated again: J (x_tt, phi_tt) = w^2 pin + phi_t^2 rod - alpha d(pin)/dtheta.
    bent = np.stack([pin[0], pin[1]], axis=-1) * (w * w)[..., None]
    rod = np.stack([l * np.cos(phi), l * np.sin(phi)], axis=-1) * (first[..., 1] ** 2)[..., None]
    return first, _solve_linear_system(jacobian, bent + rod - turned * alpha[..., None], everywhere, theta)


def _jacobian(l: Array, phi: Array) -> Array:
    rows = [[-np.ones_like(phi), -l * np.sin(phi)], [np.zeros_like(phi), l * np.cos(phi)]]
    return np.moveaxis(np.array(rows), (0, 1), (-2, -1))


def _solve_linear_system(jacobian: Array, right: Array, active: Mask, theta: Array) -> Array:
    """Solve at the active angles; zero elsewhere."""
    singular = active & (np.abs(jacobian[..., 1, 1]) < np.finfo(np.float64).tiny)
    if np.any(singular):
        raise InputError(
            "the Jacobian must not be singular, with the rod normal to the slider line; it is at crank angle "
            f"{_first_marked_angle_deg(singular, theta):.6g} deg; start with another rod angle"
        )
    step = np.zeros_like(right)
    step[active] = np.linalg.solve(jacobian[active], right[active][..., None])[..., 0]
    return step


def _first_marked_angle_deg(marked: Mask, theta: Array) -> Any:
    return math.degrees(float(theta[marked].flat[0]))


@dataclass(frozen=True)
class Polygons:
    """Vertices (..., vertex, 2), x and y, and values read from them, (...). SI and radians.

    position: O, A, B, m. velocity: o, a, b, m/s. acceleration: o1, a11, a1, b11, b1, m/s^2.
    rod_velocity, rod_acceleration: rad/s and rad/s^2, from a-b and b11-b1.
    """

    position: Array
    velocity: Array
    acceleration: Array
    rod_velocity: Array
    rod_acceleration: Array

    POSITION: ClassVar = ("O", "A", "B")
    VELOCITY: ClassVar = ("o", "a", "b")
    ACCELERATION: ClassVar = ("o1", "a11", "a1", "b11", "b1")


def motion_polygons(
    linkage: Linkage, crank_angle: ArrayLike, *, speed: ArrayLike = 0.0, acceleration: ArrayLike = 0.0
) -> Polygons:
    """Return the polygons at crank angles (rad) for crank speed (rad/s) and acceleration (rad/s^2); all broadcast.

    Raises `AssemblyError` where the linkage cannot be assembled.
    """
    linkage.at(crank_angle, speed=speed, acceleration=acceleration)  # rejects linkages that cannot be assembled
    theta, w, alpha, r, l, e = np.broadcast_arrays(
        *(np.asarray(value, dtype=np.float64) for value in (crank_angle, speed, acceleration)),
        linkage.crank,
        linkage.rod,
        linkage.offset,
    )
    origin = np.zeros((*theta.shape, 2))
    crank = np.stack([r * np.cos(theta), r * np.sin(theta)], axis=-1)
    rise = e - crank[..., 1]
    slider = np.stack([crank[..., 0] + linkage.sign * np.sqrt((l - rise) * (l + rise)), e], axis=-1)
    rod = slider - crank

    pin_velocity = _quarter_turned(crank) * w[..., None]
    slider_velocity, rod_velocity = _rod_normal_on_slider_line(pin_velocity, rod)

    normal = -crank * (w * w)[..., None]
    pin_acceleration = normal + _quarter_turned(crank) * alpha[..., None]
    towards_pin = pin_acceleration - rod * (rod_velocity**2)[..., None]
    slider_acceleration, rod_acceleration = _rod_normal_on_slider_line(towards_pin, rod)
    return Polygons(
        np.stack([origin, crank, slider], axis=-2),
        np.stack([origin, pin_velocity, slider_velocity], axis=-2),
        np.stack([origin, normal, pin_acceleration, towards_pin, slider_acceleration], axis=-2),
        rod_velocity,
        rod_acceleration,
    )


def _quarter_turned(vector: Array) -> Array:
    """Return vectors (..., 2) rotated by a quarter turn counter-clockwise."""
    return np.stack([-vector[..., 1], vector[..., 0]], axis=-1)


def _rod_normal_on_slider_line(start: Array, rod: Array) -> tuple[Array, Array]:
    """Return where the normal to the rod through `start` meets y = 0, and its signed distance in rod lengths."""
    turns = -start[..., 1] / rod[..., 0]
    x = start[..., 0] - turns * rod[..., 1]
    return np.stack([x, np.zeros_like(x)], axis=-1), turns


@dataclass(frozen=True)
class StaticForces:
    """Arrays of the broadcast shape; SI and radians.

    rod_force: force along the rod, N, positive in compression. guide_reaction: force from the guide on the slider along
    +y, N. crank_torque: required drive torque, N m, counter-clockwise. tangential_force: crank_torque / crank, N.
    mechanical_advantage: magnitude of the load divided by that of the tangential force; `inf` at a dead centre.
    slider_force_per_torque: magnitude of the load divided by that of the crank torque, 1/m; `inf` at a dead centre.
    """

    crank_angle: Array
    load: Array
    rod_force: Array
    guide_reaction: Array
    crank_torque: Array
    tangential_force: Array
    mechanical_advantage: Array
    slider_force_per_torque: Array


def static_forces(linkage: Linkage, crank_angle: ArrayLike, *, load: ArrayLike) -> StaticForces:
    """Return the forces at crank angles, rad, in equilibrium with a load on the slider, N outward; all broadcast.

    The advantage does not depend on the load and is also returned for a zero load. Raises `AssemblyError` where the
    linkage cannot be assembled, `InputError` for a load that is not finite.
    """
    p = np.asarray(load, dtype=np.float64)
    if not np.all(np.isfinite(p)):
        raise InputError("the load on the slider must be finite; give it in N, positive outward")
    at = linkage.at(crank_angle)
    theta, phi = at.crank_angle, at.rod_angle
    tangent = np.tan(phi)
    outward = linkage.sign * p
    arm = linkage.crank * (np.cos(theta) * tangent - np.sin(theta))  # x'
    torque = -outward * arm
    # An angle that differs from a dead centre only by rounding is treated as the dead centre.
    still = np.abs(arm) <= 4.0 * np.finfo(np.float64).eps * (1.0 + np.abs(theta)) * linkage.crank
    with np.errstate(divide="ignore"):
        per_torque = np.where(still, np.inf, 1.0 / np.abs(arm))
    fields = (
        theta,
        p,
        -p / np.abs(np.cos(phi)),
        outward * tangent,
        torque,
        torque / linkage.crank,
        linkage.crank * per_torque,
        per_torque,
    )
    shape = np.broadcast_shapes(*(np.shape(field) for field in fields))
    return StaticForces(*(np.broadcast_to(field, shape) for field in fields))
