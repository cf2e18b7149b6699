"""The curves over the cycle whose peaks matter, each as one nonnegative formula."""

from enum import IntEnum, auto
from typing import Any

from ..dynamics.segments import Segment, load_on_slider
from ..dynamics.torque import forces_without_friction, reflected_inertia, shaking_force_and_moment
from ..dynamics.torque_with_friction import (
    Sides,
    joint_forces_with_optional_friction,
    rotation_sense,
    torque_without_crank_loads,
)
from ..kernel.arithmetic import analytic, magnitude, root
from ..kinematics.position import motion, third_slider_derivative
from ..machine.design import Design
from .position_error import influences, root_sum_square, worst_case


class Signal(IntEnum):
    """A signal judged by its magnitude over the cycle.

    Torque (N m), forces (N), guide moment (N m), power (W), component of the force between rod and slider along the
    slider line (N), slider speed, acceleration and jerk, position error (m), reflected inertia (kg m^2), shaking force
    (N), shaking moment (N m) and rocking couple (N m), which needs several cylinders. The signals up to the line force
    follow from the joint forces.
    """

    TORQUE = 0
    PIVOT_FORCE = auto()
    CRANK_PIN_FORCE = auto()
    SLIDER_PIN_FORCE = auto()
    GUIDE_FORCE = auto()
    GUIDE_MOMENT = auto()
    POWER = auto()
    LINE_FORCE = auto()
    SLIDER_SPEED = auto()
    SLIDER_ACCELERATION = auto()
    SLIDER_JERK = auto()
    POSITION_ERROR = auto()
    POSITION_ERROR_RSS = auto()
    REFLECTED_INERTIA = auto()
    SHAKING_FORCE = auto()
    SHAKING_MOMENT = auto()
    ROCKING_COUPLE = auto()

    @property
    def needs_forces(self) -> bool:
        """Whether it follows from the joint forces, and thus from loads and friction."""
        return self <= Signal.LINE_FORCE


_TORQUE, _PIVOT, _CRANK_PIN, _SLIDER_PIN, _GUIDE, _MOMENT, _POWER, _LINE, *_OTHERS = map(int, Signal)
_SPEED, _ACCELERATION, _JERK, _WORST, _RSS, _INERTIA, _SHAKING_FORCE, *_ = _OTHERS


@analytic
def slider_pin_to_guide_centre(m: Any, d: Design) -> Any:
    """Return the distance of the slider pin from the centre of the guide, m."""
    return d.outer + d.guide_distance - d.branch * m.x


@analytic
def signal_of_joint_forces(kind: Any, f: Any, m: Any, d: Design) -> Any:
    """Return the value of a `Signal` that follows from the joint forces alone."""
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
    if kind == _LINE:
        return magnitude(f.slider_pin_x)
    return magnitude(f.guide * slider_pin_to_guide_centre(m, d)) if kind == _MOMENT else magnitude(f.guide)


@analytic
def signal_of_forces(kind: Any, f: Any, m: Any, d: Design, theta: Any, segment: Segment) -> Any:
    """Return the value of a `Signal` that follows from the joint forces and the loads on the crank."""
    if kind in (_TORQUE, _POWER):
        torque = torque_without_crank_loads(f.torque, theta, rotation_sense(d), segment)
        return magnitude(torque * d.speed) if kind == _POWER else magnitude(torque)
    return signal_of_joint_forces(kind, f, m, d)


@analytic
def signal_of_motion(kind: Any, sine: Any, cosine: Any, m: Any, d: Design) -> Any:
    """Return the value of a `Signal` that needs no joint forces."""
    if kind == _SPEED:
        return magnitude(m.x_1 * d.speed)
    if kind == _ACCELERATION:
        return magnitude(m.x_2 * d.speed * d.speed + m.x_1 * d.acceleration)
    if kind == _JERK:
        third = third_slider_derivative(sine, cosine, m, d.r)
        return magnitude((third * d.speed * d.speed + 3.0 * m.x_2 * d.acceleration) * d.speed)
    if kind == _WORST:
        return worst_case(influences(sine, cosine, m, d.l), d)
    if kind == _RSS:
        return root_sum_square(influences(sine, cosine, m, d.l), d)
    if kind == _INERTIA:
        return reflected_inertia(sine, cosine, m, d)
    x, y, moment = shaking_force_and_moment(sine, cosine, m, d)
    return root(x * x + y * y) if kind == _SHAKING_FORCE else magnitude(moment)


@analytic
def signal_without_friction(kind: Any, sine: Any, cosine: Any, m: Any, d: Design, load: Any) -> Any:
    """Return the value of a `Signal` at one crank angle for the load on the slider (N, outward), without friction."""
    if kind <= _LINE:
        return signal_of_joint_forces(kind, forces_without_friction(sine, cosine, m, d, load), m, d)
    return signal_of_motion(kind, sine, cosine, m, d)


@analytic
def signal_in_segment(
    kind: Any, theta: Any, sine: Any, cosine: Any, m: Any, d: Design, segment: Segment, sides: Sides
) -> Any:
    """Return the value of a `Signal` at a crank angle within a segment.

    sides: signs of the sliding there, all 0 if there is no friction.
    """
    load = load_on_slider(m, d, theta, segment)
    if kind <= _LINE:
        return signal_of_forces(
            kind, joint_forces_with_optional_friction(sine, cosine, m, d, load, sides), m, d, theta, segment
        )
    return signal_of_motion(kind, sine, cosine, m, d)


@analytic
def design_motion(sine: Any, cosine: Any, d: Design) -> Any:
    """Return the `Motion` of a design."""
    return motion(sine, cosine, d.r, d.l, d.e, d.branch)
