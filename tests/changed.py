"""Test files that belong to what differs from a branch, one per line: `python -m tests.changed main`.

They are the test files that differ and, for every other file, those named after it or after its folder, anywhere in the
mirror of its top-level folder (`service/questions/clearance/analysis.py` has all `test_analysis*.py` and
`test_clearance*.py` under `tests/service/`), then those that import it. If these are fewer than three, those that
import it indirectly are added; the ones that mention most of its names come first. A source file without any test
file is an error.
"""

from __future__ import annotations

import re
import subprocess
import sys
from functools import cache
from pathlib import Path

from tests.imports import importers

PRODUCT = ("model", "objectives", "optimise", "service")
ENOUGH, MOST = 3, 6  # test files for one file: enough to notice a fault in about ten seconds

_NAMES = re.compile(
    r"^(?:(?:async )?def |class |export (?:async )?(?:function|class|const) |)([A-Za-z]\w{2,})\b(?=[(:= ])",
    re.MULTILINE,
)


def belonging(file: Path, root: Path, graph: dict[Path, set[Path]]) -> list[Path]:
    """Return the test files that belong to a file, by paths from the top. graph: what imports each file."""
    if _is_test(file):
        return [file]
    named = _tests_named_after(file, root)
    found = dict.fromkeys(named)
    words = _words(root / file)
    level, seen = {file}, {file}
    while level and len(found) < ENOUGH:
        level = {other for one in level for other in graph.get(one, ())} - seen
        seen |= level
        tests = [test for test in level if _is_test(test) and _is_quick(root / test)]
        found |= dict.fromkeys(sorted(tests, key=lambda test: (-_mentions(root / test, words), test)))
    return list(found)[: max(MOST, len(named))]


def _is_test(file: Path) -> bool:
    return file.suffix == ".py" and file.name.startswith("test_")


@cache
def _is_quick(test: Path) -> bool:
    """Return whether a test file has tests that are not slow."""
    return not re.search(r"^pytestmark = .*mark\.slow\b", test.read_text(encoding="utf-8"), re.MULTILINE)


def _tests_named_after(file: Path, root: Path) -> list[Path]:
    names = {file.stem, *file.parts[1:-1][-1:]} - {"__init__", "static", "lib"}
    tests = _tests_under(root / "tests" / file.parts[0])
    named = (test for test in tests if any(test.name.startswith(f"test_{name}") for name in names))
    return sorted(test.relative_to(root) for test in named if _is_quick(test))


@cache
def _tests_under(folder: Path) -> list[Path]:
    return [*folder.rglob("test_*.py")]


def _words(file: Path) -> set[str]:
    """Return the names by which tests refer to a file: its own and those that it defines."""
    return {file.stem, *_NAMES.findall(file.read_text(encoding="utf-8", errors="replace"))}


def _mentions(test: Path, words: set[str]) -> int:
    return len(words & _words_in(test))


@cache
def _words_in(test: Path) -> set[str]:
    return set(re.findall(r"\w+", test.read_text(encoding="utf-8")))


def changed(branch: str, root: Path) -> list[Path]:
    """Return the files that differ from the merge base with a branch, uncommitted and new files included.

    Deleted files are left out: files that still import them fail the type check.
    """
    base = _git(root, "merge-base", branch, "HEAD")
    names = _git(root, "diff", "--name-only", *base, "--"), _git(root, "ls-files", "--others", "--exclude-standard")
    return [Path(name) for found in names for name in found if (root / name).is_file()]


def _git(root: Path, *arguments: str) -> list[str]:
    done = subprocess.run(["git", *arguments], cwd=root, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise SystemExit(f"git {' '.join(arguments)}: {done.stderr.strip()}")
    return done.stdout.splitlines()


def main(branch: str) -> None:
    """Print the test files. Raises `SystemExit` if a source file has none."""
    root = Path.cwd()
    graph = importers(root)
    differing = [file for file in changed(branch, root) if file in graph or _is_test(file) or file.parts[0] in PRODUCT]
    tests = {file: belonging(file, root, graph) for file in differing}
    for test in sorted({test for found in tests.values() for test in found}):
        print(test)
    without = [
        file for file in differing if not tests[file] and file.parts[0] in PRODUCT and (root / file).stat().st_size
    ]
    if without:
        raise SystemExit(
            f"a source file needs a test that runs it; got none for {', '.join(map(str, without))}; import it in one, "
            f"or name one test_{without[0].stem}.py"
        )


if __name__ == "__main__":
    main(sys.argv[1])
