"""Distances along the slider line from a dead centre, for what is asked of the slider and its guide."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from ..checks import require_numbers
from .loads.load import require_word

DeadCentre = Literal["outer", "inner"]


@dataclass(frozen=True, kw_only=True)
class SliderDistances:
    """Where the slider meets its work, m before a dead centre, and how near to it, m, it counts as at rest.

    guide: m from the slider pin at its outer dead centre, outward, to the centre of the guide, which the frame holds.
    """

    dead_centre: DeadCentre = "outer"
    touch: float | None = None
    dwell: float | None = None
    guide: float | None = None

    def __post_init__(self) -> None:
        require_word("dead_centre", self.dead_centre, DeadCentre)
        require_numbers(self, "touch", "dwell", what="the {} distance of the slider", above=0.0, unit="m")
        require_numbers(self, "guide", what="the {} distance of the slider")

    @property
    def text(self) -> str:
        """The distances that are given, to follow the slider's mass; empty without any."""
        given = {
            f"meets its work {{}} before the {self.dead_centre} dead centre": self.touch,
            f"dwells within {{}} of the {self.dead_centre} dead centre": self.dwell,
            "guide centre {} outward of the outer dead centre": self.guide,
        }
        found = ((words, distance) for words, distance in given.items() if distance is not None)
        return "".join(f", {words.format(f'{1e3 * distance:.6g} mm')}" for words, distance in found)
