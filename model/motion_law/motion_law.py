"""Motion laws: crank speed as a function of crank angle, for a drive torque that is linear in each cell.

The kinetic energy is K = K_start + integral of T - Q over the angle passed (`law_turn`). It is exact except for the
integral of Q, a polynomial of degree 15 on each cell. The crank acceleration is continuous except where a load steps.

Cam table of a motion law: master time, crank angle, speed and acceleration, for a drive that interpolates.

Between two points the crank angle is the polynomial of degree 5 in time that matches the angles, speeds and
accelerations at both. Where a load steps, so does the acceleration. Two points then have the same time, angle and
speed, the first with the acceleration before the step, the second with the acceleration after it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..arrays import Array, IntArray
from ..quadrature import NODES
from ..transient.crank_equation import TURN
from ..transient.speed_profile_cycle import CrankMotion
from .law_turn import LawTurn, interpolate_in_cells

_NEWTON = 8


@dataclass(frozen=True)
class MotionLaw:
    """A motion law over the cells of a turn.

    torque: drive torque in the direction of rotation at the start of each cell, N m, (n,). start_energy: K at the start
    of the turn, J. The mean torque equals that of the loads, so the speed repeats.
    """

    turn: LawTurn
    torque: Array
    start_energy: float

    @classmethod
    def from_torque_made_periodic(cls, turn: LawTurn, torque: Array, start_energy: float) -> MotionLaw:
        """Return the law with a constant torque added that makes it repeat."""
        excess = float(turn.width @ (0.5 * (torque + np.roll(torque, -1)))) - turn.work_absorbed_by_loads
        return cls(turn, torque - excess / float(turn.width.sum()), start_energy)

    @cached_property
    def cell_start_energies(self) -> Array:
        """K at the start of each cell, J, (n,)."""
        gain = self.turn.width * 0.5 * (self.torque + np.roll(self.torque, -1))
        gain -= np.sum(self.turn.angle_weights * self.turn.terms.load, axis=1)
        return self.start_energy + np.concatenate([[0.0], np.cumsum(gain)[:-1]])

    @cached_property
    def node_energies(self) -> Array:
        """K at the nodes, J, (n, 16)."""
        cell = np.repeat(np.arange(len(self.torque)), self.turn.angle.shape[1])
        place = np.tile(NODES, len(self.torque))
        return self._energy_in_cells(cell, place).reshape(self.turn.angle.shape)

    @property
    def node_torques(self) -> Array:
        """T at the nodes, N m, (n, 16)."""
        return np.asarray(self.torque[:, None] + (np.roll(self.torque, -1) - self.torque)[:, None] * NODES)

    @cached_property
    def node_slowness(self) -> Array:
        """Time per angle, s, at the nodes, (n, 16)."""
        return np.asarray(np.sqrt(0.5 * self.turn.terms.inertia / self.node_energies))

    @property
    def period(self) -> float:
        """Time of a turn, s."""
        return float(np.sum(self.turn.angle_weights * self.node_slowness))

    @property
    def rms_torque(self) -> float:
        """Root mean square of the drive torque over the time of a turn, N m."""
        return math.sqrt(
            float(np.sum(self.turn.angle_weights * self.node_torques**2 * self.node_slowness)) / self.period
        )

    def mixed_with(self, other: MotionLaw, share: float) -> MotionLaw:
        """Return a mixture of this law's K and T with those of another law, in the proportion `share`."""
        torque = (1.0 - share) * self.torque + share * other.torque
        return MotionLaw(self.turn, torque, (1.0 - share) * self.start_energy + share * other.start_energy)

    def energy_at(self, crank_angle: Array) -> Array:
        """Return K, J, at crank angles (n,), rad."""
        return self._energy_in_cells(*self.turn.locate_in_cells(crank_angle))

    def speed_at(self, crank_angle: Array) -> Array:
        """Return the crank speed, rad/s, positive counter-clockwise, at crank angles (n,), rad."""
        return np.asarray(
            self.turn.way * np.sqrt(2.0 * self.energy_at(crank_angle) / self.turn.inertia_at(crank_angle))
        )

    def torque_at(self, crank_angle: Array) -> Array:
        """Return the drive torque, N m, positive counter-clockwise, at crank angles (n,), rad."""
        return np.asarray(self.turn.way * self._torque_in_cells(*self.turn.locate_in_cells(crank_angle)))

    def acceleration_at(self, crank_angle: Array, *, before: bool = False) -> Array:
        """Return the crank acceleration, rad/s^2, positive counter-clockwise, at crank angles (n,), rad.

        before: whether to return the value before a step in the load, if an angle lies on one.
        """
        cell, place = self.turn.locate_in_cells(crank_angle)
        if before:
            first = place <= 0.0
            cell, place = np.where(first, cell - 1, cell), np.where(first, 1.0, place)
        inertia = self.turn.inertia_at(crank_angle)
        load, slope = (
            interpolate_in_cells(values, cell, place)
            for values in (self.turn.terms.load, self.turn.terms.inertia_slope)
        )
        energy = self._energy_in_cells(cell, place)
        return np.asarray(
            self.turn.way * (self._torque_in_cells(cell, place) - load - slope * energy / inertia) / inertia
        )

    @property
    def crank_motion(self) -> CrankMotion:
        """The law as a crank motion that can be evaluated like any speed profile."""
        return CrankMotion(
            lambda angle: (self.speed_at(angle), self.acceleration_at(angle)), np.mod(self.turn.cell_start_angles, TURN)
        )

    def time_at(self, crank_angle: Array) -> Array:
        """Return the time since the start of the turn, s, at crank angles (n,), rad."""
        cell, place = self.turn.locate_in_cells(crank_angle)
        return np.asarray(
            self._cell_start_times[cell] + self.turn.integral_from_cell_start(self.node_slowness, cell, place)
        )

    def angle_at(self, time: Array) -> Array:
        """Return the crank angle, rad, not reduced modulo a turn, at times (n,) from 0 to the period, s."""
        cell = np.clip(
            np.searchsorted(self._cell_start_times, time, side="right") - 1, 0, len(self._cell_start_times) - 1
        )
        rest = time - self._cell_start_times[cell]
        lasts = self.turn.integral_from_cell_start(self.node_slowness, cell, np.ones(len(time)))
        place = rest / lasts
        for _ in range(_NEWTON):
            error = self.turn.integral_from_cell_start(self.node_slowness, cell, place) - rest
            place = np.clip(
                place - error / (self.turn.width[cell] * interpolate_in_cells(self.node_slowness, cell, place)),
                0.0,
                1.0,
            )
        return np.asarray(self.turn.start + self.turn.way * (self.turn.passed[cell] + place * self.turn.width[cell]))

    @cached_property
    def _cell_start_times(self) -> Array:
        lasts = np.sum(self.turn.angle_weights * self.node_slowness, axis=1)
        return np.concatenate([[0.0], np.cumsum(lasts)[:-1]])

    def _torque_in_cells(self, cell: IntArray, place: Array) -> Array:
        return np.asarray(self.torque[cell] + (np.roll(self.torque, -1) - self.torque)[cell] * place)

    def _energy_in_cells(self, cell: IntArray, place: Array) -> Array:
        first, rise = self.torque[cell], (np.roll(self.torque, -1) - self.torque)[cell]
        gain = self.turn.width[cell] * place * (first + 0.5 * rise * place)
        return np.asarray(
            self.cell_start_energies[cell]
            + gain
            - self.turn.integral_from_cell_start(self.turn.terms.load, cell, place)
        )


