"""A catalogue as a table: the options of a choice in a CSV file, screened before anything is solved.

Each row is an option: its name, numbers of the job that come with it, and limits. Of two rows with the same numbers and
with limits of the first nowhere tighter than those of the second, every design that meets the second's limits meets the
first's too, and is judged by the same objectives. So the front of all rows is that of the first without the second: a
row is left out where another one beats it in every limit. Limits that are equalities compare with equal ones alone, and
so do greatest values of quantities whose floor depends on them (see `violation.constraints_of`).
"""

from __future__ import annotations

import csv
import io
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ...model.errors import JobError
from ...model.linkage.values import DIMENSIONS
from ...objectives.units import shown
from .beside import beside
from .catalogue_columns import Column, columns_of
from .messages import key_of
from .paths import unknown_path, with_number

LARGEST = 10_000_000
"""Bytes of a file."""
MOST_ROWS = 50_000
MOST_OPTIONS = 200
"""Rows that may be left after screening: each is solved."""
_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,3})?", re.ASCII)
_THOUSANDS = re.compile(r"[+-]?\d{1,3}(,\d{3})+", re.ASCII)
_FORMULA = ("=", "+", "@")
_LONGEST = 60


def catalogues(data: Mapping[str, Any]) -> list[str]:
    """Return the files that choices of a job name."""
    choices = data.get("choice")
    parts = choices if isinstance(choices, list | tuple) else ()
    return [part["file"] for part in parts if isinstance(part, Mapping) and isinstance(part.get("file"), str)]


def with_catalogues(data: Mapping[str, Any], folder: Path) -> dict[str, Any]:
    """Return a job with the options of its catalogues, found in `folder`, in place of the files. Raises JobError."""
    job = dict(data)
    if catalogues(data):
        own = data.get("quantity")
        names = frozenset(own) if isinstance(own, Mapping) else frozenset()
        job["choice"] = [_filled(part, place, folder, names, data) for place, part in enumerate(job["choice"])]
    return job


def _filled(part: Any, place: int, folder: Path, own: frozenset[str], tables: Mapping[str, Any]) -> Any:
    file = part.get("file") if isinstance(part, Mapping) else None
    if not isinstance(file, str) or "option" in part:  # the model refuses both
        return part
    path, name = beside(folder, key_of(["choice", place, "file"]), file)
    options, rows = options_of(_text(path, name), name, own, tables)
    return {name: value for name, value in part.items() if name != "file"} | {"option": options, "rows": rows}


def _text(path: Path, name: str) -> str:
    try:
        if path.is_dir():
            raise JobError(f"{name} must be a file; got a folder; name a file in it")
        if not path.is_file():
            raise JobError(f"{name} must be a file; got none of that name; put it beside the job file")
        size = path.stat().st_size
        if size > LARGEST:
            raise JobError(
                f"{name} must have at most {LARGEST // 1_000_000} MB; got {size / 1e6:.3g} MB; keep the rows "
                "and columns that matter"
            )
        return path.read_bytes().decode("utf-8-sig")
    except OSError as error:
        raise JobError(f"{name} cannot be read: {error.strerror}; put it beside the job file") from None
    except UnicodeDecodeError:
        raise JobError(f"{name} must be UTF-8 text; got other bytes; save it as CSV in UTF-8") from None


def options_of(
    text: str, name: str, own: frozenset[str] = frozenset(), tables: Mapping[str, Any] | None = None
) -> tuple[list[dict[str, Any]], int]:
    """Return the options of a catalogue's text that no other one beats, and how many rows it has.

    name: of the file, for messages. own: names of the job's own quantities. tables: of the job, which give the numbers
    that columns set. Raises JobError, naming row, column and remedy.
    """
    lines = _lines(text, name)
    first = next(lines, None)
    if first is None:
        raise JobError(f"{name} must begin with a line that names its columns; got an empty file; fill it")
    columns = columns_of(first[1], name, own)
    if tables is not None:
        _require_given(columns, name, tables)
    labels: dict[str, int] = {}
    rows: list[list[str]] = []
    for number, cells in lines:
        where = f"{name}, row {number}"
        if len(cells) != len(first[1]):
            raise JobError(f"{where} must have {len(first[1])} cells, as the first line; got {len(cells)}; correct it")
        label = cells[0]
        if not label or label.startswith(_FORMULA) or len(label) > _LONGEST or not label.isprintable():
            raise JobError(
                f"{where}, column name: must be a name of 1 to {_LONGEST} characters on one line, none of = + @ first; "
                f"got {shown(label)}; write it out"
            )
        if label in labels:
            raise JobError(
                f"{where}, column name: names must differ; got {shown(label)} of row {labels[label]} again; rename one"
            )
        labels[label] = number
        for column in columns:
            _require_number(cells[column.place], f"{where}, column {shown(column.header)}")
        rows.append(cells)
        if len(rows) > MOST_ROWS:
            raise JobError(f"{name} must have at most {MOST_ROWS} rows; got more; keep those that you would buy")
    if not rows:
        raise JobError(f"{name} must have a row below the names of its columns; got none; add it")
    kept = _unbeaten(columns, rows)
    if len(kept) > MOST_OPTIONS:
        raise JobError(
            f"{name} must have at most {MOST_OPTIONS} rows that no other one beats in everything; got {len(kept)} of "
            f"{len(rows)}; leave out rows that you would not buy, or columns that do not matter"
        )
    return [_option(columns, rows[place]) for place in kept], len(rows)


