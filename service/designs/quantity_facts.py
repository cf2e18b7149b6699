"""Facts about dimensions and quantities, for forms and agents: meaning, formula, unit, source."""

from typing import Any

from ...objectives.kinds import LENGTH
from ...objectives.quantity import MECHANICS, Group, Quantity

_STATED = ("name", "title", "sentence", "advice", "formula", "section", "source", "picture", "better", "allowed_by")
"""Facts about a quantity that are passed on unchanged."""


def facts_of_all_quantities() -> list[dict[str, Any]]:
    """Return the facts about the dimensions and about every quantity, in display order."""
    from ...objectives.registry import FACTS

    return [*map(_dimension_record, _DIMENSIONS), *map(_quantity_record, FACTS.values())]


def _quantity_record(quantity: Quantity) -> dict[str, Any]:
    return {
        **{fact: getattr(quantity, fact) for fact in _STATED},
        "needs": quantity.job_requirements_text,
        "offered": list(quantity.offered),
        "column": quantity.field,
        "unit": quantity.unit.symbol,
        "kind": quantity.kind.name_without_article,
        "group": quantity.group.value,
        "motion": _required_motion(quantity),
    }


def _required_motion(quantity: Quantity) -> str:
    from ...objectives.lever_quantity import LeverQuantity

    if isinstance(quantity, LeverQuantity):
        words = {"cylinder": "lever", "turning crank": "arm"}
        return ", ".join(words[driver] for driver in quantity.moved_by if driver in words)
    return "swing" if quantity.table == "motion" else "turn" if quantity.turning else ""


_LENGTH: dict[str, Any] = {
    **{
        "unit": LENGTH.metric.symbol,
        "kind": LENGTH.name_without_article,
        "group": Group.DIMENSIONS.value,
        "source": MECHANICS,
    },
    **{"better": "", "allowed_by": "", "needs": "", "offered": [], "motion": ""},
}
"""Facts that all dimensions share."""


def _dimension_record(name: str) -> dict[str, Any]:
    texts: dict[str, Any] = dict(zip(_TEXT_FIELDS, _DIMENSIONS[name], strict=True))
    return {"name": name, "picture": name, "column": name + LENGTH.metric.suffix, **texts, **_LENGTH}


_TEXT_FIELDS = ("title", "section", "sentence", "advice", "formula")
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
        "A long rod transmits force well and moves smoothly; a short one is lighter and more compact.",
        "l; the crank rotates fully if l > r + |e|",
    ),
    "offset": (
        "offset",
        "1. Notation and signs",
        "The offset e is the distance of the slider line from the crank pivot, positive to the left of the outward "
        "direction (on the crossed branch, to its right); with it, the crank covers a larger angle in one stroke "
        "than in the other.",
        "The greater the offset, the higher the time ratio at constant speed and the smaller the transmission angle.",
        "e; the slider line is y = e",
    ),
}
"""Facts about each dimension: `_TEXT_FIELDS`."""
