"""Tables in text files, as loggers and spreadsheets write them in any language.

The first line with content names the columns; a comment line does if no other line can. Empty lines and lines that
begin with #, % or // are skipped. Commas, semicolons, tabs, bars or blanks separate the cells. The separator is the
sign that gives most lines as many cells as the first, unless a line such as "sep=;" states it. A line with units may
follow the names. `csv` splits the cells. Its `Sniffer`, which pandas also uses, mistakes a decimal comma for a
separator and cannot name the line of an invalid cell.
"""

from __future__ import annotations

import codecs
import csv
import itertools
import re
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ...model.arrays import Array
from ...model.errors import InputError
from ...objectives.kinds import count_with_noun
from ...objectives.units import is_number_with_any_unit, number_and_unit, quote, quoted_if_unprintable
from .text_table_layout import (
    EXPONENT,
    MISSING,
    SAMPLE,
    SEPARATORS,
    are_numbers,
    are_only_units,
    column_names_in_comment,
    column_names_in_line,
    content_lines,
    names_with_units,
    normalise_number_signs,
    separator_of,
    split_cells,
    stated_separator,
    title_line_count,
)

_MOST_COLUMNS = 1000
_NAMED = 6  # columns in a file's summary
_BATCH = 50_000  # rows whose cells are stored as single texts
_MARKS = (
    (codecs.BOM_UTF8, "utf-8"),
    (codecs.BOM_UTF32_LE, "utf-32-le"),
    (codecs.BOM_UTF32_BE, "utf-32-be"),
    (codecs.BOM_UTF16_LE, "utf-16-le"),
    (codecs.BOM_UTF16_BE, "utf-16-be"),
)
_BINARY = ("PK\x03\x04", "ÐÏ\x11à", "%PDF")
"""First bytes of spreadsheets and documents, decoded as Windows' Latin-1."""
_BREAK = re.compile(r"\s*[\r\n]+\s*")  # within a quoted cell
_NUMBER = re.compile(rf"[+-]?(?:\d+\.?\d*|\.\d+){EXPONENT}", re.ASCII)


def read_file_bytes(path: Path, name: str, limit: int) -> bytes:
    """Return the content of a file of at most `limit` bytes.

    Raises `InputError`; name: name of the file in messages.
    """
    try:
        with path.open("rb") as file:
            content = file.read(limit + 1)
    except FileNotFoundError:
        raise InputError(f"{name} not found; check the name and the folder") from None
    except IsADirectoryError:
        raise InputError(f"{name} must be a file; got a folder; name a file in it") from None
    except (OSError, ValueError) as error:  # ValueError: a path with a null character
        why = getattr(error, "strerror", None) or str(error)
        raise InputError(f"{name} cannot be read: {why}; name another file, or change its permissions") from None
    if len(content) > limit:
        raise InputError(
            f"{name} must be at most {limit / 1e6:.3g} MB in size; got more; keep only the rows and columns that matter"
        )
    return content


def decode_file_text(content: bytes, name: str) -> str:
    """Return a file's text: in the encoding of its byte order mark, otherwise UTF-8, otherwise Windows' Latin-1."""
    if content[:4].decode("cp1252", "replace") in _BINARY:
        raise _binary_file_error(name)
    for mark, encoding in _MARKS:
        if content.startswith(mark):
            return _decode_text(content.removeprefix(mark), encoding, name)
    even, odd = (content[place:2000:2].count(0) for place in (0, 1))
    if bool(even) != bool(odd) and not len(content) % 2:  # UTF-16 without a mark: one byte of each Latin letter is zero
        return _decode_text(content, "utf-16-be" if even else "utf-16-le", name)
    try:
        return content.decode()
    except UnicodeDecodeError:
        return content.decode("cp1252", "replace")


def _binary_file_error(name: str) -> InputError:
    return InputError(
        f"{name} must be a CSV text file; got a spreadsheet or other binary file; save it as CSV and use that file"
    )


def _decode_text(content: bytes, encoding: str, name: str) -> str:
    try:
        return content.decode(encoding)
    except UnicodeDecodeError:
        raise InputError(f"{name} must be text; got bytes that are not {encoding.upper()}; save it as CSV") from None


