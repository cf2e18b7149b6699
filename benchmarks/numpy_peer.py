"""The peer: the same four objectives and gradients in plain, chunked NumPy on equidistant crank angles.

Written as a good NumPy programmer would: chunks that stay in the cache, the motion shared between torque and position
error, and gradients by complex step at the highest sample only (envelope theorem) instead of over the whole grid.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from .machines import ANGLE, BAR, CRANK, GRAVITY, LOAD, OFFSET_SHARE, ROD, SLIDER, SPEED, Array

_STEP = 1e-30


def _size(z: Any) -> Any:
    return np.where(np.real(z) < 0.0, -z, z)


def _bar(length: Any) -> tuple[Any, Any, Any]:
    """Mass, first moment and inertia about its own pin of a round-ended bar."""
    web = BAR.density * BAR.depth * BAR.width * length
    cap = BAR.density * BAR.depth * BAR.width**2 * np.pi / 8.0
    radius = 0.5 * BAR.width
    centroid = 4.0 * radius / (3.0 * np.pi)
    inertia = web * (length * length / 3.0 + BAR.width**2 / 12.0)
    return (
        web + 2.0 * cap,
        (0.5 * web + cap) * length,
        inertia + cap * (radius * radius + length * length + 2.0 * length * centroid),
    )


def torque_and_error(sine: Any, cosine: Any, r: Any, l: Any, e: Any) -> tuple[Any, Any]:
    """Return the sizes of drive torque (Newton-Euler) and worst-case position error."""
    across = e - r * sine
    along = np.sqrt(l * l - across * across)
    per_along = 1.0 / along
    tangent = across * per_along
    rod_1 = -r * cosine * per_along
    rod_2 = r * sine * per_along + rod_1 * rod_1 * tangent
    x_1 = -r * sine - across * rod_1
    x_2 = -r * cosine - along * rod_1 * rod_1 - across * rod_2
    w2 = SPEED**2
    mass, moment, inertia = _bar(l)
    _, crank_moment, _ = _bar(r)
    per_l = moment / l
    pin_x, pin_y = -r * cosine * w2, -r * sine * w2 - GRAVITY
    sx, sy = per_l * along, per_l * across
    bx = SLIDER * w2 * x_2 - LOAD
    by = tangent * bx - (inertia * w2 * rod_2 + sx * pin_y - sy * pin_x) * per_along
    rod_w2, rod_a = rod_1 * rod_1 * w2, rod_2 * w2
    ax = bx + mass * pin_x - sx * rod_w2 - sy * rod_a
    ay = by + mass * pin_y - sy * rod_w2 + sx * rod_a
    torque = r * (cosine * ay - sine * ax) - crank_moment * cosine * GRAVITY
    error = (
        _size(cosine + tangent * sine) * CRANK
        + l * per_along * ROD
        + _size(tangent) * OFFSET_SHARE * _size(e)
        + _size(x_1) * ANGLE
    )
    return _size(torque), error


def closed_forms(r: Any, l: Any, e: Any) -> tuple[Any, Any]:
    """Return time ratio and least transmission angle."""
    a = _size(e)
    b = np.arcsin(a / (l - r)) - np.arcsin(a / (l + r))
    return (np.pi + b) / (np.pi - b), 0.5 * np.pi - np.arcsin((r + a) / l)


def evaluate(designs: Array, *, angles: int, chunk: int) -> tuple[Array, Array]:
    """Return values (n, 4) and gradients (n, 4, 3): time ratio, peak torque, transmission angle, position error."""
    theta = np.arange(angles) * (2.0 * np.pi / angles)
    sine, cosine = np.sin(theta), np.cos(theta)
    values, gradients = np.empty((len(designs), 4)), np.empty((len(designs), 4, 3))
    for begin in range(0, len(designs), chunk):
        part = designs[begin : begin + chunk]
        curves = torque_and_error(sine, cosine, *(part[:, i : i + 1] for i in range(3)))
        for column, curve in zip((1, 3), curves, strict=True):
            at = curve.argmax(axis=1)
            values[begin : begin + chunk, column] = curve[np.arange(len(part)), at]
            for v in range(3):
                stepped = [part[:, i] + (1j * _STEP if i == v else 0j) for i in range(3)]
                slope = torque_and_error(sine[at], cosine[at], *stepped)[column // 2].imag / _STEP
                gradients[begin : begin + chunk, column, v] = slope
    values[:, 0], values[:, 2] = closed_forms(*designs.T)
    for v in range(3):
        stepped = [designs[:, i] + (1j * _STEP if i == v else 0j) for i in range(3)]
        for column, value in zip((0, 2), closed_forms(*stepped), strict=True):
            gradients[:, column, v] = value.imag / _STEP
    return values, gradients
