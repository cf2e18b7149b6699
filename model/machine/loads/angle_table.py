"""A force tabulated over the crank angle."""

from __future__ import annotations

import math
from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from ...checks import keep_tuples
from ...errors import InputError
from .load import DURING, FORCES, During, Enters, Entry, Load, Passage, Table, require_table, require_word


@dataclass(frozen=True, kw_only=True)
class AngleTable(Load):
    """A force tabulated over crank angle, interpolated linearly and periodically.

    angles: increasing, rad, spanning less than one turn (the first point follows the last one a turn later).
    forces: N, positive outward. during: the force acts in these strokes.
    """

    angles: tuple[float, ...]
    forces: tuple[float, ...]
    during: During = "cycle"

    enters: ClassVar = Enters.ANGLE_TABLE

    def __post_init__(self) -> None:
        keep_tuples(self, "angles", "forces")
        require_table("angles", self.angles, self.forces)
        require_word("during", self.during, During)
        span = self.angles[-1] - self.angles[0]
        if span >= 2.0 * math.pi:
            raise InputError(
                f"angles of a periodic table must span less than 360 deg; got {math.degrees(span):g} deg; "
                "leave out the last point, which repeats the first"
            )

    def numbers(self) -> tuple[float, float, float, float]:
        """Return factors of one in the strokes in which the force acts."""
        return (float(self.during != "inward stroke"), float(self.during != "outward stroke"), 0.0, 0.0)

    def knots(self) -> tuple[Sequence[float], Sequence[float]]:
        """Return angles and forces, closed: the first knot comes again one turn later."""
        return (*self.angles, self.angles[0] + 2.0 * math.pi), (*self.forces, self.forces[0])

    def turn_work(self, *, moving: bool) -> Mapping[Hashable, tuple[float, ...]]:
        """Return one, unless the force is the same all over the cycle."""
        constant = set(self.forces) == {0.0} or (self.during == "cycle" and len(set(self.forces)) == 1)
        return {} if constant else {AngleTable: (1.0,)}

    def stroke_work(self, passage: Passage) -> Any:
        """Return the work in the strokes in which the force acts."""
        if self.during == ("inward stroke" if passage.outward else "outward stroke"):
            return 0.0
        return passage.work(np.interp(passage.angle, self.angles, self.forces, period=2.0 * math.pi))

    @property
    def text(self) -> str:
        """The size of the table."""
        return f"table of {len(self.angles)} crank angles, {self.during}"


def _built(crank_angles: tuple[float, ...], forces: tuple[float, ...], during: During) -> AngleTable:
    return AngleTable(angles=crank_angles, forces=forces, during=during)


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
            DURING,
        ),
        {"crank_angles": ["0 deg", "180 deg"], "forces": ["0 N", "-100 N"]},
        _built,
    ),
)
