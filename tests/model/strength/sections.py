"""Stress in a section of crank or rod from the other end, integrated over the area beyond it."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from slidercrank.model.cycle.cycle import cycle, derived_design
from slidercrank.model.dynamics.torque import forces_without_friction
from slidercrank.model.kinematics.position import motion
from slidercrank.model.linkage.linkage import Linkage
from slidercrank.model.machine.links_and_joints import Bar
from slidercrank.model.machine.mechanism import Mechanism
from slidercrank.model.strength.section_forces import (
    CRANK,
    ROD,
    Stress,
    stress_at_length_fraction,
    stress_coefficients_of_link,
)
from tests.model.cases import STRENGTH, Array, linkage_of, random_machine


def random_bars(random: np.random.Generator) -> Mechanism:
    """Return a random machine with crank and rod as bars, pins and a material."""
    machine = random_machine(random)
    bars = [
        Bar(width=random.uniform(0.02, 0.06), depth=random.uniform(0.005, 0.04), density=random.uniform(2e3, 9e3))
        for _ in range(2)
    ]
    return replace(machine, crank=bars[0], rod=bars[1], strength=STRENGTH)


def section_stress(mechanism: Mechanism, part: str, linkage: Linkage, theta: Array, share: float, face: float) -> Array:
    """Return the stress (n,) of a face (1 or -1) of the rod or the crank at crank angles (n,).

    By Gauss points over the area between the section and the end beyond the slider pin or the crank pivot; the forces
    there are those of the cycle. Without friction in the pins.
    """
    bar: Any = getattr(mechanism, part)
    length = float(getattr(linkage, part))
    radius, x = 0.5 * bar.width, share * length
    nodes, weights = np.polynomial.legendre.leggauss(12)
    curves = cycle(mechanism, linkage, theta)
    given = {"speed": mechanism.speed, "acceleration": mechanism.acceleration}
    if part == "rod":
        angle = linkage.at(theta).rod_angle
        # Of the slider on the rod.
        far, held = np.stack([-curves.slider_pin_x, -curves.slider_pin_y]), None
    else:
        angle = theta + np.pi  # from the crank pin to the pivot
        far, held = np.stack([curves.pivot_x, curves.pivot_y]), curves.torque
    t, n = np.stack([np.cos(angle), np.sin(angle)]), np.stack([-np.sin(angle), np.cos(angle)])

    def acceleration(along: float, across: float) -> Array:
        if part == "rod":
            found = linkage.rod_point(theta, along=along, across=across, **given).acceleration
        else:
            point = (length - along) * np.exp(1j * theta) - 1j * across * np.exp(1j * theta)
            moved = point * (1j * mechanism.acceleration - mechanism.speed**2)
            found = np.stack([moved.real, moved.imag], axis=-1)
        return np.asarray(found - np.asarray(mechanism.gravity)).T

    force, moment = np.zeros((2, len(theta))), np.zeros(len(theta))
    per_area = bar.density * bar.depth
    # The web, and the half-disc in polar coordinates about the far pin.
    points = [
        (0.5 * (length + x) + 0.5 * (length - x) * u, radius * v, 0.5 * (length - x) * radius * a * b)
        for u, a in zip(nodes, weights, strict=True)
        for v, b in zip(nodes, weights, strict=True)
    ]
    for u, a in zip(nodes, weights, strict=True):
        for v, b in zip(nodes, weights, strict=True):
            r, turn = 0.5 * radius * (1.0 + u), 0.5 * np.pi * v
            points.append((length + r * np.cos(turn), r * np.sin(turn), 0.25 * radius * np.pi * r * a * b))
    for along, across, area in points:
        push = per_area * area * acceleration(along, across)
        force += push
        moment += (along - x) * (push * n).sum(axis=0) - across * (push * t).sum(axis=0)
    # Of the cut on what lies beyond it: mass times acceleration less the pin's force.
    on_far = force - far
    couple = moment - (length - x) * (far * n).sum(axis=0) - (0.0 if held is None else held)
    normal, bending = -(on_far * t).sum(axis=0), -couple  # on the near part
    stress: Array = normal / (bar.width * bar.depth) + face * 6.0 * bending / (bar.depth * bar.width**2)
    return stress


def stress_rows(mechanism: Mechanism, part: str, linkage: Linkage, theta: Array, shares: Array) -> tuple[Array, Array]:
    """Return axial stress and stress by bending, each (n, m), at crank angles (n,) and shares of the length (m,)."""
    bar: Any = getattr(mechanism, part)
    load = cycle(mechanism, linkage, theta).load
    masses = tuple(own for own in mechanism.loads if own.is_moving_mass)
    design = derived_design(replace(mechanism, loads=masses), linkage)
    moved = motion(np.sin(theta), np.cos(theta), design.r, design.l, design.e, design.branch)
    c = stress_coefficients_of_link(
        ROD if part == "rod" else CRANK,
        np.sin(theta),
        np.cos(theta),
        moved,
        design,
        forces_without_friction(np.sin(theta), np.cos(theta), moved, design, load),
        0.0,
        (bar.width, bar.depth, bar.density),
    )
    column = Stress(*(np.broadcast_to(each, theta.shape)[:, None] for each in c))
    axial = stress_at_length_fraction(column, 0.0, shares)
    return axial, stress_at_length_fraction(column, 1.0, shares) - axial


def eye_rows(mechanism: Mechanism, part: str, linkage: Linkage, theta: Array) -> Array:
    """Return the stress (n, m) at m edges of a link's eyes, from area and second moment without the hole."""
    bar: Any = getattr(mechanism, part)
    strength = mechanism.strength
    assert strength is not None
    w, d, raised = bar.width, bar.depth, strength.eye_concentration
    axial, bending = stress_rows(mechanism, part, linkage, theta, np.array([0.0, 1.0]))
    force, moment = axial * w * d, bending * d * w**2 / 6.0
    found = []
    for end, hole in enumerate((strength.crank_pin, strength.slider_pin if part == "rod" else strength.crank_pivot)):
        area, second = (w - hole) * d, d * (w**3 - hole**3) / 12.0
        pivot = part == "crank" and end == 1  # elsewhere moments, which are by friction and round ends, are left out
        edges = [(raised, min(raised, 2.0) if pivot else 0.0, 0.5 * hole)]
        if pivot:
            edges.append((1.0, 1.0, 0.5 * w))
        for pulled, bent, lever in edges:
            for face in (1.0, -1.0):
                stress = pulled * force[:, end] / area + face * bent * moment[:, end] * lever / second
                found.append(stress)
    return np.stack(found, axis=1)


def linkage_with(mechanism: Mechanism, design: Array) -> Linkage:
    """Return the linkage of a design on the machine's branch."""
    return linkage_of(design, mechanism.branch)