@dataclass(frozen=True)
class _Portion:
    """Some rows: their line numbers, and the cells of each column as one text, with a line for each cell."""

    lines: Array
    columns: list[str]


@dataclass
class TableFile:
    """A table read from a file.

    name: name of the file, for messages. heads: its headings. notes: on separator and signs.

    signs: decimal sign and thousands separator, known once numbers have been read.
    """

    name: str
    heads: tuple[str, ...]
    notes: list[str]
    separator: str
    portions: list[_Portion] = field(repr=False)
    signs: tuple[str, str] = (".", ",")

    def __len__(self) -> int:
        return sum(len(portion.lines) for portion in self.portions)

    def summary_text(self, places: Sequence[int]) -> str:
        """Return a summary of the table: rows, first columns, first and last row, decimal sign."""
        left_over = f" and {count_with_noun(len(places) - _NAMED, 'column')} more" if len(places) > _NAMED else ""
        places = places[:_NAMED]
        ends = ((self.portions[0], 0), (self.portions[-1], -1))
        first, last = (
            ", ".join(self._number_in_words(portion.columns[place].split("\n")[n]) for place in places)
            for portion, n in ends
        )
        names = (self.heads[place] for place in places)
        heads = ", ".join(map(quoted_if_unprintable, names))
        rows = f"{len(self):,} row{'s' if len(self) > 1 else ''}"
        return "; ".join([f"{rows} of {heads}{left_over}", f"first {first}", f"last {last}", *self.notes])

    def _number_in_words(self, cell: str) -> str:
        decimal, grouping = self.signs
        digits = normalise_number_signs(cell).replace(grouping, "").replace(decimal, ".")
        return f"{float(digits) + 0.0:.6g}" if _NUMBER.fullmatch(digits) else cell or "empty"

    @property
    def row_lines(self) -> list[int]:
        """Line of each row in the file."""
        return [int(line) for portion in self.portions for line in portion.lines]

    def column_cells(self, place: int) -> list[str]:
        """Return the cells of a column."""
        return [cell for portion in self.portions for cell in portion.columns[place].split("\n")]

    def number_columns(self, places: Sequence[int], *, missing: Collection[int] = ()) -> list[Array]:
        """Return columns of numbers, NaN for cells without a number in columns that may be `missing` some.

        Raises `InputError` for other cells.
        """
        if not places:
            return []
        parts = self._with_decimal_points(places)
        return [
            np.concatenate(
                [self._column_floats(n, portion, cells[n], missing=n in missing) for portion, cells in parts]
            )
            for n in places
        ]

    def number_texts(self, places: Sequence[int], *, missing: Collection[int] = ()) -> list[list[str]]:
        """Return columns of numbers as written, with decimal points; cells may be empty in `missing` columns.

        Raises `InputError` for other cells.
        """
        numbers, parts = self.number_columns(places, missing=missing), self._with_decimal_points(places)
        columns = [[cell for _, cells_by_column in parts for cell in cells_by_column[n].split("\n")] for n in places]
        for place, column, cells in zip(places, numbers, columns, strict=True):
            for n in np.flatnonzero(np.isnan(column)):
                if cells[n]:
                    cell_text = self.cell_name(self.row_lines[n], place)
                    raise InputError(f"{cell_text}: must be a number or empty; got {quote(cells[n])}; correct it")
        return columns

    def _with_decimal_points(self, places: Sequence[int]) -> list[tuple[_Portion, dict[int, str]]]:
        """Return the cells of columns with decimal points and without thousands separators."""
        parts = [
            (portion, {n: normalise_number_signs(portion.columns[n]) for n in places}) for portion in self.portions
        ]
        signs = _Signs([text for _, cells in parts for text in cells.values()])
        decimal, grouping = self.signs = self._decimal_and_grouping_signs(signs)
        example = signs.first_cell_of_form(_ambiguous_number_pattern(decimal))
        word = "comma" if decimal == "," else "point"
        note = f"decimal {word}"
        if example is not None and (number := f"{float(example.replace(decimal, '.')):g}") != example:
            note = f"the {word} is read as a decimal {word}, so {example} is {number}; if it separates thousands, "
            note += f"write {example.replace(decimal, '')}"
        if (example is not None or decimal == ",") and note not in self.notes:
            self.notes.append(note)
        in_threes = rf"[+-]?\d{{1,3}}(?:\{grouping}\d{{3}})+(?:\{decimal}\d*)?{EXPONENT}"
        wrong = re.compile(rf"^(?!{in_threes}$).*\{grouping}.*$", re.MULTILINE | re.ASCII)
        for _, cells in parts:
            for n, text in cells.items():
                if grouping in text:  # a number must be grouped in threes
                    text = wrong.sub(lambda cell: cell[0].replace(grouping, "?"), text).replace(grouping, "")
                cells[n] = text.replace(decimal, ".")
        return parts

    def _decimal_and_grouping_signs(self, signs: _Signs) -> tuple[str, str]:
        """Return a file's decimal sign and its thousands separator."""
        point, comma = (
            signs.first_cell_of_form(_certain_number_pattern(".", ",")),
            signs.first_cell_of_form(_certain_number_pattern(",", ".")),
        )
        if point is not None and comma is not None:
            raise InputError(
                f"{self.name} must use one decimal sign; got {comma} and {point}; write all numbers the same way"
            )
        if point is not None or comma is not None:
            return (".", ",") if comma is None else (",", ".")
        comma, point = (
            signs.first_cell_of_form(_ambiguous_number_pattern(",")),
            signs.first_cell_of_form(_ambiguous_number_pattern(".")),
        )
        if comma is not None and (point is not None or self.separator == ","):
            second = f" and {point}" if point is not None else ""
            raise InputError(
                f"{self.name} must have an unambiguous decimal sign; got {comma}{second}, which may mean a thousand "
                "times as much; leave out the thousands separator"
            )
        return (".", ",") if comma is None else (",", ".")

    def _column_floats(self, place: int, portion: _Portion, text: str, *, missing: bool) -> Array:
        """Return the numbers in cells with decimal points, by a fast path if all are numbers."""
        cells = text.split("\n")
        try:
            numbers = np.array([float(cell) if cell else np.nan for cell in cells])
            if "_" not in text and np.isfinite(numbers).all():
                return numbers
        except ValueError:
            pass
        return np.array(
            [self._number_of_cell(place, portion, n, cell, missing=missing) for n, cell in enumerate(cells)]
        )

    def _number_of_cell(self, place: int, portion: _Portion, n: int, cell: str, *, missing: bool) -> float:
        if _NUMBER.fullmatch(cell) and np.isfinite(float(cell)):
            return float(cell)
        if missing and cell.casefold() in MISSING:
            return float("nan")
        cell_text = portion.columns[place].split("\n")[n]
        if not cell_text:
            why = "an empty cell; fill it, or leave out the row"
        elif cell_text.startswith("="):
            why = f"the formula {quote(cell_text)}; save values instead of formulas"
        else:
            with_unit = number_and_unit(cell_text) if is_number_with_any_unit(cell_text) else None
            number = with_unit[0] if with_unit and with_unit[1] else "the number alone"
            why = f"{quote(cell_text)}; write {number}, as the unit belongs in the heading"
        raise InputError(f"{self.cell_name(int(portion.lines[n]), place)}: must be a number; got {why}")

    def cell_name(self, line: int, place: int) -> str:
        """Return the name of a cell for messages."""
        return f"{self.name}, row {line}, column {quote(self.heads[place])}"


