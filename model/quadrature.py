"""Gauss-Legendre quadrature over the crank angle or over time, on panels that are halved until curves are resolved.

A panel is resolved once the last coefficients of its polynomial have died out, by a criterion that the owner of the
curve defines. Owners weight the nodes: equally for means over the crank angle, by the time per angle for means over
time.
"""

from collections.abc import Callable
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from .arrays import Array, Mask

DEGREE = 15
"""Degree of the polynomial through the nodes of a panel."""
DEEPEST = 24
"""Maximum halvings of a panel."""
MOST_HALVINGS = 20_000
"""Maximum number of panels that halving adds for one design; beyond that, only rounding of the curves remains."""
ANGLE_ROUNDING = 1e-13
"""Shift of a curve, rad, due to rounding of angles and positions; halving does not reduce its effect."""
_TAIL = 3  # Legendre coefficients that show whether a panel is resolved


@lru_cache(maxsize=8)
def gauss_nodes_and_weights(count: int) -> tuple[Array, Array]:
    """Return the Gauss nodes on [0, 1] and their weights, whose sum is 1."""
    nodes, weights = legendre.leggauss(count)
    return 0.5 * (1.0 + nodes), 0.5 * weights


@lru_cache(maxsize=8)
def graded_gauss_nodes_and_weights(panels: int, grades: int) -> tuple[Array, Array]:
    """Return nodes on [0, 1], 20 in each panel and denser towards both ends, with their weights."""
    nodes, weights = legendre.leggauss(20)
    edges, half = np.linspace(0.0, 1.0, panels + 1), 0.5 / panels
    u, w = (edges[:-1, None] + half + half * nodes).ravel(), np.tile(half * weights, panels)
    for _ in range(grades):
        w = w * 6.0 * u * (1.0 - u)
        u = u * u * (3.0 - 2.0 * u)
    return u, w


@lru_cache(maxsize=8)
def legendre_fit_matrix(count: int) -> Array:
    """Return the matrix (count, count) from values at the Gauss nodes to the coefficients of their Legendre series."""
    nodes, weights = legendre.leggauss(count)
    return np.asarray((np.arange(count) + 0.5)[:, None] * (weights[:, None] * legendre.legvander(nodes, count - 1)).T)


NODES, WEIGHTS = gauss_nodes_and_weights(DEGREE + 1)
"""Nodes of a panel on [0, 1], and their weights."""
FIT = legendre_fit_matrix(DEGREE + 1)
"""Matrix from values at the nodes to the coefficients of a panel's polynomial."""
INTEGRATED = 0.5 * legendre.legint(np.eye(DEGREE + 1), lbnd=-1.0, axis=0)
"""Matrix from these coefficients to those of the polynomial's integral from the panel's start, on [0, 1]."""
INTEGRALS = np.asarray(legendre.legval(2.0 * NODES - 1.0, INTEGRATED).T @ FIT)
"""Matrix from values at the nodes to integrals from the panel's start to each node."""
TAIL = np.ascontiguousarray(FIT[-_TAIL:])
"""Last rows of `FIT`."""


def last_coefficients_magnitude(values: Array) -> Array:
    """Return the maximum magnitude of the last coefficients (...,) of curves at the nodes of panels (..., 16)."""
    return np.asarray(np.abs(values @ TAIL.T).max(axis=-1, initial=0.0))


Samples = tuple[Mask, list[NDArray[Any]]]
"""Panels (p,) that are not resolved, and arrays (p, ...) to be collected from resolved panels."""


def resolve_panels(
    sample: Callable[..., Samples],
    low: Array,
    width: Array,
    *labels: NDArray[Any],
    deepest: int = DEEPEST,
    limit: float = np.inf,
) -> list[NDArray[Any]]:
    """Return low, width, labels and samples of panels (p,), halved until they are resolved.

    sample: function of low, width and labels. labels: arrays (p, ...) that both halves inherit. deepest: maximum
    halvings of a panel. limit: maximum number of panels.
    """
    resolved: list[list[NDArray[Any]]] = []
    total = 0
    for depth in range(deepest + 1):
        rough, samples = sample(low, width, *labels)
        if depth == deepest or total + 2 * len(low) > limit:
            rough = np.zeros(len(low), dtype=bool)
        total += len(low)
        resolved.append([column[~rough] for column in (low, width, *labels, *samples)])
        if not rough.any():
            break
        half = 0.5 * width[rough]
        labels = tuple(np.concatenate([column[rough]] * 2) for column in labels)
        low, width = np.concatenate([low[rough], low[rough] + half]), np.concatenate([half, half])
    return [np.concatenate(column) for column in zip(*resolved, strict=True)]
