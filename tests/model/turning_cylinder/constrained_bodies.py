"""Lever, barrel and piston rod as three free bodies, held together by nine constraints: an independent model.

Coordinates: mass centre and angle of each body. M q'' + J^T lambda = Q, J q'' = -(dJ/dt) q'; the multipliers are the
forces of the joints.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from slidercrank.model.turning_cylinder.cylinder_and_pin_forces import LeverMachine

STEP = 1e-30
Numbers = NDArray[np.float64]


@dataclass(frozen=True)
class JointForces:
    """Push along the line, forces on the lever at B and O, on the cylinder at A, N; coordinates."""

    push: float
    pin: complex
    pivot: complex
    cylinder_pivot: complex
    coordinates: Numbers


def _rotated(angle: complex, point: tuple[float, float]) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]:
    """Return a body's point in the plane relative to its centre, and its derivative with respect to the angle."""
    sine, cosine = np.sin(angle), np.cos(angle)
    turned = np.array([cosine * point[0] - sine * point[1], sine * point[0] + cosine * point[1]])
    return turned, np.array([-turned[1], turned[0]])


def _complex(vector: NDArray[np.complex128]) -> complex:
    return complex(vector[0].real, vector[1].real)


class Bodies:
    """The three bodies of a machine, with the places of their joints in their own axes."""

    def __init__(self, machine: LeverMachine) -> None:
        """Place the joints; the lever's centre and inertia follow from its moments about O."""
        lever, sizes = machine.lever, machine.sizes
        centre = np.array([lever.moment_along, lever.moment_across]) / lever.mass
        pin = sizes.crank * np.array([np.cos(sizes.pin_angle), np.sin(sizes.pin_angle)])
        self.at_o, self.at_b = tuple(-centre), tuple(pin - centre)
        self.at_a = (-0.5 * machine.barrel.length, -sizes.offset)
        self.end = (0.5 * machine.piston_rod.length, 0.0)
        self.pivot = sizes.frame * np.array([np.cos(sizes.frame_angle), np.sin(sizes.frame_angle)])
        self.offset = sizes.offset
        rods = machine.barrel, machine.piston_rod
        masses = [lever.mass, *(rod.mass for rod in rods)]
        inertias = [lever.inertia - lever.mass * float(centre @ centre), *(rod.inertia for rod in rods)]
        self.mass = np.diag([size for m, i in zip(masses, inertias, strict=True) for size in (m, m, i)])
        self.spring = machine.spring
        self.weight = np.array([size for m in masses for size in (*(m * np.array(machine.gravity)), 0.0)])

    def constraints(self, q: NDArray[np.complex128]) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]:
        """Return the constraints (9,) without the driver's length, and their derivatives (9, 9)."""
        values, rows = np.zeros(9, np.complex128), np.zeros((9, 9), np.complex128)
        unit = np.eye(2)
        o, o_1 = _rotated(q[2], self.at_o)
        values[:2], rows[:2, :2], rows[:2, 2] = q[:2] + o, unit, o_1
        a, a_1 = _rotated(q[5], self.at_a)
        values[2:4], rows[2:4, 3:5], rows[2:4, 5] = q[3:5] + a - self.pivot, unit, a_1
        b, b_1 = _rotated(q[2], self.at_b)
        end, end_1 = _rotated(q[8], self.end)
        values[4:6] = q[6:8] + end - q[:2] - b
        rows[4:6, :2], rows[4:6, 2], rows[4:6, 6:8], rows[4:6, 8] = -unit, -b_1, unit, end_1
        values[6], rows[6, 8], rows[6, 5] = q[8] - q[5], 1.0, -1.0
        line, normal = _rotated(q[5], (1.0, 0.0))
        reach = q[6:8] + end - q[3:5] - a
        for row, (way, way_1) in enumerate(((normal, -line), (line, normal)), start=7):
            values[row] = way @ reach
            rows[row, 3:5], rows[row, 6:8], rows[row, 8] = -way, way, way @ end_1
            rows[row, 5] = way_1 @ reach - way @ a_1
        values[7] -= self.offset
        return values, rows

    def forces(self, q: Numbers) -> Numbers:
        """Return the weights, and the force of the spring on the lever with its moment about the mass centre."""
        forces, spring = self.weight.copy(), self.spring
        if spring is not None:
            arm = spring.lever * np.exp(1j * (q[2] + spring.pin_angle)) + _complex(_rotated(q[2], self.at_o)[0])
            span = complex(q[0], q[1]) + arm - spring.frame * np.exp(1j * spring.frame_angle)
            push = spring.force - spring.stiffness * (abs(span) - spring.length)
            force = push * span / abs(span)
            forces[:3] += force.real, force.imag, (arm.conjugate() * force).imag
        return forces

    def joint_forces(self, guess: Numbers, length: float, speed: float, acceleration: float) -> JointForces:
        """Return the forces for the motion of the cylinder's length, from a guess of the coordinates."""
        q: NDArray[np.complex128] = guess.astype(np.complex128)
        driver = np.eye(9)[8]
        for _ in range(60):
            values, rows = self.constraints(q)
            change = np.linalg.solve(rows.real, (values - driver * length).real)
            q -= change
            if np.abs(change).max() < 1e-15:
                break
        slopes = self.constraints(q)[1].real
        rate = np.linalg.solve(slopes, driver * speed)
        bend = self.constraints(q + 1j * STEP * rate)[1].imag / STEP @ rate
        matrix = np.block([[self.mass, slopes.T], [slopes, np.zeros((9, 9))]])
        solved = np.linalg.solve(matrix, np.concatenate([self.forces(q.real), driver * acceleration - bend]))[9:]
        force = solved[0::2][:3] + 1j * solved[1::2][:3]
        return JointForces(-float(solved[8]), complex(force[2]), -complex(force[0]), -complex(force[1]), q.real)
