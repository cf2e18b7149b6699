"""Comparison of two recordings: what differs, line by line, but for what a file allows with its reason.

[[allowed]]
cases = "turn/front-*"           # names of cases, with wildcards
lines = "crank_mm"               # a regular expression that a differing line must match; any line if left out
reason = "lengths have four digits"
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass, field
from difflib import unified_diff
from fnmatch import fnmatch
from pathlib import Path

_LINES, _WIDTH = 20, 160


@dataclass
class Allowance:
    """Differences that are meant. used: how many lines, or whole cases, it covered."""

    cases: str
    reason: str
    lines: str = ""
    used: int = 0

    def covers(self, case: str, line: str) -> bool:
        """Return whether a line of a case may differ; if so it is counted."""
        covered = fnmatch(case, self.cases) and re.search(self.lines, line) is not None
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


def compare(before: Path, after: Path, allowances: list[Allowance]) -> Comparison:
    """Compare two folders that `record` wrote."""
    names = sorted({str(file.relative_to(top)) for top in (before, after) for file in top.rglob("*.txt")})
    found = Comparison(cases=len(names))
    for name in names:
        case = name.removesuffix(".txt")
        old, new = before / name, after / name
        if not (old.exists() and new.exists()):
            line = f"only in {before if old.exists() else after}"
            if any(one.covers(case, line) for one in allowances):
                found.allowed += 1
            else:
                found.differences[case] = line
            continue
        texts = [file.read_text(encoding="utf-8").splitlines() for file in (old, new)]
        _, _, *lines = unified_diff(texts[0], texts[1], n=0, lineterm="") if texts[0] != texts[1] else ("", "")
        changed = [line for line in lines if not line.startswith("@@")]
        left = [line for line in changed if not any(one.covers(case, line[1:]) for one in allowances)]
        found.allowed += len(changed) - len(left)
        if left:
            found.differences[case] = "\n".join(_short(left))
    return found


def _short(lines: list[str]) -> Iterator[str]:
    """Yield the first lines of a difference, long ones cut around the first place where they differ."""
    for index, line in enumerate(lines[:_LINES]):
        other = next((one for one in lines[max(0, index - 1) : index + 2] if one[0] != line[0]), line)
        at = next((i for i, pair in enumerate(zip(line[1:], other[1:], strict=False)) if pair[0] != pair[1]), 0)
        begin = max(0, at - _WIDTH // 2)
        text = line[1:][begin : begin + _WIDTH]
        yield f"  {line[0]} {'...' if begin else ''}{text}{'...' if len(line) > begin + _WIDTH + 1 else ''}"
    if len(lines) > _LINES:
        yield f"  ... and {len(lines) - _LINES} more lines"
