"""A catalogue as a table: the options of a choice, a row each, screened before anything is solved.

Each row has its name, numbers of the job that come with it, limits, and amounts and texts that are kept with designs.
Rows that lose in everything that is asked for are not searched; those of them that may be the least that serves a
design, see `catalogue_screening`, stay as options that are only named.
"""

from __future__ import annotations

import csv
import io
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from ...model.errors import JobError
from ...model.linkage.values import DIMENSIONS
from ...objectives.units import shown
from .beside import beside
from .catalogue_columns import Column, columns_of
from .catalogue_screening import screened
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
_LONGEST_NOTE = 200
_ARTICLE = re.compile(r"[+-]?0\d.*|\d{7,}")
"""A number that is none but the name of an article."""


@dataclass(frozen=True)
class Catalogue:
    """A catalogue after screening.

    name: of the choice. options: as a job has them, the least first; those that lose only where they may be the least
    that serves. rows: of the table. lost: rows that are not searched, each with the one that beats it, or None for one
    without a number that is asked for. compared: what rows are compared in. idle: headers of columns of which nothing
    is asked for. added: headers without min, max or equals, with what they are read as.
    """

    options: list[dict[str, Any]]
    rows: int
    name: str = ""
    lost: dict[str, str | None] = field(default_factory=dict)
    compared: tuple[str, ...] = ()
    idle: tuple[str, ...] = ()
    added: dict[str, str] = field(default_factory=dict)


def catalogues(data: Mapping[str, Any]) -> list[str]:
    """Return the files that choices of a job name."""
    choices = data.get("choice")
    parts = choices if isinstance(choices, list | tuple) else ()
    return [part["file"] for part in parts if _names_file(part)]


def _names_file(part: Any) -> bool:
    return isinstance(part, Mapping) and isinstance(part.get("file"), str) and not {"option", "table"} & set(part)


def with_catalogues(data: Mapping[str, Any], folder: Path) -> dict[str, Any]:
    """Return a job with the text of its catalogues, found in `folder`, beside the names of their files.

    Raises JobError.
    """
    job = dict(data)
    if catalogues(data):
        job["choice"] = [
            {**part, "table": _text(*beside(folder, key_of(["choice", place, "file"]), part["file"]))}
            if _names_file(part)
            else part
            for place, part in enumerate(job["choice"])
        ]
    return job


def with_options(data: Mapping[str, Any]) -> tuple[dict[str, Any], list[Catalogue]]:
    """Return a job with the options of its tables beside these, and the catalogues that they are from.

    Raises JobError for tables that cannot be read.
    """
    job, found = dict(data), list[Catalogue]()
    own = data.get("quantity")
    names = frozenset(own) if isinstance(own, Mapping) else frozenset[str]()
    choices = data.get("choice")
    parts = list(choices) if isinstance(choices, list | tuple) else []
    for place, part in enumerate(parts):
        if not isinstance(part, Mapping) or not isinstance(part.get("table"), str):
            continue
        key = key_of(["choice", place, "table"])
        if "option" in part:
            raise JobError(f"{key}: must stand without options; got both; leave out one of the two")
        file = part.get("file")
        where = f"{key_of(['choice', place, 'file'])}: {shown(file)}" if isinstance(file, str) else f"{key}: the table"
        catalogue = read_catalogue(part["table"], where, names, data, str(part.get("name", "")))
        parts[place] = {**part, "option": catalogue.options}
        found.append(catalogue)
    return (job | {"choice": parts} if found else job), found


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


def read_catalogue(
    text: str,
    where: str,
    own: frozenset[str] = frozenset(),
    tables: Mapping[str, Any] | None = None,
    name: str = "",
) -> Catalogue:
    """Return the catalogue of a text, screened.

    where: what messages begin with. own: names of the job's own quantities. tables: of the job, which give the numbers
    that columns set and say what is asked for; without them nothing but limits is. name: of the choice.
    Raises JobError, naming row, column and remedy.
    """
    lines = _lines(text, where)
    first = next(lines, None)
    if first is None:
        raise JobError(f"{where} must begin with a line that names its columns; got an empty file; fill it")
    columns = columns_of(first[1], where, own)
    if tables is not None:
        _require_given(columns, where, tables)
    rows = _rows(lines, len(first[1]), where)
    checked = (_with_cells(column, rows, where) for column in columns)
    used, cells = [column for column in checked if column is not None], [cells for _, cells in rows]
    found = screened(used, cells, tables or {}, where)
    if len(found.searched) > MOST_OPTIONS:
        raise JobError(
            f"{where} must have at most {MOST_OPTIONS} rows that no other one beats in everything; got "
            f"{len(found.searched)} of {len(rows)}; leave out rows that you would not buy, or columns that do not "
            "matter"
        )
    return Catalogue(
        options=[_option(used, cells[row], searched=row in found.searched) for row in found.order],
        rows=len(rows),
        name=name,
        lost={cells[row][0]: None if by is None else cells[by][0] for row, by in found.lost.items()},
        compared=found.compared,
        idle=tuple(column.header for column in used if column.kept and column.name not in found.asked),
        added={column.header: column.said for column in used if column.added},
    )


