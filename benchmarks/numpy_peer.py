"""The peer: the same four objectives and gradients in plain, chunked NumPy on equidistant crank angles.

Written as a good NumPy programmer would: chunks that stay in the cache, the motion shared between torque and position
error, what depends on the design alone computed once a design, and gradients by complex step at the highest sample only
(envelope theorem), for many designs at a time. With the same 360 angles, it is what one would write without this
software, so no refinement: its peak is the highest sample.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from .machines import ANGLE, BAR, CRANK, GRAVITY, LOAD, OFFSET_SHARE, ROD, SLIDER, SPEED, Array

_STEP = 1e-30
_BATCH = 2048  # designs whose gradients are computed together: measured, 512 and 8192 are slower


class _Motion(NamedTuple):
    """The linkage at a crank angle: components of the rod, 1 / along, tan(phi), phi', phi'', x', x''."""

    rs: Any
    rc: Any
    across: Any
    along: Any
    per_along: Any
    tangent: Any
    rod_1: Any
    rod_2: Any
    x_1: Any
    x_2: Any


def _size(z: Any) -> Any:
    """Absolute value whose complex step is the derivative."""
    return np.where(z.real < 0.0, -z, z) if np.iscomplexobj(z) else np.abs(z)


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


def _motion(sine: Any, cosine: Any, r: Any, l: Any, e: Any) -> _Motion:
    rs, rc = r * sine, r * cosine
    across = e - rs
    along = np.sqrt(l * l - across * across)
    per_along = 1.0 / along
    tangent = across * per_along
    rod_1 = -rc * per_along
    square = rod_1 * rod_1
    rod_2 = rs * per_along + square * tangent
    x_1 = -rs - across * rod_1
    x_2 = -rc - along * square - across * rod_2
    return _Motion(rs, rc, across, along, per_along, tangent, rod_1, rod_2, x_1, x_2)


def _torque(m: _Motion, sine: Any, cosine: Any, r: Any, l: Any) -> Any:
    """Size of the drive torque, by Newton and Euler: slider, rod, crank."""
    w2 = SPEED**2
    mass, moment, inertia = _bar(l)
    _, crank_moment, _ = _bar(r)
    per_l = moment / l
    pin_x, pin_y = -w2 * m.rc, -w2 * m.rs - GRAVITY
    sx, sy = per_l * m.along, per_l * m.across
    bx = (SLIDER * w2) * m.x_2 - LOAD
    by = m.tangent * bx - ((inertia * w2) * m.rod_2 + sx * pin_y - sy * pin_x) * m.per_along
    rod_w2, rod_a = w2 * (m.rod_1 * m.rod_1), w2 * m.rod_2
    ax = bx + mass * pin_x - sx * rod_w2 - sy * rod_a
    ay = by + mass * pin_y - sy * rod_w2 + sx * rod_a
    return _size(m.rc * ay - m.rs * ax - (crank_moment * GRAVITY) * cosine)


def _error(m: _Motion, sine: Any, cosine: Any, l: Any, e: Any) -> Any:
    """Worst-case position error."""
    error = CRANK * _size(cosine + m.tangent * sine) + (ROD * l) * m.per_along
    return error + (OFFSET_SHARE * _size(e)) * _size(m.tangent) + ANGLE * _size(m.x_1)


def torque(sine: Any, cosine: Any, r: Any, l: Any, e: Any) -> Any:
    """Return the size of the drive torque, N m."""
    return _torque(_motion(sine, cosine, r, l, e), sine, cosine, r, l)


def error(sine: Any, cosine: Any, r: Any, l: Any, e: Any) -> Any:
    """Return the worst-case position error, m."""
    return _error(_motion(sine, cosine, r, l, e), sine, cosine, l, e)


def closed_forms(r: Any, l: Any, e: Any) -> tuple[Any, Any]:
    """Return time ratio and least transmission angle."""
    a = _size(e)
    b = np.arcsin(a / (l - r)) - np.arcsin(a / (l + r))
    return (np.pi + b) / (np.pi - b), 0.5 * np.pi - np.arcsin((r + a) / l)


def evaluate(designs: Array, *, angles: int, chunk: int) -> tuple[Array, Array]:
    """Return values (4, n) and gradients (4, n, 3): time ratio, peak torque, transmission angle, position error.

    chunk: designs swept together.
    """
    n = len(designs)
    theta = np.arange(angles) * (2.0 * np.pi / angles)
    sine, cosine = np.sin(theta), np.cos(theta)
    values, gradients = np.empty((4, n)), np.empty((4, n, 3))
    highest = np.empty((2, n), dtype=np.int64)
    for begin in range(0, n, chunk):
        r, l, e = (designs[begin : begin + chunk, i : i + 1] for i in range(3))
        m = _motion(sine, cosine, r, l, e)
        curves = _torque(m, sine, cosine, r, l), _error(m, sine, cosine, l, e)
        rows = np.arange(len(r))
        for at, row, curve in zip(highest, (1, 3), curves, strict=True):
            at[begin : begin + chunk] = places = curve.argmax(axis=1)
            values[row, begin : begin + chunk] = curve[rows, places]
    for begin in range(0, n, _BATCH):
        part = slice(begin, begin + _BATCH)
        values[0, part], values[2, part] = closed_forms(*designs[part].T)
        for v in range(3):
            stepped = [designs[part, i] + (1j * _STEP if i == v else 0j) for i in range(3)]
            ratio, angle = closed_forms(*stepped)
            slopes = [ratio, angle]
            for at, curve in zip(highest, (torque, error), strict=True):
                slopes.append(curve(sine[at[part]], cosine[at[part]], *stepped))
            for row, slope in zip((0, 2, 1, 3), slopes, strict=True):
                gradients[row, part, v] = slope.imag / _STEP
    return values, gradients
