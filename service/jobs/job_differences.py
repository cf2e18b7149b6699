"""Differences of jobs, place by place."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

_LEFT_OUT = ("name", "description")


def differences(jobs: Sequence[Mapping[str, Any]]) -> list[tuple[str, tuple[str | None, ...]]]:
    """Return the places where the tables of jobs differ, such as "load.1.force", with the value in each job.

    The value is None if a job has nothing there. Names and descriptions are omitted.
    """
    flat = [dict(_leaves(job, "")) for job in jobs]
    places = dict.fromkeys(place for leaves in flat for place in leaves)
    rows = [(place, tuple(leaves.get(place) for leaves in flat)) for place in places]
    return [(place, values) for place, values in rows if place not in _LEFT_OUT and len(set(values)) > 1]


def _leaves(value: Any, place: str) -> list[tuple[str, str]]:
    """Return the values within a table, each with its place. Lists of tables count from 1; ranges are "a to b"."""
    if isinstance(value, Mapping):
        return [leaf for key, part in value.items() for leaf in _leaves(part, f"{place}.{key}" if place else str(key))]
    if isinstance(value, list | tuple) and any(isinstance(part, Mapping) for part in value):
        return [leaf for number, part in enumerate(value, 1) for leaf in _leaves(part, f"{place}.{number}")]
    if isinstance(value, list | tuple):
        return [(place, (" to " if len(value) == 2 else ", ").join(map(_text, value)))]
    return [(place, _text(value))]


def _text(value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:.12g}" if isinstance(value, float) else str(value)
