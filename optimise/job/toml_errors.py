"""Mistakes in the syntax of a TOML text, in words: the key, the rule, what was typed, and how to write it.

The parser says only where it stops. So the line is tried with each of some edits; the one with which most of it can be
read is kept, until all of it can be. A remedy is therefore always a line that the parser takes.
"""

from __future__ import annotations

import re
import tomllib
from collections import Counter
from collections.abc import Callable, Iterator, Sequence

from ...objectives.units import number_and_unit
from .messages import SEVERAL, SINGLE, example_of, key_of, nodes_at
from .model import Job
from .schema import schema_of

_LONGEST = 1000  # of a line that is read and edited
_MOST_SHOWN = 80  # characters of a line that are repeated
_LIST = "x = ["
"""What stands before a line of a list that began above it."""
_PLACE = re.compile(r"at line (\d+), column (\d+)")
_TWICE = re.compile(r"Cannot |Duplicate inline table key '(.*)'")
_WORD = r"""(?:[\w-]+|"[^"\n]*"|'[^'\n]*')"""
_PATH = rf"{_WORD}(?:\s*\.\s*{_WORD})*"
_KEY = re.compile(rf"\s*({_PATH})\s*[=:]")
_HEADER = re.compile(rf"\s*(\[\[?)\s*({_PATH})\s*\]\]?\s*(?:#.*)?")
_NAME = re.compile(rf"\s*(\[*)\s*({_PATH})\s*([\])}}]*)\s*[:;,]?\s*((?:#.*)?)")
_INNER = re.compile(r"([\w-]+)\s*=\s*\[?\s*$")
_PASSED = r"""("(?:[^"\\]|\\.)*"|'[^']*'|#.*)|"""
"""Whole texts and comments, which an edit leaves as they are."""
_APART = r"=,;:\[\]{}()#\"'"
_VALUE = re.compile(
    rf"{_PASSED}(?<=[=\[,;{{])(\s*)([+-]?\d+,\d+(?![\d,])[^{_APART}]*?|[^\s{_APART}][^{_APART}]*?)"
    r"(?=\s*(?:[,;\]})#]|//|--|/\*|$))"
)
_DIGITS = re.compile(r"([+-]?)(\d*)([.,]?)(\d*)([eE][+-]?\d+)?", re.ASCII)
_WRITTEN = re.compile(r"(?=.*[^\W\d]|.*[%°±\"]|[+-]?\d*[.,]?\d*$)")
"""A text, a value with a unit or a number, however they are written."""
_BORDER = re.compile(r"(?<=[=\[,{])\s*()(?=\S)|(?<=\S)()(?=\s*(?:[,\]}#]|$))")
Path = tuple[str | int, ...]
"""Keys of a table and of what stands in it, from the top of the file on."""
Edit = Callable[[str], tuple[str, str]]
"""Returns the rule that it restores, and the line edited."""


def _edit(wrong: str, right: str, rule: str) -> Edit:
    """Return the edit that replaces a pattern outside of texts and comments."""
    pattern = re.compile(f"{_PASSED}(?:{wrong})")
    return lambda line: (rule, pattern.sub(lambda found: found[1] or found.expand(right), line))


