"""A force tabulated over the crank angle."""

from __future__ import annotations

import math
from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np

from ...arrays import Array
from ...checks import store_as_tuples
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
    has_step,
    increasing_points_entry,
    load_builder,
    require_valid_table,
    require_word,
)
from .load_text import SLIDES, effect_by_direction, force_magnitude_text, range_of_angles, without_end_zeros_at_steps

_ROUNDING = 1e-9  # rad
_TURN = 2.0 * math.pi


@dataclass(frozen=True, kw_only=True)
class AngleTable(Load):
    """A force tabulated over the crank angle, interpolated linearly and periodically.

    angles: increasing, with two equal ones where the force steps, rad. The first point follows the last one a cycle
    later. If the last point is exactly a cycle after the first, it gives the force before a step at the first point.
    forces: N, positive outward.
    during: strokes in which the force acts. datum: origin of the angles: zero, counted counter-clockwise, or a dead
    centre, counted in the sense of rotation. cycle: one turn or two. turn: 0, or the only one of two turns in which the
    load acts (`two_turns`). drives: see `Load`.
    """

    angles: tuple[float, ...]
    forces: tuple[float, ...]
    during: During = "cycle"
    datum: AngleDatum = "zero crank angle"
    cycle: CycleAngle = "360 deg"
    turn: int = 0
    may_drive: bool = False

    enters: ClassVar = Enters.ANGLE_TABLE
    sizes: ClassVar = ("forces",)
    tabulated: ClassVar = ("forces", "N")

    def __post_init__(self) -> None:
        store_as_tuples(self, "angles", "forces")
        require_valid_table("angles", self.angles, self.forces, values=self.tabulated[0])
        require_word("during", self.during, During)
        require_word("datum", self.datum, AngleDatum)
        require_word("cycle", self.cycle, CycleAngle)
        span = self.angles[-1] - self.angles[0]
        if span > self._period + _ROUNDING:
            two_turns = self.cycle == "720 deg" or span > 2.0 * _TURN + _ROUNDING
            raise InputError(
                f"angles of a periodic table must span at most {self.cycle}; got {math.degrees(span):.6g} deg; "
                + ("give at most two turns" if two_turns else 'for a cycle of two turns, set cycle = "720 deg"')
            )
        if self._is_closed and (self.angles[1] == self.angles[0] or self.angles[-2] == self.angles[-1]):
            raise InputError(
                "a periodic table may have at most two points at one angle, and its first angle recurs "
                f"{self.cycle} later; got three points there, from {math.degrees(self.angles[0]):.6g} deg to "
                f"{math.degrees(self.angles[-1]):.6g} deg; keep only the forces before and after the step"
            )

    @property
    def _is_closed(self) -> bool:
        """Whether the last point is the first one a cycle later."""
        return self.angles[-1] - self.angles[0] >= self._period - _ROUNDING

    @property
    def _period(self) -> float:
        return 2.0 * _TURN if self.cycle == "720 deg" else _TURN

    @property
    def cycle_turns(self) -> int:
        """Two for a cycle of 720 deg, unless the table belongs to one of its turns."""
        return 2 if self.cycle == "720 deg" and not self.turn else 1

    def load_on_turn(self, turn: int) -> Load:
        """Return the table of turn 1 or 2 alone, or itself if all turns are alike."""
        return replace(self, turn=turn) if self.cycle_turns > 1 else self

    def numbers_for_kernel(self) -> tuple[float, float, float, float]:
        """Return unit factors for the strokes in which the force acts."""
        return (float(self.during != "inward stroke"), float(self.during != "outward stroke"), 0.0, 0.0)

    def knots(self) -> tuple[Sequence[float], Sequence[float]]:
        """Return angles and forces, closed: the first knot repeats a cycle later.

        A table for one of two turns has both ends.
        """
        inner = len(self.angles) - self._is_closed
        at = (*self.angles[:inner], self.angles[0] + self._period)
        forces = (*self.forces[:inner], self.forces[-1 if self._is_closed else 0])
        return self._knots_of_turn(np.array(at), np.array(forces)) if self.turn else (at, forces)

    def _knots_of_turn(self, at: Array, forces: Array) -> tuple[Sequence[float], Sequence[float]]:
        """Return the knots for one of two turns, from 0 to a turn, with the interior forces at its ends."""
        begin = _TURN * (self.turn - 1)
        shift = self._period * math.floor((begin - at[0]) / self._period) - begin
        if forces[-1] == forces[0]:
            at, forces = at[:-1], forces[:-1]
        else:  # both sides of the step at the seam, exactly at one angle
            at, forces = np.r_[at[0], at[:-1]], np.r_[forces[-1], forces[:-1]]
        at = np.concatenate([at + (shift + n * self._period) for n in (-1, 0, 1, 2)])  # even if one turn has no knot
        forces = np.tile(forces, 4)
        is_inner = (at > _ROUNDING) & (at < _TURN - _ROUNDING)
        low, high = (int(np.searchsorted(at, end)) for end in (_ROUNDING, _TURN - _ROUNDING))
        first = forces[low - 1] if at[low - 1] >= -_ROUNDING else np.interp(0.0, at, forces)
        last = forces[high] if at[high] <= _TURN + _ROUNDING else np.interp(_TURN, at, forces)
        return [0.0, *at[is_inner].tolist(), _TURN], [float(first), *forces[is_inner].tolist(), float(last)]

    def _force_at(self, angle: Any) -> Any:
        at, forces = replace(self, turn=0).knots()
        return np.interp(at[0] + np.mod(angle - at[0], self._period), at, forces)

    @property
    def has_steps(self) -> bool:
        """Whether the force steps at any angle."""
        return has_step(self.angles) or (self._is_closed and self.forces[-1] != self.forces[0])

    @property
    def has_knots_in_sense_of_rotation(self) -> bool:
        """Whether the angles are counted from a dead centre."""
        return self.datum != "zero crank angle"

    def turn_work_by_key(self, *, moving: bool) -> Mapping[Hashable, tuple[float, ...]]:
        """Return one, unless the force is constant over the cycle."""
        forces = set(self.knots()[1])
        constant = forces == {0.0} or (self.during == "cycle" and len(forces) == 1)
        return {} if constant else {AngleTable: (1.0,)}

    def work_deciding_loaded_stroke(self, passage: Passage) -> Any:
        """Return the work in the strokes in which the force acts."""
        if self.during == ("inward stroke" if passage.outward else "outward stroke"):
            return 0.0
        angle = passage.angle
        if self.has_knots_in_sense_of_rotation:
            step = angle[:, 1:2] - angle[:, :1]
            starts = (self.datum == "inner dead centre") == passage.outward
            angle = np.sign(step) * (angle - (angle[:, :1] - 0.5 * step if starts else angle[:, -1:] + 0.5 * step))
        if self.cycle_turns > 1:  # work per turn, averaged over both
            return 0.5 * passage.work_of_force(self._force_at(angle) + self._force_at(angle + _TURN))
        return passage.work_of_force(self._force_at(angle))

    @property
    def magnitude_text(self) -> str:
        """The minimum and maximum force."""
        return force_magnitude_text(without_end_zeros_at_steps(self.angles, self.forces))

    @property
    def possible_stroke_forces(self) -> tuple[Sequence[float], Sequence[float]] | None:
        """The forces in the stroke in which they act; None over the whole cycle, as angles do not identify strokes."""
        if self.during == "cycle":
            return None
        return (self.forces, (0.0,)) if self.during == "outward stroke" else ((0.0,), self.forces)

    @property
    def effect_text(self) -> str:
        """Effect on its stroke or, over the whole cycle, on motion in either direction."""
        return (
            effect_by_direction(self.forces, SLIDES, "motion")
            if self.possible_stroke_forces is None
            else super().effect_text
        )

    @property
    def range_text(self) -> str:
        """The ends of the table, and its cycle."""
        return range_of_angles(self.angles, self.datum, self.cycle)


