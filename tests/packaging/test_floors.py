"""The least versions that pyproject.toml allows. `.ci/floors` installs them and runs a part of everything."""

from __future__ import annotations

import re
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name
from packaging.version import Version

DEVELOPMENT = {"test", "docs", "benchmark"}  # extras of those who work on the project


@pytest.fixture(scope="module")
def root(pytestconfig: pytest.Config) -> Path:
    return pytestconfig.rootpath


@pytest.fixture(scope="module")
def project(root: Path) -> dict[str, Any]:
    with (root / "pyproject.toml").open("rb") as file:
        found: dict[str, Any] = tomllib.load(file)["project"]
    return found


@pytest.fixture(scope="module")
def floors(root: Path) -> dict[str, Version]:
    done = subprocess.run([sys.executable, root / ".ci/floors.py"], capture_output=True, text=True, check=True)
    lines = [line.partition("==") for line in done.stdout.splitlines()]
    return {name: Version(version) for name, _, version in lines}


def test_every_requirement_of_a_user_has_a_floor_which_the_tested_versions_are_not_below(
    root: Path, project: dict[str, Any], floors: dict[str, Version]
) -> None:
    extras = {name: lines for name, lines in project["optional-dependencies"].items() if name not in DEVELOPMENT}
    wanted = [Requirement(line) for lines in (project["dependencies"], *extras.values()) for line in lines]
    assert {need.name for need in wanted} - {"slidercrank"} <= floors.keys()
    pins = re.findall(r"^([\w.-]+)==([\w.]+)", (root / "constraints.txt").read_text(), re.MULTILINE)
    tested = {canonicalize_name(name): Version(version) for name, version in pins}
    assert [name for name, floor in floors.items() if tested.get(canonicalize_name(name), floor) < floor] == []


def test_a_package_with_two_floors_is_refused(root: Path) -> None:
    code = "from floors import floors; floors({'dependencies': ['a>=1'], 'optional-dependencies': {'b': ['a[c]>=2']}})"
    done = subprocess.run([sys.executable, "-c", code], cwd=root / ".ci", capture_output=True, text=True, check=False)
    assert "a package has one floor; got 1 and 2 of a" in done.stderr


def test_the_checks_of_every_change_run_the_floors(root: Path) -> None:
    assert re.search(r"^[^#]*\.ci/floors\b", (root / ".ci/run").read_text(), re.MULTILINE)