_SIGNS: tuple[Edit, ...] = (
    _edit("[“”„‟«»‘’‚‛`´″]", '"', "text must be in straight quotes"),
    _edit("'", '"', "text must end with the quote that it begins with"),
    _edit("[−–]", "-", "a minus sign must be the - of the keyboard"),
    _edit("[\u00a0\u2007\u2009\u202f]", " ", "spaces must be ordinary ones"),
)
"""Before values are read."""
_COMMAS = _edit(r"\s*;\s*(?!\s*(?:#|$))", ", ", "values must be separated by commas")
_EDITS: tuple[Edit, ...] = (
    _edit(r"(?:^\s*[;!%]|//|--|/\*)\s*(.*?)\s*(?:\*/\s*)?$", r"# \2", "a comment must begin with #"),
    _edit(r"\s*(?::=?|=[=>]|<-)\s*", " = ", "there must be = between a key and its value"),
    _edit(r"^(\s*[\w.-]+)\s+(?=[\"'\d+\[{-])", r"\2 = ", "there must be = between a key and its value"),
    lambda line: _with_decimal_points(line),
    _COMMAS,
    _edit(r"(?<=[\"'\]}\w])\s+(?=[\"'\[{\d]|[\w-]+\s*=)", ", ", "values must be separated by commas"),
    _edit(r"\s*[;,](?=\s*(?:#|$))", "", "a line must end after its value"),
    _edit(r"\s*[;,]?\s+(?=[\w.-]+\s*=)", "\n", "each key must have a line of its own"),
    _edit(r",\s*(?=})", " ", "there must be no comma before a closing brace"),
    _edit(r"(?<=[^\s{])\s*$", " }", "a table in braces must be on one line"),
    _edit(r"\(([^()]*)\)", r"[\2]", "a list must be in square brackets"),
    _edit(r"(?<==)\s*([^\[{#]*,[^#]*?)\s*(?=#|$)", r" [\2]", "a list must be in square brackets"),
    _edit(rf"(?<==)\s*([^\W\d][^{_APART}]*(?:,[^{_APART}]*)*?)\s*(?=#|$)", r' "\2"', "text must be in quotes"),
    lambda line: ("folders in a path must be separated by /", line.replace("\\", "/")),
    lambda line: _with_brackets(line),
)


def in_words(text: str, error: str) -> str:
    """Return key, rule, value and remedy for a parser's error in a text."""
    lines = text.replace("\r\n", "\n").split("\n")
    place = _PLACE.search(error)  # none at the end of the text
    number = min(int(place[1]), len(lines)) if place else len(lines)
    number = next((n for n in range(number, 0, -1) if lines[n - 1].strip()), 1)
    begins = _begins(lines[number - 1])
    start = next((n for n in range(number - 1, 0, -1) if _begins(lines[n - 1])), number)
    if twice := _TWICE.search(error):
        return _repeated(lines[: number if begins else start], twice[1])
    within = start < number and _left(lines[start - 1 : number - 1]) < 0
    if not place or (within and begins):
        first = start if within else number
        if _left(lines[first - 1 : number - begins * within]) < 0:
            return _unclosed(lines[:first], f"line {number}" if place else "the end of the file")
    path = _path_of(lines[: start if within else number])
    before = _LIST if within else ""
    if within and _left([before + lines[number - 1]]) <= 0:
        number = max(n for n in range(start, number) if lines[n - 1].strip())
        rules, edited = ["values must be separated by commas"], f"{lines[number - 1].rstrip()},"
    else:
        rules, edited = _edited(before + lines[number - 1], path)
    line, edited = lines[number - 1], edited.removeprefix(before)
    if rules:
        got, write = (_shown(_around(one, _same(line, edited))) for one in (line, edited))
        return f"{_named(path)}{'; '.join(rules)}; got {got} in line {number}; write {write}"
    like = example_of(schema_of(Job), path) or "key = value, [table], or # and a comment"
    got = _shown(_around(line, int(place[2]) if place else 0))
    return (
        f"{_named(path)}must be a line like {like}; got {got} in line {number}; write keys in plain letters, and texts "
        "and values with units in quotes"
    )


def _begins(line: str) -> bool:
    """Whether a line begins a key or a table."""
    return bool(_KEY.match(line[:_LONGEST]) or _HEADER.fullmatch(line[:_LONGEST]))


