"""Test files that belong to what differs from a branch, one a line: `python -m tests.changed main`.

They are the test files that differ, and those named after a source file that differs or after the folder that it is in,
wherever they are in the mirror of its folder at the top: `service/topics/clearance/analysis.py` has all
`test_analysis*.py` and `test_clearance*.py` under `tests/service/`.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

SOURCES = ("model", "objectives", "optimise", "service", "benchmarks")


def belonging(file: Path, root: Path) -> list[Path]:
    """Return the test files that belong to a file, by paths from the top."""
    if file.suffix != ".py":
        return []
    if file.parts[0] == "tests" and file.name.startswith("test_"):
        return [file] if (root / file).is_file() else []
    if file.parts[0] not in SOURCES:
        return []
    names = {file.stem, *file.parts[1:-1][-1:]} - {"__init__"}
    tests = (found for name in names for found in (root / "tests" / file.parts[0]).rglob(f"test_{name}*.py"))
    return sorted({found.relative_to(root) for found in tests})


def changed(branch: str, root: Path) -> list[Path]:
    """Return the files that differ from where a branch was left, those not yet committed or added among them."""
    base = _git(root, "merge-base", branch, "HEAD")
    names = _git(root, "diff", "--name-only", *base, "--"), _git(root, "ls-files", "--others", "--exclude-standard")
    return [Path(name) for found in names for name in found]


def _git(root: Path, *arguments: str) -> list[str]:
    done = subprocess.run(["git", *arguments], cwd=root, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise SystemExit(f"git {' '.join(arguments)}: {done.stderr.strip()}")
    return done.stdout.splitlines()


def main(branch: str) -> None:
    """Print them."""
    root = Path.cwd()
    for test in sorted({test for file in changed(branch, root) for test in belonging(file, root)}):
        print(test)


if __name__ == "__main__":
    main(sys.argv[1])
