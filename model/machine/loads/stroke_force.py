"""A force that is constant within each stroke."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

from ...checks import require_numbers
from ...errors import InputError
from .load import DURING, During, Enters, Entry, Load, Passage, StrokePart, Table
from .load_text import force_magnitude_text
from .position_table import PositionTable


@dataclass(frozen=True, kw_only=True)
class StrokeForce(Load):
    """A force that is constant within each stroke, N, positive outward.

    Equal values make a constant force; `outward=-F, inward=0` resists the outward stroke only;
    `outward=-F, inward=F` always opposes the motion (Coulomb, of given magnitude). drives: see `Load`.
    """

    outward: float
    inward: float
    may_drive: bool = False

    enters: ClassVar = Enters.STROKE_FORCE
    sizes: ClassVar = ("outward", "inward")
    slots: ClassVar = {"outward": (0, "N"), "inward": (1, "N")}

    def __post_init__(self) -> None:
        require_numbers(self, "outward", "inward")

    def numbers_for_kernel(self) -> tuple[float, float, float, float]:
        """Return the forces in the two strokes."""
        return (self.outward, self.inward, 0.0, 0.0)

    @property
    def is_conservative(self) -> bool:
        """Whether both strokes have the same force."""
        return self.outward == self.inward

    def turn_work_by_key(self, *, moving: bool) -> Mapping[Hashable, tuple[float, ...]]:
        """Return the force in the outward stroke and the negated force in the inward stroke."""
        return {StrokeForce: (self.outward, -self.inward)}

    def work_deciding_loaded_stroke(self, passage: Passage) -> Any:
        """Return the force times the stroke."""
        return passage.work_of_force(self.outward if passage.outward else self.inward)

    @property
    def magnitude_text(self) -> str:
        """The forces, without direction if they are equal along the motion."""
        if self.outward == -self.inward:
            return f"{abs(self.outward):.6g} N"
        forces = {force: force_magnitude_text((force,)) for force in (self.outward, self.inward) if force}
        return " on the outward and ".join(forces.values()) + (" on the inward stroke" if len(forces) > 1 else "")

    @property
    def possible_stroke_forces(self) -> tuple[Sequence[float], Sequence[float]]:
        """Both forces."""
        return (self.outward,), (self.inward,)

    @property
    def range_text(self) -> str:
        """The whole of a stroke."""
        return "throughout"


def _force_along_motion(force: float, stroke: str, part: StrokePart, *, drives: bool = False) -> Load:
    """Return a load with a force along the motion, N, in all or part of a stroke.

    stroke: "motion" for both strokes.
    """
    outward = 0.0 if stroke == "inward stroke" else force
    inward = 0.0 if stroke == "outward stroke" else -force
    if part.part == "whole":
        return StrokeForce(outward=outward, inward=inward, may_drive=drives)
    if stroke == "motion":
        raise InputError(
            f"a load on the {part.part} part of a stroke must name one stroke; got motion, which means both; name "
            "the outward or the inward stroke, with a separate load for each"
        )
    from_outer = (stroke == "outward stroke") == (part.part == "last")
    size = outward + inward
    return PositionTable(
        positions=(0.0, part.length, part.length),
        forces=(size, size, 0.0),
        datum="outer dead centre" if from_outer else "inner dead centre",
        during="outward stroke" if stroke == "outward stroke" else "inward stroke",
        may_drive=drives,
    )


def _opposing_force(force: float, direction: str, during: During) -> StrokeForce:
    signed = force if direction == "outward" else -force
    return StrokeForce(
        outward=0.0 if during == "inward stroke" else signed,
        inward=0.0 if during == "outward stroke" else signed,
    )


_SIZE = Entry("force", "Resistance", "its size", "200 N")
_STROKES = ("outward stroke", "inward stroke", "motion")
_OVER = Entry(
    "over",
    "StrokePart",
    'the part of the stroke on which it acts: "first" or "last" and a length; the whole stroke if left out',
    "last 60 mm",
    default="whole stroke",
)
StrokeForce.tables = (
    Table(
        "opposes",
        "OpposingForce",
        "force against a stroke or the motion",
        "A force of constant size that resists a stroke, part of a stroke or every motion (Coulomb friction of "
        "known size).",
        (_SIZE, Entry("opposes", _STROKES, "what it resists", "outward stroke"), _OVER),
        {"force": "100 N", "opposes": "outward stroke"},
        lambda force, opposes, over: _force_along_motion(-force, opposes, over),
    ),
    Table(
        "helps",
        "HelpingForce",
        "force along a stroke or the motion",
        "A force of constant size that helps a stroke, part of a stroke or every motion.",
        (_SIZE, Entry("helps", _STROKES, "what it helps", "inward stroke"), _OVER),
        {"force": "100 N", "helps": "inward stroke"},
        lambda force, helps, over: _force_along_motion(force, helps, over, drives=True),
    ),
    Table(
        "direction",
        "DirectedForce",
        "force in one direction",
        "A force of constant size and direction, throughout or during one stroke.",
        (
            _SIZE,
            Entry(
                "direction",
                ("outward", "inward"),
                "direction in which it pushes the slider; outward is away from the crank pivot",
                "inward",
            ),
            DURING,
        ),
        {"force": "100 N", "direction": "inward"},
        _opposing_force,
    ),
)
