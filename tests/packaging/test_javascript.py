"""The tools that check the page's JavaScript: fixed versions, from whichever registry, and none of them shipped."""

from __future__ import annotations

import json
import re
import tomllib
from pathlib import Path
from typing import Any

import pytest


@pytest.fixture
def locked(pytestconfig: pytest.Config) -> dict[str, Any]:
    found: dict[str, Any] = json.loads((pytestconfig.rootpath / ".javascript/package-lock.json").read_text("utf-8"))
    return found


def test_every_tool_is_locked_by_version_and_checksum_and_none_by_address(locked: dict[str, Any]) -> None:
    packages = {name: package for name, package in locked["packages"].items() if name}
    assert len(packages) > 50
    for name, package in packages.items():
        assert re.fullmatch(r"\d+\.\d+\.\d+(-[\w.]+)?", package["version"]), name
        assert package["integrity"].startswith("sha512-"), name
        assert "resolved" not in package, name
        assert package["dev"] is True, name


def test_the_tools_that_are_asked_for_are_those_of_the_lock_file(
    locked: dict[str, Any], pytestconfig: pytest.Config
) -> None:
    asked = json.loads((pytestconfig.rootpath / ".javascript/package.json").read_text("utf-8"))["devDependencies"]
    assert asked == locked["packages"][""]["devDependencies"]
    assert asked == {name: locked["packages"][f"node_modules/{name}"]["version"] for name in asked}


def test_no_tool_and_no_type_is_part_of_the_wheel(pytestconfig: pytest.Config) -> None:
    root = pytestconfig.rootpath
    with (root / "pyproject.toml").open("rb") as file:
        shipped = tomllib.load(file)["tool"]["setuptools"]["package-data"]
    folders = {Path("service", *name.split(".")[2:]): patterns for name, patterns in shipped.items() if "." in name}
    files = [file for folder, patterns in folders.items() for one in patterns for file in (root / folder).glob(one)]
    assert {file.suffix for file in files} >= {".js", ".css", ".html"}
    assert [file for file in files if file.suffix == ".ts" or "node_modules" in file.parts] == []


def test_no_module_of_the_page_turns_the_checks_off(pytestconfig: pytest.Config) -> None:
    folders = ("service/page/static", "service/motion/player")
    files = [file for folder in folders for file in (pytestconfig.rootpath / folder).rglob("*.js")]
    assert len(files) > 70
    off = re.compile(r"@ts-(nocheck|ignore|expect-error)|eslint-disable|\{any\}|<any>|\bany\[\]")
    assert [file.name for file in files if off.search(file.read_text("utf-8"))] == []
