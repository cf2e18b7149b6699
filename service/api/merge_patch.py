"""Changes to a JSON value as JSON (RFC 7396)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any


def merged(value: Any, changes: Any) -> Any:
    """Return a value with changes applied: tables key by key; null removes a key; anything else replaces the value."""
    if not isinstance(changes, Mapping):
        return changes
    kept = dict(value) if isinstance(value, Mapping) else {}
    for key, change in changes.items():
        if change is None:
            kept.pop(key, None)
        else:
            kept[key] = merged(kept.get(key), change)
    return kept