class _Signs:
    """Cell texts to search for the first cell of a given form."""

    def __init__(self, texts: Sequence[str]) -> None:
        self._texts = [text for text in texts if "." in text or "," in text]

    def first_cell_of_form(self, pattern: str) -> str | None:
        """Return the first cell of a form; None if there is none."""
        cells = re.compile(rf"^(?:{pattern})$", re.MULTILINE | re.ASCII)
        return next((hit[0] for hit in map(cells.search, self._texts) if hit), None)


def _ambiguous_number_pattern(sign: str) -> str:
    """Return the form of a number whose only sign may be decimal or a thousands separator: 1.300, but not 0.300."""
    return rf"[+-]?[1-9]\d{{0,2}}\{sign}\d{{3}}"


def _certain_number_pattern(decimal: str, grouping: str) -> str:
    """Return the form of a number whose decimal sign is certain: 0.3, .3, 1.3000, 1,300.5, and 1,000,000."""
    plain_number = rf"(?!{_ambiguous_number_pattern(decimal)}$)[+-]?(?:\d+\{decimal}\d*|\{decimal}\d+){EXPONENT}"
    parted = rf"[+-]?\d{{1,3}}(?:\{grouping}\d{{3}})+\{decimal}\d*{EXPONENT}"
    return rf"{plain_number}|{parted}|[+-]?\d{{1,3}}(?:\{grouping}\d{{3}}){{2,}}"


