"""Every quantity as it is explained: the dimensions, then those of designs and of wanted motions."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from ...objectives.kinds import LENGTH
from ...objectives.quantity import MECHANICS, Group, Quantity
from ...objectives.registry import FACTS


@dataclass(frozen=True, kw_only=True)
class Explained:
    """The explanation of a dimension or a quantity; the facts are those of `Quantity`.

    column: its key in tables and JSON. unit: as shown, "" for a ratio. kind: of value, "length". better: usual
    direction, "" where it is no objective. offered: parts of a form that ask for it.
    """

    name: str
    column: str
    title: str
    unit: str
    kind: str
    group: str
    sentence: str
    advice: str
    formula: str
    section: str
    source: str
    picture: str
    better: str = ""
    offered: tuple[str, ...] = ()


def explained() -> Iterator[Explained]:
    """Yield the dimensions, then all quantities in the order of the registry, then those of wanted motions."""
    yield from _dimensions()
    yield from map(_of, FACTS.values())


_SHARED = ("name", "title", "sentence", "advice", "formula", "section", "source", "picture", "better", "offered")
"""Facts that a quantity states as they are explained."""


def _of(quantity: Quantity) -> Explained:
    return Explained(
        **{fact: getattr(quantity, fact) for fact in _SHARED},
        column=quantity.field,
        unit=quantity.unit.symbol,
        kind=quantity.kind.plain,
        group=quantity.group.value,
    )


def _dimensions() -> Iterator[Explained]:
    for name, (title, section, sentence, advice, formula) in _DIMENSIONS.items():
        yield Explained(
            name=name,
            column=name + LENGTH.metric.suffix,
            title=title,
            unit=LENGTH.metric.symbol,
            kind=LENGTH.plain,
            group=Group.DIMENSIONS.value,
            sentence=sentence,
            advice=advice,
            formula=formula,
            section=section,
            source=MECHANICS,
            picture=name,
        )


_DIMENSIONS = {
    "crank": (
        "crank",
        "2. Closed forms",
        "The crank is the link that the motor turns; its length r runs from the crank pivot to the crank pin.",
        "It sets the stroke, which is twice the crank without offset and a little more with one.",
        "r; from a stroke S: r^2 = S^2 (l^2 - e^2 - S^2/4) / (4 l^2 - S^2)",
    ),
    "rod": (
        "connecting rod",
        "2. Closed forms",
        "The connecting rod joins crank pin and slider pin; its length l runs between the two pin centres.",
        "A long rod transmits force well and moves evenly; a short one is lighter and more compact.",
        "l; the crank turns fully if l > r + |e|",
    ),
    "offset": (
        "offset",
        "1. Notation and signs",
        "The offset e is the distance of the slider line from the crank pivot, positive to the left of the outward "
        "direction, on the crossed branch to its right; it makes one stroke slower than the other.",
        "The more offset, the higher the time ratio, and the smaller the transmission angle.",
        "e; the slider line is y = e",
    ),
}
"""Title, section of the theory, sentence, advice and formula."""
