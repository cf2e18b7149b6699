r"""Equations of motion of a linkage with one loose pin and a crank at steady speed.

Whichever pin is loose, the linkage has two degrees of freedom besides the crank angle theta: slider position x and rod
angle phi. With plane vectors written as complex numbers, the loop of the ideal linkage fails to close by the *gap*

    C = x + i e - l exp(i phi) - r exp(i theta),        |C| <= radial clearance, apart from penetration.

A loose crank pivot lets the crank translate while a coupling still turns it steadily: the crank's origin is then at C,
and the crank pin at C + r exp(i theta). With a loose crank pin, the rod's end is C away from it; with a loose slider
pin, the slider is C away from it. So the contact does the same work in every case; only the positions of the masses
differ. The mass centre of each body is k (x + i e) + a exp(i phi) + b exp(i theta):

    loose joint      crank                  rod                   slider
    crank pivot      k 1, a -l, b c - r     k 1, a s - l, b 0     k 1, a 0, b 0
    crank pin        k 0, a 0,  b c         k 1, a s - l, b 0     k 1, a 0, b 0
    slider pin       k 0, a 0,  b c         k 0, a s,     b r     k 1, a 0, b 0

where c and s are the mass centres of the crank and the rod in their own axes. Lagrange's equations follow from these
sums.

The state of the integration is the gap and its velocity rather than x and phi, because the penetration is a millionth
of x. Three integrals are included: the work of the drive, the work of the loads on the slider, and the energy
dissipated in the contact.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from ..dynamics.segments import Segment, add_formula_loads, find_load_pieces, load_on_slider
from ..kernel.arithmetic import analytic
from ..kernel.kernel import Flags, Row, Table, kernel
from ..kinematics.position import Motion
from ..machine.design import design_at
from ..machine.raw_machine_vector import Loads

STATES = 7
"""Gap x, y; gap velocity x, y; work of the drive, work of the loads, dissipated energy."""


class System(NamedTuple):
    """Parameters of a linkage with a loose joint.

    SI; sums over the bodies, with mass m, inertia I and k, a, b as above.

    start: crank angle at time zero. clearance to slip_speed: contact parameters. journal_turns: whether the journal
    turns with the crank. bearing_turns: whether the bearing turns with the rod. m_xx: sum k m. m_x_rod, m_x_crank: sums
    k m a, k m b. m_rod, m_crank: sums m |a|^2 + I, m |b|^2 + I. m_rod_crank: sum m a conj(b). first_rod, first_crank:
    sums m a, m b.
    """

    r: float
    l: float
    e: float
    branch: float
    speed: float
    start: float
    gravity: complex
    clearance: float
    bearing_radius: float
    stiffness: float
    friction: float
    slip_speed: float
    journal_turns: float
    bearing_turns: float
    m_xx: float
    m_x_rod: complex
    m_x_crank: complex
    m_rod: float
    m_crank: float
    m_rod_crank: complex
    first_rod: complex
    first_crank: complex


class Place(NamedTuple):
    """Configuration of the linkage: crank and rod directions as complex numbers, coordinates and speeds."""

    crank: Any
    rod: Any
    x: Any
    x_t: Any
    rod_t: Any


class Contact(NamedTuple):
    """Contact.

    force: complex force on the body that carries the gap C. normal, tangential: N, the tangential one on the journal.

    on_crank, on_rod: friction moments about the pins, N m. penetration: m, negative if apart. elastic: stored energy,
    J. lost: dissipated power, W.
    """

    force: Any
    normal: Any
    tangential: Any
    on_crank: Any
    on_rod: Any
    penetration: Any
    elastic: Any
    lost: Any


@analytic
def configuration_of(time: float, gap: complex, gap_t: complex, s: System) -> Place:
    """Return the linkage's configuration, from the two components of the gap and of its derivative."""
    theta = s.start + s.speed * time
    crank = complex(math.cos(theta), math.sin(theta))
    l_sin = s.e - s.r * crank.imag - gap.imag
    l_cos = s.branch * math.sqrt(s.l * s.l - l_sin * l_sin)
    rod_t = -(gap_t.imag + s.r * s.speed * crank.real) / l_cos
    x = gap.real + l_cos + s.r * crank.real
    x_t = gap_t.real - l_sin * rod_t - s.r * s.speed * crank.imag
    return Place(crank, complex(l_cos, l_sin) / s.l, x, x_t, rod_t)


