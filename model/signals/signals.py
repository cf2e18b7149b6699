"""The curves over the cycle whose peaks matter, each as one formula that is never negative."""

from __future__ import annotations

from enum import IntEnum
from typing import Any

from ..dynamics.inertia import reflected_inertia, shaking
from ..dynamics.rubbing import joint_forces
from ..kernel.arithmetic import analytic, chosen_by_type, magnitude, root
from ..kinematics.position import motion, third_derivative
from ..machine.design import Design
from .position_error import influences, root_sum_square, worst_case


class Signal(IntEnum):
    """A signal that is watched over the cycle by its size.

    Torque (N m), forces (N), slider speed and acceleration, position error (m), power (W), reflected inertia (kg m^2),
    shaking force (N), shaking moment (N m), slider jerk (m/s^3), and the component along the slider line
    of the force between rod and slider (N).
    """

    TORQUE = 0
    PIVOT_FORCE = 1
    CRANK_PIN_FORCE = 2
    SLIDER_PIN_FORCE = 3
    GUIDE_FORCE = 4
    SLIDER_SPEED = 5
    SLIDER_ACCELERATION = 6
    POSITION_ERROR = 7
    POSITION_ERROR_RSS = 8
    POWER = 9
    REFLECTED_INERTIA = 10
    SHAKING_FORCE = 11
    SHAKING_MOMENT = 12
    SLIDER_JERK = 13
    LINE_FORCE = 14

    @property
    def needs_forces(self) -> bool:
        """Whether it follows from the joint forces, and with them from loads and friction."""
        return self <= Signal.GUIDE_FORCE or self in (Signal.POWER, Signal.LINE_FORCE)

    @property
    def code(self) -> int | tuple[int]:
        """Number by which kernels know the signal; in a tuple for one with kernels of its own.

        A branch more in the formula of all would make the compiler group the others anew, and move their last digits.
        """
        return int(self) if self <= Signal.SHAKING_MOMENT else (int(self),)


_TORQUE, _PIVOT, _CRANK_PIN, _SLIDER_PIN, _GUIDE, _SPEED, _ACCELERATION, _WORST, _RSS = range(9)
_POWER, _INERTIA, _SHAKING_FORCE = range(9, 12)
_JERK = int(Signal.SLIDER_JERK)


@analytic
def _together(kind: Any, sine: Any, cosine: Any, m: Any, d: Design, load: Any, sides: Any = None) -> Any:
    """Return a signal of the formula that is compiled for all up to the shaking moment."""
    if kind <= _GUIDE or kind == _POWER:
        f = joint_forces(sine, cosine, m, d, load, sides)
        if kind == _TORQUE:
            return magnitude(f.torque)
        if kind == _POWER:
            return magnitude(f.torque * d.speed)
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
    if kind == _INERTIA:
        return reflected_inertia(sine, cosine, m, d)
    if kind > _INERTIA:
        x, y, moment = shaking(sine, cosine, m, d)
        return root(x * x + y * y) if kind == _SHAKING_FORCE else magnitude(moment)
    i = influences(sine, cosine, m, d.l)
    if kind == _WORST:
        return worst_case(i, d)
    return root_sum_square(i, d)


@analytic
def _alone(kind: Any, sine: Any, cosine: Any, m: Any, d: Design, load: Any, sides: Any = None) -> Any:
    """Return a signal with kernels of its own."""
    if kind[0] == _JERK:
        third = third_derivative(sine, cosine, m, d.r)
        return magnitude((third * d.speed * d.speed + 3.0 * m.x_2 * d.acceleration) * d.speed)
    return magnitude(joint_forces(sine, cosine, m, d, load, sides).slider_pin_x)


@chosen_by_type(together=_together, alone=_alone)
def signal(kind: Any, sine: Any, cosine: Any, m: Any, d: Design, load: Any, sides: Any = None) -> Any:
    """Return the signal of a `Signal.code` at one crank angle for the load on the slider (N, outward).

    sides: signs of the sliding where there is friction (`rubbing.Sides`).
    """
    return (_alone if isinstance(kind, tuple) else _together)(kind, sine, cosine, m, d, load, sides)


@analytic
def design_motion(sine: Any, cosine: Any, d: Design) -> Any:
    """Return the `Motion` of a design."""
    return motion(sine, cosine, d.r, d.l, d.e, d.branch)
