"""Sentences on a job with the change of the job that settles them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Change:
    """A change of a job. path: key in its tables, such as "load #1.force". label: what it does, as an instruction.

    value: new value at the key, as a job file writes it; None removes the key.
    """

    path: str
    value: Any
    label: str


class Remark(str):
    """A sentence on a job, and the change that settles it."""

    change: Change | None

    def __new__(cls, sentence: str, change: Change | None = None) -> Remark:
        """Return a sentence with its change."""
        remark = super().__new__(cls, sentence)
        remark.change = change
        return remark


def changes_of(sentences: Iterable[str]) -> list[dict[str, Any]]:
    """Return the changes that settle some sentences, each with its sentence, path, value and label."""
    remarks = [sentence for sentence in sentences if isinstance(sentence, Remark)]
    return [{"sentence": str(remark), **vars(remark.change)} for remark in remarks if remark.change is not None]
