"""Measured curves in a CSV file, as loggers and spreadsheets write them: read column by column, wrong cells named.

The first line names the columns. Between values stand commas, semicolons or tabs, as there. A comma within a number is
its decimal sign where no value of the file has a point. Empty lines and lines that begin with "#" are passed over.
"""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Callable, Collection, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ...model.errors import InputError

if TYPE_CHECKING:
    from ...model.linkage.linkage import Linkage
    from ...model.machine.mechanism import Mechanism
    from ...objectives.kinds import Kind
    from ...objectives.quantity import Array
    from ...objectives.tables.measured import Measured

_LARGEST = 300_000_000  # bytes: millions of rows
_MOST_COLUMNS = 1000
_AT_ONCE = 50_000  # rows that are kept as text
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d{1,3})?", re.ASCII)
_MISSING = ("", "nan", "na", "n/a", "null", "-")
_NAME = "a measured file"


def text_of(path: Path) -> str:
    """Return the text of a file. Raises `InputError` for one that cannot be read, is large or is no text."""
    try:
        with path.open("rb") as file:
            content = file.read(_LARGEST + 1)
        if len(content) > _LARGEST:
            raise InputError(f"{_NAME} has at most {_LARGEST // 1_000_000} MB; got more in {path}; keep fewer rows")
        return content.decode("utf-8-sig")
    except IsADirectoryError:
        raise InputError(f"{_NAME} is CSV text; got the folder {path}; name a file in it") from None
    except OSError as error:
        raise InputError(
            f"{_NAME} is one that can be read; got {path}: {error.strerror}; name another one, or permit it"
        ) from None
    except UnicodeDecodeError:
        raise InputError(f"{_NAME} is UTF-8 text; got other bytes; save it as CSV in UTF-8") from None


def read_measured(text: str, mechanism: Mechanism, linkage: Linkage) -> Measured:
    """Return the samples of a file's text. Raises `InputError` for what is no table, and for what cannot be."""
    from ...objectives.tables.measured import columns_of, measured_from

    text = text.removeprefix("\ufeff")
    if "\0" in text:
        raise InputError(f"{_NAME} is text; got a byte 0 in it; save it as CSV in UTF-8")
    found = _columns(text, lambda names: columns_of(names, mechanism, linkage, _any_unit))
    return measured_from(found, mechanism, linkage, _any_unit)


def _any_unit(text: str, kind: Kind) -> float | None:
    """Return the value in SI of any unit that jobs know; None for what is no unit of a kind."""
    from ...objectives.tables.measured import squeezed
    from ...objectives.units import to_si

    typed = {squeezed(symbol): symbol for symbol in kind.typed}
    try:
        return to_si(f"1 {typed.get(squeezed(text), text.replace('_', ' '))}", kind)
    except InputError:
        return None


def _columns(text: str, chosen: Callable[[list[str]], Collection[str]]) -> dict[str, Array]:
    """Return every column by its name, NaN for all cells of one that is not chosen."""
    lines = _lines(text)
    head = next(lines, None)
    if head is None:
        raise InputError(f"{_NAME} begins with a line that names its columns; got an empty one; fill it")
    names = [name.strip() for name in head[1]]
    if len(names) > _MOST_COLUMNS:
        raise InputError(f"{_NAME} has at most {_MOST_COLUMNS} columns; got {len(names)}; keep those that matter")
    if all(_number(name, ",", ".") is not None for name in names if name):
        raise InputError(
            f"{_NAME} begins with a line that names its columns; got {', '.join(names)[:60]!r}; add one such as "
            "crank_angle_deg,slider_position_mm"
        )
    meant = chosen([name for name in names if name])
    wanted = [place for place, name in enumerate(names) if name in meant]
    parts: list[list[Array]] = [[] for _ in wanted]
    count, signs = 0, _Signs()
    for places, rows in _portions(lines, len(names)):
        count += len(rows)
        columns = list(zip(*rows, strict=True))
        for place, part in zip(wanted, parts, strict=True):
            part.append(signs.numbers(names[place], places, columns[place]))
    if not count:
        raise InputError(f"{_NAME} has rows below its first line; got none; add the samples")
    nothing = np.full(count, np.nan)
    found = {names[place]: np.concatenate(part) for place, part in zip(wanted, parts, strict=True)}
    return {name: found.get(name, nothing) for name in names if name}


