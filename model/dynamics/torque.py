"""Inverse dynamics: drive torque and joint reactions of the rigid linkage for a prescribed crank motion.

Newton-Euler, body by body, slider to crank. Let G be gravity, S and C the first moments of rod and crank (mass times
vector from the link's origin to its mass centre), A the crank pin, B the slider pin:

- slider: B_x = m_s (a_x - G_x) - F, and the guide carries N = -B_y - m_s G_y;
- rod, moments about the crank pin: along B_y - across B_x = -(I_A phi_tt + S x (a_A - G));
- rod, forces: A = B + m_rod (a_A - G) + S_tt;
- crank, moments about the pivot: T = I_O alpha - C x G + r_OA x A; forces: P = A + C_tt - m_crank G.

Friction adds to these equations: `torque_with_friction`.

Inertia effects of the moving masses: reflected inertia, shaking force and shaking moment.

Let A be the crank pin, S the rod's first moment about it, and C that of the crank (counterweight included) about the
pivot:

    J = I_O + m_rod r^2 + 2 phi' (A . S) + phi'^2 I_A + (m_s + m_a) x'^2

so that J w^2 / 2 is the kinetic energy; m_s is the slider's mass, and m_a the mass moving with it, such as fluid in a
pipe. The shaking force, the resultant of all inertia forces, is minus the rate of change of the linkage's momentum. The
shaking moment is minus the rate of change of its angular momentum about the crank pivot. They are the machine's actions
on its frame through pivot, guide and motor (including the reaction to the drive torque, as the motor stands on the
frame). Gravity and loads, including added masses, are left out: gravity is constant or balanced by the foundation at
rest, and loads usually have their reaction within the machine. Friction is internal and affects neither of them.
"""

from typing import Any, NamedTuple

from ..kernel.arithmetic import analytic
from ..kinematics.position import Motion
from ..machine.design import Design


@analytic
def reflected_inertia(sine: Any, cosine: Any, m: Motion, d: Design) -> Any:
    """Return the inertia of the whole linkage reflected to the crank, kg m^2."""
    sx = d.rod_along * m.l_cos - d.rod_across * m.l_sin
    sy = d.rod_along * m.l_sin + d.rod_across * m.l_cos
    rod = d.rod_mass * d.r * d.r + 2.0 * m.rod_1 * d.r * (cosine * sx + sine * sy) + m.rod_1 * m.rod_1 * d.rod_inertia
    return d.crank_inertia + rod + d.moving_mass * m.x_1 * m.x_1


@analytic
def shaking_force_and_moment(sine: Any, cosine: Any, m: Motion, d: Design) -> Any:
    """Return shaking force along x and y, N, and shaking moment about the crank pivot, N m.

    Counter-clockwise moments are positive. Force -[m a]: from the crank C_tt, from the rod m_rod a_A + S_tt, from the
    slider m_s a_B. Moment -[r x m a]: I_O alpha, A x (m_rod a_A + S_tt) + S x a_A + I_A phi_tt, and -e m_s a_B.
    """
    w2, alpha = d.speed * d.speed, d.acceleration
    rod_w2 = m.rod_1 * m.rod_1 * w2
    rod_a = m.rod_2 * w2 + m.rod_1 * alpha
    pin_x, pin_y = -d.r * (cosine * w2 + sine * alpha), -d.r * (sine * w2 - cosine * alpha)
    sx = d.rod_along * m.l_cos - d.rod_across * m.l_sin
    sy = d.rod_along * m.l_sin + d.rod_across * m.l_cos
    cx = d.crank_along * cosine - d.crank_across * sine
    cy = d.crank_along * sine + d.crank_across * cosine
    rod_x = d.rod_mass * pin_x - sx * rod_w2 - sy * rod_a
    rod_y = d.rod_mass * pin_y - sy * rod_w2 + sx * rod_a
    slider = d.slider_mass * (m.x_2 * w2 + m.x_1 * alpha)
    x = -cx * w2 - cy * alpha + rod_x + slider
    y = -cy * w2 + cx * alpha + rod_y
    moment = d.crank_inertia * alpha + d.r * (cosine * rod_y - sine * rod_x)
    moment = moment + sx * pin_y - sy * pin_x + d.rod_inertia * rod_a - d.e * slider
    return -x, -y, -moment


