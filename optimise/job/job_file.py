"""Reading of job files: from bytes to tables. Rejects everything that is not a job file."""

import json
import re
import stat
import tomllib
from collections import Counter
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ...model.errors import JobError
from ...objectives.units import quote
from .mistake_messages import DEEPEST, key_of_location
from .toml_errors import explain_toml_error

LARGEST = 1_000_000
"""Bytes. A job with the maximum number of values takes half of it, at ten characters each."""
MOST = 50_000
"""Maximum number of values, lists and tables in a job: enough for two [[load]] tables with 10,000 points. Each takes up
to 30 us."""
# Possessive, and an unclosed text ends with the file, so the search time is proportional to the file's length.
_WORD = r"""(?:[\w-]++|"(?:[^"\\\n]|\\.)*+"?+|'[^'\n]*+'?+)"""
_TEXT = r'''"""(?:[^"\\]|\\.|"(?!""))*+(?:"""|\Z)|''' + r"""'''(?:[^']|'(?!''))*+(?:'''|\Z)"""
_DOT = r"[ \t]*+\.[ \t]*+"
_DEEP = rf"{_WORD}(?:{_DOT}{_WORD}){{{DEEPEST}}}"
_PASSED = re.compile(rf"(?s)(?:{_TEXT})|\"(?:[^\"\\\n]|\\.)*+\"?+|'[^'\n]*+'?+|#[^\n]*+")
"""Texts and comments."""
_DEEP_KEY = re.compile(rf"(?s)(?:(?:{_TEXT})|#[^\n]*+|(?!{_DEEP})(?:{_WORD}(?:{_DOT}{_WORD})*+|.))*+{_DEEP}")


def read_job_file(path: Path) -> dict[str, Any]:
    """Return the tables of a job file, as TOML or JSON according to its suffix. Raises JobError."""
    if path.suffix.casefold() not in (".toml", ".json"):
        raise JobError(
            f"the name of a job file must end in .toml or .json; got {quote(path.suffix or path.name)}; rename the file"
        )
    content = _read_bytes(path)
    if b"\0" in content:
        raise JobError("a job file must be plain UTF-8 text; got a binary or UTF-16 file; save it as UTF-8")
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content[: error.start].count(b"\n") + 1
        raise JobError(
            f"line {line}: a job file must be saved as UTF-8; got byte 0x{content[error.start]:02x}, which is not; in "
            "the editor choose Save as, encoding UTF-8"
        ) from None
    if not text.strip():
        raise JobError("a job file must not be empty; got an empty file; start from an example")
    return _parse_tables(text, path.suffix.casefold())


def _read_bytes(path: Path) -> bytes:
    """Return the content of a regular file of moderate size."""
    try:
        status = path.stat()
        if stat.S_ISDIR(status.st_mode):
            raise JobError("a job must be a file; got a directory; name the file in it")
        if not stat.S_ISREG(status.st_mode):
            raise JobError("a job must be a regular file; got a device or a pipe; save the job to a file")
        size = status.st_size
        if size <= LARGEST:
            with path.open("rb") as file:
                content = file.read(LARGEST + 1)
            size = len(content)
        if size > LARGEST:
            raise JobError(f"a job file must be at most 1 MB in size; got {size / 1e6:.1f} MB; is it the right file?")
        return content
    except FileNotFoundError:
        raise JobError("no such file; check the name and the folder") from None
    except PermissionError:
        raise JobError("the file is not readable; check its permissions") from None
    except (OSError, ValueError) as error:  # ValueError: a path with a null character
        raise JobError(f"the file cannot be read: {error}") from None


def _parse_tables(text: str, suffix: str) -> dict[str, Any]:
    if suffix == ".toml":
        return toml_tables(text)
    try:
        data = json.loads(text, object_pairs_hook=_object_without_duplicates)
    except RecursionError:
        raise _too_deep_error() from None
    except JobError:
        raise
    except json.JSONDecodeError as error:
        line = text.split("\n")[error.lineno - 1].strip()
        raise JobError(
            f"line {error.lineno}: the file must be JSON; got {quote(line)}, which is invalid from column "
            f"{error.colno}; put names, texts and values with units in double quotes, and commas between entries"
        ) from None
    except ValueError:
        raise _too_long_error() from None
    if not isinstance(data, dict):
        raise JobError(f"a job must be a JSON object; got {quote(data)}; put it in braces")
    return data


def toml_tables(text: str) -> dict[str, Any]:
    """Return the tables of a TOML text. Raises JobError.

    Dotted keys with more than `DEEPEST` words raise an error before the text is parsed, because `tomllib` takes time
    and memory that grow with the square of their length. So do texts with far more values than a job may have; each
    value has one or two of the counted signs.
    """
    if _DEEP_KEY.match(text):
        raise _too_deep_error()
    signs = _PASSED.sub("", text)
    if sum(signs.count(sign) for sign in "=,[{") > 2 * MOST + 100:
        raise _too_many_values_error("more")
    try:
        return tomllib.loads(text)
    except RecursionError:
        raise _too_deep_error() from None
    except ValueError as error:
        if "set_int_max_str_digits" in str(error):  # advice for programmers
            raise _too_long_error() from None
        raise JobError(explain_toml_error(text, str(error))) from None


def _too_deep_error() -> JobError:
    return JobError(f"tables must be nested at most {DEEPEST} deep; got more; flatten the file")


def _too_long_error() -> JobError:
    return JobError("a number must have a few digits only; got thousands; shorten it")


def _object_without_duplicates(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """Return an object; reject duplicate keys: JSON would silently use the last one."""
    table = dict(pairs)
    if len(table) < len(pairs):
        twice = Counter(name for name, _ in pairs).most_common(1)[0][0]
        raise JobError(f"a key may be given only once; got {quote(twice)} twice; remove one")
    return table


def _too_many_values_error(count_text: str) -> JobError:
    return JobError(
        f"a job must have at most {MOST} values, lists and tables; got {count_text}; leave some out, such as points "
        "of long "
        "tables"
    )


def require_few_values(tables: object) -> None:
    """Raise JobError for data with more values, lists and tables than a job may have."""
    left, count = [tables], -1
    while left:
        count += 1
        item = left.pop()
        if isinstance(item, Mapping | list | tuple):
            left += item.values() if isinstance(item, Mapping) else item
    if count > MOST:
        raise _too_many_values_error(f"{count}")


def require_few_values_and_no_nulls(value: object, at: tuple[object, ...] = ()) -> None:
    """Reject data with too many values or too many levels, keys that are not text, and nulls. Raises JobError.

    at: path of the data in the job.
    """
    if not at:
        if not isinstance(value, Mapping):
            raise JobError(f"a job must be a table of keys; got {quote(value)}")
        require_few_values(value)
    if len(at) > DEEPEST:
        raise JobError(f"tables must be nested at most {DEEPEST} deep; got more; flatten the job")
    if isinstance(value, Mapping):
        for key, item in value.items():
            if not isinstance(key, str):
                raise JobError(f"a key must be text; got {quote(key)}")
            if item is None:
                raise JobError(f"{key_of_location((*at, key))}: must have a value; got null; leave the key out instead")
            require_few_values_and_no_nulls(item, (*at, key))
    elif isinstance(value, list | tuple):
        for place, item in enumerate(value):
            require_few_values_and_no_nulls(item, (*at, place))
