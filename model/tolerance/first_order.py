"""First-order position errors: worst case, root-sum-square, contributions, and a bound on their inaccuracy."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Array
from ..cycle.cycle import cycle
from ..linkage.linkage import Linkage
from ..linkage.require_single_linkage import require_single_rotating_linkage
from ..machine.mechanism import Mechanism
from .error_sources import limit_box, limits_of_sources, source_influences


@dataclass(frozen=True)
class FirstOrder:
    """First-order position errors at crank angles (m,), rad.

    worst_case, root_sum_square: (m,), m. contributions: |influence| times limit of each source, (8, m), m.
    share_of_worst_case, share_of_variance: fractions, (8, m); NaN if nothing contributes. remainder: (m,), m, bound on
    the contribution from second and higher orders, anywhere within the limits.
    """

    crank_angle: Array
    worst_case: Array
    root_sum_square: Array
    contributions: Array
    share_of_worst_case: Array
    share_of_variance: Array
    remainder: Array


def first_order_position_errors(mechanism: Mechanism, linkage: Linkage, crank_angle: ArrayLike) -> FirstOrder:
    """Return the first-order position errors of one linkage at crank angles (m,), rad.

    The fractions of the variance assume that all limits are the same number of standard deviations. They are squares of
    the contributions divided by the square of the root-sum-square.
    """
    linkage = require_single_rotating_linkage(mechanism, linkage)
    angles = np.atleast_1d(np.asarray(crank_angle, dtype=np.float64))
    curves = cycle(mechanism, linkage, angles)
    parts = np.abs(source_influences(mechanism, linkage, angles)) * limits_of_sources(mechanism, linkage)[:, None]
    return FirstOrder(
        angles,
        curves.position_error,
        curves.position_error_rss,
        parts,
        fractions_of_sum(parts),
        fractions_of_sum(parts * parts),
        higher_order_bound(mechanism, linkage, angles),
    )


def fractions_of_sum(parts: Array) -> Array:
    """Return parts (n, m) divided by their sum (m,); NaN if all are zero."""
    total = parts.sum(axis=0)
    fractions: Array = np.divide(parts, total, out=np.full(parts.shape, np.nan), where=total > 0.0)
    return fractions


def higher_order_bound(mechanism: Mechanism, linkage: Linkage, crank_angle: ArrayLike) -> Array:
    """Return a bound (m,), m, on |x - x_0 - first order| within the limits, at crank angles (m,).

    Taylor's theorem: half the sum over pairs of |second derivative| T_i T_j, with bounds on the second derivatives over
    the whole box. With q = e - r sin(theta) and h = sqrt(l^2 - q^2), x = r cos(theta) + h, those of h are h_qq = -l^2 /
    h^3, h_ll = -q^2 / h^3, h_lq = l q / h^3; |q| is bounded by |q_0| + T_e + T_r + r T_theta, l and r by their limits,
    |sin| and |cos| by 1.
    """
    linkage = require_single_rotating_linkage(mechanism, linkage)
    angles = np.atleast_1d(np.asarray(crank_angle, dtype=np.float64))
    box = limit_box(mechanism, linkage)
    t = 0.5 * (box[:, 1] - box[:, 0])
    r, l_least, l = box[0, 1], box[1, 0], box[1, 1]
    greatest = r + np.abs(box[2]).max()
    q = np.abs(linkage.offset - linkage.crank * np.sin(angles)) + t[2] + t[0] + r * t[3]
    q = np.minimum(q, greatest)
    h = np.sqrt(l_least * l_least - q * q)
    sine = np.minimum(1.0, np.abs(np.sin(angles)) + t[3])
    cosine = np.minimum(1.0, np.abs(np.cos(angles)) + t[3])
    h_q, h_qq, h_ll, h_lq = q / h, l * l / h**3, q * q / h**3, l * q / h**3
    # The crank changes q by sin, the offset by 1, the crank angle by r cos: first derivatives of q times the limits.
    q_step = sine * t[0] + t[2] + r * cosine * t[3]
    of_q = h_qq * q_step**2 + 2.0 * h_lq * q_step * t[1] + h_ll * t[1] ** 2
    of_angle = 2.0 * (sine + h_q * cosine) * t[0] * t[3] + (r * cosine + h_q * r * sine) * t[3] ** 2
    bound: Array = 0.5 * (of_q + of_angle)
    return bound