def _lines(text: str) -> Iterator[tuple[int, list[str]]]:
    """Yield the number and the cells of each line with content."""
    first = next((line for line in io.StringIO(text) if line.strip() and not line.lstrip().startswith("#")), "")
    separator = next((sign for sign in (";", "\t") if sign in first), ",")
    reader = csv.reader(io.StringIO(text, newline=""), delimiter=separator, strict=True)
    try:
        for cells in reader:
            begin = cells[0].lstrip() if cells else ""
            if (begin and not begin.startswith("#")) or (not begin and any(cell.strip() for cell in cells)):
                yield reader.line_num, cells
    except csv.Error as error:
        why = str(error).encode("unicode_escape").decode()  # it names the sign between the values, perhaps a tab
        raise InputError(f"{_NAME} is CSV; got {why} in line {reader.line_num}; correct it") from None


def _portions(lines: Iterator[tuple[int, list[str]]], width: int) -> Iterator[tuple[list[int], list[list[str]]]]:
    """Yield some rows at a time, each of `width` cells, with the numbers of their lines."""
    places: list[int] = []
    rows: list[list[str]] = []
    for number, cells in lines:
        if len(cells) > width and any(cell.strip() for cell in cells[width:]):
            raise InputError(
                f"{_NAME} has a value for each column in a line; got {len(cells)} for {width} columns in line "
                f"{number}; where numbers have a decimal comma, separate them by semicolons"
            )
        places.append(number)
        rows.append(cells if len(cells) == width else cells[:width] + [""] * (width - len(cells)))
        if len(rows) == _AT_ONCE:
            yield places, rows
            places, rows = [], []
    if rows:
        yield places, rows


class _Signs:
    """Decimal sign of a file: a point or a comma, whichever comes first, and never both."""

    def __init__(self) -> None:
        self.sign = ""
        self._where = ""

    def numbers(self, name: str, lines: Sequence[int], cells: Sequence[str]) -> Array:
        """Return the values of cells, each of a line. Raises `InputError` for one that is no number."""
        texts = cells if self.sign != "," else [text.replace(".", "?").replace(",", ".") for text in cells]
        try:
            # The quick way; the other one finds what is wrong, and what Python alone takes for a number.
            found = np.array([float(text) if text else np.nan for text in texts])
            if not any("_" in text for text in texts) and not np.isinf(found).any():
                self._seen(next(((line, text) for line, text in zip(lines, cells, strict=True) if "." in text), None))
                return found
        except ValueError:
            pass
        return np.array([self._one(name, line, text.strip()) for line, text in zip(lines, cells, strict=True)])

    def _seen(self, cell: tuple[int, str] | None) -> None:
        if cell is not None and not self.sign:
            self.sign, self._where = ".", f"{cell[1][:40]!r} in line {cell[0]}"

    def _one(self, name: str, line: int, text: str) -> float:
        if text.casefold() in _MISSING:
            return np.nan
        signs = [sign for sign in ".," if sign in text]
        if not self.sign and len(signs) == 1:
            self.sign, self._where = signs[0], f"{text[:40]!r} in line {line}"
        number = _number(text, *signs)
        if number is None:
            raise InputError(f"{name!r} has numbers; got {text[:40]!r} in line {line}; correct it, or leave it empty")
        if any(sign != self.sign for sign in signs):
            raise InputError(
                f"{_NAME} has one decimal sign and none for thousands; got {self._where} and {text[:40]!r} in line "
                f"{line}; write all numbers alike"
            )
        return number


def _number(text: str, *signs: str) -> float | None:
    """Return a number, which may have any of some decimal signs; None for what is none or not finite."""
    plain = text.replace(",", ".") if "," in signs else text
    return float(plain) if _NUMBER.fullmatch(plain) and np.isfinite(float(plain)) else None
