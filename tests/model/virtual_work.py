"""The mechanics once more, by other means than the project's: virtual work and plain NumPy.

The project solves Newton's and Euler's equations body by body. Here the drive torque follows from energies alone:
T = w^2 J'/2 + J alpha + V' - F x' - M, with J(theta) w^2 / 2 the kinetic energy, V the potential energy of gravity,
F the load on the slider and M the torque of the loads on the crank. All functions broadcast: dimensions
against crank angles.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from slidercrank.model.machine.links_and_joints import Bar, Link
from slidercrank.model.machine.loads.added_mass import AddedMass
from slidercrank.model.machine.loads.angle_table import AngleTable
from slidercrank.model.machine.loads.crank_torque import CrankTorque, CrankTorqueTable
from slidercrank.model.machine.loads.drag import Drag
from slidercrank.model.machine.loads.load import During, Load
from slidercrank.model.machine.loads.position_table import PositionTable
from slidercrank.model.machine.loads.spring import Spring
from slidercrank.model.machine.loads.stroke_force import StrokeForce
from slidercrank.model.machine.loads.viscous import Viscous
from slidercrank.model.machine.mechanism import Mechanism

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Body:
    """Mass, mass centre along and across the link, and inertia about the mass centre."""

    mass: Any
    along: Any
    across: Any
    inertia: Any


def body(link: Link, length: Any) -> Body:
    """Return the mass properties of a link; the polar inertia of a round-ended bar is integrated by hand."""
    if isinstance(link, Bar):
        w, radius = link.width, 0.5 * link.width
        area_density = link.density * link.depth
        polar = (
            w * length**3 / 12.0
            + w**3 * length / 12.0
            + 0.5 * math.pi * radius**4
            + 0.25 * math.pi * radius**2 * length**2
            + 4.0 / 3.0 * radius**3 * length
        )
        mass = area_density * (length * w + math.pi * radius**2)
        return Body(mass, 0.5 * length, 0.0, area_density * polar)
    along = 0.5 * length if link.centre is None else link.centre
    inertia = link.mass * length**2 / 12.0 if link.inertia is None else link.inertia
    return Body(link.mass, along, link.centre_across, inertia)


@dataclass(frozen=True)
class Path:
    """Slider position x and the rod's direction, each with two derivatives with respect to crank angle."""

    sine: Any
    cosine: Any
    rod_sine: Any
    rod_cosine: Any
    rod_1: Any
    rod_2: Any
    x: Any
    x_1: Any
    x_2: Any


def path(designs: Any, theta: Any, branch: float) -> Path:
    """Return the motion for designs (..., 3) at crank angles: loop closure in its trigonometric form."""
    r, l, e = designs[..., 0], designs[..., 1], designs[..., 2]
    sine, cosine = np.sin(theta), np.cos(theta)
    rod_sine = (e - r * sine) / l
    # (1 - s)(1 + s) rather than 1 - s^2: near locking s is close to one.
    rod_cosine = branch * np.sqrt((1.0 - rod_sine) * (1.0 + rod_sine))
    ratio = r / (l * rod_cosine)
    rod_1 = -ratio * cosine
    tangent = rod_sine / rod_cosine
    rod_2 = ratio * sine + tangent * rod_1**2
    # x' = -r sin(theta - phi) / cos(phi)
    x_1 = -r * (sine - cosine * tangent)
    x_2 = -r * (cosine + sine * tangent - cosine * rod_1 / rod_cosine**2)
    x = r * cosine + l * rod_cosine
    return Path(sine, cosine, rod_sine, rod_cosine, rod_1, rod_2, x, x_1, x_2)


def stroke_ends(designs: Any) -> tuple[Any, Any]:
    """Return the least and the greatest distance of the slider from the crank pivot along its line."""
    r, l, e = designs[..., 0], designs[..., 1], np.abs(designs[..., 2])
    return np.sqrt((l - r - e) * (l - r + e)), np.sqrt((l + r - e) * (l + r + e))


def acts(during: During, outward: Any) -> Any:
    """Return where a load acts."""
    if during == "cycle":
        return np.ones_like(outward)
    return outward if during == "outward stroke" else ~outward


def load_force(load: Load, position: Any, velocity: Any, outward: Any, theta: Any, ends: tuple[Any, Any]) -> Any:
    """Return one load, N outward, for the distance and the velocity away from the crank pivot."""
    if isinstance(load, StrokeForce):
        return np.where(outward, load.outward, load.inward)
    if isinstance(load, AngleTable):
        force = np.interp(theta, load.angles, load.forces, period=2.0 * math.pi)
        return np.where(acts(load.during, outward), force, 0.0)
    if isinstance(load, Drag):
        return -load.drag * velocity * np.abs(velocity)
    if isinstance(load, Viscous):
        return -load.coefficient * velocity
    if isinstance(load, AddedMass):
        return np.zeros_like(position)  # inertia, below
    assert isinstance(load, Spring | PositionTable)
    counted = {
        "crank pivot": position,
        "inner dead centre": position - ends[0],
        "outer dead centre": ends[1] - position,
    }[load.datum]
    if isinstance(load, Spring):
        pull = -load.stiffness * (counted - load.free_position)
        return -pull if load.datum == "outer dead centre" else pull
    force = np.interp(counted, load.positions, load.forces)
    return np.where(acts(load.during, outward), force, 0.0)


