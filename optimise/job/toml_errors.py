"""Mistakes in TOML syntax, in words: line and key, rule, typed text, and correction.

The parser only says where it stops. So each of several edits is tried on the line. The edit that lets the parser
read furthest is kept, and the next one is tried, until the parser reads the whole line. A remedy is therefore always a
line that the parser accepts.
"""

import math
import re
import tomllib
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from itertools import takewhile

from pydantic import ValidationError

from ...objectives.units import SPACES, number_and_unit
from .mistake_messages import (
    SEVERAL,
    SINGLE,
    example_of_key,
    headings_with_keys,
    key_of_location,
    keys_of_location,
    mistake_sentence,
    schema_nodes_at,
)
from .model import Job, schema_of
from .plain_numbers import key_above

_LONGEST = 1000  # maximum length of a line to read and edit
_LONGEST_EXCERPT = 200  # maximum number of characters to quote from a line
_MOST_JOINED = 8  # maximum number of lines that may form one
_LIST = "x = ["
"""Prefix for a line of a list that began above it."""
_PLACE = re.compile(r"at line (\d+), column (\d+)")
_TWICE = re.compile(r"Cannot |Duplicate inline table key '(.*)'")
_WORD = r"""(?:[\w-]+|"[^"\n]*"|'[^'\n]*')"""
_PATH = rf"{_WORD}(?:\s*\.\s*{_WORD})*"
_KEY = re.compile(rf"\s*({_PATH})\s*[=:]")
_BARE = re.compile(rf"\s*{_PATH}\s*[=:]?\s*")
_HEADER = re.compile(rf"\s*(\[\[?)\s*({_PATH})\s*\]\]?\s*(?:#.*)?")
_NAMES = re.compile(r"[\s(<{]*(\[*)\s*([^\W\d][\w-]*(?:[\s.,/]+[^\W\d][\w-]*)*)\s*(\]*)[\s)>}]*[=:;,]?\s*")
"""A heading in any spelling."""
_INNER = re.compile(r"([\w-]+)\s*=\s*\[?\s*$")
_TEXT = r"""(?:"(?:[^"\\]|\\.)*"|'[^']*')"""
_ITEM = rf"(?:{_TEXT}|[-+]?[\d.]+(?:e[-+]?\d+)?)"
_PASSED = rf"({_TEXT}|#.*)|"
"""Complete texts and comments, which an edit leaves unchanged."""
_COMMENT = re.compile(rf"{_TEXT}|(\s*#.*)")
_SEPARATORS = r"=,;:\[\]{}()#\"'"
_FORMULA = r"(?=[^\"'#=<>]{0,200}[^\W\d])[^\"'#=<>]{1,200}"
_VALUE = re.compile(
    rf"{_PASSED}(?<=[=\[,;{{])(\s*)([+-]?\d+,\d+(?![\d,])[^{_SEPARATORS}]*?|[^\s{_SEPARATORS}][^{_SEPARATORS}]*?)"
    r"(?=\s*(?:[,;\]})]|//|--|/\*|$))"
)
_DIGITS = re.compile(r"([+-]?)(\d*)([.,]?)(\d*)([eE][+-]?\d+)?", re.ASCII)
_WRITTEN = re.compile(r"(?=.*[^\W\d]|.*[%°±\"]|[+-]?\d*[.,]?\d*$)")
"""A text, a value with a unit or a number, in any spelling."""
_BORDER = re.compile(r"(?<=[=\[,{])\s*()(?=\S)|(?<=\S)()(?=\s*(?:[,\]}]|$))")
Path = tuple[str | int, ...]
"""Keys of a table and of its content, from the top level of the file."""
Edit = Callable[[str], tuple[str, str]]
"""Returns the rule that the edit restores, and the edited line."""


def _edit_code(wrong: str, right: str, rule: str) -> Edit:
    """Return an edit that replaces a pattern outside texts and comments."""
    pattern = re.compile(f"{_PASSED}(?:{wrong})")
    return lambda line: (rule, pattern.sub(lambda found: found[1] or found.expand(right), line).rstrip(" "))


def _edit_all(wrong: str, right: str, rule: str) -> Edit:
    """Return an edit that replaces a pattern, even within texts.

    Its groups count from 2, as those of `_edit_code` do.
    """
    pattern = re.compile(f"()(?:{wrong})")
    return lambda line: (rule, pattern.sub(right, line))