def _lines(text: str, name: str) -> Iterator[tuple[int, list[str]]]:
    """Yield number and cells of every line that is not empty; commas, semicolons or tabs stand between cells."""
    if "\0" in text:
        raise JobError(f"{name} must be text; got a byte 0 in it; save it as CSV in UTF-8")
    head = text[: text.find("\n")] if "\n" in text else text
    reader = csv.reader(io.StringIO(text, newline=""), strict=True, delimiter=max(",;\t", key=head.count))
    try:
        for cells in reader:
            if any(cell.strip() for cell in cells):
                yield reader.line_num, [cell.strip() for cell in cells]
    except csv.Error as error:
        raise JobError(f"{name}, row {reader.line_num}: must be a line of CSV; got: {error}; save it as CSV") from None


def _require_given(columns: Sequence[Column], name: str, tables: Mapping[str, Any]) -> None:
    """Refuse a column that sets a number which the job does not give."""
    for column in columns:
        if column.word is None and column.name not in DIMENSIONS:
            try:
                with_number(tables, column.name, 0.0)
            except LookupError:
                raise JobError(f"{name}, column {shown(column.header)}: {unknown_path(column.name, tables)}") from None


def _require_number(cell: str, where: str) -> None:
    if _NUMBER.fullmatch(cell) and math.isfinite(float(cell)):
        return
    if not cell:
        raise JobError(f"{where}: must have a number; got an empty cell; fill it, or leave out the row")
    if cell.startswith("="):
        raise JobError(f"{where}: must be a number; got the formula {shown(cell)}; save values instead of formulas")
    if _THOUSANDS.fullmatch(cell):
        write = "leave the comma out if it parts thousands, or write a decimal point instead"
    elif "," in cell:
        write = "write a decimal point instead of the comma"
    else:
        write = "write the number alone; its unit stands in the header"
    raise JobError(f"{where}: must be a number; got {shown(cell)}; {write}")


def _unbeaten(columns: Sequence[Column], rows: Sequence[Sequence[str]]) -> list[int]:
    """Return the places of rows that no other one beats; of equal ones the first."""
    from ..front.dominance import nondominated  # brings what computes

    numbers = np.array([[float(row[column.place]) for column in columns] for row in rows])
    limits = np.array([column.monotone for column in columns])
    tightness = numbers[:, limits] * np.array([-1.0 if of.word == "max" else 1.0 for of in columns if of.monotone])
    _, groups = np.unique(numbers[:, ~limits], axis=0, return_inverse=True)
    kept: list[int] = []
    for group in range(int(groups.max()) + 1):
        own = np.flatnonzero(groups.ravel() == group)
        if not limits.any():
            kept.append(int(own[0]))
            continue
        _, first = np.unique(tightness[own], axis=0, return_index=True)
        different = own[np.sort(first)]
        kept += different[nondominated(tightness[different])].tolist()
    return sorted(kept)


def _option(columns: Sequence[Column], row: Sequence[str]) -> dict[str, Any]:
    values: dict[str, Any] = {}
    constraints: dict[str, Any] = {}
    for column in columns:
        value = column.value(row[column.place])
        if column.word is None:
            values[column.name] = value
        else:
            constraints.setdefault(column.name, {})[column.word] = value
    found: dict[str, Any] = {"name": row[0]}
    found |= {"values": values} if values else {}
    return found | ({"constraints": constraints} if constraints else {})
