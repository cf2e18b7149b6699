"""The Makefile gives pip the extras that its targets need, whole and as pyproject.toml names them."""

import re
import shlex
import shutil
import subprocess
import tomllib
from pathlib import Path

import pytest

pytestmark = pytest.mark.skipif(shutil.which("make") is None, reason="needs make")
EXTRAS = {
    "run": {"all"},
    "test": {"test"},
    "benchmark": {"test", "benchmark"},
    "pictures": {"test", "benchmark"},
}


def given_to_pip(root: Path, *targets: str) -> list[str]:
    """Return the requirement of each call of pip for the project that make would run if nothing were installed."""
    command = ["make", "--dry-run", "--always-make", "--no-print-directory", *targets]
    lines = subprocess.run(command, cwd=root, capture_output=True, text=True, check=True).stdout
    words = [shlex.split(line) for line in lines.splitlines() if " -m pip install " in line and " -e " in line]
    return [line[line.index("-e") + 1] for line in words]


def installing(root: Path) -> list[str]:
    """Return the targets of the Makefile that install the project."""
    rules = re.findall(r"^\$\(VENV\)/(\S+):.*\n\t\$\(call install,", (root / "Makefile").read_text(), re.MULTILINE)
    return [f".venv/{name}" for name in rules]


def extras(requirement: str) -> set[str]:
    """Return the extras of the project that a requirement asks for."""
    whole = re.fullmatch(r"\.\[([\w,-]+)\]", requirement)
    assert whole, f"not the project with extras: {requirement}"
    return {*whole[1].split(",")}


def test_every_target_that_installs_names_extras_of_the_project(pytestconfig: pytest.Config) -> None:
    root = pytestconfig.rootpath
    named = set(tomllib.loads((root / "pyproject.toml").read_text())["project"]["optional-dependencies"])
    targets = installing(root)
    assert len(targets) == (root / "Makefile").read_text().count("$(call install,") > 0
    for target in targets:
        (requirement,) = given_to_pip(root, target)
        assert extras(requirement) <= named


@pytest.mark.parametrize("target", EXTRAS)
def test_a_target_installs_all_that_it_needs(target: str, pytestconfig: pytest.Config) -> None:
    (requirement,) = given_to_pip(pytestconfig.rootpath, target)
    assert extras(requirement) == EXTRAS[target]
