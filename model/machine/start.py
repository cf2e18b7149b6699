"""Where a swing starts, for a start that designs choose."""

from __future__ import annotations

from dataclasses import dataclass

from ..checks import require_numbers


@dataclass(frozen=True, kw_only=True)
class Start:
    """Start of a swing: of the crank, rad, or of the slider, m. None where it is that of the swing itself."""

    angle: float | None = None
    place: float | None = None

    def __post_init__(self) -> None:
        require_numbers(self, "angle", "place", phrase="the {} at which a swing starts")
