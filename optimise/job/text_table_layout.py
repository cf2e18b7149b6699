"""Layout of a table in a text file: separators, comments, title lines, names and units of columns."""

import csv
import io
import itertools
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence

from ...objectives.units import is_number_with_any_unit

SEPARATORS = {"\t": "tabs", ";": "semicolons", "|": "bars", ",": "commas", " ": "blanks"}
"""In order of preference: a comma may be a decimal sign, and names may contain blanks."""
MISSING = ("", "nan", "na", "n/a", "#n/a", "#nv", "null", "-")
"""Cells without a number, in lower case."""
EXPONENT = r"(?:[eE][+-]?\d{1,3})?"
_COMMENT = re.compile(r"\s*(?:#|%|//)+\s*")
_SAID = re.compile(r'\s*"?sep=(\\t|.)"?\s*', re.IGNORECASE)
SAMPLE = 200
"""Number of lines from which separators and title lines are inferred."""
_LIKE_A_NUMBER = re.compile(rf"[+-]?[.,]?\d[\d.,]*{EXPONENT}", re.ASCII)
_BLANKS = re.compile(r"(?<=\d)[ '\u2019\u00a0\u2007\u2009\u202f](?=\d{3}(?!\d))")
"""Signs that can only be thousands separators."""


def normalise_number_signs(text: str) -> str:
    """Return cells without blanks as thousands separators, and with plain minus signs."""
    return _BLANKS.sub("", text).replace("\u2212", "-")


def content_lines(text: str) -> Iterator[str]:
    """Yield the lines of a text; comments and a line that states the separator become empty lines."""
    has_content = False
    for line in io.StringIO(text):
        empty = _COMMENT.match(line) or not line.strip()
        yield "\n" if empty or (not has_content and _SAID.fullmatch(line)) else line
        has_content = has_content or not empty


def split_cells(lines: Iterable[str], separator: str) -> Iterator[tuple[int, list[str]]]:
    """Yield the line number and the cells of each line with content."""
    if separator == " ":
        lines = (line.replace("\t", " ") for line in lines)
    reader = csv.reader(lines, delimiter=separator, strict=True)
    try:
        for cells in reader:
            if any(cell.strip() for cell in cells):
                yield reader.line_num, [cell for cell in cells if cell] if separator == " " else cells
    except csv.Error as error:
        why = str(error).encode("unicode_escape").decode()  # it quotes the separator, which may be a tab
        raise csv.Error(f"{why} in row {reader.line_num}") from None


def separator_of(text: str) -> str:
    """Return the separator: from a first line such as "sep=;", or the sign that splits most lines alike."""
    if stated := stated_separator(text):
        return stated
    sample = [line for line in itertools.islice(content_lines(text), 10 * SAMPLE) if line.strip()][:SAMPLE]
    best, separator = 0.0, ","
    for sign in SEPARATORS:
        try:
            every = [cells for _, cells in split_cells(sample, sign)]
        except csv.Error:
            continue
        rows = every[title_line_count(every) :]
        widths = [len(row) for row in rows]
        width = Counter(widths[1:] or widths).most_common(1)[0][0] if widths else 1
        if sign != " ":
            width = widths[0] if widths else 1
        elif not all(are_numbers(row) for row in rows[1 + (len(rows) > 1 and are_only_units(rows[1])) :]):
            continue
        alike = widths.count(width) / len(every) if width > 1 else 0.0
        if alike and are_numbers(rows[0]) and column_names_in_comment(text, sign, width):
            alike += 1.0  # as many names as numbers
        if alike > best:
            best, separator = alike, sign
    return separator


def title_line_count(rows: Sequence[Sequence[str]]) -> int:
    """Return the number of rows above the column names, such as the title and date of a measurement.

    0 if uncertain. The names are the last row of text above rows that contain only numbers, with one name for each
    number. In other tables, they are the first row without numbers that has as many cells as all rows below it, if no
    row above has as many.
    """
    first = next((n for n, row in enumerate(rows) if all(map(_is_number, row))), len(rows))
    if first < len(rows):
        names = max(first - 1 - (first > 0 and are_only_units(rows[first - 1])), 0)
        certain = len(rows[names]) == len(rows[first]) and all(_is_number(cell) for row in rows[first:] for cell in row)
    else:
        widths = [len(row) for row in rows]
        names = next((n for n in range(len(rows)) if widths[n] > 1 and set(widths[n:]) == {widths[n]}), 0)
        first = names + 1
        certain = first < len(rows) and widths[names] not in widths[:names]
    named = (
        names > 0
        and certain
        and not any(_is_number(name) for name, cell in zip(rows[names], rows[first], strict=True) if cell)
    )
    return names if named else 0


def _is_number(cell: str) -> bool:
    """Whether a cell is a number or a mark for a missing one."""
    return cell.strip().casefold() in MISSING or are_numbers([cell])


def stated_separator(text: str) -> str:
    """Return the separator that the first line with content states; empty if it states none."""
    first = next((line for line in io.StringIO(text) if line.strip() and not _COMMENT.match(line)), "")
    statement = _SAID.fullmatch(first)
    return "" if statement is None else statement[1].replace("\\t", "\t")


def are_only_units(cells: Sequence[str]) -> bool:
    """Whether a line has only units, at least two, as loggers write them below the names."""
    units = [_unit_without_brackets(cell) for cell in cells if _unit_without_brackets(cell)]
    return len(units) > 1 and all(is_number_with_any_unit(f"1 {unit}") for unit in units)


def _unit_without_brackets(cell: str) -> str:
    return cell.strip().strip("[]()-")


def names_with_units(heads: list[str], units: Sequence[str]) -> list[str]:
    """Return the column names with the units from a line below them, if it has as many cells."""
    if len(units) != len(heads):
        return heads
    return [
        f"{head} ({_unit_without_brackets(unit)})" if _unit_without_brackets(unit) else head
        for head, unit in zip(heads, units, strict=True)
    ]


def are_numbers(cells: Sequence[str]) -> bool:
    """Whether all of the cells are numbers, with any decimal and thousands signs."""
    return any(cells) and all(_LIKE_A_NUMBER.fullmatch(normalise_number_signs(cell.strip())) for cell in cells if cell)


def column_names_in_comment(text: str, separator: str, width: int) -> list[str] | None:
    """Return the column names in the last comment before the numbers that has as many; None if there is none."""
    names = None
    for line in io.StringIO(text):
        comment = _COMMENT.match(line)
        if comment:
            named = column_names_in_line(line[comment.end() :], separator, width)
            names = names_with_units(names, named) if names and named and are_only_units(named) else named or names
        elif line.strip() and not _SAID.fullmatch(line):
            break
    return names


def column_names_in_line(line: str, separator: str, width: int) -> list[str] | None:
    """Return the names of `width` columns in a line; names may have several words. None if there are none."""
    ways = [[cell.strip() for _, cells in split_cells([line], separator) for cell in cells]]
    if separator == " ":
        ways += [re.split(pattern, line.strip()) for pattern in (r"\s{2,}|\t", r"(?<=[)\]])\s+")]
    return next((heads for heads in ways if len(heads) == width and not are_numbers(heads)), None)
