"""Start of a swing, for designs that choose it."""

from __future__ import annotations

from dataclasses import dataclass

from ..checks import require_numbers


@dataclass(frozen=True, kw_only=True)
class Start:
    """Start of a swing: crank angle, rad, or slider position, m. None keeps the start stated for the swing itself."""

    angle: float | None = None
    place: float | None = None

    def __post_init__(self) -> None:
        require_numbers(self, "angle", "place", phrase="the {} at which a swing starts")
