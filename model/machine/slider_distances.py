"""Distances of the slider from a dead centre, for what is asked of it there."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from ..checks import require_numbers
from .loads.load import require_word

DeadCentre = Literal["outer", "inner"]


@dataclass(frozen=True, kw_only=True)
class SliderDistances:
    """Where the slider meets its work, m before a dead centre, and how near to it, m, it counts as at rest."""

    dead_centre: DeadCentre = "outer"
    touch: float | None = None
    dwell: float | None = None

    def __post_init__(self) -> None:
        require_word("dead_centre", self.dead_centre, DeadCentre)
        require_numbers(self, "touch", "dwell", what="the {} distance of the slider", above=0.0, unit="m")

    @property
    def text(self) -> str:
        """The distances that are given, to follow the slider's mass; empty without any."""
        given = {"meets its work {} before": self.touch, "dwells within {} of": self.dwell}
        return "".join(
            f", {words.format(f'{1e3 * distance:.6g} mm')} the {self.dead_centre} dead centre"
            for words, distance in given.items()
            if distance is not None
        )
