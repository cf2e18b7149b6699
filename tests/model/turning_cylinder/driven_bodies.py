"""Crank, barrel, arm, piston rod and ram as five free bodies with fifteen constraints: an independent model.

Coordinates: mass centre and angle of each body. M q'' + J^T lambda = Q, J q'' = -(dJ/dt) q'; the multipliers are the
forces of the joints, and that of the crank's angle is the torque on it.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from slidercrank.model.turning_cylinder.lever_state import LeverNumbers

STEP = 1e-30
Complex = NDArray[np.complex128]
CRANK, BARREL, ARM, ROD, RAM = range(5)


class Forces(NamedTuple):
    """Crank torque, N m, joint forces at B, O and A, N, and power of the loads, W."""

    torque: float
    pin: complex
    pivot: complex
    cylinder_pivot: complex
    load_power: float
    coordinates: NDArray[np.float64]


def _at(q: Complex, body: int, along: float = 0.0, across: float = 0.0) -> Any:
    """Return a point of a body in the plane, given in its own axes from its centre."""
    x, y, angle = q[3 * body : 3 * body + 3]
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.array([x + along * cosine - across * sine, y + along * sine + across * cosine])


class DrivenBodies:
    """The five bodies of one machine. c: its numbers as floats, with an arm, a ram and all masses above zero."""

    def __init__(self, c: LeverNumbers) -> None:
        """Place the centres; those of crank and arm follow from their first moments."""
        self.c = c
        self.crank = c.moment_along / c.lever_mass, c.moment_across / c.lever_mass
        self.arm = c.arm_moment / c.arm_mass
        self.frame = np.array([np.cos(c.frame_angle), np.sin(c.frame_angle)])
        self.normal = np.array([-self.frame[1], self.frame[0]])
        masses = [c.lever_mass, c.barrel_mass, c.arm_mass, c.rod_mass, c.ram_mass]
        inertias = [
            c.inertia - c.lever_mass * (self.crank[0] ** 2 + self.crank[1] ** 2),
            c.barrel_mass * c.barrel_length**2 / 12.0,
            c.arm_inertia - c.arm_mass * self.arm**2,
            c.rod_mass * c.rod_length**2 / 12.0,
            1.0,
        ]
        self.mass = np.diag([size for m, i in zip(masses, inertias, strict=True) for size in (m, m, i)])
        self.weight = np.array([size for m in masses for size in (m * c.gravity_x, m * c.gravity_y, 0.0)])

    def constraints(self, q: Complex, angle: Any) -> Complex:
        """Return the constraints (15,) at a crank angle."""
        c, pivot = self.c, self.c.frame * self.frame
        pin = c.crank * np.array([np.cos(c.pin_angle), np.sin(c.pin_angle)]) - self.crank
        end, housing = _at(q, ROD, 0.5 * c.rod_length), _at(q, BARREL, -0.5 * c.barrel_length, -c.offset)
        line = np.array([-np.sin(q[3 * BARREL + 2]), np.cos(q[3 * BARREL + 2])])
        slot = _at(q, RAM) - _at(q, ARM, c.ram - self.arm)
        values = [
            *_at(q, CRANK, -self.crank[0], -self.crank[1]),
            *(housing - pivot),
            *(_at(q, ARM, -self.arm) - pivot),
            *(end - _at(q, CRANK, *pin)),
            q[3 * CRANK + 2] - angle,
            q[3 * ARM + 2] - q[3 * BARREL + 2],
            q[3 * ROD + 2] - q[3 * BARREL + 2],
            line @ (end - housing) - c.offset,
            q[3 * RAM + 2],
            self.frame @ (_at(q, RAM) - pivot),
            self.normal @ slot,
        ]
        return np.array(values)

    def slopes(self, q: Complex, angle: Any) -> Any:
        """Return the derivatives (15, 15) of the constraints at real coordinates."""
        columns = [self.constraints(q + 1j * STEP * unit, angle).imag / STEP for unit in np.eye(15)]
        return np.stack(columns, axis=1)

    def forces(self, guess: NDArray[np.float64], angle: float, speed: float, *, slow: bool) -> Forces:
        """Return the forces at a crank angle and speed. slow: whether the stroke of the ram is the slow one."""
        c, q, driver = self.c, guess.astype(np.complex128), np.eye(15)[8]
        for _ in range(60):
            change = np.linalg.solve(self.slopes(q, angle), self.constraints(q, angle).real)
            q -= change
            if np.abs(change).max() < 1e-15:
                break
        slopes = self.slopes(q, angle)
        rate = np.linalg.solve(slopes, driver * speed)
        h = 1e-6
        bend = (self.slopes(q + h * rate, angle) - self.slopes(q - h * rate, angle)) / (2.0 * h) @ rate
        loads = np.zeros(15)
        turn, ram = rate[3 * ARM + 2], self.normal @ rate[3 * RAM : 3 * RAM + 2]
        loads[3 * ARM + 2] = -c.arm_torque * np.sign(turn)
        loads[3 * RAM : 3 * RAM + 2] = -c.ram_force * np.sign(ram) * slow * self.normal
        line = np.array([np.cos(q[3 * ROD + 2].real), np.sin(q[3 * ROD + 2].real)])
        sliding = line @ rate[3 * ROD : 3 * ROD + 2] + turn * c.offset  # the line turns about A
        rub = -c.rub * np.sign(sliding) * line
        loads[3 * ROD : 3 * ROD + 2] += rub
        loads[3 * BARREL : 3 * BARREL + 2] -= rub
        matrix = np.block([[self.mass, slopes.T], [slopes, np.zeros((15, 15))]])
        solved = np.linalg.solve(matrix, np.concatenate([self.weight + loads, -bend]))[15:]
        joints = solved[0:8:2] + 1j * solved[1:8:2]
        return Forces(
            -float(solved[8]),
            complex(joints[3]),
            -complex(joints[0]),
            -complex(joints[1] + joints[2]),
            -float(loads @ rate),
            q.real,
        )
