"""Table with the minimum and maximum of curves and their positions."""

from collections.abc import Iterator, Mapping
from typing import Any

from ...objectives.kinds import ANGLE, LENGTH, name_and_kind_of_key
from .blocks import Table, Text, Unit, column, value_from_record

_PLACES = (column("at", ANGLE), column("slider", LENGTH))


def extremes_table(curves: Mapping[str, Mapping[str, Any]]) -> Table:
    """Return a line for each curve of a metric record: both extremes, each with crank angle and slider position."""
    columns = (column("curve", left=True), column("least"), *_PLACES, column("greatest"), *_PLACES)
    rows = tuple(
        (entry["title"], *_extreme_cells(entry, "least"), *_extreme_cells(entry, "greatest"))
        for entry in curves.values()
    )
    units = (Unit(name_and_kind_of_key(_position_key(entry, "least"))[1]) for entry in curves.values())
    lines = tuple((*row, unit) for row, unit in zip(rows, units, strict=True))
    return Table((*columns, column("unit", left=True)), lines, ruled=True)


def _extreme_cells(entry: Mapping[str, Any], word: str) -> Iterator[Text]:
    value = value_from_record(entry, _position_key(entry, word))
    yield value
    for place in ("crank_angle_deg", "slider_position_mm"):
        at = value_from_record(entry, f"{word}_at_{place}", decimals=2, missing="")
        yield "" if value.number is None else at


def _position_key(entry: Mapping[str, Any], word: str) -> str:
    return next(key for key in entry if name_and_kind_of_key(key)[0] == word)
