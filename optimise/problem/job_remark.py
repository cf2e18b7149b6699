"""Sentences about a job with the change to the job that resolves them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Change:
    """A change to a job. path: key in its tables, such as "load #1.force". label: its effect, as an instruction.

    value: new value at the key, as a job file writes it; None removes the key.
    """

    path: str
    value: Any
    label: str


class Remark(str):
    """A sentence about a job, and the change that resolves it."""

    change: Change | None

    def __new__(cls, sentence: str, change: Change | None = None) -> Remark:
        """Return a sentence with its change."""
        remark = super().__new__(cls, sentence)
        remark.change = change
        return remark


def changes_of(sentences: Iterable[str]) -> list[dict[str, Any]]:
    """Return the changes that resolve sentences, each with its sentence, path, value and label."""
    remarks = [sentence for sentence in sentences if isinstance(sentence, Remark)]
    return [{"sentence": str(remark), **vars(remark.change)} for remark in remarks if remark.change is not None]
