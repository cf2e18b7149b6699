"""A force tabulated over the crank angle."""

from __future__ import annotations

import math
from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np

from ...checks import keep_tuples
from ...errors import InputError
from .cylinder import PRESSURES, Head, piston_forces
from .load import (
    ANGLE_DATUM,
    CYCLE,
    DURING,
    FORCES,
    AngleDatum,
    CycleAngle,
    During,
    Enters,
    Load,
    Passage,
    Table,
    built,
    points,
    require_table,
    require_word,
)

_ROUNDING = 1e-9  # rad
_TURN = 2.0 * math.pi


@dataclass(frozen=True, kw_only=True)
class AngleTable(Load):
    """A force tabulated over crank angle, interpolated linearly and periodically.

    angles: increasing, rad, spanning less than the cycle (the first point follows the last one a cycle later).
    forces: N, positive outward. during: the force acts in these strokes. datum: what the angles are counted from: zero,
    counter-clockwise, or a dead centre, in the sense in which the crank turns. cycle: one turn or two. turn: 0, or the
    one of the two turns that the load is of (`two_turns`).
    """

    angles: tuple[float, ...]
    forces: tuple[float, ...]
    during: During = "cycle"
    datum: AngleDatum = "zero crank angle"
    cycle: CycleAngle = "360 deg"
    turn: int = 0

    enters: ClassVar = Enters.ANGLE_TABLE
    tabulated: ClassVar = ("forces", "N")

    def __post_init__(self) -> None:
        keep_tuples(self, "angles", "forces")
        require_table("angles", self.angles, self.forces, of=self.tabulated[0])
        require_word("during", self.during, During)
        require_word("datum", self.datum, AngleDatum)
        require_word("cycle", self.cycle, CycleAngle)
        span = self.angles[-1] - self.angles[0]
        if span >= self._period:
            raise InputError(
                f"angles of a periodic table must span less than {self.cycle}; got {math.degrees(span):.6g} deg; "
                + self._instead(span)
            )

    def _instead(self, span: float) -> str:
        """Return the remedy for a table of a cycle or more."""
        if span > self._period + _ROUNDING:
            more = self.cycle == "720 deg" or span > 2.0 * _TURN + _ROUNDING
            return "give two turns at most" if more else 'for a cycle of two turns give cycle = "720 deg"'
        if self.forces[0] == self.forces[-1]:
            return "leave out the last point, which repeats the first"
        unit = self.tabulated[1]
        return (
            f"its last point is the first one {self.cycle} later, with another value, {self.forces[-1]:.6g} {unit} "
            f"after {self.forces[0]:.6g} {unit}, so that the table does not close; correct one of the two and leave "
            "out the last"
        )

    @property
    def _period(self) -> float:
        return 2.0 * _TURN if self.cycle == "720 deg" else _TURN

    @property
    def cycle_turns(self) -> int:
        """Two for a cycle of 720 deg, unless the table is of one of its turns."""
        return 2 if self.cycle == "720 deg" and not self.turn else 1

    def on_turn(self, turn: int) -> Load:
        """Return the table of turn 1 or 2 alone, which need not close; itself where every turn is the same."""
        return replace(self, turn=turn) if self.cycle_turns > 1 else self

    def numbers(self) -> tuple[float, float, float, float]:
        """Return factors of one in the strokes in which the force acts."""
        return (float(self.during != "inward stroke"), float(self.during != "outward stroke"), 0.0, 0.0)

    def knots(self) -> tuple[Sequence[float], Sequence[float]]:
        """Return angles and forces, closed: the first knot comes again a cycle later. Of one turn both its ends."""
        if self.turn:
            begin = _TURN * (self.turn - 1)
            inside = np.mod(np.subtract(self.angles, begin), self._period)
            kept = np.sort(inside[(inside > _ROUNDING) & (inside < _TURN - _ROUNDING)])
            at = np.concatenate([[0.0], kept, [_TURN]])
            return at.tolist(), self._force(at + begin).tolist()
        return (*self.angles, self.angles[0] + self._period), (*self.forces, self.forces[0])

    def _force(self, angle: Any) -> Any:
        return np.interp(angle, self.angles, self.forces, period=self._period)

    @property
    def turns(self) -> bool:
        """Whether the angles are counted from a dead centre."""
        return self.datum != "zero crank angle"

    def turn_work(self, *, moving: bool) -> Mapping[Hashable, tuple[float, ...]]:
        """Return one, unless the force is the same all over the cycle."""
        forces = set(self.knots()[1])
        constant = forces == {0.0} or (self.during == "cycle" and len(forces) == 1)
        return {} if constant else {AngleTable: (1.0,)}

    def stroke_work(self, passage: Passage) -> Any:
        """Return the work in the strokes in which the force acts."""
        if self.during == ("inward stroke" if passage.outward else "outward stroke"):
            return 0.0
        angle = passage.angle
        if self.turns:
            step = angle[:, 1:2] - angle[:, :1]
            starts = (self.datum == "inner dead centre") == passage.outward
            angle = np.sign(step) * (angle - (angle[:, :1] - 0.5 * step if starts else angle[:, -1:] + 0.5 * step))
        if self.cycle_turns > 1:  # of a turn, the mean of both
            return 0.5 * passage.work(self._force(angle) + self._force(angle + _TURN))
        return passage.work(self._force(angle))

    @property
    def text(self) -> str:
        """The size of the table."""
        datum = f" from the {self.datum}" if self.turns else ""
        during = f"cycle of {self.cycle}" if self.cycle_turns > 1 and self.during == "cycle" else self.during
        return f"table of {len(self.angles)} crank angles{datum}, {during}"


