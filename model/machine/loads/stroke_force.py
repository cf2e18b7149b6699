"""A force that is constant within each stroke."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from ...checks import require_numbers
from .load import DURING, During, Enters, Entry, Load, Passage, Table


@dataclass(frozen=True, kw_only=True)
class StrokeForce(Load):
    """A force that is constant within each stroke, N, positive outward.

    Equal values make a constant force; `outward=-F, inward=0` resists the outward stroke only;
    `outward=-F, inward=F` always opposes the motion (Coulomb, of given size).
    """

    outward: float
    inward: float

    enters: ClassVar = Enters.STROKE_FORCE
    sizes: ClassVar = ("outward", "inward")
    slots: ClassVar = {"outward": (0, "N"), "inward": (1, "N")}

    def __post_init__(self) -> None:
        require_numbers(self, "outward", "inward")

    def numbers(self) -> tuple[float, float, float, float]:
        """Return the forces in the two strokes."""
        return (self.outward, self.inward, 0.0, 0.0)

    @property
    def by_position(self) -> bool:
        """Whether the two strokes have one force."""
        return self.outward == self.inward

    def turn_work(self, *, moving: bool) -> Mapping[Hashable, tuple[float, ...]]:
        """Return the two forces, against each other."""
        return {StrokeForce: (self.outward, -self.inward)}

    def stroke_work(self, passage: Passage) -> Any:
        """Return force times stroke."""
        return passage.work(self.outward if passage.outward else self.inward)

    @property
    def text(self) -> str:
        """The forces."""
        if self.outward == self.inward:
            return f"{self.outward:.6g} N, positive outward"
        return f"{self.outward:.6g} N in the outward and {self.inward:.6g} N in the inward stroke, positive outward"


def _opposing(force: float, opposes: str) -> StrokeForce:
    return StrokeForce(
        outward=0.0 if opposes == "inward stroke" else -force,
        inward=0.0 if opposes == "outward stroke" else force,
    )


def _directed(force: float, direction: str, during: During) -> StrokeForce:
    signed = force if direction == "outward" else -force
    return StrokeForce(
        outward=0.0 if during == "inward stroke" else signed,
        inward=0.0 if during == "outward stroke" else signed,
    )


_SIZE = Entry("force", "Resistance", "its size", "200 N")
StrokeForce.tables = (
    Table(
        "opposes",
        "OpposingForce",
        "force against a stroke or the motion",
        "A force of constant size that opposes a stroke, or every motion (Coulomb friction of known size).",
        (_SIZE, Entry("opposes", ("outward stroke", "inward stroke", "motion"), "what it resists", "outward stroke")),
        {"force": "100 N", "opposes": "outward stroke"},
        _opposing,
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
                "where it pushes the slider: outward is away from the crank pivot",
                "inward",
            ),
            DURING,
        ),
        {"force": "100 N", "direction": "inward"},
        _directed,
    ),
)
