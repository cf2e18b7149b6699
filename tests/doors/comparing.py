"""Comparison of two recordings: what differs, line by line, but for what a file allows with its reason.

[[allowed]]
cases = "turn/front-*"           # names of cases, with wildcards
lines = "crank_mm"               # a regular expression that a differing line must match; any line if left out
added = true                     # only lines that the second recording has besides; any if left out
reason = "lengths have four digits"
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass, field
from difflib import SequenceMatcher
from fnmatch import fnmatch
from pathlib import Path

_LINES, _WIDTH = 20, 160
_WHOLE = re.compile(r"(?:exit code|status) \d+$|--- |only in ")
_KEY = re.compile(r'^ *("[^"]*":) ?')
_WORD = re.compile(r'^"[^\s"]*",?$')
_DATUM = re.compile(r"(?<![\w.-])--[a-z][a-z-]+|(?<![\w.^])[-+\u2212]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?(?!\w)")


@dataclass
class Allowance:
    """Differences that are meant. used: how many lines, or whole cases, it covered. added: whether only new lines."""

    cases: str
    reason: str
    lines: str = ""
    added: bool = False
    used: int = 0

    def covers(self, case: str, line: str) -> bool:
        """Return whether a line of a case, with + or - before it, may differ; if so it is counted."""
        covered = fnmatch(case, self.cases) and re.search(self.lines, line[1:]) is not None
        covered = covered and not (self.added and line.startswith("-"))
        self.used += covered
        return covered


@dataclass
class Comparison:
    """Two recordings side by side. differences: text by case. allowed: how many lines differ as they may."""

    cases: int = 0
    differences: dict[str, str] = field(default_factory=dict)
    allowed: int = 0


def read_allowances(file: Path) -> list[Allowance]:
    """Return the differences that a file allows. Raises `TypeError` for one without cases or reason."""
    return [Allowance(**one) for one in tomllib.loads(file.read_text(encoding="utf-8")).get("allowed", [])]


def data_of(lines: list[str]) -> list[str]:
    """Return codes, files, keys, one-word values, options and numbers of a record, one per line.

    The words of sentences are left out, their numbers are not: what was only worded otherwise is the same. Drawings
    within HTML are left out too.
    """
    data: list[str] = []
    drawing = False
    for line in lines:
        drawing = (drawing or line.startswith("<svg")) and not line.startswith("</svg")
        if drawing:
            continue
        if _WHOLE.match(line):
            data.append(line)
            continue
        key = _KEY.match(line)
        value = line[key.end() :] if key else line.strip()
        before = f"{key[1]} " if key else ""
        found = (
            [value.rstrip(",")]
            if _WORD.match(value)
            else [_with_plain_number(datum) for datum in _DATUM.findall(value)]
        )
        data += [f"{before}{datum}" for datum in found] or ([before.strip()] if key else [])
    return data


def _with_plain_number(datum: str) -> str:
    """Return an option unchanged, and a number in one spelling: 9.10e-03 is 0.0091, -0 is 0."""
    return datum if datum.startswith("--") else f"{float(datum.replace(chr(0x2212), '-')) + 0.0:.12g}"


def compare(before: Path, after: Path, allowances: list[Allowance], *, data: bool = False) -> Comparison:
    """Compare two folders that `record` wrote. data: only what programs read, see `data_of`."""
    names = sorted({str(file.relative_to(top)) for top in (before, after) for file in top.rglob("*.txt")})
    found = Comparison(cases=len(names))
    for name in names:
        case = name.removesuffix(".txt")
        old, new = before / name, after / name
        if not (old.exists() and new.exists()):
            line = f"-only in {before}" if old.exists() else f"+only in {after}"
            if any(one.covers(case, line) for one in allowances):
                found.allowed += 1
            else:
                found.differences[case] = line[1:]
            continue
        texts = [file.read_text(encoding="utf-8").splitlines() for file in (old, new)]
        texts = [data_of(lines) for lines in texts] if data else texts
        changed = list(_differing_lines(*texts))
        left = [line for line in changed if not any(one.covers(case, line) for one in allowances)]
        found.allowed += len(changed) - len(left)
        if left:
            found.differences[case] = "\n".join(_shortened_lines(left))
    return found


def _differing_lines(before: list[str], after: list[str]) -> Iterator[str]:
    """Yield lines that one of two texts has and the other has not, with - or + before them."""
    for kind, start, end, begin, stop in SequenceMatcher(None, before, after, autojunk=False).get_opcodes():
        if kind != "equal":
            yield from (f"-{line}" for line in before[start:end])
            yield from (f"+{line}" for line in after[begin:stop])


def _shortened_lines(lines: list[str]) -> Iterator[str]:
    """Yield the first lines of a difference, long ones cut around the first place where they differ."""
    for index, line in enumerate(lines[:_LINES]):
        other = next((one for one in lines[max(0, index - 1) : index + 2] if one[0] != line[0]), line)
        at = next((i for i, pair in enumerate(zip(line[1:], other[1:], strict=False)) if pair[0] != pair[1]), 0)
        begin = max(0, at - _WIDTH // 2)
        text = line[1:][begin : begin + _WIDTH]
        yield f"  {line[0]} {'...' if begin else ''}{text}{'...' if len(line) > begin + _WIDTH + 1 else ''}"
    if len(lines) > _LINES:
        yield f"  ... and {len(lines) - _LINES} more lines"