_TEXT_QUOTED, _VALUE_QUOTED = "text must be in quotes", "a value with a unit must be in quotes"
_STRAIGHT, _EQUALS = "text must be in straight quotes", "there must be = between a key and its value"
_COMMENTED, _COMMA_RULE = "a comment must begin with #", "values must be separated by commas"
_BRACES, _SQUARE = "keys within a value must be in braces", "a list must be in square brackets"
_BELOW, _ABOVE = "a lower limit is written with min", "an upper limit is written with max"
_ONE_NAME = "a key must not contain spaces"
_SIGNS: tuple[Edit, ...] = (
    _edit_code("[“”„‟«»‘’‚‛`´″]", '"', _STRAIGHT),
    _edit_all("''", '"', _STRAIGHT),
    _edit_code("'", '"', "text must end with the quote it begins with"),
    _edit_code("[−–]", "-", "a minus sign must be the - of the keyboard"),
    _edit_code(
        f"[{SPACES}]", " ", "a space must be an ordinary space, not a non-breaking one (␣) from Word or a web page"
    ),
)
"""Edits to make before values are read."""
_COMMAS = _edit_code(r"(?<!\d,\d)(?<!\d,\d\d)(?<!\d,\d\d\d)\s*;\s*(?!\s*(?:$|[+-]?\d+,\d))", ", ", _COMMA_RULE)
_EDITS: tuple[Edit, ...] = (
    _edit_code(r"(?:^\s*[;!%]|//|--|/\*)\s*(.*?)\s*(?:\*/\s*(.*))?$", r"# \2 \3", _COMMENTED),
    _edit_code(r"\s*(?::=?|=[=>]|<-)\s*", " = ", _EQUALS),
    _edit_code(r"^(\s*[\w.-]+)\s*\"\s*=\s*", r'\2 = "', _EQUALS),
    _edit_code(r"^(\s*[\w.-]+)\s+(?=[\"'\d+\[{-])", r"\2 = ", _EQUALS),
    _edit_code(r"([{,]\s*[\w-]+)\s+(?=[\"'\d+\[{-])", r"\2 = ", _EQUALS),
    _edit_code(rf"^(\s*[\w.-]+)\s*=?\s*>=?\s*({_FORMULA})$", r'\2 = { min = "\3" }', _BELOW),
    _edit_code(rf"^(\s*[\w.-]+)\s*=?\s*<=?\s*({_FORMULA})$", r'\2 = { max = "\3" }', _ABOVE),
    _edit_code(rf"=?\s*>=?\s*({_TEXT}|[\d.]+)", r" = { min = \2 }", _BELOW),
    _edit_code(rf"=?\s*<=?\s*({_TEXT}|[\d.]+)", r" = { max = \2 }", _ABOVE),
    _edit_code(r"(?<={)\s*>=?\s*", " min = ", _BELOW),
    _edit_code(r"(?<={)\s*<=?\s*", " max = ", _ABOVE),
    _COMMAS,
    _edit_code(r"(?<=[\"'\]}\w])\s+(?=[\"'\[{\d]|[\w-]+\s*=)", ", ", _COMMA_RULE),
    _edit_code(r",\s*,", ",", "there must be one comma between values"),
    _edit_code(r"\s*[;,]$", "", "a line must not end with a comma or semicolon"),
    _edit_code(r"\s*[;,]?\s+(?=[\w.-]+\s*=)", "\n", "each key must have a line of its own"),
    _edit_code(r",\s*(?=})", " ", "there must be no comma before a closing brace"),
    _edit_code(r"=\s*(?=[\w-]+\s*=)", "= { ", _BRACES),
    _edit_code(r"(?<=[^\s{])$", " }", _BRACES),
    _edit_code(rf"{{(\s*{_ITEM}(?:\s*,\s*{_ITEM})*\s*)}}", r"[\2]", _SQUARE),
    lambda line: _bracket_heading(line),
    _edit_code(r"\(([^()]*)\)", r"[\2]", _SQUARE),
    _edit_code(r"(?<==)\s*(?=[^\[{]*\]$)", " [", _SQUARE),
    _edit_code(r"(?<==)\s*([^\[{]*,.*?)\s*$", r" [\2]", _SQUARE),
    _edit_all(r"^(\s*\w+(?:\.\w+)+)(\s+)([\w-]+)(?=\s*=)", r"\2.\4", _ONE_NAME),
    _edit_all(r"^(\s*[\w.-]+)(\s+)([\w-]+)(?=\s*=)", r"\2_\4", _ONE_NAME),
    _edit_all(
        r"^(\s*)(\w+)(?=\s*=)", r'\2"\3"', "a key outside quotes must consist of the letters a to z, digits, _ and -"
    ),
    _edit_code(
        r"\[\s*([\d.]+)\s*,\s*([\d.]+)\s*\]\s*([^\W\d]\w*)$", r'["\2 \4", "\3 \4"]', "each value must have its unit"
    ),
    _edit_all(
        r"\"([+-]?[\d.]+)\"\s+([^\W\d][^\",;\]}]*)$", r'"\2 \3"', "a unit must be within the quotes of its number"
    ),
    _edit_all(r"^(\s*)\"([\w.-]+)\s*=\s*([^\"]*)\"$", r'\2\3 = "\4"', "only a value may be in quotes"),
    _edit_code(rf"(?<==)\s*([^\W\d][^{_SEPARATORS}]*(?:,[^{_SEPARATORS}]*)*?)\s*$", r' "\2"', _TEXT_QUOTED),
    _edit_code(r"(?<=[\"\]}])\s+(?=[^\W\d][\w ,.-]*$)", "  # ", _COMMENTED),
    _edit_code(r"^(?=(?:[^\W\d][\w,.:-]*\s+){3,}[\w.]+$)", "# ", _COMMENTED),
    _edit_all(
        r"^(\s*[\w.-]+\s*=\s*\"[^\"]*\s)\"([^\"]+)\"([\s.,;:)][^\"]*\")$",
        r"\2'\3'\4",
        'text in double quotes must not contain "',
    ),
    lambda line: ("folders in a path must be separated by /", line.replace("\\", "/")),
)


