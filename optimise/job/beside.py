"""Files beside a job file that it names."""

from __future__ import annotations

import csv
import math
from collections.abc import Sequence
from pathlib import Path, PurePath

from ...model.errors import JobError
from ...model.file_names import path_from_text
from ...objectives.units import shown

MOST_POINTS = 1000
"""Points of a curve over the crank angle, in a job or in a file."""
_LARGEST = 1_000_000  # bytes


def beside(folder: Path, key: str, file: str) -> tuple[Path, str]:
    """Return the path of a file that a job names under a key, and what messages begin with. Raises `JobError`."""
    if PurePath(file).is_absolute() or ".." in PurePath(file).parts:
        raise JobError(f"{key}: must lie beside the job file; got {shown(file)}; copy it there")
    return folder / path_from_text(file), f"{key}: {shown(file)}"


def require_few_points(count: int, name: str, of: str = "") -> None:
    """Raise `JobError` for more points than a job takes. name: of the file, for messages. of: what has the points."""
    if count > MOST_POINTS:
        raise JobError(
            f"{name} must have at most {MOST_POINTS:,} points{of}; got {count:,}; thin it out: keep one line in "
            f"{math.ceil(count / MOST_POINTS)}, and the last one"
        )


def table_of(path: Path, name: str, headers: Sequence[tuple[str, ...]]) -> tuple[tuple[str, ...], list[list[str]]]:
    """Return the first line of a file of comma-separated values, one of some, and the lines below. Raises `JobError`.

    name: of the file, for messages.
    """
    try:
        if path.stat().st_size > _LARGEST:
            raise JobError(f"{name} must have at most 1 MB; is it the right file?")
        with path.open(newline="", encoding="utf-8-sig") as file:
            header, *lines = [[cell.strip() for cell in line] for line in csv.reader(file, strict=True) if line] or [[]]
    except OSError as error:
        raise JobError(f"{name} cannot be read: {error.strerror}; put it beside the job file") from None
    except (csv.Error, UnicodeDecodeError) as error:
        raise JobError(f"{name} must be a CSV file, text with commas; got: {error}; save it as CSV") from None
    if tuple(header) not in headers:
        choice = " or ".join(",".join(one) for one in headers)
        raise JobError(f"{name} must begin with the line {choice}; got {shown(','.join(header))}")
    return tuple(header), lines
