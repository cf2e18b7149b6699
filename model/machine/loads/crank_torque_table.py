"""A torque on the crank tabulated over the crank angle."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, ClassVar

from .angle_table import AngleTable
from .load import ANGLE_DATUM, CYCLE, Entry, Passage, Table, increasing_points_entry, load_builder
from .load_text import TURNS, effect_by_direction, force_magnitude_text


@dataclass(frozen=True, kw_only=True)
class CrankTorqueTable(AngleTable):
    """A torque on the crank tabulated over the crank angle, interpolated linearly and periodically.

    forces: torques, N m, positive counter-clockwise. The other fields are those of `AngleTable`; it acts throughout the
    cycle.
    """

    on_crank: ClassVar = True
    tabulated: ClassVar = ("torques", "N m")

    def numbers_for_kernel(self) -> tuple[float, float, float, float]:
        """Return unit factors for both strokes."""
        return (1.0, 1.0, 0.0, 0.0)

    def turn_work_by_key(self, *, moving: bool) -> Mapping[Hashable, tuple[float, ...]]:
        """Return the work between knots, which cancels if the mean torque is zero."""
        angles, torques = self.knots()
        pairs = zip(pairwise(angles), pairwise(torques), strict=True)
        return {CrankTorqueTable: tuple(0.5 * (b - a) * (first + second) for (a, b), (first, second) in pairs)}

    def stroke_work(self, passage: Passage) -> Any:
        """Return zero, because it loads neither stroke."""
        return 0.0

    @property
    def magnitude_text(self) -> str:
        """The minimum and maximum torque."""
        return f"{force_magnitude_text(self.forces, 'N m', TURNS)} on the crank"

    @property
    def effect_text(self) -> str:
        """Effect on rotation in either direction."""
        return effect_by_direction(self.forces, TURNS, "rotation")


CrankTorqueTable.tables = (
    Table(
        "torque_angles",
        "CrankTorqueTableLoad",
        "table of torques on the crank over the crank angle",
        "A torque on the crank tabulated over the crank angle: linear between the points, periodic; two points at "
        "one angle form a step.",
        (
            increasing_points_entry(
                "torque_angles", "Angle", "increasing crank angles within one cycle", "0 deg", "90 deg"
            ),
            Entry(
                "torques",
                "Torque",
                "torque on the crank at each point, positive counter-clockwise",
                ["-20 N m", "0 N m"],
                several=True,
            ),
            ANGLE_DATUM,
            CYCLE,
        ),
        {"torque_angles": ["0 deg", "180 deg"], "torques": ["0 N m", "-20 N m"]},
        load_builder(CrankTorqueTable, torque_angles="angles", torques="forces", measured_from="datum"),
    ),
)
