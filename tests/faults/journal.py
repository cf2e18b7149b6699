"""Notes of workers outside the store: lines that outlive a kill, to be compared with the store."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

What = Literal["evaluated", "wrote", "refused", "failed"]


@dataclass(frozen=True)
class Note:
    """A note of a worker. evaluated: round `number`; wrote: write `number` is committed; refused: lease lost.

    failed: a transaction that the database did not take, of whichever job; the numbers are 0.
    """

    what: What
    job: int
    fence: int
    number: int


class Journal:
    """A file that many processes append to; a line is in it whole or not at all."""

    def __init__(self, file: Path) -> None:
        """Open it."""
        self._descriptor = os.open(file, os.O_CREAT | os.O_APPEND | os.O_WRONLY, 0o666)

    def note(self, what: What, job: int, fence: int, number: int) -> None:
        """Add a line."""
        os.write(self._descriptor, f"{what} {job} {fence} {number}\n".encode())


def notes(file: Path) -> list[Note]:
    """Return the lines of a journal, in the order in which they were written."""
    lines = (line.split() for line in file.read_text().splitlines()) if file.exists() else iter(())
    return [Note(what, int(job), int(fence), int(number)) for what, job, fence, number in lines]  # type: ignore[arg-type]
