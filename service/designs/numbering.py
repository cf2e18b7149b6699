"""Designs of a run by their numbers, counted from 1."""

from __future__ import annotations

from ...model.errors import InputError
from ..runs.result import Result


def require_alone(design: int, result: Result, run: str, *, others: bool) -> None:
    """Raise `InputError` for a number that the run does not have, and for one given with another way of choosing."""
    if others:
        raise InputError("a design is chosen in one way; got --design and another; keep one of them")
    if not 1 <= design <= len(result.designs):
        count = len(result.designs)
        raise InputError(f"the run has designs 1 to {count}; got {design}; see slidercrank front {run}")
