"""Values of a job file that were written without their quotes."""

from __future__ import annotations

import re

_LONGEST = 60  # of a value that is repeated in a message
_QUOTED = re.compile(r"\"[^\"]*\"|'[^']*'|#.*")
_BARE = r"(?:[+-]?\d[\d.]*(?:e[+-]?\d+)?[ \t]*)?[A-Za-zµ°%]"  # how a word begins, or a number with its unit
_LINE = re.compile(rf"[^=\[{{]+=\s*({_BARE}[^=\[{{]*)")
_PART = re.compile(rf"[=:,\[{{]\s*({_BARE}[^=,:\]}}]*)(?=[,\]}}]|$)")


def remedy(text: str, error: str) -> str:
    """Return the remedy for a parser's error, told with its line: quotes for a value that lacks them."""
    place = re.search(r"line (\d+)", error)
    lines = text.splitlines()
    line = lines[min(int(place[1]), len(lines)) - 1] if place else lines[-1]  # "at end of document"
    line = "" if line.lstrip().startswith("[") else _QUOTED.sub("", line)
    whole = _LINE.fullmatch(line)
    for value in (match[1].strip() for match in ([whole] if whole else _PART.finditer(line))):
        if len(value) <= _LONGEST and value not in ("true", "false", "null", "nan", "inf"):
            return f'put {value} in quotes: "{value}"'
    return "correct the line"
