"""Imports between tests, harness and benchmarks point one way: support <- faults <- benchmarks <- test files."""

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

ORDER = ("support of tests", "harness of faults", "benchmarks", "test files")  # each may import those before it


def test_imports_of_tests_harness_and_benchmarks_point_one_way(pytestconfig: pytest.Config) -> None:
    root = pytestconfig.rootpath
    files = [file for folder in ("tests", "benchmarks") for file in sorted((root / folder).rglob("*.py"))]
    assert {folder_of(file.relative_to(root)) for file in files} == set(ORDER)
    wrong = [
        f"{file.relative_to(root)}:{line} imports {imported.relative_to(root)}"
        for file in files
        for line, imported in imported_files(file, root)
        if ORDER.index(folder_of(imported.relative_to(root))) > ORDER.index(folder_of(file.relative_to(root)))
    ]
    assert not wrong, "\n".join(wrong)


def folder_of(file: Path) -> str:
    """Return where a file belongs, by its path from the top."""
    if file.parts[0] == "benchmarks":
        return "benchmarks"
    if file.name.startswith("test_") or file.name == "conftest.py":
        return "test files"
    return "harness of faults" if file.parts[1] == "faults" else "support of tests"


def imported_files(file: Path, root: Path) -> Iterator[tuple[int, Path]]:
    """Yield line and file of every import of tests or benchmarks, wherever it stands in a file."""
    package = file.relative_to(root).parent.parts
    for node in ast.walk(ast.parse(file.read_bytes())):
        if isinstance(node, ast.Import):
            paths = [alias.name.split(".") for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            module = node.module.split(".") if node.module else []
            base = [*package[: len(package) + 1 - node.level], *module] if node.level else module
            paths = [base, *([*base, alias.name] for alias in node.names)]
        else:
            continue
        for path in paths:
            found = root.joinpath(*path).with_suffix(".py")
            if path[0] in ("tests", "benchmarks") and found.is_file():
                yield node.lineno, found
