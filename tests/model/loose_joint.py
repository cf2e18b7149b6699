"""The linkage with a loose joint by other means: Newton's and Euler's equations of every body in absolute coordinates.

Nine accelerations (mass centre and angle of crank, rod and slider) and the reactions of what is ideal are one linear
system; constraints are differentiated twice. The contact is worked out anew, from the motion of two touching points.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.links_and_joints import Clearance
from slidercrank.model.machine.mechanism import Mechanism
from tests.model.virtual_work import body

Array = NDArray[np.float64]


def turned(angle: float, arm: Any) -> Array:
    """Return an arm given in a body's axes, in space."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([c * arm[0] - s * arm[1], s * arm[0] + c * arm[1]])


def left(v: Any) -> Array:
    return np.array([-v[1], v[0]])


@dataclass(frozen=True)
class State:
    """Angles of crank, rod and slider with their speeds, and position and velocity of each body's own point.

    The points: crank pivot's end of the crank, crank pin's end of the rod, slider pin.
    """

    angles: Array
    spins: Array
    points: Array
    velocities: Array


def state_of(linkage: Linkage, joint: str, gap: Array, gap_t: Array, theta: float, speed: float) -> State:
    """Return the bodies' places for a gap between the slider pin and where crank and rod lead, and its derivative."""
    r, l, e = float(linkage.crank), float(linkage.rod), float(linkage.offset)
    sine = (e - r * np.sin(theta) - gap[1]) / l
    phi = np.arcsin(sine) if linkage.branch == "open" else np.pi - np.arcsin(sine)
    phi_t = -(gap_t[1] + r * speed * np.cos(theta)) / (l * np.cos(phi))
    slider = np.array([r * np.cos(theta) + l * np.cos(phi) + gap[0], e])
    slider_t = np.array([-r * speed * np.sin(theta) - l * phi_t * np.sin(phi) + gap_t[0], 0.0])
    crank, rod = turned(theta, (r, 0.0)), turned(phi, (l, 0.0))
    zero = np.zeros(2)
    if joint == "crank pivot":
        points = [slider - rod - crank, slider - rod, slider]
        velocities = [slider_t - phi_t * left(rod) - speed * left(crank), slider_t - phi_t * left(rod), slider_t]
    elif joint == "crank pin":
        points, velocities = [zero, slider - rod, slider], [zero, slider_t - phi_t * left(rod), slider_t]
    else:
        points, velocities = [zero, crank, slider], [zero, speed * left(crank), slider_t]
    return State(np.array([theta, phi, 0.0]), np.array([speed, phi_t, 0.0]), np.array(points), np.array(velocities))


def accelerations(
    mechanism: Mechanism, linkage: Linkage, clearance: Clearance, state: State, damping: float, load: float
) -> tuple[float, float, float, float]:
    """Return accelerations of slider and rod angle, the drive torque, and the power that the contact dissipates.

    damping: h / d'_0. load: along x.
    """
    r, l = float(linkage.crank), float(linkage.rod)
    crank, rod = body(mechanism.crank, r), body(mechanism.rod, l)
    weight = mechanism.counterweight
    # Crank and counterweight as one body about their common mass centre.
    out = np.array([np.cos(weight.angle), np.sin(weight.angle)]) * weight.radius
    total = crank.mass + weight.mass
    own = np.array([crank.along, crank.across])
    centre = (crank.mass * own + weight.mass * out) / total
    inertia = crank.inertia + weight.inertia
    inertia += crank.mass * np.sum((own - centre) ** 2) + weight.mass * np.sum((out - centre) ** 2)
    masses = np.array([total, rod.mass, mechanism.slider_mass])
    inertias = np.array([inertia, rod.inertia, 1.0])
    centres = [centre, np.array([rod.along, rod.across]), np.zeros(2)]

    def arm(i: int, at: Any) -> Array:
        """From a body's mass centre to a place on it, in space."""
        return turned(state.angles[i], np.asarray(at) - centres[i])

    pins = {
        "crank pivot": (0, (0.0, 0.0), None, None),
        "crank pin": (0, (r, 0.0), 1, (0.0, 0.0)),
        "slider pin": (2, (0.0, 0.0), 1, (l, 0.0)),
    }
    n = 9
    rows: list[Array] = []
    right: list[float] = []

    def hold(axis: int, parts: list[tuple[int, Any, float]]) -> None:
        """Let the sum of the accelerations of places on bodies vanish along an axis."""
        row, known = np.zeros(n), 0.0
        for i, at, sign in parts:
            a = arm(i, at)
            row[3 * i + axis] += sign
            row[3 * i + 2] += sign * left(a)[axis]
            known += sign * state.spins[i] ** 2 * a[axis]
        rows.append(row)
        right.append(known)

    for name, (i, at, j, other) in pins.items():
        if name == clearance.joint:
            continue
        for axis in (0, 1):
            hold(axis, [(i, at, 1.0)] + ([(j, other, -1.0)] if j is not None else []))
    hold(1, [(2, (0.0, 0.0), 1.0)])
    for i in (0, 2):  # the crank turns steadily, the slider not at all
        row = np.zeros(n)
        row[3 * i + 2] = 1.0
        rows.append(row)
        right.append(0.0)

    forces = np.zeros(n)
    for i in range(3):
        forces[3 * i : 3 * i + 2] = masses[i] * np.array(mechanism.gravity)
    forces[6] += load

    # Contact: journal i against bearing j, or against the frame.
    def place(k: int | None, at: Any) -> tuple[Array, Array, float]:
        if k is None:
            return np.zeros(2), np.zeros(2), 0.0
        a = turned(state.angles[k], at)
        return state.points[k] + a, state.velocities[k] + state.spins[k] * left(a), state.spins[k]

    i, at, j, other = pins[clearance.joint]
    journal, journal_t, journal_spin = place(i, at)
    bearing, bearing_t, bearing_spin = place(j, other)
    apart = journal - bearing
    distance = float(np.hypot(*apart))
    normal = apart / distance
    depth = distance - clearance.radius
    lost = 0.0
    if depth > 0.0:
        touching = bearing + (clearance.journal_radius + clearance.radius) * normal
        on_journal = journal_t + journal_spin * left(touching - journal)
        on_bearing = bearing_t + bearing_spin * left(touching - bearing)
        relative = on_journal - on_bearing
        depth_t, slide = float(relative @ normal), float(relative @ left(normal))
        spring = clearance.contact_stiffness * depth**1.5
        press = max(0.0, spring * (1.0 + damping * depth_t))
        rub = -clearance.friction * press * slide / np.hypot(slide, clearance.slip_speed)
        force = -press * normal + rub * left(normal)
        lost = -float(force @ relative) - spring * depth_t
        for k, sign in ((i, 1.0), (j, -1.0)):
            if k is not None:
                centre_of_mass = state.points[k] + turned(state.angles[k], centres[k])
                forces[3 * k : 3 * k + 2] += sign * force
                forces[3 * k + 2] += sign * float(left(touching - centre_of_mass) @ force)
    m = np.diag(np.column_stack([masses, masses, inertias]).ravel())
    g = np.array(rows)
    solved = np.linalg.solve(np.block([[m, -g.T], [g, np.zeros((len(g), len(g)))]]), np.concatenate([forces, right]))
    torque = solved[n + len(g) - 2]  # the moment that keeps the crank's spin
    return float(solved[6]), float(solved[5]), float(torque), lost
