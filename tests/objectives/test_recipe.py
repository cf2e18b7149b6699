"""The recipe of docs/architecture.md, followed: a quantity in one file is taken up by the contract tests unasked."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

NAME = "rms_slider_acceleration"
SUITES = ("objectives/test_quantities.py", "optimise/test_units.py", "optimise/test_job.py")
PLUGIN = """
import slidercrank.objectives as package
package.__path__.append({folder!r})
"""


def test_a_quantity_in_one_file_is_taken_up_by_the_suites_of_all_quantities(
    pytestconfig: pytest.Config, tmp_path: Path
) -> None:
    root = pytestconfig.rootpath
    section = (root / "docs" / "architecture.md").read_text(encoding="utf-8").split("## A new quantity")[1]
    block = re.search(r"^```python\n(.*?)^```$", section, flags=re.MULTILINE | re.DOTALL)
    assert block is not None
    assert NAME in block[1]
    (tmp_path / "families").mkdir()
    (tmp_path / "families" / "recipe.py").write_text(block[1], encoding="utf-8")
    (tmp_path / "added.py").write_text(PLUGIN.format(folder=str(tmp_path / "families")), encoding="utf-8")
    suites = [f"tests/{name}" for name in SUITES]
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "added", "-p", "no:cacheprovider", "-k", NAME, *suites],
        cwd=root,
        env=os.environ | {"PYTHONPATH": str(tmp_path)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    passed = re.search(r"(\d+) passed", done.stdout)
    assert passed is not None
    assert int(passed[1]) >= 5