class Forces(NamedTuple):
    """Drive torque on the crank (N m, counter-clockwise) and joint forces (N).

    pivot: force from the frame on the crank. crank_pin: force from the crank on the rod. slider_pin: force from the rod
    on the slider. guide: force from the guide on the slider, along +y.
    """

    torque: Any
    pivot_x: Any
    pivot_y: Any
    crank_pin_x: Any
    crank_pin_y: Any
    slider_pin_x: Any
    slider_pin_y: Any
    guide: Any


@analytic
def load_without_pieces(m: Motion, d: Design, stroke_force: Any) -> Any:
    """Return the load on the slider, N outward: stroke force, springs and viscous resistance."""
    return stroke_force + d.spring_force - d.stiffness * d.branch * m.x - d.viscous * d.branch * m.x_1 * d.speed


class Balance(NamedTuple):
    """Terms in the equations of motion that do not depend on the slider pin force, N and N m.

    pull: B_x without friction in the guide. moment: I_A phi_tt + S x (a_A - G) of the rod. rod_x, rod_y: A - B.
    crank_x, crank_y: P - A. couple: torque without the crank pin's contribution.
    """

    pull: Any
    moment: Any
    rod_x: Any
    rod_y: Any
    crank_x: Any
    crank_y: Any
    couple: Any


@analytic
def balance_before_pin_force(sine: Any, cosine: Any, m: Motion, d: Design, load: Any) -> Balance:
    """Return the `Balance` for a load on the slider (N, outward)."""
    w2 = d.speed * d.speed
    gx, gy = d.gravity_x, d.gravity_y
    rod_w2 = m.rod_1 * m.rod_1 * w2
    rod_a = m.rod_2 * w2 + m.rod_1 * d.acceleration
    pin_x = -d.r * (cosine * w2 + sine * d.acceleration) - gx
    pin_y = -d.r * (sine * w2 - cosine * d.acceleration) - gy
    sx = d.rod_along * m.l_cos - d.rod_across * m.l_sin
    sy = d.rod_along * m.l_sin + d.rod_across * m.l_cos
    cx = d.crank_along * cosine - d.crank_across * sine
    cy = d.crank_along * sine + d.crank_across * cosine
    return Balance(
        d.moving_mass * (m.x_2 * w2 + m.x_1 * d.acceleration) - d.slider_mass * gx - d.branch * load,
        d.rod_inertia * rod_a + sx * pin_y - sy * pin_x,
        d.rod_mass * pin_x - sx * rod_w2 - sy * rod_a,
        d.rod_mass * pin_y - sy * rod_w2 + sx * rod_a,
        -cx * w2 - cy * d.acceleration - d.crank_mass * gx,
        -cy * w2 + cx * d.acceleration - d.crank_mass * gy,
        d.crank_inertia * d.acceleration - (cx * gy - cy * gx),
    )


@analytic
def add_crank_couple(b: Balance, couple: Any) -> Balance:
    """Return a balance with a couple added on the crank, N m."""
    return Balance(b.pull, b.moment, b.rod_x, b.rod_y, b.crank_x, b.crank_y, b.couple + couple)


@analytic
def forces_from_slider_pin_force(sine: Any, cosine: Any, d: Design, b: Balance, bx: Any, by: Any) -> Forces:
    """Return drive torque and reactions for a slider pin force; the torque excludes pin friction."""
    ax = bx + b.rod_x
    ay = by + b.rod_y
    torque = b.couple + d.r * (cosine * ay - sine * ax)
    return Forces(torque, ax + b.crank_x, ay + b.crank_y, ax, ay, bx, by, -by - d.slider_mass * d.gravity_y)


@analytic
def forces_without_friction(sine: Any, cosine: Any, m: Motion, d: Design, load: Any) -> Forces:
    """Return drive torque and reactions without friction for a load on the slider (N, outward)."""
    b = balance_before_pin_force(sine, cosine, m, d, load)
    by = m.tangent * b.pull - b.moment * m.per_l_cos
    return forces_from_slider_pin_force(sine, cosine, d, b, b.pull, by)
