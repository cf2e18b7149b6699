"""The curves over the cycle whose peaks matter, each as one formula that is never negative."""

from __future__ import annotations

from enum import IntEnum
from typing import Any

from .arithmetic import analytic, magnitude, root
from .dynamics import forces
from .kinematics import motion
from .parameters import Design
from .position_error import influences, root_sum_square, worst_case


class Signal(IntEnum):
    """What is watched over the cycle: sizes of torque (N m), forces (N), speed, acceleration, position error (m)."""

    TORQUE = 0
    PIVOT_FORCE = 1
    CRANK_PIN_FORCE = 2
    SLIDER_PIN_FORCE = 3
    GUIDE_FORCE = 4
    SLIDER_SPEED = 5
    SLIDER_ACCELERATION = 6
    POSITION_ERROR = 7
    POSITION_ERROR_RSS = 8


_TORQUE, _PIVOT, _CRANK_PIN, _SLIDER_PIN, _GUIDE, _SPEED, _ACCELERATION, _WORST = range(8)


@analytic
def signal(kind: Any, sine: Any, cosine: Any, m: Any, d: Design, load: Any) -> Any:
    """Return the signal at one crank angle for the load on the slider (N, outward)."""
    if kind <= _GUIDE:
        f = forces(sine, cosine, m, d, load)
        if kind == _TORQUE:
            return magnitude(f.torque)
        if kind == _PIVOT:
            return root(f.pivot_x * f.pivot_x + f.pivot_y * f.pivot_y)
        if kind == _CRANK_PIN:
            return root(f.crank_pin_x * f.crank_pin_x + f.crank_pin_y * f.crank_pin_y)
        if kind == _SLIDER_PIN:
            return root(f.slider_pin_x * f.slider_pin_x + f.slider_pin_y * f.slider_pin_y)
        return magnitude(f.guide)
    if kind == _SPEED:
        return magnitude(m.x_1 * d.speed)
    if kind == _ACCELERATION:
        return magnitude(m.x_2 * d.speed * d.speed + m.x_1 * d.acceleration)
    i = influences(sine, cosine, m, d.l)
    if kind == _WORST:
        return worst_case(i, d)
    return root_sum_square(i, d)


@analytic
def design_motion(sine: Any, cosine: Any, d: Design) -> Any:
    """Return the `Motion` of a design."""
    return motion(sine, cosine, d.r, d.l, d.e, d.branch)