def read_table(text: str, name: str, *, ragged: bool = False) -> TableFile:
    """Return the table in a text. Raises `InputError`, naming row and remedy, if the text is not a table.

    name: name of the file, for messages. ragged: whether rows may lack their last cells.
    """
    text = text.removeprefix("\ufeff").replace("\r\n", "\n").replace("\r", "\n")
    if text[:4] in _BINARY or "\0" in text:
        raise _binary_file_error(name)
    try:
        return _read_table(text, name, ragged=ragged)
    except csv.Error as error:
        raise InputError(f"{name} must be a table in CSV; got {error}; correct it") from None


def _read_table(text: str, name: str, *, ragged: bool) -> TableFile:
    separator = separator_of(text)
    lines = split_cells(content_lines(text), separator)
    leading = list(itertools.islice(lines, SAMPLE))
    titles = title_line_count([cells for _, cells in leading])
    lines = itertools.chain(leading[titles:], lines)
    head = next(lines, None)
    if head is None:
        raise InputError(f"{name} must begin with a line of column names; got an empty file; fill it")
    heads = [cell.strip() for cell in head[1]]
    first = next(lines, None)
    units = first[1] if first is not None and are_only_units(first[1]) else None
    if units is not None:
        first = next(lines, None)
    elif len(heads) == 1 and stated_separator(text) and any(sign in heads[0] for sign in SEPARATORS if sign != " "):
        raise InputError(
            f'{name} must separate its cells as its line "sep={separator}" states; got {quote(heads[0])}; correct '
            "that line, or leave it out"
        )
    width = len(heads) if first is None else len(first[1])
    rows = lines if first is None else itertools.chain([first], lines)
    if are_numbers(heads):
        rows = itertools.chain([head], rows)
        heads = column_names_in_comment(text, separator, len(heads)) or heads
    elif len(heads) != width:
        line = next(line for line in content_lines(text) if line.strip())
        heads = column_names_in_line(line, separator, width) or heads
    heads = names_with_units(heads, units or [])
    if are_numbers(heads):
        raise InputError(
            f"{name} must begin with a line of column names with units; got {', '.join(heads)[:60]!r}; add one "
            "such as crank_angle_deg,force_N"
        )
    if len(heads) > _MOST_COLUMNS:
        raise InputError(
            f"{name} must have at most {_MOST_COLUMNS} columns; got {len(heads)}; keep only those that matter"
        )
    portions = list(_row_portions(rows, len(heads), name, ragged=ragged))
    if not portions:
        raise InputError(f"{name} must have rows below the column names; got none; add them")
    notes = [f"separated by {SEPARATORS.get(separator, quote(separator))}"] if len(heads) > 1 else []
    notes += [f"{count_with_noun(titles, 'title line')} above the column names skipped"] if titles else []
    return TableFile(name, tuple(heads), notes, separator, portions)


def _row_portions(rows: Iterable[tuple[int, list[str]]], width: int, name: str, *, ragged: bool) -> Iterator[_Portion]:
    """Yield portions of rows, each with `width` cells; short rows are padded if they may be `ragged`."""
    rows = iter(rows)
    while block := list(itertools.islice(rows, _BATCH)):
        for place, cells in block:
            if len(cells) != width and (any(cell.strip() for cell in cells[width:]) or not (ragged or cells[width:])):
                raise InputError(
                    f"{name}, row {place} must have {width} cells, like the first line; got {len(cells)}; correct it, "
                    "or delete lines above the column names; if numbers have a decimal comma, separate them by "
                    "semicolons"
                )
        full = [cells[:width] + [""] * (width - len(cells)) for _, cells in block]
        columns = ["\n".join([_BREAK.sub(" ", cell.strip()) for cell in column]) for column in zip(*full, strict=True)]
        yield _Portion(np.array([place for place, _ in block]), columns)
