"""Parameters of one linkage with a loose joint, from its mechanism; rejects machines that cannot be simulated."""

from __future__ import annotations

import numpy as np

from ..arrays import Array
from ..errors import InputError
from ..linkage.linkage import Linkage
from ..machine.clearance import Clearance
from ..machine.crank_load_checks import require_no_crank_load
from ..machine.derived_designs import derived_blocks
from ..machine.design import design_at
from ..machine.mechanism import Mechanism
from ..machine.raw_machine_vector import Loads, Raw, load_structure, raw_vector
from .equations import System


def build_system(
    mechanism: Mechanism, linkage: Linkage, clearance: Clearance, *, start: float = 0.0
) -> tuple[System, Array, Loads]:
    """Return the system, its derived block and the structure of its loads. start: crank angle at time zero, rad.

    Raises `InputError` for an accelerating crank, for masses that leave the motion undetermined, and for a clearance
    that would let the linkage fold over to its other branch; `AssemblyError` unless the linkage rotates fully.
    """
    _require_simulable(mechanism, linkage, clearance)
    r, l, e = float(linkage.crank), float(linkage.rod), float(linkage.offset)
    raw = raw_vector(mechanism)
    raw[:3] = r, l, e
    # Loads take the slider velocity as velocity per radian times speed; with unit speed they can use it directly.
    raw[Raw.SPEED] = 1.0
    loads = load_structure(mechanism)
    block = derived_blocks(raw, loads)[0][0]
    d = design_at(block, 0)
    crank_first = complex(d.crank_along, d.crank_across)
    rod_first = l * complex(d.rod_along, d.rod_across)
    # Mass centres; zero for a massless link, which has no mass centre and needs none.
    c = crank_first / d.crank_mass if d.crank_mass else 0.0j
    s = rod_first / d.rod_mass if d.rod_mass else 0.0j
    spin_crank = d.crank_inertia - d.crank_mass * abs(c) ** 2
    spin_rod = d.rod_inertia - d.rod_mass * abs(s) ** 2
    pivot, slider = clearance.joint == "crank pivot", clearance.joint == "slider pin"
    k = np.array([1.0 if pivot else 0.0, 0.0 if slider else 1.0, 1.0])
    a = np.array([-l if pivot else 0.0, s if slider else s - l, 0.0], dtype=complex)
    b = np.array([c - r if pivot else c, r if slider else 0.0, 0.0], dtype=complex)
    m = np.array([d.crank_mass, d.rod_mass, d.slider_mass])
    system = System(
        r=r,
        l=l,
        e=e,
        branch=float(d.branch),
        speed=float(mechanism.speed),
        start=start,
        gravity=complex(*mechanism.gravity),
        clearance=clearance.radius,
        bearing_radius=clearance.bearing_radius,
        stiffness=clearance.contact_stiffness,
        friction=clearance.friction,
        slip_speed=clearance.slip_speed,
        journal_turns=0.0 if slider else 1.0,
        bearing_turns=0.0 if pivot else 1.0,
        m_xx=float(k @ m),
        m_x_rod=complex((k * m) @ a),
        m_x_crank=complex((k * m) @ b),
        m_rod=float(m @ np.abs(a) ** 2 + spin_rod),
        m_crank=float(m @ np.abs(b) ** 2 + spin_crank),
        m_rod_crank=complex((m * a) @ b.conj()),
        first_rod=complex(m @ a),
        first_crank=complex(m @ b),
    )
    # Effective inertia of the rod once the slider yields, at the rod angle with the strongest coupling.
    if system.m_xx * system.m_rod <= (1.0 + 1e-9) * abs(system.m_x_rod) ** 2:
        raise InputError(
            f"rod and slider need masses to simulate clearance in the {clearance.joint}; got a rod of "
            f"{d.rod_mass:g} kg and a slider of {d.slider_mass:g} kg; give both a mass"
        )
    return system, block, loads


def _require_simulable(mechanism: Mechanism, linkage: Linkage, clearance: Clearance) -> None:
    """Raise the errors of `build_system`, except those about masses."""
    linkage.require_full_rotation()
    if mechanism.acceleration:
        raise InputError(
            "a joint with clearance needs a crank at constant speed; got an acceleration of "
            f"{mechanism.acceleration:g} rad/s^2; set it to zero"
        )
    require_no_crank_load(mechanism, "a simulation of clearance")
    for load in mechanism.loads:
        if load.is_moving_mass:
            raise InputError(
                f"a simulation of clearance only takes forces on the slider; got {load.magnitude_text}; "
                "add that mass to the slider's, or leave that load out"
            )
    rod_margin = float(linkage.rod - linkage.crank - abs(linkage.offset))
    if clearance.radius >= 0.5 * rod_margin:
        raise InputError(
            "a clearance must be less than half of rod - crank - |offset|, or the rod could fold over; "
            f"got {1e3 * clearance.radius:g} mm and {1e3 * rod_margin:g} mm; lengthen the rod or reduce the clearance"
        )
