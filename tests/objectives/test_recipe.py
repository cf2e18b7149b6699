"""The recipe of docs/architecture.md, followed: a quantity in one file is taken up by the contract tests unasked."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.recipes import code_of, require_taken_up

NAME = "rms_slider_acceleration"
SUITES = (
    *("objectives/test_quantities.py", "objectives/test_units.py", "objectives/test_gradients.py"),
    *("optimise/test_job.py", "optimise/test_every_quantity_as_an_objective.py"),
)


@pytest.mark.slow
def test_a_quantity_in_one_file_is_taken_up_by_the_suites_of_all_quantities(
    pytestconfig: pytest.Config, tmp_path: Path
) -> None:
    root = pytestconfig.rootpath
    code = code_of(root, "A new quantity")
    assert NAME in code
    require_taken_up(root, tmp_path, code, "objectives", NAME, [f"tests/{name}" for name in SUITES])
