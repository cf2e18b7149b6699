"""A catalogue as a table: the options of a choice, one per row, screened before a search.

Each row has a name, numbers of the job, limits, and amounts and text that are stored with designs. Dominated rows are
not searched. Those that may be the smallest sufficient option for a design, see `catalogue_screening`, are only named.
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

from ...model.errors import InputError, JobError
from ...model.linkage.dimensions import DIMENSIONS
from ...objectives.units import quote
from .catalogue_columns import Column, columns_of_header
from .catalogue_screening import screen_rows
from .mistake_messages import key_of_location
from .named_files import Files, read_named_text, table_in, tables_in
from .plain_numbers import unknown_path_message, with_value_at_path
from .text_table import TableFile, read_table
from .text_table_layout import are_numbers

MOST_ROWS = 50_000
MOST_OPTIONS = 200
"""Maximum number of rows after screening, because each is solved."""
_FORMULA = ("=", "+", "@")
_LONGEST = 60
_LONGEST_NOTE = 200
_ARTICLE = re.compile(r"[+-]?0\d.*|\d{7,}")
"""A numeric text that is really an article number."""


@dataclass(frozen=True)
class Catalogue:
    """A catalogue after screening.

    name: name of the choice. options: as in a job file, smallest first; dominated ones only if they may be the smallest
    sufficient option. rows: number of rows. lost: rows that are not searched, each with the one that dominates it.
    excluded: rows whose amounts the job does not allow, each with the reason. compared: criteria for the comparison.
    idle: headers of columns that no requirement uses. added: headers without min, max or equals, with their
    interpretation. understood: summary of the file, in words.
    """

    options: list[dict[str, Any]]
    rows: int
    name: str = ""
    lost: dict[str, str] = field(default_factory=dict)
    excluded: dict[str, str] = field(default_factory=dict)
    compared: tuple[str, ...] = ()
    idle: tuple[str, ...] = ()
    added: dict[str, str] = field(default_factory=dict)
    understood: str = field(default="", compare=False)


def catalogue_files(data: Mapping[str, Any]) -> list[str]:
    """Return the files that a job's choices name."""
    return [part["file"] for part in tables_in(data, "choice") if _names_file(part)]


def _names_file(part: Any) -> bool:
    return isinstance(part, Mapping) and isinstance(part.get("file"), str) and not {"option", "table"} & set(part)


def with_catalogues(data: Mapping[str, Any], files: Files) -> dict[str, Any]:
    """Return a job with the text of its catalogues beside the names of their files. Raises `InputError`."""
    job = dict(data)
    if catalogue_files(data):
        job["choice"] = [
            {**part, "table": read_named_text(files, key_of_location(["choice", place, "file"]), part["file"])}
            if _names_file(part)
            else part
            for place, part in enumerate(job["choice"])
        ]
    return job


def with_options(data: Mapping[str, Any]) -> tuple[dict[str, Any], list[Catalogue]]:
    """Return a job with the options from its tables, and the catalogues that they come from.

    Raises JobError for unreadable tables.
    """
    job, screened_catalogues = dict(data), list[Catalogue]()
    names, choices = frozenset(table_in(data, "quantity")), data.get("choice")
    parts = list(choices) if isinstance(choices, list | tuple) else []
    for place, part in enumerate(parts):
        if not isinstance(part, Mapping) or not isinstance(part.get("table"), str):
            continue
        key = key_of_location(["choice", place, "table"])
        if "option" in part:
            raise JobError(f"{key}: must not be combined with options; got both; leave out one of the two")
        file = part.get("file")
        source_name = (
            f"{key_of_location(['choice', place, 'file'])}: {quote(file)}"
            if isinstance(file, str)
            else f"{key}: the table"
        )
        catalogue = read_catalogue(part["table"], source_name, names, data, str(part.get("name", "")))
        parts[place] = {**part, "option": catalogue.options}
        screened_catalogues.append(catalogue)
    return (job | {"choice": parts} if screened_catalogues else job), screened_catalogues


def read_catalogue(
    text: str,
    file_name: str,
    custom_names: frozenset[str] = frozenset(),
    tables: Mapping[str, Any] | None = None,
    name: str = "",
) -> Catalogue:
    """Return the screened catalogue from a text.

    file_name: prefix for messages. custom_names: names of the job's custom quantities. tables: those of the job, with
    the numbers that columns set, objectives and constraints; without them only limits count. name: name of the choice.
    Raises JobError, naming row, column and remedy.
    """
    try:
        return _read_catalogue(read_table(text, file_name), custom_names, tables, name)
    except JobError:
        raise
    except InputError as error:
        raise JobError(str(error)) from None