def _left(lines: Sequence[str]) -> int:
    """Return how much of lines the parser does not read, in signs other than quotes and spaces, counted from 1.

    0 if it reads all of it, -1 if the lines end within a list or text.
    """
    text = "\n".join(lines) + "\n"
    try:
        tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        place = _PLACE.search(str(error))
        rest = text.split("\n")[int(place[1]) - 1 :] if place else []
        return 1 + len(re.sub("[\\s\"']", "", "\n".join(rest)[int(place[2]) - 1 :])) if place else -1
    return 0


def _edited(line: str, path: Path) -> tuple[list[str], str]:
    """Return the rules that a line breaks and the line as they want it; no rules if it cannot be read even then."""
    rules: list[str] = []
    left = _left([line]) if len(line) <= _LONGEST else 0
    while left > 0:
        tried = [*(edit(line) for edit in _SIGNS), _with_values(line, path), *(edit(line) for edit in _EDITS)]
        tried += _with_a_quote(line)
        rule, line = min(tried, key=lambda one: max(_left([one[1]]), 0))
        left, before = _left([line]), left
        if left >= before:
            return [], line
        rules += [rule] if rule not in rules else []
    return rules, line


def _with_values(line: str, path: Path) -> tuple[str, str]:
    """Return a line whose values are numbers or in quotes, and the rule of the first that was neither."""
    rules = []

    def value(found: re.Match[str]) -> str:
        if found[1] or not _left([f"x = {found[3]}"]) or not _WRITTEN.match(found[3]):
            return found[0]
        inner = _INNER.search(line[: found.start(3)])
        in_braces = inner is not None and "{" in line[: inner.start()]
        rule, text = _value(found[3], (*path, inner[1]) if inner and in_braces else path)
        rules.append(rule)
        return found[2] + text

    edited = _VALUE.sub(value, line) if "=" in line else line
    return rules[0] if rules else "", edited


def _value(token: str, path: Path) -> tuple[str, str]:
    """Return what is wrong with the value of a key, and the value as it is to be written."""
    if token.lower() in ("true", "false"):
        return "true and false must be in lower case", token.lower()
    point = re.sub(r"^([+-]?\d*),(\d)", r"\1.\2", token)
    rules = ["use a decimal point"] if point != token else []
    digits = _DIGITS.fullmatch(token)
    if digits is None or not (digits[2] or digits[4]):
        measured = token[0] in "+-.0123456789"
        rules.append("a value with a unit must be in quotes" if measured else "text must be in quotes")
        return "; ".join(rules), f'"{point}"'
    sign, whole, separator, part, power = digits.groups(default="")
    number = f"{sign}{whole.lstrip('0') or '0'}{f'.{part or 0}' if separator else ''}{power}"
    rules = rules or ["numbers are written like 2 or 0.5"]
    unit = _unit_of(path)
    if not unit:
        return rules[0], number
    return f"{rules[0]} and give the unit, such as {unit}", f'"{number} {unit}"'


def _unit_of(path: Path) -> str:
    """Return the unit of the example of a key; "" without one."""
    example = next((node["examples"][0] for node in nodes_at(schema_of(Job), path) if node.get("examples")), None)
    first = example[0] if isinstance(example, list) and example else example
    parts = number_and_unit(first) if isinstance(first, str) else None
    return parts[1] if parts else ""


def _with_a_quote(line: str) -> Iterator[tuple[str, str]]:
    """Yield a line with one more quote at each place where a text may begin or end."""
    if re.search("[\"']", re.sub(_PASSED[:-1], "", line)):
        for place in (border.end() for border in _BORDER.finditer(line)):
            yield "text must have quotes on both sides", f'{line[:place]}"{line[place:]}'


def _with_decimal_points(line: str) -> tuple[str, str]:
    """Return a line of decimal commas between semicolons with points between commas."""
    decimal = re.sub(r"(\d),(\d)", r"\1.\2", line)
    rule = "values must be separated by commas, and decimals by a point"
    return rule, line if decimal == line else _COMMAS(decimal)[1]


