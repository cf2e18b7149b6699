"""A force tabulated over the crank angle."""

from __future__ import annotations

import math
from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from ...checks import keep_tuples
from ...errors import InputError
from .cylinder import PRESSURES, Head, piston_forces
from .load import (
    ANGLE_DATUM,
    DURING,
    FORCES,
    AngleDatum,
    During,
    Enters,
    Entry,
    Load,
    Passage,
    Table,
    require_table,
    require_word,
)

_ROUNDING = 1e-9  # rad


@dataclass(frozen=True, kw_only=True)
class AngleTable(Load):
    """A force tabulated over crank angle, interpolated linearly and periodically.

    angles: increasing, rad, spanning less than one turn (the first point follows the last one a turn later).
    forces: N, positive outward. during: the force acts in these strokes. datum: what the angles are counted from: zero,
    counter-clockwise, or a dead centre, in the sense in which the crank turns.
    """

    angles: tuple[float, ...]
    forces: tuple[float, ...]
    during: During = "cycle"
    datum: AngleDatum = "zero crank angle"

    enters: ClassVar = Enters.ANGLE_TABLE

    def __post_init__(self) -> None:
        keep_tuples(self, "angles", "forces")
        require_table("angles", self.angles, self.forces)
        require_word("during", self.during, During)
        require_word("datum", self.datum, AngleDatum)
        span = self.angles[-1] - self.angles[0]
        if span >= 2.0 * math.pi:
            raise InputError(
                f"angles of a periodic table must span less than 360 deg; got {math.degrees(span):.6g} deg; "
                + self._instead(span)
            )

    def _instead(self, span: float) -> str:
        """Return the remedy for a table of a turn or more."""
        if span > 2.0 * math.pi + _ROUNDING:
            return "a cycle of more than a turn, such as that of four strokes, is not covered; give one turn"
        if self.forces[0] == self.forces[-1]:
            return "leave out the last point, which repeats the first"
        return (
            "its last point is the first one a turn later, with another value, so that the table does not close; "
            "correct one of the two and leave out the last"
        )

    def numbers(self) -> tuple[float, float, float, float]:
        """Return factors of one in the strokes in which the force acts."""
        return (float(self.during != "inward stroke"), float(self.during != "outward stroke"), 0.0, 0.0)

    def knots(self) -> tuple[Sequence[float], Sequence[float]]:
        """Return angles and forces, closed: the first knot comes again one turn later."""
        return (*self.angles, self.angles[0] + 2.0 * math.pi), (*self.forces, self.forces[0])

    @property
    def turns(self) -> bool:
        """Whether the angles are counted from a dead centre."""
        return self.datum != "zero crank angle"

    def turn_work(self, *, moving: bool) -> Mapping[Hashable, tuple[float, ...]]:
        """Return one, unless the force is the same all over the cycle."""
        constant = set(self.forces) == {0.0} or (self.during == "cycle" and len(set(self.forces)) == 1)
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
        return passage.work(np.interp(angle, self.angles, self.forces, period=2.0 * math.pi))

    @property
    def text(self) -> str:
        """The size of the table."""
        datum = f" from the {self.datum}" if self.turns else ""
        return f"table of {len(self.angles)} crank angles{datum}, {self.during}"


def _built(
    crank_angles: tuple[float, ...], forces: tuple[float, ...], measured_from: AngleDatum, during: During
) -> AngleTable:
    return AngleTable(angles=crank_angles, forces=forces, datum=measured_from, during=during)


def _of_pressures(pressure_angles: tuple[float, ...], head: Head, during: During, **pressures: Any) -> AngleTable:
    forces = piston_forces(pressure_angles, head=head, **pressures)
    return AngleTable(angles=pressure_angles, forces=forces, datum=head, during=during)


AngleTable.tables = (
    Table(
        "crank_angles",
        "AngleLoad",
        "table of forces over the crank angle",
        "A force tabulated over the crank angle: linear between the points, periodic.",
        (
            Entry(
                "crank_angles",
                "Angle",
                "crank angles, increasing, spanning less than 360 deg",
                ["0 deg", "90 deg"],
                several=True,
                increasing=True,
            ),
            FORCES,
            ANGLE_DATUM,
            DURING,
        ),
        {"crank_angles": ["0 deg", "180 deg"], "forces": ["0 N", "-100 N"]},
        _built,
    ),
    Table(
        "pressure_angles",
        "PressureAngleLoad",
        "table of pressures over the crank angle",
        "Pressure in a cylinder over the crank angle: linear between the points, periodic; pressures are absolute.",
        (
            Entry(
                "pressure_angles",
                "Angle",
                "crank angles from the dead centre at the head, in the sense of rotation, increasing, spanning less "
                "than 360 deg",
                ["0 deg", "90 deg"],
                several=True,
                increasing=True,
            ),
            *PRESSURES,
            DURING,
        ),
        {"pressure_angles": ["0 deg", "180 deg"], "bore": "70 mm", "pressures": ["8 bar", "1 bar"]},
        _of_pressures,
    ),
)
