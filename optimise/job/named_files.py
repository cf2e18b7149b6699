"""Files that a job names: beside the job file, or sent with it.

In the tables of a job before validation, missing tables, and values of another type, count as empty.
"""

from collections.abc import Mapping
from pathlib import Path, PurePath
from typing import Any

from ...model.errors import InputError, JobError
from ...model.file_name_encoding import path_from_text
from ...objectives.units import quote
from .text_table import TableFile, decode_file_text, read_file_bytes, read_table


def table_in(tables: Mapping[str, Any], name: str) -> Mapping[Any, Any]:
    """Return the table under a key; keys in it that are not text raise an error later."""
    table = tables.get(name)
    return table if isinstance(table, Mapping) else {}


def tables_in(tables: Mapping[str, Any], name: str) -> list[Mapping[str, Any]]:
    """Return the tables in the list under a key."""
    parts = tables.get(name)
    return [part for part in parts if isinstance(part, Mapping)] if isinstance(parts, list | tuple) else []


def options_in(tables: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    """Return the options of all choices in a job."""
    return [option for choice in tables_in(tables, "choice") for option in tables_in(choice, "option")]


Files = Path | Mapping[str, str | bytes]
"""The folder that contains the files, or their contents by name."""
MOST_POINTS = 10_000
"""Maximum number of points on a curve in a job; a curve from a file is thinned to this number."""
LARGEST = 10_000_000
"""Maximum size of a file, bytes."""
SOURCE = "source"
"""Key that summarises the file that filled a table, in words; not part of the problem."""


def read_named_table(files: Files, key: str, file: str) -> TableFile:
    """Return the table in a file that a job names under a key. Raises `InputError`."""
    return read_table(read_named_text(files, key, file), f"{key}: {quote(file)}")


def read_named_text(files: Files, key: str, file: str) -> str:
    """Return the text of a file that a job names under a key. Raises `InputError`."""
    name = f"{key}: {quote(file)}"
    if PurePath(file).is_absolute() or ".." in PurePath(file).parts:
        raise JobError(f"{key}: must be in the folder of the job file; got {quote(file)}; copy it there")
    if isinstance(files, Path):
        return decode_file_text(read_file_bytes(files / path_from_text(file), name, LARGEST), name)
    if file not in files:
        sent = f" ({', '.join(files)})" if files else ""
        raise JobError(f"{name} not found among the files sent with the job{sent}; send it too")
    content = files[file]
    return content if isinstance(content, str) else decode_file_text(content, name)


def unread_file_error(file: str, instead: str) -> InputError:
    """Return the error for an unread file. instead: keys that may replace it."""
    return InputError(
        f"a file must be in the folder of the job file, or be sent with the job (API: files), and replaces "
        f"{instead}; got file {quote(file)}; send it, or give only the {instead}"
    )


def require_point_count(count: int, name: str, least: int) -> None:
    """Raise `InputError` for more points than a job may have, or fewer than `least`. name: file name for messages."""
    if count < least:
        raise InputError(f"{name} must have at least {least} different points; got {count}; add rows")
    if count > MOST_POINTS:
        raise InputError(
            f"{name} must have at most {MOST_POINTS:,} significant points; got {count:,}; smooth the curve, or keep "
            f"one line in {-(-count // MOST_POINTS)} and the last one"
        )
