"""Friction against the whole system of equations solved by another method, against energy, and without friction."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np
import pytest
from scipy.optimize import root

from slidercrank.model.averages import average_torque
from slidercrank.model.cycle import Cycle, cycle
from slidercrank.model.errors import InputError
from slidercrank.model.friction import Friction, Pin
from slidercrank.model.linkage import Linkage
from slidercrank.model.mechanism import Mechanism
from slidercrank.model.peaks import find_peaks
from slidercrank.model.screening import screens
from slidercrank.model.signals import Signal
from tests.model.bodies import bodies
from tests.model.cases import MACHINES, SMOOTH, STROKES, TABLES, Array, random_designs, random_friction, random_machine
from tests.model.contour import distance_to_locking, motion_in_time
from tests.model.virtual_work import path, slider_load

# Rods at least 30 % longer than crank + offset: with the friction of `random_friction` none of them locks.
DESIGNS = random_designs(40, seed=81, least_margin=0.3)
FORCES = ("torque", "pivot_x", "pivot_y", "crank_pin_x", "crank_pin_y", "slider_pin_x", "slider_pin_y", "guide")


def machines() -> list[Mechanism]:
    random = np.random.default_rng(82)
    return [dataclasses.replace(random_machine(random), friction=random_friction(random)) for _ in DESIGNS]


def inertia_forces(machine: Mechanism, design: Array, theta: Array) -> dict[str, tuple[Array, Array, Array]]:
    """Return of every body m (a - G) along x and y and the moment r x m (a - G) + I turn'' about the crank pivot."""
    reach = distance_to_locking(*design)
    found = {}
    for name, part in bodies(machine, design).items():
        x, y, turn = (
            motion_in_time(f, theta, speed=machine.speed, acceleration=machine.acceleration, reach=reach)
            for f in (part.x, part.y, part.turn)
        )
        fx, fy = part.mass * (x[2] - machine.gravity[0]), part.mass * (y[2] - machine.gravity[1])
        found[name] = (fx, fy, x[0] * fy - y[0] * fx + part.inertia * turn[2])
    return found


def residual(u: Array, machine: Mechanism, at: dict[str, Any]) -> Array:
    """Nine equations: forces and moment about the pivot of crank, rod and slider, and the guide's friction."""
    torque, px, py, ax, ay, bx, by, guide, drag = u
    f = machine.friction
    turn = math.copysign(1.0, machine.speed)
    spin_rod = at["rod_1"] * machine.speed
    spin_pin = (at["rod_1"] - 1.0) * machine.speed
    on_rod_at_a = -f.crank_pin.circle * math.hypot(ax, ay) * np.sign(spin_pin)
    on_rod_at_b = -f.slider_pin.circle * math.hypot(bx, by) * np.sign(spin_rod)
    on_crank_at_o = -f.crank_pivot.circle * math.hypot(px, py) * turn
    (cx, cy, cm), (rx, ry, rm), (sx, sy, _) = at["crank"], at["rod"], at["slider"]
    (kx, ky), (x, e) = at["pin"], at["slider_at"]
    return np.array(
        [
            px - ax - cx,
            py - ay - cy,
            torque - (kx * ay - ky * ax) + on_crank_at_o - on_rod_at_a - cm,
            ax - bx - rx,
            ay - by - ry,
            (kx * ay - ky * ax) - (x * by - e * bx) + on_rod_at_a + on_rod_at_b - rm,
            bx + at["load"] + drag - sx,
            by + guide - sy,
            drag + f.guide * abs(guide) * np.sign(at["x_1"] * machine.speed),
        ]
    )


def test_forces_solve_the_nine_equations_of_the_three_bodies() -> None:
    """By Powell's method from the frictionless forces, the system as a textbook draws it; no joint force eliminated."""
    theta = 2.0 * math.pi * np.arange(24) / 24 + 0.013
    sides = set()
    for machine, design in zip(machines(), DESIGNS, strict=True):
        r, _, e = design
        sign = 1.0 if machine.branch == "open" else -1.0
        way = path(design, theta, sign)
        inertia = inertia_forces(machine, design, theta)
        load = sign * slider_load(machine, design, theta, way)
        got = cycle(machine, Linkage(*design), theta)
        start = cycle(dataclasses.replace(machine, friction=Friction()), Linkage(*design), theta)
        for i, angle in enumerate(theta):
            at: dict[str, Any] = {
                "crank": [a[i] + b[i] for a, b in zip(inertia["crank"], inertia["weight"], strict=True)],
                "rod": [a[i] for a in inertia["rod"]],
                "slider": [a[i] for a in inertia["slider"]],
                "pin": (r * math.cos(angle), r * math.sin(angle)),
                "slider_at": (way.x[i], e),
                "rod_1": way.rod_1[i],
                "x_1": way.x_1[i],
                "load": load[i],
            }
            guess = np.array([getattr(start, name)[i] for name in FORCES] + [0.0])
            found = root(residual, guess, args=(machine, at), options={"xtol": 1e-13})
            values = np.array([getattr(got, name)[i] for name in FORCES])
            size = np.abs(values[1:]).max()
            # The forces first, over the greatest; the torque over force times crank, its own scale.
            np.testing.assert_allclose(found.x[1:8], values[1:], rtol=0, atol=1e-9 * size)
            assert abs(found.x[0] - values[0]) < 1e-9 * size * (r + abs(e))
            sides.add((values[7] > 0.0, at["x_1"] * machine.speed > 0.0, way.rod_1[i] * machine.speed > 0.0))
    assert len(sides) == 8  # every combination of signs occurred
