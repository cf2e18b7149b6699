"""Mistakes in a TOML text in words: the key, what is wrong with it, and the remedy."""

from __future__ import annotations

import re

_LONGEST = 500  # of a line that is read for its key
_WORD = r"""(?:[\w-]+|"[^"\n]*"|'[^'\n]*')"""
_KEY = re.compile(rf"^\s*({_WORD}(?:\s*\.\s*{_WORD})*)\s*=")
_HEADER = re.compile(r"^\s*(\[\[?)\s*([^\[\]#]+?)\s*\]\]?\s*(?:#.*)?$")
_COMMA = re.compile(r"""(?:"[^"]*"|'[^']*'|[^"'#])*?[=\[,:{]\s*([+-]?\d+,\d+)(?=\s*(?:[,\]}#]|$))""")
_TWICE = re.compile(r"Cannot overwrite a value|Duplicate inline table key '(?P<inline>[^']*)'")
_AGAIN = re.compile(r"Cannot declare \((?P<names>.*?),?\) twice")


def in_words(text: str, error: str) -> str | None:
    """Return rule, value and remedy for a parser's error in a text; None for a mistake without words of its own."""
    place = re.search(r"line (\d+)", error)  # none at the end of the text
    lines = [line[:_LONGEST] for line in text.splitlines()]
    number = min(int(place[1]), len(lines)) if place else len(lines)
    comma = _COMMA.match(lines[number - 1])
    if comma is not None and not (_TWICE.search(error) or _AGAIN.search(error)):
        key = _KEY.match(lines[number - 1])
        where = f"{_path(lines, number, key[1])}: " if key else ""
        return (
            f"{where}the decimal sign is a point; got {comma[1]} in line {number}; write {comma[1].replace(',', '.')}"
        )
    if again := _AGAIN.search(error):
        name = ".".join(re.findall(r"'([^']*)'", again["names"]))
        remedy = "join the two; tables of which a job has several, such as loads, have double brackets"
        if f"[[{name}]]" in text:
            remedy = f"write [[{name}]], in double brackets, here too"
        return f"[{name}]: each table may come once; got it again in line {number}; {remedy}"
    if twice := _TWICE.search(error):
        while number > 1 and not _KEY.match(lines[number - 1]):  # the error is at the end of a long value
            number -= 1
        key = _KEY.match(lines[number - 1])
        path = _path(lines, number, key[1]) if key else ""
        path = ".".join(filter(None, (path, twice["inline"])))
        return f"{path}: each key may come once; got it again in line {number}; remove one of the two"
    return None


def _path(lines: list[str], number: int, key: str) -> str:
    """Return the key of a line, counted from 1, with the table that it stands in."""
    headers = (_HEADER.match(line) for line in reversed(lines[: number - 1]))
    header = next((found for found in headers if found), None)
    return f"{header[2]}.{key}" if header else key