@analytic
def contact_force(gap: complex, gap_t: complex, rod_t: float, damping_rate: float, s: System) -> Contact:
    """Return the contact. rate: h / d'_0, s/m; negative while the journal is in free flight."""
    distance = abs(gap)
    depth = distance - s.clearance
    if damping_rate < 0.0 or depth <= 0.0:
        return Contact(0.0j, 0.0, 0.0, 0.0, 0.0, depth, 0.0, 0.0)
    normal = gap / distance
    depth_t = normal.real * gap_t.real + normal.imag * gap_t.imag
    spring = s.stiffness * depth * math.sqrt(depth)
    press = max(0.0, spring * (1.0 + damping_rate * depth_t))
    # Both bodies touch at one point on the bearing's radius, so that no spurious moment arises.
    arm = s.bearing_radius - distance
    slide = normal.real * gap_t.imag - normal.imag * gap_t.real
    slide += arm * s.journal_turns * s.speed - s.bearing_radius * s.bearing_turns * rod_t
    rub = -s.friction * press * slide / math.sqrt(slide * slide + s.slip_speed * s.slip_speed)
    force = -press * normal + rub * 1j * normal
    lost = (press - spring) * depth_t - rub * slide
    return Contact(
        force,
        press,
        rub,
        rub * arm * s.journal_turns,
        -rub * s.bearing_radius * s.bearing_turns,
        depth,
        0.4 * spring * depth,
        lost,
    )


@analytic
def solve_accelerations(
    p: Place, force: complex, on_crank: float, on_rod: float, load: float, s: System
) -> tuple[complex, float, float]:
    """Return the second derivative of the gap, the slider acceleration, and the drive torque.

    force: generalised force on the gap. on_crank, on_rod: additional moments. load: load on the slider along x, N.
    """
    w, u = s.speed, p.rod_t
    m_x_rod, m_x_crank = 1j * p.rod * s.m_x_rod, 1j * p.crank * s.m_x_crank
    twist = s.m_rod_crank * p.rod * p.crank.conjugate()
    turn_rod, turn_crank = 1j * p.rod, 1j * p.crank
    right_x = load + force.real + s.m_xx * s.gravity.real
    right_x += (p.rod * s.m_x_rod).real * u * u + (p.crank * s.m_x_crank).real * w * w
    right_rod = on_rod + (turn_rod * (s.first_rod * s.gravity.conjugate() - s.l * force.conjugate())).real
    right_rod -= twist.imag * w * w
    determinant = s.m_xx * s.m_rod - m_x_rod.real * m_x_rod.real
    x_tt = (s.m_rod * right_x - m_x_rod.real * right_rod) / determinant
    rod_tt = (s.m_xx * right_rod - m_x_rod.real * right_x) / determinant
    torque = m_x_crank.real * x_tt + twist.real * rod_tt - twist.imag * u * u - on_crank
    torque -= (turn_crank * (s.first_crank * s.gravity.conjugate() - s.r * force.conjugate())).real
    gap_tt = x_tt - s.l * (1j * rod_tt - u * u) * p.rod + s.r * w * w * p.crank
    return gap_tt, x_tt, torque


