"""Tables of a job before validation: missing tables, and values of another type, count as empty."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any


def table_in(tables: Mapping[str, Any], name: str) -> Mapping[Any, Any]:
    """Return the table under a key; keys in it that are not text raise an error later."""
    table = tables.get(name)
    return table if isinstance(table, Mapping) else {}


def tables_in(tables: Mapping[str, Any], name: str) -> list[Mapping[str, Any]]:
    """Return the tables in the list under a key."""
    parts = tables.get(name)
    return [part for part in parts if isinstance(part, Mapping)] if isinstance(parts, list | tuple) else []


def options_in(tables: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    """Return the options of all choices in a job."""
    return [option for choice in tables_in(tables, "choice") for option in tables_in(choice, "option")]