def _rows(lines: Iterator[tuple[int, list[str]]], width: int, where: str) -> list[tuple[int, list[str]]]:
    """Return number and cells of the rows, whose names differ."""
    labels: dict[str, int] = {}
    rows: list[tuple[int, list[str]]] = []
    for number, cells in lines:
        row = f"{where}, row {number}"
        if len(cells) != width:
            raise JobError(f"{row} must have {width} cells, as the first line; got {len(cells)}; correct it")
        label = cells[0]
        if not label or label.startswith(_FORMULA) or len(label) > _LONGEST or not label.isprintable():
            raise JobError(
                f"{row}, column name: must be a name of 1 to {_LONGEST} characters on one line, none of = + @ first; "
                f"got {shown(label)}; write it out"
            )
        if label in labels:
            raise JobError(
                f"{row}, column name: names must differ; got {shown(label)} of row {labels[label]} again; rename one"
            )
        labels[label] = number
        rows.append((number, cells))
        if len(rows) > MOST_ROWS:
            raise JobError(f"{where} must have at most {MOST_ROWS} rows; got more; keep those that you would buy")
    if not rows:
        raise JobError(f"{where} must have a row below the names of its columns; got none; add it")
    return rows


def _with_cells(column: Column, rows: Sequence[tuple[int, list[str]]], where: str) -> Column | None:
    """Return a column whose cells are checked, one that is kept as numbers or texts; None if it is empty.

    A cell of a number of the job must be filled; a limit that is blank is none.
    """
    cells = [(number, row[column.place]) for number, row in rows]
    filled = [(number, cell) for number, cell in cells if cell]
    if column.kept and not filled and not column.unit:
        return None
    numbers = all(_is_number(cell) and not _ARTICLE.fullmatch(cell) for _, cell in filled)
    if column.kept and not column.unit and not numbers:
        for number, cell in filled:
            if cell.startswith("=") or len(cell) > _LONGEST_NOTE or not cell.isprintable():
                raise JobError(
                    f"{where}, row {number}, column {shown(column.header)}: must be a number, or a text of at most "
                    f"{_LONGEST_NOTE} characters on one line, no formula; got {shown(cell)}; correct it, or let the "
                    "column begin with # to pass it over"
                )
        return replace(column, kind=None)
    for number, cell in filled if column.kept or column.word else cells:
        _require_number(cell, f"{where}, row {number}, column {shown(column.header)}")
    return column


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
        if column.word is None and not column.kept and column.name not in DIMENSIONS:
            try:
                with_number(tables, column.name, 0.0)
            except LookupError:
                raise JobError(f"{name}, column {shown(column.header)}: {unknown_path(column.name, tables)}") from None


def _is_number(cell: str) -> bool:
    return _NUMBER.fullmatch(cell) is not None and math.isfinite(float(cell))


def _require_number(cell: str, where: str) -> None:
    if _is_number(cell):
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


def _option(columns: Sequence[Column], row: Sequence[str], *, searched: bool) -> dict[str, Any]:
    found: dict[str, Any] = {"name": row[0]}
    for column in columns:
        cell = row[column.place]
        if not cell:
            continue
        if column.word is not None:
            found.setdefault("constraints", {}).setdefault(column.name, {})[column.word] = column.value(cell)
        elif not column.kept:
            found.setdefault("values", {})[column.name] = column.value(cell)
        elif column.kind is not None:
            found.setdefault("amounts", {})[column.name] = column.value(cell)
        else:
            found.setdefault("notes", {})[column.name] = cell
    return found if searched else found | {"searched": False}