def explain_toml_error(text: str, error: str) -> str:
    """Return line, key, rule, value and remedy for a parser error in a text."""
    lines = text.replace("\r\n", "\n").split("\n")
    place = _PLACE.search(error)  # at the end of the text there is none
    number = min(int(place[1]), len(lines)) if place else len(lines)
    number = next((n for n in range(number, 0, -1) if lines[n - 1].strip()), 1)
    begins = _begins_entry(lines[number - 1])
    start = next((n for n in range(number - 1, 0, -1) if _begins_entry(lines[n - 1])), number)
    code = _without_comment(lines[number - 1])
    if (twice := _TWICE.search(error)) and (begins or _bracket_heading(code)[1] == code):
        return _repeated_key_message(lines[: number if begins else start], twice[1])
    opened = [n for n, line in enumerate(lines, start=1) for _ in re.findall("\"\"\"|'''", line)]
    if not place and len(opened) % 2:
        return _unclosed_message(lines[: opened[-1]], "the end of the file")
    in_list = start < number and _unread_length(lines[start - 1 : number - 1]) < 0
    if not place or (in_list and begins):
        first = start if in_list else number
        if _unread_length(lines[first - 1 : number - begins * in_list]) < 0:
            return _unclosed_message(lines[:first], f"line {number}" if place else "the end of the file")
    path = _path_of_last_line(lines[: start if in_list else number]) or _path_of_last_line(
        [*lines[: number - 1], f"{code} ="]
    )
    like = example_of_key(schema_of(Job), path)
    before = _LIST if in_list else ""
    if like and _BARE.fullmatch(code) and _bracket_heading(code)[1] == code:
        rules, edited = ["there must be = and a value after a key"], like
    elif in_list and _unread_length([before + code]) <= 0:
        number = max(n for n in range(start, number) if _without_comment(lines[n - 1]).strip())
        code = _without_comment(lines[number - 1])
        rules, edited = ["a line of a list must end with a comma"], f"{code},"
    else:
        joined = [
            " ".join(map(_without_comment, lines[number - 1 : n])) for n in range(number + 1, number + _MOST_JOINED)
        ]
        few = not in_list and len(joined[-1]) <= _LONGEST
        last = next((number + n for n, one in enumerate(joined, start=1) if few and not _unread_length([one])), 0)
        if last:
            rule = "a text, or keys in braces, must be on one line"
            return f"{_line_prefix(number, path)}{rule}; got lines {number} to {last}; join them"
        rules, edited = _correct_line(before + code, path)
    if rules:
        edited = edited.removeprefix(before)
        path = path if in_list else _path_of_last_line([*lines[: number - 1], edited])
        if set(rules) <= {_TEXT_QUOTED, _VALUE_QUOTED} and (refused := _mistake_in_value(lines[: number - 1], edited)):
            return f"line {number}, {refused}"
        same = sum(1 for _ in takewhile(lambda pair: pair[0] == pair[1], zip(code, edited, strict=False)))
        typed, write = (_quote_line(one, same) for one in (code, edited))
        return f"{_line_prefix(number, path)}{'; '.join(rules)}; got {typed}; write {write}"
    like = like or "key = value, a heading like [objectives], or # and a comment"
    return (
        f"{_line_prefix(number, path)}must be a line like {like}; got "
        f"{_quote_line(code, int(place[2]) if place else 0)}; "
        "write keys in plain letters, and texts and values with units in quotes"
    )


