"""Material and pins of the crank and the rod, for judging their strength."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from ..checks import require_numbers
from ..errors import InputError
from .loads.load import require_word

Criterion = Literal["goodman", "soderberg"]


@dataclass(frozen=True, kw_only=True)
class Material:
    """Material of the crank and the rod, SI.

    endurance: fully reversed strength of the finished bar, with all corrections except stress concentration in the eyes
    (Shigley eq. 6-18). bearing_pressure: allowable pressure at the pins, on the projected area.
    """

    density: float
    elasticity: float
    yield_strength: float
    ultimate_strength: float
    endurance: float
    bearing_pressure: float

    def __post_init__(self) -> None:
        for name in self.__dataclass_fields__:
            value = getattr(self, name)
            if not math.isfinite(value) or value <= 0.0:
                raise InputError(f"a material's {name.replace('_', ' ')} must be positive and finite; got {value:g}")
        if not self.endurance <= self.yield_strength <= self.ultimate_strength:
            raise InputError(
                "a material must have endurance strength <= yield strength <= ultimate strength; got "
                f"{1e-6 * self.endurance:g}, {1e-6 * self.yield_strength:g} and {1e-6 * self.ultimate_strength:g} "
                "MPa; swap them if they were interchanged, or use the lower value for both"
            )


@dataclass(frozen=True, kw_only=True)
class Strength:
    """Material of a machine's bars, and its pins.

    crank_pivot, crank_pin, slider_pin: diameters of the pins, m. eye_concentration: maximum stress divided by mean
    stress in the net section of an eye. criterion: fatigue criterion for mean stresses. wear_coefficient: worn volume
    divided by force and sliding distance, m^2/N (Archard); None if unknown.
    """

    material: Material
    crank_pivot: float
    crank_pin: float
    slider_pin: float
    eye_concentration: float = 1.0
    criterion: Criterion = "goodman"
    wear_coefficient: float | None = None

    def __post_init__(self) -> None:
        names = ("crank_pivot", "crank_pin", "slider_pin")
        require_numbers(self, *names, phrase="the diameter of the {}", above=0.0, unit="m")
        require_numbers(self, "eye_concentration", phrase="{}", least=1.0)
        require_numbers(self, "wear_coefficient", phrase="the {}", above=0.0, unit="m^2/N")
        require_word("criterion", self.criterion, Criterion)

    @property
    def mean_stress_reference_strength(self) -> float:
        """Reference strength for mean stresses: ultimate (Goodman) or yield (Soderberg), Pa."""
        return self.material.ultimate_strength if self.criterion == "goodman" else self.material.yield_strength
