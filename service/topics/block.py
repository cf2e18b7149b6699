"""Sentences and tables of an analysis, as data."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Block:
    """A sentence, or a table where there are rows.

    heading: whether the sentence heads what follows. heads: of the columns, empty ones where they have none. right:
    whether a column is aligned to the right, as numbers are. rows: the texts of the cells.
    """

    sentence: str = ""
    heading: bool = False
    heads: tuple[str, ...] = ()
    right: tuple[bool, ...] = ()
    rows: tuple[tuple[str, ...], ...] = ()
