"""Cam table of a motion law: master time, crank angle, speed and acceleration, for a drive that interpolates.

Between two points the crank angle is the polynomial of degree 5 in time that matches the angles, speeds and
accelerations at both. Where a load steps, so does the acceleration. Two points then have the same time, angle and
speed, the first with the acceleration before the step, the second with the acceleration after it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..transient.crank_equation import TURN
from .motion_law import MotionLaw

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


def cam_table(law: MotionLaw, intervals: int = POINTS) -> CamTable:
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