def with_line_numbers(message: str, text: str) -> str:
    """Return a message on the tables of a TOML text, with mistakes in line order."""
    keys = list(_paths_of_lines(text.split("\n")))
    lines = {key_of_location(path[:-1]): number for number, path, brackets in reversed(keys) if brackets == "[["}
    lines |= {key_of_location(path): number for number, path, _ in keys}

    def with_line_number(match: re.Match[str]) -> str:
        key = match[2]
        while key and key not in lines:
            key = key_above(key)
        return f"{match[1]}line {lines[key]}, {match[2]}" if key else match[0]

    message = re.sub(r"(?m)^( *)([^\s:;=][^:;=\n]*)(?=: )", with_line_number, message)
    heading, *problems = message.split("\n")

    def place(problem: str) -> float:
        match = re.match(r" *line (\d+), ", problem)
        return float(match[1]) if match else math.inf

    return "\n".join([heading, *sorted(problems, key=place)])


def _without_comment(line: str) -> str:
    """Return a line without its comment."""
    return line[: next((comment.start() for comment in _COMMENT.finditer(line[:_LONGEST]) if comment[1]), None)]


def _mistake_in_value(lines_above: Sequence[str], line: str) -> str:
    """Return key and mistake for the value in a line with valid syntax; "" if it has none."""
    lines = [*(line_above for line_above in lines_above if _HEADER.fullmatch(line_above[:_LONGEST])), line]
    path = _path_of_last_line(lines)
    try:
        Job.model_validate(tomllib.loads("\n".join(lines)))
    except ValidationError as error:
        for details in error.errors(include_url=False):
            place = keys_of_location(details["loc"])
            if path and tuple(place[: len(path)]) == path and details["type"] not in ("missing", "extra_forbidden"):
                return f"{key_of_location(place)}: {mistake_sentence(details, schema_of(Job))}"
    except ValueError:  # duplicate headings
        pass
    return ""


def _begins_entry(line: str) -> bool:
    """Whether a line starts a key or a table."""
    return bool(_KEY.match(line[:_LONGEST]) or _HEADER.fullmatch(line[:_LONGEST]))


def _unread_length(lines: Sequence[str]) -> int:
    """Return the unread length of lines, in characters other than quotes and spaces, plus 1.

    0 if it reads everything, -1 if the lines end within a list or text.
    """
    text = "\n".join(lines) + "\n"
    try:
        tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        place = _PLACE.search(str(error))
        rest = text.split("\n")[int(place[1]) - 1 :] if place else []
        return 1 + len(re.sub("[\\s\"']", "", "\n".join(rest)[int(place[2]) - 1 :])) if place else -1
    return 0


def _correct_line(line: str, path: Path) -> tuple[list[str], str]:
    """Return the rules that a line breaks, and the corrected line; no rules if no correction works."""
    rules: list[str] = []
    unread = _unread_length([line]) if len(line) <= _LONGEST else 0
    while unread > 0:
        rule, values = _correct_values(line, path)
        combined = [(f"{rule}; {_COMMA_RULE}", _COMMAS(values)[1])] if rule else []
        tried = [*(edit(line) for edit in _SIGNS), (rule, values), *combined, *(edit(line) for edit in _EDITS)]
        tried += _with_a_sign_more_or_less(line)
        rule, line = min(tried, key=lambda one: max(_unread_length([one[1]]), 0))
        unread, before = _unread_length([line]), unread
        if unread >= before:
            return [], line
        rules += [rule] if rule not in rules else []
    return rules, line