def _read_catalogue(
    table: TableFile, custom_names: frozenset[str], tables: Mapping[str, Any] | None, name: str
) -> Catalogue:
    file_name = table.name
    columns = columns_of_header(table.heads, file_name, custom_names)
    if tables is not None:
        _require_stated_number(columns, file_name, tables)
    _require_distinct_row_names(table)
    filled_columns = [column for column in map(partial(_validated_column, table), columns) if column is not None]
    places = [column.place for column in filled_columns if column.kind is not None or not column.is_amount]
    blank = [column.place for column in filled_columns if column.word is not None or column.is_amount]
    digits = dict(zip(places, table.number_texts(places, missing=blank), strict=True))
    cells_by_column = (digits.get(place) or table.column_cells(place) for place in range(len(table.heads)))
    cells = [list(row) for row in zip(*cells_by_column, strict=True)]
    screening = screen_rows(filled_columns, cells, tables or {}, file_name)
    if len(screening.searched) > MOST_OPTIONS:
        raise JobError(
            f"{file_name} must have at most {MOST_OPTIONS} non-dominated rows; got {len(screening.searched)} of "
            f"{len(table)}; "
            "leave out rows that you would not buy, or columns that do not matter"
        )
    return Catalogue(
        options=[
            _option_of_row(filled_columns, cells[row], searched=row in screening.searched) for row in screening.order
        ],
        rows=len(table),
        understood=table.summary_text([0, *(column.place for column in filled_columns)]),
        name=name,
        lost={cells[row][0]: cells[better][0] for row, better in screening.lost.items()},
        excluded={cells[row][0]: why for row, why in screening.excluded.items()},
        compared=screening.compared,
        idle=tuple(
            column.header for column in filled_columns if column.is_amount and column.name not in screening.requested
        ),
        added={column.header: column.header_text for column in filled_columns if column.added},
    )


def _require_distinct_row_names(table: TableFile) -> None:
    """Reject rows without a name, duplicate names, and too many rows."""
    if len(table) > MOST_ROWS:
        raise JobError(f"{table.name} must have at most {MOST_ROWS} rows; got more; keep those that you would buy")
    labels: dict[str, int] = {}
    for number, label in zip(table.row_lines, table.column_cells(0), strict=True):
        row = f"{table.name}, row {number}"
        if not label or label.startswith(_FORMULA) or len(label) > _LONGEST or not label.isprintable():
            raise JobError(
                f"{row}, column name: must be a name of 1 to {_LONGEST} characters on one line that does not begin "
                f"with =, + or @; got {quote(label)}; write it out"
            )
        if label in labels:
            raise JobError(
                f"{row}, column name: names must differ; got {quote(label)} of row {labels[label]} again; rename one"
            )
        labels[label] = number


def _validated_column(table: TableFile, column: Column) -> Column | None:
    """Return a column that is stored as numbers or text; None if it is empty. Texts are checked."""
    cells = table.column_cells(column.place)
    filled = [cell for cell in cells if cell]
    if not column.is_amount or column.unit or not filled:
        return None if column.is_amount and not column.unit else column
    if are_numbers(filled) and not any(map(_ARTICLE.fullmatch, filled)):
        return column
    for number, cell in zip(table.row_lines, cells, strict=True):
        if cell.startswith("=") or len(cell) > _LONGEST_NOTE or not (cell.isprintable() or not cell):
            raise JobError(
                f"{table.cell_name(number, column.place)}: must be a number, or a text of at most {_LONGEST_NOTE} "
                f"characters on one line, no formula; got {quote(cell)}; correct it, or let the column name begin with "
                "# to skip it"
            )
    return replace(column, kind=None)


def _require_stated_number(columns: Sequence[Column], name: str, tables: Mapping[str, Any]) -> None:
    """Reject a column that sets, or seems to set, a number that the job does not state."""
    machine = table_in(tables, "mechanism")
    for column in columns:
        if column.is_amount and isinstance(machine.get(column.name), str | int | float):
            unit_text = f" ({column.unit})" if column.unit else ""
            raise JobError(
                f"{name}, column {quote(column.header)}: it would be stored with designs but have no effect; did you "
                f"mean mechanism.{column.name}{unit_text}? rename it, or let it begin with # to skip it"
            )
        if column.word is None and not column.is_amount and column.name not in DIMENSIONS:
            try:
                with_value_at_path(tables, column.name, 0.0)
            except LookupError:
                raise JobError(
                    f"{name}, column {quote(column.header)}: {unknown_path_message(column.name, tables)}"
                ) from None


def _option_of_row(columns: Sequence[Column], row: Sequence[str], *, searched: bool) -> dict[str, Any]:
    option: dict[str, Any] = {"name": row[0]}
    for column in columns:
        cell = row[column.place]
        if not cell:
            continue
        if column.word is not None:
            option.setdefault("constraints", {}).setdefault(column.name, {})[column.word] = column.job_value_of_cell(
                cell
            )
        elif not column.is_amount:
            option.setdefault("values", {})[column.name] = column.job_value_of_cell(cell)
        elif column.kind is not None:
            option.setdefault("amounts", {})[column.name] = column.job_value_of_cell(cell)
        else:
            option.setdefault("notes", {})[column.name] = cell
    return option if searched else option | {"searched": False}
