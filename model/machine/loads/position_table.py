"""A force tabulated over the slider position."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from ...checks import store_as_tuples
from ...errors import InputError
from .cylinder import PRESSURES, Head, piston_forces
from .load import (
    DATUM,
    DURING,
    FORCES,
    Datum,
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
from .load_text import force_magnitude_text, range_of_positions, without_end_zeros_at_steps


@dataclass(frozen=True, kw_only=True)
class PositionTable(Load):
    """A force tabulated over the slider position, interpolated linearly, constant beyond the ends of the table.

    positions: increasing, with two equal ones where the force steps, m, from the datum; distances from a dead centre
    are zero or more. forces: N, positive outward. during: strokes in which the force acts. drives: see `Load`.
    """

    positions: tuple[float, ...]
    forces: tuple[float, ...]
    datum: Datum = "crank pivot"
    during: During = "cycle"
    may_drive: bool = False

    enters: ClassVar = Enters.POSITION_TABLE
    sizes: ClassVar = ("forces",)

    def __post_init__(self) -> None:
        store_as_tuples(self, "positions", "forces")
        require_valid_table("positions", self.positions, self.forces)
        require_word("datum", self.datum, Datum)
        require_word("during", self.during, During)
        if self.datum != "crank pivot" and self.positions[-1] <= 0.0:
            ends = f"{1e3 * self.positions[0]:g} mm to {1e3 * self.positions[-1]:g} mm"
            raise InputError(
                f"positions from the {self.datum} are distances and must be zero or more; got {ends}, so that only "
                "the last force would ever act; reverse the signs"
            )

    def numbers_for_kernel(self) -> tuple[float, float, float, float]:
        """Return unit factors for the strokes in which the force acts."""
        return (float(self.during != "inward stroke"), float(self.during != "outward stroke"), 0.0, 0.0)

    def knots(self) -> tuple[Sequence[float], Sequence[float]]:
        """Return positions and forces."""
        return self.positions, self.forces

    @property
    def has_steps(self) -> bool:
        """Whether the force steps at any position."""
        return has_step(self.positions)

    @property
    def is_conservative(self) -> bool:
        """Whether the force acts in both strokes."""
        return self.during == "cycle"

    def turn_work_by_key(self, *, moving: bool) -> Mapping[Hashable, tuple[float, ...]]:
        """Return 1 or -1 for a table in one stroke; the same table in the other stroke cancels it."""
        if self.during == "cycle":
            return {}
        return {(self.datum, self.positions, self.forces): (1.0 if self.during == "outward stroke" else -1.0,)}

    def work_deciding_loaded_stroke(self, passage: Passage) -> Any:
        """Return the work of a table in one stroke; a table over the whole cycle returns what it absorbs."""
        if self.during != ("outward stroke" if passage.outward else "inward stroke"):
            return 0.0
        at, distance = 0.5 * (passage.distance[:, 1:] + passage.distance[:, :-1]), passage.distance
        if self.datum == "inner dead centre":
            at = at - distance.min(axis=1, keepdims=True)
        elif self.datum == "outer dead centre":
            at = distance.max(axis=1, keepdims=True) - at
        return passage.work_of_force(np.interp(at, self.positions, self.forces))

    @property
    def magnitude_text(self) -> str:
        """The minimum and maximum force."""
        return force_magnitude_text(without_end_zeros_at_steps(self.positions, self.forces))

    @property
    def possible_stroke_forces(self) -> tuple[Sequence[float], Sequence[float]]:
        """The forces in the strokes in which they act."""
        outward, inward = self.numbers_for_kernel()[:2]
        return [outward * force for force in self.forces], [inward * force for force in self.forces]

    @property
    def range_text(self) -> str:
        """The ends of the table, and the force beyond them."""
        return range_of_positions(self.positions, self.forces, self.datum, self.during)


def _table_of_pressures(
    pressure_positions: tuple[float, ...], head: Head, during: During, **pressures: Any
) -> PositionTable:
    forces = piston_forces(pressure_positions, head=head, **pressures)
    return PositionTable(positions=pressure_positions, forces=forces, datum=head, during=during, may_drive=True)


PositionTable.tables = (
    Table(
        "positions",
        "PositionLoad",
        "table of forces over the slider position",
        "A force tabulated over the slider position: linear between the points, constant beyond them; two points "
        "at one position form a step.",
        (
            increasing_points_entry("positions", "Length", "slider positions, increasing", "0 mm", "20 mm"),
            FORCES,
            DATUM,
            DURING,
        ),
        {"positions": ["0 mm", "50 mm"], "forces": ["0 N", "-100 N"], "measured_from": "inner dead centre"},
        load_builder(PositionTable, measured_from="datum"),
    ),
    Table(
        "pressure_positions",
        "PressurePositionLoad",
        "table of pressures over the slider position",
        "Pressure in a cylinder over the piston's distance from its top: linear between the points, constant "
        "beyond; two points at one distance form a step.",
        (
            increasing_points_entry(
                "pressure_positions",
                "Length",
                "increasing distances of the piston from its top, the dead centre at the head",
                "0 mm",
                "20 mm",
            ),
            *PRESSURES,
            DURING,
        ),
        {"pressure_positions": ["0 mm", "50 mm"], "bore": "70 mm", "pressures": ["8 bar", "1 bar"]},
        _table_of_pressures,
        motion="turn",
    ),
)