def _correct_values(line: str, path: Path) -> tuple[str, str]:
    """Return a line whose values are numbers or quoted, and the rule for the first value that was neither."""
    rules = []

    def value(match: re.Match[str]) -> str:
        if match[1] or not _unread_length([f"x = {match[3]}"]) or not _WRITTEN.match(match[3]):
            return match[0]
        inner = _INNER.search(line[: match.start(3)])
        in_braces = inner is not None and "{" in line[: inner.start()]
        rule, text = _correct_value(match[3], (*path, inner[1]) if inner and in_braces else path)
        rules.append(rule)
        return match[2] + text

    edited = _VALUE.sub(value, line) if "=" in line else line
    return rules[0] if rules else "", edited


def _correct_value(token: str, path: Path) -> tuple[str, str]:
    """Return the rule that a key's value breaks, and the corrected value."""
    if token.lower() in ("true", "false"):
        return "true and false must be in lower case", token.lower()
    point = re.sub(r"^([+-]?\d*),(\d)", r"\1.\2", token)
    rules = ["use a decimal point"] if point != token else []
    digits = _DIGITS.fullmatch(token)
    if digits is None or not (digits[2] or digits[4]):
        measured = token[0] in "+-−.0123456789"
        rules.append(_VALUE_QUOTED if measured else _TEXT_QUOTED)
        return "; ".join(rules), f'"{point}"'
    sign, integer_part, separator, part, power = digits.groups(default="")
    number = f"{sign}{integer_part.lstrip('0') or '0'}{f'.{part or 0}' if separator else ''}{power}"
    plain = "a number must have digits before and after its point" if separator else "a number must not begin with 0"
    rules = rules or [plain]
    unit = _example_unit(path)
    if not unit:
        return rules[0], number
    return f"{rules[0]}, and a unit ({unit}, if that is meant)", f'"{number} {unit}"'


def _example_unit(path: Path) -> str:
    """Return the unit in a key's example; "" if it has none."""
    example = next(
        (node["examples"][0] for node in schema_nodes_at(schema_of(Job), path) if node.get("examples")), None
    )
    first = example[0] if isinstance(example, list) and example else example
    parts = number_and_unit(first) if isinstance(first, str) else None
    return parts[1] if parts else ""


def _with_a_sign_more_or_less(line: str) -> Iterator[tuple[str, str]]:
    """Yield a line with one quote added at the edge of a text, then with one quote or bracket removed."""
    if re.search("[\"']", re.sub(_TEXT, "", line)):
        for place in (border.end() for border in _BORDER.finditer(line)):
            yield "text must have quotes on both sides", f'{line[:place]}"{line[place:]}'
    for sign in reversed(list(re.finditer("[]\"'[(){}]", line))):
        shortened = line[: sign.start()] + line[sign.end() :]
        if not _unread_length([shortened]):
            yield f"one {sign[0]} too many", shortened


def _bracket_heading(line: str) -> tuple[str, str]:
    """Return a table's heading in its brackets."""
    rule = "a heading must be one name in matching brackets, its parts joined by dots"
    if (heading_match := _NAMES.fullmatch(line)) is None:
        return rule, line
    opening, name, closing = heading_match.groups()
    words = re.findall(r"[\w-]+", name)
    tried = [words if len(words) < 3 else ["_".join(words)], ["_".join(words)], ["".join(words)]]
    count = min(len(opening) or len(closing), 2) if len(words) == 1 + name.count(".") else 0
    bracketed = f"{'[' * count}{name}{']' * count}" if count else line
    return rule, next(
        (heading for candidate in tried for heading in headings_with_keys(candidate, schema_of(Job))), bracketed
    )


def _unclosed_message(lines: Sequence[str], end: str) -> str:
    """Return the message on a list or text that begins in the last of the lines. end: where it is still open."""
    line = _without_comment(lines[-1])
    three = next((three for three in ('"""', "'''") if three in line), "")
    if three:
        rule = f"text that begins with {three} must end with {three}; on one line, use a single quote at each end"
        candidate = line.replace(three, '"')
        tried = [candidate, f'{candidate}"'] if not line.endswith(three) else []
    else:
        rule, tried = "a list must end with ]", [f"{line}]"]
    write = next(
        (f"write {_quote_line(candidate)}" for candidate in tried if not _unread_length([candidate])),
        f"add {three or ']'} where it ends",
    )
    return (
        f"{_line_prefix(len(lines), _path_of_last_line(lines))}{rule}; got {_quote_line(line)}, open at {end}; {write}"
    )