POINTS = 1_000
"""Minimum number of intervals in a table."""
_STEP = 1e-9  # relative to the maximum acceleration: a smaller step is a rounding error


@dataclass(frozen=True)
class CamTable:
    """Points (n,) over a turn, including its end: time, s; crank angle, rad, not reduced modulo a turn; rad/s.

    Rad/s^2.
    """

    time: Array
    crank_angle: Array
    speed: Array
    acceleration: Array


def cam_table_of_turn(law: MotionLaw, intervals: int = POINTS) -> CamTable:
    """Return the table at the ends of all cells and at equal parts of the longest cells."""
    turn = law.turn
    parts = np.maximum(1, np.ceil(turn.width * intervals / TURN)).astype(np.int64)
    cell = np.repeat(np.arange(len(parts)), parts)
    place = (np.arange(len(cell)) - np.repeat(np.cumsum(parts) - parts, parts)) / parts[cell]
    phi = np.append(turn.passed[cell] + place * turn.width[cell], TURN)
    angle = turn.start % TURN + turn.way * phi
    inside = np.append(angle[:-1], angle[0])
    after, before = law.acceleration_at(inside), law.acceleration_at(inside, before=True)
    time, speed = np.concatenate([[0.0], law.time_at(inside[1:-1]), [law.period]]), law.speed_at(inside)
    steps = np.abs(after - before) > _STEP * float(np.abs(after).max())
    first, last = np.arange(len(phi)) == 0, np.arange(len(phi)) == len(phi) - 1
    double = np.repeat(np.arange(len(phi)), np.where(steps & ~first & ~last, 2, 1))
    repeated = np.concatenate([double[1:] == double[:-1], [False]]) | last[double]
    return CamTable(time[double], angle[double], speed[double], np.where(repeated, before[double], after[double]))
