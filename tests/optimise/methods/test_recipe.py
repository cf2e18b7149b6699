"""The recipe of docs/architecture.md, followed: a method in one file is taken up by the contract tests unasked."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.recipes import code_of, require_taken_up

SUITES = ("test_checkpoints.py", "methods/test_registry.py", "test_enumeration.py")


@pytest.mark.slow
def test_a_method_in_one_file_is_taken_up_by_the_suites_of_all_methods(
    pytestconfig: pytest.Config, tmp_path: Path
) -> None:
    root = pytestconfig.rootpath
    code = code_of(root, "A new method")
    suites = [f"tests/optimise/{name}" for name in SUITES]
    require_taken_up(root, tmp_path, code, "optimise.methods", "halton", suites)
