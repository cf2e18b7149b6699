"""Distances along the slider line from a dead centre, for quantities of the slider and its guide."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from ..checks import require_numbers
from .loads.load import require_word

DeadCentre = Literal["outer", "inner"]


@dataclass(frozen=True, kw_only=True)
class SliderDistances:
    """Distances of the slider from a dead centre, m.

    touch: distance at which it meets its work. dwell: distance within which it counts as at rest. guide: outward
    distance from the slider pin at its outer dead centre to the centre of the guide, which is fixed to the frame.
    """

    dead_centre: DeadCentre = "outer"
    touch: float | None = None
    dwell: float | None = None
    guide: float | None = None

    def __post_init__(self) -> None:
        require_word("dead_centre", self.dead_centre, DeadCentre)
        require_numbers(self, "touch", "dwell", phrase="the {} distance of the slider", above=0.0, unit="m")
        require_numbers(self, "guide", phrase="the {} distance of the slider")

    @property
    def text(self) -> str:
        """The stated distances, as text after the slider's mass; empty if there are none."""
        distances = {
            f"meets its work {{}} before the {self.dead_centre} dead centre": self.touch,
            f"dwells within {{}} of the {self.dead_centre} dead centre": self.dwell,
            "guide centre {} outward from the outer dead centre": self.guide,
        }
        stated = ((words, distance) for words, distance in distances.items() if distance is not None)
        return "".join(f", {words.format(f'{1e3 * distance:.6g} mm')}" for words, distance in stated)
