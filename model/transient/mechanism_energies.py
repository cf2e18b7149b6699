"""Kinetic and potential energy of the mechanism, from the speeds and heights of its bodies.

Nothing here is used to move the mechanism. The energy balance of a simulation compares these energies with the work
done, so it checks the equation of motion as well as its integration.
"""

from typing import Any

from ..kernel.arithmetic import analytic
from ..kinematics.position import Motion
from ..machine.design import Design


@analytic
def moving_inertia(sine: Any, cosine: Any, m: Motion, d: Design) -> Any:
    """Return J in the kinetic energy J w^2 / 2, kg m^2.

    Crank about its pivot; rod from the speed of the crank pin, its rotation phi', and its first moment S about the pin:
    m_rod r^2 + 2 phi' r (sin S_y + cos S_x) + I_A phi'^2; slider with added masses (m_s + m_a) x'^2.
    """
    sx = d.rod_along * m.l_cos - d.rod_across * m.l_sin
    sy = d.rod_along * m.l_sin + d.rod_across * m.l_cos
    return (
        d.crank_inertia
        + d.r * (d.rod_mass * d.r + 2.0 * m.rod_1 * (sine * sy + cosine * sx))
        + d.rod_inertia * m.rod_1 * m.rod_1
        + d.moving_mass * m.x_1 * m.x_1
    )


@analytic
def gravity_potential_energy(sine: Any, cosine: Any, m: Motion, d: Design) -> Any:
    """Return the potential energy of gravity, J: minus gravity times the first moments of all bodies."""
    x = (
        (d.crank_along + d.rod_mass * d.r) * cosine
        - d.crank_across * sine
        + d.rod_along * m.l_cos
        - d.rod_across * m.l_sin
        + d.slider_mass * m.x
    )
    y = (
        (d.crank_along + d.rod_mass * d.r) * sine
        + d.crank_across * cosine
        + d.rod_along * m.l_sin
        + d.rod_across * m.l_cos
        + d.slider_mass * d.e
    )
    return -d.gravity_x * x - d.gravity_y * y