def _with_brackets(line: str) -> tuple[str, str]:
    """Return the name of a table with as many brackets after it as before it."""
    rule = "a table name must have the same brackets on both sides"
    found = _NAME.fullmatch(line)
    if found is None:
        return rule, line
    count = min(len(found[1]) or found[3].count("]"), 2)
    return rule, f"{'[' * count}{found[2]}{']' * count} {found[4]}".rstrip()


def _unclosed(lines: Sequence[str], end: str) -> str:
    """Return the message on a list or text that begins in the last of some lines. end: where it is still open."""
    line = lines[-1]
    what, sign = next(((f"text after {three}", three) for three in ('"""', "'''") if three in line), ("a list", "]"))
    got = f"got {_shown(line)} in line {len(lines)} without {sign} before {end}"
    return f"{_named(_path_of(lines))}{what} must end with {sign}; {got}; add it"


def _repeated(lines: Sequence[str], inner: str | None) -> str:
    """Return the message on a key or table that stands in the last of some lines and above. inner: a key in braces."""
    *above, (_, path, brackets) = _paths(lines)
    if inner:
        return f"{key_of((*path, inner))}: may be given only once; got it twice in line {len(lines)}; remove one"
    near = [one for one in above if one[1][: len(path)] == path or path[: len(one[1])] == one[1]]
    first, other, opened = max(near, key=lambda one: (min(len(one[1]), len(path)), one[1] == path))
    shared = min(path, other, key=len)
    name = key_of(shared)
    if brackets and opened and brackets != opened:
        several = any(node.get("type") == "array" for node in nodes_at(schema_of(Job), path))
        opening, rule = ("[[", SEVERAL) if several else ("[", SINGLE)
        where, wrong = (len(lines), brackets) if opened == opening else (first, opened)
        got, write = (f"{signs}{name}{']' * len(signs)}" for signs in (wrong, opening))
        return f"{name}: {rule}; got {got} in line {where}; write {write}"
    remedy = "put its keys in one place" if brackets or opened or path != other else "remove one"
    return f"{name}: may be given only once; got it in lines {first} and {len(lines)}; {remedy}"


def _paths(lines: Sequence[str]) -> Iterator[tuple[int, Path, str]]:
    """Yield line, path and opening brackets of each table and, without brackets, of each key that lines begin."""
    table: Path = ()
    count = Counter[Path]()
    for number, line in enumerate((line[:_LONGEST] for line in lines), start=1):
        if header := _HEADER.fullmatch(line):
            name = table = _words(header[2])
            if header[1] == "[[":
                table = (*name, count[name])
                count[name] += 1
            yield number, name, header[1]
        elif key := _KEY.match(line):
            yield number, (*table, *_words(key[1])), ""


def _words(path: str) -> Path:
    return tuple(word.strip("\"'") for word in re.findall(_WORD, path))


def _path_of(lines: Sequence[str]) -> Path:
    """Return the key that the last of some lines begins; an empty one if it begins none."""
    *_, (number, path, brackets) = ((0, (), ""), *_paths(lines))
    return path if number == len(lines) and not brackets else ()


def _named(path: Path) -> str:
    """Return how a message on a key begins; "" without a key."""
    return f"{key_of(path)}: " if path else ""


def _same(one: str, other: str) -> int:
    """Return how many characters of two texts are the same from their beginnings on."""
    return next((n for n, (a, b) in enumerate(zip(one, other, strict=False)) if a != b), min(len(one), len(other)))


def _around(line: str, place: int) -> str:
    """Return a line, or of a long one what stands around a place in it."""
    return line if len(line) <= _MOST_SHOWN else line[max(place - _MOST_SHOWN // 2, 0) :]


def _shown(line: str) -> str:
    """Return a line for a message: printable, of moderate length."""
    text = line.strip().replace("\n", " and below it ")
    text = "".join(sign if sign.isprintable() else "?" for sign in text)
    return text if len(text) <= _MOST_SHOWN else f"{text[:_MOST_SHOWN]}..."
