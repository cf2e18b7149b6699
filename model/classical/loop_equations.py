r"""The two loop equations solved by Newton-Raphson iteration: an independent check of the closed form.

    f_1 = r cos(theta) + l cos(phi) - x = 0        J = d(f_1, f_2) / d(x, phi) = | -1   -l sin(phi) |
    f_2 = r sin(theta) + l sin(phi) - e = 0                                      |  0    l cos(phi) |

Linear solves with the same matrix give the rates: J (x', phi') = -df/dtheta, and again for the second derivatives.
Source of the approach: J. Gupta, "Offset-Slider Crank Mechanism", course report ME748, section 3.1, whose rod points
the other way and whose offset is the mirror image.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

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