def outward_motion(mechanism: Mechanism, at: Path) -> tuple[Any, Any, Any]:
    """Return distance from the pivot, velocity away from it, and whether the slider moves outward."""
    sign = 1.0 if mechanism.branch == "open" else -1.0
    turn = -1.0 if mechanism.speed < 0.0 else 1.0
    return sign * at.x, sign * at.x_1 * mechanism.speed, sign * turn * at.x_1 > 0.0


def slider_load(mechanism: Mechanism, designs: Any, theta: Any, at: Path) -> Any:
    """Return the sum of all loads on the slider, N outward."""
    position, velocity, outward = outward_motion(mechanism, at)
    ends = stroke_ends(designs)
    total = np.zeros_like(position)
    for load in mechanism.loads:
        if not load.on_crank:
            total = total + load_force(load, position, velocity, outward, theta, ends)
    return total


def crank_torque(mechanism: Mechanism, theta: Any) -> Any:
    """Return the sum of the torques of loads on the crank, N m, tables from zero crank angle."""
    total = 0.0 * np.asarray(theta)
    for load in mechanism.loads:
        if isinstance(load, CrankTorqueTable):
            total = total + np.interp(theta, load.angles, load.forces, period=2.0 * math.pi)
        elif isinstance(load, CrankTorque):
            against = load.resistance * math.copysign(1.0, mechanism.speed)
            total = total + (load.torque - against - load.crank_stiffness * (theta - load.free_angle))
    return total


def added_mass(mechanism: Mechanism) -> float:
    """Return the mass that moves with the slider, kg."""
    return sum(load.mass for load in mechanism.loads if isinstance(load, AddedMass))


def drive_torque(mechanism: Mechanism, designs: Any, theta: Any) -> Any:
    """Return the drive torque, N m, for designs (..., 3) at crank angles that broadcast with (...)."""
    sign = 1.0 if mechanism.branch == "open" else -1.0
    r, l = designs[..., 0], designs[..., 1]
    at = path(designs, theta, sign)
    crank, rod, weight = body(mechanism.crank, r), body(mechanism.rod, l), mechanism.counterweight
    gx, gy = mechanism.gravity
    # First moment of the rod about the crank pin, in space.
    sx = rod.mass * (rod.along * at.rod_cosine - rod.across * at.rod_sine)
    sy = rod.mass * (rod.along * at.rod_sine + rod.across * at.rod_cosine)
    about_pin = rod.inertia + rod.mass * (rod.along**2 + rod.across**2)
    coupling = r * (sx * at.cosine + sy * at.sine)
    coupling_1 = r * (1.0 - at.rod_1) * (sy * at.cosine - sx * at.sine)
    constant = (
        crank.inertia
        + crank.mass * (crank.along**2 + crank.across**2)
        + weight.inertia
        + weight.mass * weight.radius**2
        + rod.mass * r**2
    )
    moving = mechanism.slider_mass + added_mass(mechanism)
    inertia = constant + 2.0 * coupling * at.rod_1 + about_pin * at.rod_1**2 + moving * at.x_1**2
    half_slope = (
        coupling * at.rod_2 + coupling_1 * at.rod_1 + about_pin * at.rod_1 * at.rod_2 + moving * at.x_1 * at.x_2
    )
    along = crank.mass * crank.along + weight.mass * weight.radius * math.cos(weight.angle)
    across = crank.mass * crank.across + weight.mass * weight.radius * math.sin(weight.angle)
    along = along + rod.mass * r
    moved_x = -along * at.sine - across * at.cosine - sy * at.rod_1 + mechanism.slider_mass * at.x_1
    moved_y = along * at.cosine - across * at.sine + sx * at.rod_1
    load = sign * slider_load(mechanism, designs, theta, at)
    return (
        mechanism.speed**2 * half_slope + mechanism.acceleration * inertia - gx * moved_x - gy * moved_y - load * at.x_1
    ) - crank_torque(mechanism, theta)


def error_parts(mechanism: Mechanism, designs: Any, theta: Any) -> tuple[Any, Any, Any, Any]:
    """Return the slider displacement by each tolerance: crank, rod, offset, crank angle, m, with its sign."""
    sign = 1.0 if mechanism.branch == "open" else -1.0
    r, l, e = designs[..., 0], designs[..., 1], designs[..., 2]
    at = path(designs, theta, sign)
    tolerances = mechanism.tolerances
    return (
        (at.cosine * at.rod_cosine + at.sine * at.rod_sine)
        / at.rod_cosine
        * (tolerances.crank.absolute + tolerances.crank.fraction * r),
        1.0 / at.rod_cosine * (tolerances.rod.absolute + tolerances.rod.fraction * l),
        -at.rod_sine / at.rod_cosine * (tolerances.offset.absolute + tolerances.offset.fraction * np.abs(e)),
        at.x_1 * tolerances.crank_angle.absolute,
    )


def position_error(mechanism: Mechanism, designs: Any, theta: Any, *, rss: bool = False) -> Any:
    """Return the position error, m, zero outside the window of the tolerances."""
    sign = 1.0 if mechanism.branch == "open" else -1.0
    parts = error_parts(mechanism, designs, theta)
    error = np.sqrt(sum(part**2 for part in parts)) if rss else sum(np.abs(part) for part in parts)
    window = mechanism.tolerances.window
    position, _, outward = outward_motion(mechanism, path(designs, theta, sign))
    inner, outer = stroke_ends(designs)
    fraction = (position - inner) / (outer - inner)
    counts = acts(window.during, outward)
    if window.start > 0.0:
        counts = counts & (fraction >= window.start)
    if window.end < 1.0:
        counts = counts & (fraction <= window.end)
    return np.where(counts, error, 0.0)
