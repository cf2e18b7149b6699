"""Mistakes in a TOML text in words: the key, what is wrong with it, and the remedy."""

from __future__ import annotations

import re

from ...objectives.units import number_and_unit
from .messages import nodes_at

_LONGEST = 500  # of a line that is read for its key
_WORD = r"""(?:[\w-]+|"[^"\n]*"|'[^'\n]*')"""
_KEY = re.compile(rf"^\s*({_WORD}(?:\s*\.\s*{_WORD})*)\s*=")
_HEADER = re.compile(r"^\s*(\[\[?)\s*([^\[\]#]+?)\s*\]\]?\s*(?:#.*)?$")
_COMMA = re.compile(r"""(?:"[^"]*"|'[^']*'|[^"'#])*?[=\[,:{]\s*([+-]?\d+,\d+)(?=\s*(?:[,\]}#]|$))""")
_INLINE = re.compile(r"([\w-]+)\s*=\s*$")
_TWICE = re.compile(r"Cannot overwrite a value|Duplicate inline table key '(?P<inline>[^']*)'")
_AGAIN = re.compile(r"Cannot declare \((?P<names>.*?),?\) twice")


def in_words(text: str, error: str) -> str | None:
    """Return rule, value and remedy for a parser's error in a text; None for a mistake without words of its own."""
    place = re.search(r"line (\d+)", error)  # none at the end of the text
    lines = [line[:_LONGEST] for line in text.splitlines()]
    number = min(int(place[1]), len(lines)) if place else len(lines)
    comma = _COMMA.match(lines[number - 1])
    if comma is not None and not (_TWICE.search(error) or _AGAIN.search(error)):
        key, point = _key_at(lines, number, comma.start(1)), comma[1].replace(",", ".")
        unit, got = _unit_of(key), f"got {comma[1]} in line {number}"
        where = f"{key}: " if key else ""
        if unit is None:
            return f"{where}use a decimal point; {got}; write {point}, or with its unit in quotes"
        if not unit:
            return f"{where}use a decimal point; {got}; write {point}"
        return f'{where}use a decimal point and give the unit; {got}; write "{point} {unit}" if {unit} is meant'
    if again := _AGAIN.search(error):
        name = ".".join(re.findall(r"'([^']*)'", again["names"]))
        remedy = "join the two; tables of which a job has several, such as loads, have double brackets"
        if f"[[{name}]]" in text:
            remedy = f"write [[{name}]], in double brackets, here too"
        return f"[{name}]: each table may come once; got it again in line {number}; {remedy}"
    if twice := _TWICE.search(error):
        while number > 1 and not _KEY.match(lines[number - 1]):  # the error is at the end of a long value
            number -= 1
        path = ".".join(filter(None, (_key_at(lines, number), twice["inline"])))
        return f"{path}: key given twice, {_both(lines, number, path)}; remove one"
    return None


def key_at(text: str, number: int) -> str:
    """Return the key of a line of a text, counted from 1, with the table that it stands in; "" without one."""
    return _key_at(text.splitlines(), number)


def _key_at(lines: list[str], number: int, column: int | None = None) -> str:
    """Return the key of a line; of an inline table the key before a column."""
    line = lines[number - 1][:_LONGEST]
    key = _KEY.match(line)
    if not key:
        return ""
    headers = (_HEADER.match(line) for line in reversed(lines[: number - 1]))
    header = next((found for found in headers if found), None)
    inline = _INLINE.search(line, 0, column) if column is not None else None
    parts = (header and header[2], key[1], inline and inline.start(1) > key.start(1) and inline[1])
    return ".".join(part for part in parts if part)


def _both(lines: list[str], number: int, path: str) -> str:
    """Return in words in which lines a key stands that comes again in one."""
    first = next((n for n in range(1, number) if _key_at(lines, n) == path), None)
    return f"again in line {number}" if first is None else f"in lines {first} and {number}"


def _unit_of(path: str) -> str | None:
    """Return the unit of the example of a key, "" for a number without one; None for an unknown key."""
    from .model import Job
    from .schema import schema_of

    schema, words = schema_of(Job), [word.strip() for word in path.split(".")]
    for keys in (words, [words[0], 0, *words[1:]]):
        example = next((node["examples"][0] for node in nodes_at(schema, keys) if node.get("examples")), None)
        example = example[0] if isinstance(example, list) and example else example
        if isinstance(example, str) and (parts := number_and_unit(example)):
            return parts[1]
        if isinstance(example, int | float):
            return ""
    return None