def _repeated_key_message(lines: Sequence[str], inner: str | None) -> str:
    """Return the message on a key or table that occurs in the last of the lines and above. inner: a key in braces."""
    *above, (last, path, brackets) = _paths_of_lines(lines)
    if inner:
        return f"{_line_prefix(last, (*path, inner))}may be given only once; got it twice; remove one"
    near = [one for one in above if one[1][: len(path)] == path or path[: len(one[1])] == one[1]]
    first, other, opened = max(near, key=lambda one: (min(len(one[1]), len(path)), one[1] == path))
    shared = min(path, other, key=len)
    if brackets and opened and brackets != opened:
        name = ".".join(map(str, shared))
        write = next(iter(headings_with_keys(name.split("."), schema_of(Job))), f"[{name}]")
        rule, wrong = (SEVERAL, f"[{name}]") if write.startswith("[[") else (SINGLE, f"[[{name}]]")
        number = first if wrong.startswith(f"{opened}{name[0]}") else last
        return f"{_line_prefix(number, shared)}{rule.format(name)}; got {wrong}; write {write}"
    remedy = "put both in one place, or remove one"
    if path == other and brackets:
        remedy = "move the lines below it there"
    elif path == other:
        header = next((one.split("#")[0].strip() for one in reversed(lines) if _HEADER.fullmatch(one[:_LONGEST])), "")
        moved = [n for n in range(first + 1, last + 1) if _mistake_in_value([header], lines[n - 1])]
        known = [
            item for name in schema_of(Job)["properties"] for item in headings_with_keys([name], schema_of(Job)).items()
        ]
        fits = [one for one, keys in known if path[-1] in keys and not _mistake_in_value([one], lines[-1])]
        if moved and fits:
            rule = f"this value belongs below the heading {fits[0]}"
            return f"{_line_prefix(last, path)}{rule}; got it below {header}; write {fits[0]} above line {moved[0]}"
        remedy = f"remove one, or begin another with {header} above it" if header.startswith("[[") else "remove one"
    rule = "may be given only once"
    return f"{_line_prefix(last, path)}{rule}; got {key_of_location(other)} in line {first} already; {remedy}"


def _paths_of_lines(lines: Sequence[str]) -> Iterator[tuple[int, Path, str]]:
    """Yield line, path and opening brackets of each table and, without brackets, of each key that starts a line."""
    table: Path = ()
    count = Counter[Path]()
    for number, line in enumerate((line[:_LONGEST] for line in lines), start=1):
        if header := _HEADER.fullmatch(line):
            name = table = _words_of_path(header[2])
            if header[1] == "[[":
                name = table = (*name, count[name])
                count[name[:-1]] += 1
            yield number, name, header[1]
        elif key := _KEY.match(line):
            yield number, (*table, *_words_of_path(key[1])), ""


def _words_of_path(path: str) -> Path:
    return tuple(word.strip("\"'") for word in re.findall(_WORD, path))


def _path_of_last_line(lines: Sequence[str]) -> Path:
    """Return the key that the last of the lines starts; an empty one if it starts none."""
    *_, (number, path, brackets) = ((0, (), ""), *_paths_of_lines(lines))
    return path if number == len(lines) and not brackets else ()


def _line_prefix(number: int, path: Path) -> str:
    """Return the prefix of a message on a line and its key."""
    return f"line {number}, {key_of_location(path)}: " if path else f"line {number}: "


def _quote_line(line: str, place: int = 0) -> str:
    """Return a line for a message: printable, and if long only the part around a position."""
    first = max(place - _LONGEST_EXCERPT // 2, 0) if len(line) > _LONGEST_EXCERPT else 0
    text = re.sub(f"[{SPACES}]", "␣", line[first:].strip(" \t").replace("\n", " and below it "))
    text = "".join(sign if sign.isprintable() else "?" for sign in text)
    return f"{'...' * (first > 0)}{text[:_LONGEST_EXCERPT]}{'...' * (len(text) > _LONGEST_EXCERPT)}"