@analytic
def load_along_x(
    time: float, p: Place, outward: bool, s: System, block: Any, loads: Any, piece: Any, shift: Any
) -> float:
    """Return the loads on the slider at its actual position and velocity, along x.

    piece, shift: work space (loads,).
    """
    d = design_at(block, 0)
    theta = s.start + s.speed * time
    find_load_pieces(d, block, 0, theta, d.branch * p.x, loads, piece, shift)
    # The block was derived for unit speed, so velocity per crank angle is the velocity.
    m = Motion(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, p.x, p.x_t, 0.0)
    force = load_on_slider(m, d, theta, Segment(block, loads, outward, piece, shift))
    moving = d.branch * p.x_t > 0.0
    if moving != outward:  # near a dead centre the loose slider lags; loads that oppose its motion reverse with it
        force += add_formula_loads(0.0, m, d, block, 0, moving, loads) - add_formula_loads(
            0.0, m, d, block, 0, outward, loads
        )
    return float(d.branch * force)


@kernel
def _fill_state_rates(
    time: float, y: Row, rate: float, outward: bool, s: System, block: Table, loads: Loads, out: Row
) -> None:
    gap, gap_t = complex(y[0], y[1]), complex(y[2], y[3])
    p = configuration_of(time, gap, gap_t, s)
    piece, shift = np.zeros(loads.kind.shape[0], np.int64), np.zeros(loads.kind.shape[0])
    load = load_along_x(time, p, outward, s, block, loads, piece, shift)
    c = contact_force(gap, gap_t, p.rod_t, rate, s)
    gap_tt, _, torque = solve_accelerations(p, c.force, c.on_crank, c.on_rod, load, s)
    out[0], out[1] = gap_t.real, gap_t.imag
    out[2], out[3] = gap_tt.real, gap_tt.imag
    out[4], out[5], out[6] = torque * s.speed, load * p.x_t, c.lost


def state_rates(time: float, y: Row, rate: float, outward: bool, s: System, block: Table, loads: Loads) -> Row:
    """Return the time derivative of the state (7,).

    rate: as in `contact_force`. outward: whether it is the outward stroke.
    """
    out = np.empty(STATES)
    _fill_state_rates(time, y, rate, outward, s, block, loads, out)
    return out


@kernel
def _fill_reported_quantities(
    times: Row, y: Table, rate: Row, outward: Flags, s: System, block: Table, loads: Loads, out: Table
) -> None:
    piece, shift = np.zeros(loads.kind.shape[0], np.int64), np.zeros(loads.kind.shape[0])
    for i in range(times.shape[0]):
        gap, gap_t = complex(y[0, i], y[1, i]), complex(y[2, i], y[3, i])
        p = configuration_of(times[i], gap, gap_t, s)
        load = load_along_x(times[i], p, outward[i], s, block, loads, piece, shift)
        c = contact_force(gap, gap_t, p.rod_t, rate[i], s)
        _, x_tt, torque = solve_accelerations(p, c.force, c.on_crank, c.on_rod, load, s)
        out[0, i], out[1, i], out[2, i] = p.x, p.x_t, x_tt
        out[3, i], out[4, i], out[5, i], out[6, i] = c.normal, c.tangential, c.penetration, torque
        w, u = s.speed, p.rod_t
        kinetic = 0.5 * (s.m_xx * p.x_t * p.x_t + s.m_rod * u * u + s.m_crank * w * w)
        kinetic += (1j * p.rod * s.m_x_rod).real * p.x_t * u + (1j * p.crank * s.m_x_crank).real * p.x_t * w
        kinetic += (s.m_rod_crank * p.rod * p.crank.conjugate()).real * u * w
        moment = s.m_xx * complex(p.x, s.e) + s.first_rod * p.rod + s.first_crank * p.crank
        out[7, i], out[8, i], out[9, i] = kinetic, -(s.gravity.conjugate() * moment).real, c.elastic


def reported_quantities(
    times: Row, y: Table, rate: Row, outward: Flags, s: System, block: Table, loads: Loads
) -> Table:
    """Return the reported quantities for states (7, n), as (10, n).

    Slider position, velocity, acceleration; normal and tangential contact force; penetration; drive torque; kinetic,
    potential and elastic energy.
    """
    out = np.empty((10, len(times)))
    _fill_reported_quantities(times, y, rate, outward, s, block, loads, out)
    return out
