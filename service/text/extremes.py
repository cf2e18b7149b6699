"""Least and greatest value of curves, and where, as a table for people."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from ..designs.columns import split_unit
from .tables import print_table, table

if TYPE_CHECKING:
    from rich.console import Console

WORDS = ("least", "greatest")


def show_extremes(console: Console, title: str, curves: Mapping[str, Mapping[str, Any]]) -> None:
    """Write a line for each curve of a record: its extremes, each with crank angle and slider position."""
    console.print(title, style="bold", soft_wrap=True)
    unit = next((unit for entry in curves.values() for _, unit in [_place(entry, "least")]), "mm")
    heads = ("curve", ">least", ">at,\ndeg", f">slider,\n{unit}", ">greatest", ">at,\ndeg", f">slider,\n{unit}", "unit")
    rows = table(*heads, ruled=True)
    for entry in curves.values():
        rows.add_row(*extremes_line(entry))
    print_table(console, rows)


def extremes_line(entry: Mapping[str, Any]) -> list[str]:
    """Return the cells of a curve: title, both extremes with value, crank angle and place, unit."""
    return [str(entry["title"]), *(cell for word in WORDS for cell in _cells(entry, word)), _value(entry, "least")[1]]


def _cells(entry: Mapping[str, Any], word: str) -> Iterator[str]:
    value, _ = _value(entry, word)
    yield "undefined" if value is None else f"{value:.6g}"
    for place in (entry[f"{word}_at_crank_angle_deg"], _place(entry, word)[0]):
        yield "" if place is None or value is None else f"{round(place, 2) + 0.0:.2f}"


def _value(entry: Mapping[str, Any], word: str) -> tuple[Any, str]:
    key = next(key for key in entry if split_unit(key)[0] == word)
    return entry[key], split_unit(key)[1]


def _place(entry: Mapping[str, Any], word: str) -> tuple[Any, str]:
    key = next(key for key in entry if key.startswith(f"{word}_at_slider_position_"))
    return entry[key], split_unit(key)[1]
