"""Limits on sections: safety factors, pins, available sizes."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

from ...model.errors import InputError


def _require_at_least(subject: str, name: str, value: float, least: float = 0.0) -> None:
    if not math.isfinite(value) or value <= least:
        raise InputError(f"{subject} must have a finite {name} above {least:g}; got {value:g}")


@dataclass(frozen=True, kw_only=True)
class SectionLimits:
    """Safety factors, pins and available sections, SI.

    crank_pivot, crank_pin, slider_pin: pin diameters, m. width, depth: least and greatest, m. criterion: fatigue
    criterion. eye_concentration: ratio of greatest to mean stress in the net section of an eye. The default factors are
    customary for known loads and materials; set your own.
    """

    crank_pivot: float
    crank_pin: float
    slider_pin: float
    width: tuple[float, float] = (5e-3, 0.2)
    depth: tuple[float, float] = (3e-3, 0.1)
    static_safety: float = 2.0
    fatigue_safety: float = 1.5
    buckling_safety: float = 3.0
    criterion: str = "goodman"
    eye_concentration: float = 1.0

    def __post_init__(self) -> None:
        for name in ("crank_pivot", "crank_pin", "slider_pin"):
            _require_at_least("a pin", f"diameter ({name})", getattr(self, name))
        for name in (item.name for item in fields(self) if item.name.endswith("_safety")):
            if not 1.0 <= getattr(self, name) < math.inf:
                raise InputError(f"{name} must be at least 1 and finite; got {getattr(self, name):g}")
        for name in ("width", "depth"):
            low, high = getattr(self, name)
            if not 0.0 < low < high < math.inf:
                raise InputError(f"the {name} must have 0 < least < greatest, both finite; got {low:g} to {high:g} m")
        if not 1.0 <= self.eye_concentration < math.inf:
            raise InputError(f"eye_concentration must be at least 1 and finite; got {self.eye_concentration:g}")
        if self.criterion not in ("goodman", "soderberg"):
            raise InputError(f"the fatigue criterion must be 'goodman' or 'soderberg'; got {self.criterion!r}")
