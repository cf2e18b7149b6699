"""Recipes of docs/architecture.md, followed: their code, and the suites that must take it up."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

PLUGIN = """
import slidercrank.{package} as package
package.__path__.append({folder!r})
"""


def code_of(root: Path, recipe: str) -> str:
    """Return the first block of Python in a section of the page, such as "A new method"."""
    section = (root / "docs" / "architecture.md").read_text(encoding="utf-8").split(f"## {recipe}")[1]
    block = re.search(r"^```python\n(.*?)^```$", section, flags=re.MULTILINE | re.DOTALL)
    assert block is not None
    return block[1]


def require_taken_up(root: Path, place: Path, code: str, package: str, name: str, suites: Sequence[str]) -> None:
    """Fail unless tests of suites take up, and pass, what a module added to a package declares under a name."""
    (place / "added").mkdir()
    (place / "added" / f"{name}.py").write_text(code, encoding="utf-8")
    plugin = PLUGIN.format(package=package, folder=str(place / "added"))
    (place / "adding.py").write_text(plugin, encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "adding", "-p", "no:cacheprovider", "-k", name, *suites],
        cwd=root,
        env=os.environ | {"PYTHONPATH": str(place), "PYTEST_ADDOPTS": ""},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    passed = re.search(r"(\d+) passed", done.stdout)
    assert passed is not None
    assert int(passed[1]) >= 5
