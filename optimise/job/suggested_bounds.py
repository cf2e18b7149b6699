"""Bounds that people probably mean by a value alone, such as `stroke = 180` or `stroke = ">= 60 mm"`."""

import re
from typing import Any

from ...objectives.kinds import RATIO, Kind
from ...objectives.units import number_and_unit, plus_minus_ends

_FORMS = {
    "min": re.compile(r"\s*(?:>=?|=>|≥|at least\b|min(?:imum)?\b)[\s:=]*(.+)", re.IGNORECASE | re.DOTALL),
    "max": re.compile(r"\s*(?:<=?|=<|≤|at most\b|max(?:imum)?\b)[\s:=]*(.+)", re.IGNORECASE | re.DOTALL),
    "equals": re.compile(r"\s*(?:==?|equals?\b|exactly\b)[\s:=]*(.+)", re.IGNORECASE | re.DOTALL),
}


def suggested_bounds(value: str | float, kind: Kind | None) -> list[dict[str, Any]]:
    """Return the tables of bounds that a value may mean, likeliest first.

    A plain number gets the unit that its size suggests: 180 is "180 mm" as a stroke, and 0.18 is "0.18 m". kind: kind
    of the quantity, None if unknown.
    """
    kind = kind or RATIO
    if isinstance(value, str):
        for word, form in _FORMS.items():
            if match := form.fullmatch(value):
                return [{word: _with_unit(match[1].strip(), kind)}]
    words = ("equals",) if plus_minus_ends(value) else ("equals", "min", "max")
    return [{word: _with_unit(value, kind)} for word in words]


def _with_unit(value: str | float, kind: Kind) -> str | float:
    """Return a number with its unit, or unchanged if it has none; other text stays unchanged."""
    parts = number_and_unit(str(value))
    if parts is None or parts[1]:
        return value
    if not kind.unit or kind.amount:
        return float(value) if isinstance(value, str) else value
    usual = kind.unit if kind.is_plausible(float(parts[0])) else kind.metric.symbol
    return f"{parts[0]} {usual}"