def _of_pressures(
    pressure_angles: tuple[float, ...], head: Head, cycle: CycleAngle, during: During, **pressures: Any
) -> AngleTable:
    forces, given = piston_forces(pressure_angles, head=head, **pressures), pressures["pressures"]
    period = 2.0 * _TURN if cycle == "720 deg" else _TURN
    if abs(pressure_angles[-1] - pressure_angles[0] - period) <= _ROUNDING and given[0] != given[-1]:
        raise InputError(
            f"pressures must come back to the first one after {cycle}; got {1e-5 * given[-1]:.6g} bar at the end and "
            f"{1e-5 * given[0]:.6g} bar at the start; correct one of the two and leave out the last point"
        )
    return AngleTable(angles=pressure_angles, forces=forces, datum=head, cycle=cycle, during=during)


AngleTable.tables = (
    Table(
        "crank_angles",
        "AngleLoad",
        "table of forces over the crank angle",
        "A force tabulated over the crank angle: linear between the points, periodic.",
        (
            points(
                "crank_angles", "Angle", "crank angles, increasing, spanning less than the cycle", "0 deg", "90 deg"
            ),
            FORCES,
            ANGLE_DATUM,
            CYCLE,
            DURING,
        ),
        {"crank_angles": ["0 deg", "180 deg"], "forces": ["0 N", "-100 N"]},
        built(AngleTable, crank_angles="angles", measured_from="datum"),
    ),
    Table(
        "pressure_angles",
        "PressureAngleLoad",
        "table of pressures over the crank angle",
        "Pressure in a cylinder over the crank angle: linear between the points, periodic; pressures are absolute.",
        (
            points(
                "pressure_angles",
                "Angle",
                "crank angles from the dead centre at the head, in the sense of rotation, increasing, spanning less "
                "than the cycle",
                "0 deg",
                "90 deg",
            ),
            *PRESSURES,
            CYCLE,
            DURING,
        ),
        {"pressure_angles": ["0 deg", "180 deg"], "bore": "70 mm", "pressures": ["8 bar", "1 bar"]},
        _of_pressures,
        motion="turn",
    ),
)
