"""Every quantity with its explanation: those of designs, of wanted motions, and the dimensions themselves."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from .forces import FORCES
from .geometry import GEOMETRY
from .text import Text

TEXTS: dict[str, Text] = {text.name: text for text in (*GEOMETRY, *FORCES)}
"""By the name of the quantity."""

_DIMENSIONS = (("crank", "crank"), ("rod", "connecting rod"), ("offset", "offset"))


@dataclass(frozen=True)
class Explained:
    """A quantity and its text. column: its key in tables and JSON. unit: as shown, "" for a ratio."""

    column: str
    title: str
    unit: str
    text: Text


def explained() -> Iterator[Explained]:
    """Yield the dimensions, then all quantities in the order of the registry, then those of wanted motions."""
    from ...objectives.motion_deviation import DEVIATIONS
    from ...objectives.registry import QUANTITIES

    for name, title in _DIMENSIONS:
        yield Explained(f"{name}_mm", title, "mm", TEXTS[name])
    for quantity in QUANTITIES.values():
        yield Explained(quantity.field, quantity.title, quantity.unit.symbol, TEXTS[quantity.name])
    for name, (title, _) in DEVIATIONS.items():
        yield Explained(f"{name}_mm", title, "mm", TEXTS[name])
