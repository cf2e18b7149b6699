"""Inertia effects of the moving masses: reflected inertia, shaking force and shaking moment.

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

from __future__ import annotations

from typing import Any

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
