"""Jobs as TOML: writes the tables of a job so that reading them gives the same tables."""

import json
import math
import re
from collections.abc import Mapping
from typing import Any

from ...model.errors import JobError

_BARE = re.compile(r"[A-Za-z0-9_-]+")
_WIDEST = 100


def job_toml(tables: Mapping[str, Any]) -> str:
    """Return the tables of a job as the text of a job file.

    Tables get headings, nested tables stay in braces, as in the included jobs. Raises `JobError` for values that TOML
    cannot express: null and non-finite numbers.
    """
    plain = [f"{_key_toml(key)} = {_value_toml(value)}" for key, value in tables.items() if not _is_table(value)]
    parts = ["\n".join(plain)] if plain else []
    for key, value in tables.items():
        if isinstance(value, Mapping):
            parts.append(_table_toml(f"[{_key_toml(key)}]", value))
        elif _is_table(value):
            parts += [_table_toml(f"[[{_key_toml(key)}]]", item) for item in value]
    return "\n\n".join(parts) + "\n"


def _is_table(value: object) -> bool:
    return isinstance(value, Mapping) or (
        isinstance(value, list) and bool(value) and all(isinstance(item, Mapping) for item in value)
    )


def _table_toml(heading: str, table: Mapping[str, Any]) -> str:
    return "\n".join([heading, *(f"{_key_toml(key)} = {_value_toml(value)}" for key, value in table.items())])


def _key_toml(key: str) -> str:
    return key if _BARE.fullmatch(key) else _text_toml(key)


def _value_toml(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return _text_toml(value)
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float) and math.isfinite(value):
        return repr(value)
    if isinstance(value, Mapping):
        return (
            "{ " + ", ".join(f"{_key_toml(key)} = {_value_toml(item)}" for key, item in value.items()) + " }"
            if value
            else "{}"
        )
    if isinstance(value, list):
        items = [_value_toml(item) for item in value]
        line = "[" + ", ".join(items) + "]"
        # Only a list may span several lines.
        return line if len(line) <= _WIDEST else "[\n" + "".join(f"    {item},\n" for item in items) + "]"
    word = "null" if value is None else str(value)[:60]
    raise JobError(f"a job may only contain text, finite numbers, lists and tables; got {word}; leave the key out")


def _text_toml(text: str) -> str:
    # JSON escapes are valid in TOML, except for characters beyond 16 bits, which stay unescaped, and DEL.
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")
