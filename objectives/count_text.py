"""Counts in messages, with their noun in the singular or plural."""

from __future__ import annotations


def count_with_noun(count: int, noun: str) -> str:
    """Return a count with its noun: "1 design", "20 designs". The plural ends in s."""
    return f"{count} {noun}{'' if count == 1 else 's'}"