def _table_of_pressures(
    pressure_angles: tuple[float, ...], head: Head, cycle: CycleAngle, during: During, **pressures: Any
) -> AngleTable:
    forces = piston_forces(pressure_angles, head=head, **pressures)
    return AngleTable(angles=pressure_angles, forces=forces, datum=head, cycle=cycle, during=during, may_drive=True)


AngleTable.tables = (
    Table(
        "crank_angles",
        "AngleLoad",
        "table of forces over the crank angle",
        "A force tabulated over the crank angle: linear between the points, periodic; two points at one angle form "
        "a step.",
        (
            increasing_points_entry(
                "crank_angles", "Angle", "increasing crank angles within one cycle", "0 deg", "90 deg"
            ),
            FORCES,
            ANGLE_DATUM,
            CYCLE,
            DURING,
        ),
        {"crank_angles": ["0 deg", "180 deg"], "forces": ["0 N", "-100 N"]},
        load_builder(AngleTable, crank_angles="angles", measured_from="datum"),
    ),
    Table(
        "pressure_angles",
        "PressureAngleLoad",
        "table of pressures over the crank angle",
        "Pressure in a cylinder over the crank angle: linear between the points, periodic; two points at one angle "
        "form a step; pressures are absolute.",
        (
            increasing_points_entry(
                "pressure_angles",
                "Angle",
                "increasing crank angles from the dead centre at the head, in the direction of rotation, "
                "within one cycle",
                "0 deg",
                "90 deg",
            ),
            *PRESSURES,
            CYCLE,
            DURING,
        ),
        {"pressure_angles": ["0 deg", "180 deg"], "bore": "70 mm", "pressures": ["8 bar", "1 bar"]},
        _table_of_pressures,
        motion="turn",
    ),
)
